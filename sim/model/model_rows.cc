#include "sim/model/model_rows.h"

#include <vector>

#include "sim/law/effect_registry.h"
#include "sim/model/row_store.h"
#include "sim/robot/ball_handling.h"
#include "sim/robot/electric_model.h"

namespace omnihil {
namespace {

using enum ParameterKind;
using namespace store;

using E = ElectricModel;
constexpr std::string_view kDriveKinds[] = {"dc", "dq", "switched"};
constexpr std::string_view kPwmModes[] = {"complementary", "high_side_chop", "fast_decay"};
constexpr std::string_view kShapes[] = {"sine", "trapezoid"};
constexpr std::string_view kConstantsFor[] = {"as_driven", "block", "sinusoidal"};
constexpr std::string_view kShuntPlaces[] = {"phase", "low_side", "bus"};
constexpr std::string_view kMotorLoops[] = {"duty", "foc", "six_step", "emotional"};

constexpr std::uint32_t R = kRigRobot, A = kRigAxis, L = kRigLinearAxis, M = kRigMotor;
using H = BallHandling;
constexpr BallHandling kHandling{};  // the defaults
constexpr std::nullopt_t kNone = std::nullopt;
constexpr auto kLong = &RobotModel::tyre_longitudinal;
constexpr auto kLat = &RobotModel::tyre_lateral;
constexpr TyreCurve kLongDefault = kDefaultTyreLongitudinal, kLatDefault = kDefaultTyreLateral;

// section, key, kind, unit, otherwise, lower, upper, lower excluded, rigs, needed by, what, how, store
constexpr ParameterRow kRows[] = {
    {"", "format", kText, "", kNone, 0, 0, false, R | A | L | M, R | A | L | M, "\"omnihil-model/1\"", ""},
    {"", "rig", kText, "", kNone, 0, 0, false, R | A | L | M, R | A | L | M,
     "\"robot\" (wheels on the floor), \"axis\" (one drive) or \"motor\" (a motor's own file)", ""},
    {"", "linear", kTruth, "", 0, 0, 1, false, A | L, 0, "the axis moves along a line: N, m and kg", ""},
    {"", "name", kText, "", kNone, 0, 0, false, R | A | L | M, 0, "what it is, for people", ""},
    {"", "source", kText, "", kNone, 0, 0, false, R | A | L | M, 0, "where the numbers are from", ""},

    {"motor", "file", kText, "", kNone, 0, 0, false, R | A, 0, "motor file, relative to this one", ""},
    {"motor", "resistance_ohm", kNumber, "ohm", kNone, 0, 1000, true, R | A | L | M, R | M,
     "winding, phase to phase, bridge and leads included",
     "four-wire meter, three phase pairs, rotor turned between", motor<&MotorParams::resistance_ohm>},
    {"motor", "inductance_H", kNumber, "H", 0.0, 0, 1, false, R | A | L | M, 0, "winding, phase to phase",
     "LCR meter at 1 kHz, mean over one turn", motor<&MotorParams::inductance_H>},
    {"motor", "torque_constant_Nm_per_A", kNumber, "N m/A", kNone, 0, 100, true, R | A | M, R | M,
     "torque per ampere; the same number in V s/rad is the back-EMF constant",
     "turn it by hand drill, open leads: peak voltage between two phases over speed",
     motor<&MotorParams::torque_constant_Nm_per_A>},
    {"motor", "torque_constant_N_per_A", kNumber, "N/A", kNone, 0, 1e6, true, L, 0, "force per ampere",
     "spring balance against a known current"},
    {"motor", "pole_pairs", kWholeNumber, "1", 0, 0, 1000, false, R | A | L | M, 0,
     "magnet pole pairs; 0: unknown", "count magnets, or electrical periods per turn",
     motor<&MotorParams::pole_pairs>},
    {"motor", "slots", kWholeNumber, "1", 0, 0, 1000, false, R | A | L | M, 0, "stator teeth; 0: unknown",
     "count teeth"},
    {"motor", "rotor_inertia_kg_m2", kNumber, "kg m2", kNone, 0, 10, true, R | A | M, R | M,
     "rotor alone, about its axle", "run-up time at a known current",
     motor<&MotorParams::rotor_inertia_kg_m2>},
    {"motor", "viscous_friction_Nm_s_per_rad", kNumber, "N m s/rad", 0.0, 0, 10, false, R | A | M, 0,
     "friction torque per speed, at the rotor", "no-load current at several speeds: the slope",
     motor<&MotorParams::viscous_friction_Nm_s_per_rad>},
    {"motor", "viscous_friction_N_s_per_m", kNumber, "N s/m", 0.0, 0, 1e6, false, L, 0,
     "friction force per speed", "steady force at several speeds: the slope"},
    {"motor", "current_limit_A", kNumber, "A", 0.0, 0, 1000, false, R | A | M, 0,
     "bridge or supply never gives more; 0: none",
     "controller's setting; plateau of the current in a hard start", motor<&MotorParams::current_limit_A>},
    {"motor", "duty_limit_ratio", kNumber, "1", 1.0, 0, 1, true, R | A | M, 0,
     "largest duty the bridge gives", "controller's setting", motor<&MotorParams::duty_limit_ratio>},
    {"motor", "back_emf", kChoice, "", 0.0, 0, 1, false, R | M, 0,
     "shape of a phase's back-EMF; trapezoid: drive.kind = \"switched\" alone",
     "oscilloscope across two phases, turned by hand", part<&E::back_emf, &BackEmf::shape>, kShapes},
    {"motor", "flat_top_deg", kNumber, "deg", 120.0, 0, 179, false, R | M, 0,
     "electrical length of a trapezoid's top", "oscilloscope", degrees<&E::back_emf, &BackEmf::flat_top_rad>},
    {"motor", "torque_constant_for", kChoice, "", 0.0, 0, 2, false, R | M, 0,
     "commutation that torque_constant belongs to; as_driven: the drive's own", "data sheet: most say block",
     electric<&E::constant_for>, kConstantsFor},
    {"motor", "saliency_ratio", kNumber, "1", 1.0, 0.1, 10, false, R | M, 0,
     "L_q over L_d, their mean being half of inductance_H; drive.kind = \"dq\" alone",
     "LCR meter over the rotor's angle: largest and smallest", electric<&E::saliency_ratio>},
    {"motor", "inductance_saturation_per_A", kNumber, "1/A", 0.0, 0, 10, false, R | M, 0,
     "L / (1 + (s i)^2) per axis; drive.kind = \"dq\" alone", "slope of a current step at several currents",
     electric<&E::inductance_saturation_per_A>},
    {"motor", "flux_saturation_per_A", kNumber, "1/A", 0.0, 0, 10, false, R | M, 0,
     "flux linkage / (1 + (s i_q)^2); drive.kind = \"dq\" alone", "torque over current up to the largest",
     electric<&E::flux_saturation_per_A>},

    {"gear", "ratio", kNumber, "1", 1.0, 0, 10000, true, R | A, 0, "rotor turns per output turn",
     "count teeth", robot<&RobotModel::gear_ratio>},
    {"load", "inertia_kg_m2", kNumber, "kg m2", 0.0, 0, 1e6, false, A, 0, "what turns at the output shaft",
     "from its drawing, or run-up with and without it"},
    {"load", "gravity_torque_Nm", kNumber, "N m", 0.0, 0, 1e6, false, A, 0,
     "m g l of a pendulum at the output; position 0 hangs down", "scales and ruler"},
    {"load", "mass_kg", kNumber, "kg", kNone, 0, 1e6, true, L, L, "everything that moves along the axis",
     "scales"},
    {"supply", "voltage_V", kNumber, "V", kNone, 0, 1000, true, R | A | L, R, "bus voltage at the bridge",
     "meter at the bridge, motors idle", robot<&RobotModel::bus_voltage_V>},
    {"supply", "capacitance_F", kNumber, "F", 0.0, 0, 10, false, R, 0,
     "capacitor on the bus; needs a [battery]", "its print", electric<&E::bus_capacitance_F>},
    {"drive", "kind", kChoice, "", 0.0, 0, 2, false, R, 0,
     "dc: DC-equivalent motor; dq: three phases, averaged; switched: three phases, every edge of the bridge",
     "", electric<&E::kind>, kDriveKinds},
    {"drive", "pwm_frequency_Hz", kNumber, "Hz", kNone, 0, 1e7, true, R | A | L, 0,
     "switching frequency of the bridge; three phases: 20000 if not given, 8000 to 100000",
     "oscilloscope, or the firmware's timer setting", pwm_frequency},
    {"drive", "pwm_mode", kChoice, "", 0.0, 0, 2, false, R, 0,
     "how a switched drive that is given a duty chops", "the bridge's data sheet", electric<&E::pwm_mode>,
     kPwmModes},
    {"drive", "dead_time_s", kNumber, "s", 0.0, 0, 1e-4, false, R, 0, "both switches of a leg off at an edge",
     "the bridge's setting", part<&E::inverter, &Inverter::dead_time_s>},
    {"drive", "switch_resistance_ohm", kNumber, "ohm", 0.0, 0, 10, false, R, 0,
     "one switch, where resistance_ohm of the motor leaves the bridge out", "data sheet",
     part<&E::inverter, &Inverter::switch_resistance_ohm>},
    {"drive", "diode_forward_V", kNumber, "V", 0.0, 0, 5, false, R, 0, "of a freewheeling diode",
     "data sheet", part<&E::inverter, &Inverter::diode_forward_V>},
    {"battery", "cells", kWholeNumber, "1", 0.0, 0, 100, false, R, 0,
     "lithium-polymer cells in series; 0: no battery, the bus stays at voltage_V", "its label",
     part<&E::battery, &BatteryParams<double>::cells>},
    {"battery", "capacity_Ah", kNumber, "Ah", 1.3, 0, 1000, true, R, 0, "full charge", "its label",
     battery_capacity},
    {"battery", "resistance_ohm", kNumber, "ohm", 0.04, 0, 10, true, R, 0, "whole pack with leads",
     "dip of the voltage under a known current", part<&E::battery, &BatteryParams<double>::resistance_ohm>},
    {"battery", "charge_ratio", kNumber, "1", 1.0, 0, 1, true, R, 0, "charge at the start, of the full one",
     "voltage at rest", electric<&E::battery_charge_ratio>},
    {"battery", "refuses_charge", kTruth, "", 0.0, 0, 1, false, R, 0,
     "no current goes back into it: braking pumps the bus up", "a diode in the lead, or a bench supply",
     battery_refuses},
    {"thermal", "winding_to_housing_K_per_W", kNumber, "K/W", 0.0, 0, 1000, false, R | M, 0,
     "R_th2 of the data sheet; 0: no heat is reckoned", "data sheet",
     part<&E::heat, &HeatModel::winding_to_housing_K_per_W>},
    {"thermal", "housing_to_ambient_K_per_W", kNumber, "K/W", 0.0, 0, 1000, false, R | M, 0,
     "R_th1 of the data sheet, as mounted", "data sheet",
     part<&E::heat, &HeatModel::housing_to_ambient_K_per_W>},
    {"thermal", "winding_time_constant_s", kNumber, "s", 0.0, 0, 1e5, false, R | M, 0, "of the winding alone",
     "data sheet", part<&E::heat, &HeatModel::winding_time_constant_s>},
    {"thermal", "housing_time_constant_s", kNumber, "s", 0.0, 0, 1e6, false, R | M, 0,
     "of the motor as a whole", "data sheet", part<&E::heat, &HeatModel::housing_time_constant_s>},
    {"thermal", "copper_per_K", kNumber, "1/K", kCopperPerK, 0, 0.1, false, R | M, 0,
     "rise of the winding's resistance", "of the metal", part<&E::heat, &HeatModel::copper_per_K>},
    {"thermal", "magnet_per_K", kNumber, "1/K", kNeodymiumPerK, -0.1, 0, false, R | M, 0,
     "change of the magnets' flux", "of the magnet's grade", part<&E::heat, &HeatModel::magnet_per_K>},
    {"hall", "mounting_error_deg", kNumber, "deg", 0.0, -180, 180, false, R | M, 0,
     "electrical, of all three sensors", "edges against the back-EMF's crossings",
     degrees<&E::hall, &HallParams::mounting_error_rad>},
    {"hall", "offset_1_deg", kNumber, "deg", 0.0, -60, 60, false, R | M, 0, "electrical, of the first alone",
     "lengths of the six sectors at steady speed", hall_offset<0>},
    {"hall", "offset_2_deg", kNumber, "deg", 0.0, -60, 60, false, R | M, 0, "of the second", "as the first",
     hall_offset<1>},
    {"hall", "offset_3_deg", kNumber, "deg", 0.0, -60, 60, false, R | M, 0, "of the third", "as the first",
     hall_offset<2>},
    {"hall", "glitch_ratio", kNumber, "1", 0.0, 0, 1, false, R | M, 0,
     "of the reads in which one sensor is inverted", "count codes that are no neighbour's",
     part<&E::hall, &HallParams::glitch_probability>},
    {"angle_sensor", "bits", kWholeNumber, "1", 0.0, 0, 24, false, R | M, 0,
     "of the absolute encoder that gives the electrical angle; 0: not rounded", "data sheet",
     part<&E::angle, &AbsoluteEncoderParams::bits>},
    {"angle_sensor", "zero_deg", kNumber, "deg", 0.0, -180, 180, false, R | M, 0,
     "rotor angle it shows too much: an error of alignment", "current against torque",
     degrees<&E::angle, &AbsoluteEncoderParams::zero_rad>},
    {"angle_sensor", "eccentricity_deg", kNumber, "deg", 0.0, 0, 30, false, R | M, 0,
     "error of order 1 over the rotor's turn", "against a second encoder",
     degrees<&E::angle, &AbsoluteEncoderParams::eccentricity_rad>},
    {"angle_sensor", "latency_s", kNumber, "s", 0.0, 0, 0.01, false, R | M, 0, "age of what it shows",
     "data sheet", part<&E::angle, &AbsoluteEncoderParams::latency_s>},
    {"current_sensor", "place", kChoice, "", 0.0, 0, 2, false, R, 0, "where the shunt is", "the board",
     part<&E::current_sensor, &CurrentSensor::place>, kShuntPlaces},
    {"current_sensor", "bits", kWholeNumber, "1", 0.0, 0, 24, false, R, 0, "of the ADC; 0: not rounded",
     "data sheet", part<&E::current_sensor, &CurrentSensor::bits>},
    {"current_sensor", "shunt_ohm", kNumber, "ohm", 1e-3, 0, 1, true, R, 0, "the shunt", "the board",
     part<&E::current_sensor, &CurrentSensor::shunt_ohm>},
    {"current_sensor", "amplifier_gain", kNumber, "1", 20.0, 0, 10000, true, R, 0,
     "from the shunt to the ADC", "the board", part<&E::current_sensor, &CurrentSensor::amplifier_gain>},
    {"current_sensor", "reference_V", kNumber, "V", 3.3, 0, 100, true, R, 0,
     "full scale of the ADC, zero current in its middle", "the board",
     part<&E::current_sensor, &CurrentSensor::reference_V>},
    {"current_sensor", "gain_error_ratio", kNumber, "1", 0.0, -0.9, 10, false, R, 0,
     "that the firmware does not know of", "against a meter",
     part<&E::current_sensor, &CurrentSensor::gain_error_ratio>},
    {"current_sensor", "offset_V", kNumber, "V", 0.0, -10, 10, false, R, 0, "at the ADC's input",
     "reading without current", part<&E::current_sensor, &CurrentSensor::offset_V>},
    {"current_sensor", "noise_V", kNumber, "V", 0.0, 0, 10, false, R, 0, "one sigma at the ADC's input",
     "spread of the reading without current", part<&E::current_sensor, &CurrentSensor::noise_sigma_V>},
    {"current_sensor", "sample_ratio", kNumber, "1", 0.0, 0, 1, false, R, 0,
     "instant within the PWM period; 0: middle of the off-time, 0.5: middle of the on-time", "the firmware",
     electric<&E::current_sample_ratio>},
    {"servo", "kp_duty_per_rad", kNumber, "1/rad", kNone, 0, 1e6, true, A, 0,
     "duty per position error of a position servo", "the servo's register"},
    {"servo", "duty_limit", kNumber, "1", 1.0, 0, 1, true, A, 0, "largest duty of the servo",
     "the servo's register"},

    {"controller", "kp_V_s_per_rad", kNumber, "V s/rad", 0.0, 0, 1e3, false, R, 0,
     "what makes duties of radio commands: volts per rad/s of the rotor's speed error",
     "the firmware's source"},
    {"controller", "ki_V_per_rad", kNumber, "V/rad", 0.0, 0, 1e5, false, R, 0,
     "volts per rad of the error's integral", "the firmware's source"},
    {"controller", "feedforward_V_s_per_rad", kNumber, "V s/rad", 0.0, 0, 100, false, R, 0,
     "volts per rad/s of the rotor's reference", "the firmware's source"},
    {"controller", "acceleration_feedforward_V_s2_per_rad", kNumber, "V s2/rad", 0.0, 0, 100, false, R, 0,
     "volts per rad/s2 of the rotor's reference", "the firmware's source"},
    {"controller", "integral_limit_ratio", kNumber, "1", 1.0, 0, 10, false, R, 0,
     "largest integral, of the bus voltage", "the firmware's source"},
    {"controller", "rate_limit_rad_s2", kNumber, "rad/s2", 0.0, 0, 1e6, false, R, 0,
     "fastest change of the rotor's reference under commands of wheel speeds; 0: none",
     "the firmware's source"},
    {"controller", "speed_filter_s", kNumber, "s", 0.0, 0, 1, false, R, 0,
     "time constant of the low pass on the measured speed; 0: none", "the firmware's source"},
    {"controller", "planned_grip", kNumber, "1", 0.0, 0, 10, false, R, 0,
     "friction coefficient that changes of the body's velocity are planned with, by the hardest-worked "
     "wheel; 0: none",
     "the firmware's source"},
    {"controller", "report_filter_s", kNumber, "s", 0.0, 0, 1, false, R, 0,
     "time constant of the low pass on the speeds that telemetry tells; 0: as the loop sees them",
     "the firmware's source"},
    {"controller", "latency_s", kNumber, "s", 0.0, 0, 0.5, false, R, 0,
     "from a command's time in the record to the loop that follows it",
     "step the command, film wheel and lamp"},
    {"controller", "acceleration_limit_m_s2", kNumber, "m/s2", 0.0, 0, 100, false, R, 0,
     "fastest change of the body's commanded velocity; 0: none", "the firmware's source"},
    {"controller", "yaw_acceleration_limit_rad_s2", kNumber, "rad/s2", 0.0, 0, 1e4, false, R, 0,
     "the same of its turning; 0: none", "the firmware's source"},
    {"controller", "period_s", kNumber, "s", 1e-3, 1e-4, 0.1, false, R, 0, "of the control loop",
     "the firmware's source"},
    {"controller", "timeout_s", kNumber, "s", 0.0, 0, 3600, false, R, 0,
     "without a command for so long the references are zero; 0: never", "the firmware's source"},
    {"controller", "wheel_radius_m", kNumber, "m", kNone, 0, 1, true, R, 0,
     "of the firmware's own geometry, for commands of the body's velocity", "the firmware's source"},
    {"controller", "wheel_center_radius_m", kNumber, "m", kNone, 0, 1, true, R, 0,
     "of the firmware's own geometry", "the firmware's source"},

    {"encoder", "counts_per_turn", kWholeNumber, "counts", 4096, 1, 1e9, false, R | A | M, 0,
     "per rotor turn, after quadrature (four per line)", "turn ten times by hand and read the counter",
     encoder<&EncoderParams::counts_per_turn>},
    {"encoder", "direction", kWholeNumber, "1", 1, -1, 1, false, R | A | M, 0,
     "1: counts rise with positive rotation; -1: they fall",
     "turn the wheel counter-clockwise and read the counter", encoder<&EncoderParams::direction>},
    {"encoder", "index_offset_counts", kWholeNumber, "counts", 0, 0, 1e9, false, R | A | M, 0,
     "count within a turn at which the index line is high", "counter at the index pulse",
     encoder<&EncoderParams::index_offset_counts>},

    {"robot", "mass_kg", kNumber, "kg", kNone, 0, 100, true, R, R, "whole robot with battery and wheels",
     "scales", robot<&RobotModel::mass_kg>},
    {"robot", "yaw_inertia_kg_m2", kNumber, "kg m2", kNone, 0, 10, true, R, R,
     "whole robot about the vertical through its centre", "period on a two-string swing",
     robot<&RobotModel::yaw_inertia_kg_m2>},
    {"robot", "center_of_mass_height_m", kNumber, "m", kNone, 0, 1, false, R, R, "above the floor",
     "tip it until it balances on two wheels", robot<&RobotModel::center_of_mass_height_m>},
    {"robot", "center_of_mass_x_m", kNumber, "m", 0.0, -1, 1, false, R, 0, "ahead of the geometric centre",
     "scales under each wheel", robot<&RobotModel::center_of_mass_x_m>},
    {"robot", "center_of_mass_y_m", kNumber, "m", 0.0, -1, 1, false, R, 0, "left of the geometric centre",
     "scales under each wheel", robot<&RobotModel::center_of_mass_y_m>},
    {"robot", "wheel_center_radius_m", kNumber, "m", kNone, 0, 1, true, R, R,
     "R_b: geometric centre to wheel contact", "ruler, across two opposite wheels",
     robot<&RobotModel::wheel_center_radius_m>},
    {"robot", "wheel_radius_m", kNumber, "m", kNone, 0, 1, true, R, R, "axle to floor, rollers included",
     "way rolled in ten turns", robot<&RobotModel::wheel_radius_m>},
    {"robot", "wheel_mass_kg", kNumber, "kg", 0.06, 0, 10, true, R, 0, "one wheel; the default is a guess",
     "scales", robot<&RobotModel::wheel_mass_kg>},
    {"robot", "wheel_inertia_kg_m2", kNumber, "kg m2", kNone, 0, 1, false, R, R,
     "one wheel about its axle, without the rotor", "from its drawing: about m r^2 / 2",
     robot<&RobotModel::wheel_inertia_kg_m2>},
    {"robot", "wheel_angle_deg", kWheelNumbers, "deg", kNone, -360, 360, false, R, R,
     "where each wheel sits, from x (forward) towards y (left)", "drawing", wheel_angles},
    {"robot", "rollers_per_wheel", kWholeNumber, "1", 0, 0, 1000, false, R, 0, "0: unknown", "count",
     robot<&RobotModel::rollers_per_wheel>},
    {"robot", "slip_speed_floor_m_s", kNumber, "m/s", kDefaultSlipSpeedFloor_m_s, 0, 10, true, R, 0,
     "below this speed slip is taken relative to it", "a choice: larger is softer at standstill",
     robot<&RobotModel::slip_speed_floor_m_s>},

    {"tyre.longitudinal", "extremum_slip", kNumber, "1", kLongDefault.extremum_slip, 0, 10, true, R, 0,
     "slip of the largest grip", "pull test: slip at break-away", tyre<kLong, &TyreCurve::extremum_slip>},
    {"tyre.longitudinal", "extremum_value", kNumber, "1", kLongDefault.extremum_value, 0, 5, true, R, 0,
     "largest grip: force over wheel load", "pull test: largest force over weight",
     tyre<kLong, &TyreCurve::extremum_value>},
    {"tyre.longitudinal", "asymptote_slip", kNumber, "1", kLongDefault.asymptote_slip, 0, 100, true, R, 0,
     "slip from which grip stays", "pull test with spinning wheels", tyre<kLong, &TyreCurve::asymptote_slip>},
    {"tyre.longitudinal", "asymptote_value", kNumber, "1", kLongDefault.asymptote_value, 0, 5, false, R, 0,
     "grip of a spinning wheel", "pull test with spinning wheels", tyre<kLong, &TyreCurve::asymptote_value>},
    {"tyre.lateral", "extremum_slip", kNumber, "1", kLatDefault.extremum_slip, 0, 10, true, R, 0,
     "slip of the largest roller drag", "a choice", tyre<kLat, &TyreCurve::extremum_slip>},
    {"tyre.lateral", "extremum_value", kNumber, "1", kLatDefault.extremum_value, 0, 5, true, R, 0,
     "largest roller drag: force over wheel load",
     "push the robot along one axle's direction, spring balance", tyre<kLat, &TyreCurve::extremum_value>},
    {"tyre.lateral", "asymptote_slip", kNumber, "1", kLatDefault.asymptote_slip, 0, 100, true, R, 0,
     "slip from which the drag stays", "a choice", tyre<kLat, &TyreCurve::asymptote_slip>},
    {"tyre.lateral", "asymptote_value", kNumber, "1", kLatDefault.asymptote_value, 0, 5, false, R, 0,
     "roller drag at speed", "push the robot at speed, spring balance",
     tyre<kLat, &TyreCurve::asymptote_value>},

    {"hull", "radius_m", kNumber, "m", kHandling.outline.radius_m, 0.01, 0.5, false, R, 0,
     "circle about the geometric centre", "drawing; the league allows 0.09",
     handling<&H::outline, &RobotOutline::radius_m>},
    {"hull", "front_m", kNumber, "m", kHandling.outline.front_m, 0.005, 0.5, false, R, 0,
     "from the geometric centre to the flat front", "drawing", handling<&H::outline, &RobotOutline::front_m>},
    {"hull", "height_m", kNumber, "m", kHandling.outline.height_m, 0.01, 1, false, R, 0,
     "of the hull, floor to top", "drawing; the league allows 0.15",
     handling<&H::outline, &RobotOutline::height_m>},
    {"hull", "restitution", kNumber, "1", kHandling.restitution, 0, 1, false, R, 0, "of a ball that meets it",
     "film of a ball that rolls against it: speed after over before", handling<&H::restitution>},
    {"hull", "friction", kNumber, "1", kHandling.friction, 0, 5, false, R, 0, "with the ball", "tilted plate",
     handling<&H::friction>},
    {"kicker", "pulse_unit_s", kNumber, "s", kHandling.kick.pulse_unit_s, 0, 1, true, R, 0,
     "k = pulse over this", "the firmware's scale", handling<&H::kick, &KickLaw::pulse_unit_s>},
    {"kicker", "c0_m_s", kNumber, "m/s", kHandling.kick.c[0], -100, 100, false, R, 0,
     "speed of the ball = c0 + c1 k + c2 k^2 + c3 k^3, capacitor full", "omnihil field kick TABLE.csv",
     kick_coefficient<0>},
    {"kicker", "c1_m_s", kNumber, "m/s", kHandling.kick.c[1], -100, 100, false, R, 0, "per k", "",
     kick_coefficient<1>},
    {"kicker", "c2_m_s", kNumber, "m/s", kHandling.kick.c[2], -100, 100, false, R, 0, "per k squared", "",
     kick_coefficient<2>},
    {"kicker", "c3_m_s", kNumber, "m/s", kHandling.kick.c[3], -100, 100, false, R, 0, "per k cubed", "",
     kick_coefficient<3>},
    {"kicker", "k_least", kNumber, "1", kHandling.kick.k_least, 0, 1e6, false, R, 0, "no kick below", "",
     handling<&H::kick, &KickLaw::k_least>},
    {"kicker", "k_most", kNumber, "1", kHandling.kick.k_most, 0, 1e6, true, R, 0,
     "a longer pulse kicks as this one", "", handling<&H::kick, &KickLaw::k_most>},
    {"kicker", "chip_network", kText, "", kNone, 0, 0, false, R, 0,
     "speed and angle of a chip: the numbers that omnihil field chip prints", "omnihil field chip TABLE.csv"},
    {"kicker", "reach_m", kNumber, "m", kHandling.kick_reach_m, 0, 0.1, true, R, 0,
     "from the front: how far the plunger takes the ball", "drawing", handling<&H::kick_reach_m>},
    {"kicker", "half_width_m", kNumber, "m", kHandling.kick_half_width_m, 0, 0.1, true, R, 0,
     "of the plunger", "drawing", handling<&H::kick_half_width_m>},
    {"kicker", "capacitance_F", kNumber, "F", kHandling.capacitor.capacitance_F, 0, 1, true, R, 0,
     "of the kicker's capacitor", "its print", handling<&H::capacitor, &KickCapacitor::capacitance_F>},
    {"kicker", "full_V", kNumber, "V", kHandling.capacitor.full_V, 0, 1000, true, R, 0, "where charging ends",
     "the charger's setting", handling<&H::capacitor, &KickCapacitor::full_V>},
    {"kicker", "charge_power_W", kNumber, "W", kHandling.capacitor.charge_power_W, 0, 1e4, true, R, 0,
     "out of the bus while it charges", "bus current while it charges",
     handling<&H::capacitor, &KickCapacitor::charge_power_W>},
    {"kicker", "charge_efficiency", kNumber, "1", kHandling.capacitor.charge_efficiency, 0, 1, true, R, 0,
     "of the charger", "energy in the capacitor over energy out of the bus",
     handling<&H::capacitor, &KickCapacitor::charge_efficiency>},
    {"kicker", "kick_efficiency", kNumber, "1", kHandling.capacitor.kick_efficiency, 0, 1, true, R, 0,
     "energy in the ball over energy out of the capacitor", "voltage before and after a kick",
     handling<&H::capacitor, &KickCapacitor::kick_efficiency>},
    {"dribbler", "bar_x_m", kNumber, "m", kHandling.dribbler.bar_x_m, 0, 0.5, true, R, 0,
     "axle of the bar, from the geometric centre", "drawing",
     handling<&H::dribbler, &DribblerModel::bar_x_m>},
    {"dribbler", "bar_z_m", kNumber, "m", kHandling.dribbler.bar_z_m, 0, 0.2, true, R, 0,
     "the same, above the floor", "drawing", handling<&H::dribbler, &DribblerModel::bar_z_m>},
    {"dribbler", "bar_radius_m", kNumber, "m", kHandling.dribbler.bar_radius_m, 0, 0.05, true, R, 0,
     "of the bar, rubber included", "drawing", handling<&H::dribbler, &DribblerModel::bar_radius_m>},
    {"dribbler", "half_width_m", kNumber, "m", kHandling.dribbler.half_width_m, 0, 0.1, true, R, 0,
     "of the bar", "drawing", handling<&H::dribbler, &DribblerModel::half_width_m>},
    {"dribbler", "friction", kNumber, "1", kHandling.dribbler.friction, 0, 5, false, R, 0,
     "of its material on the ball", "tilted plate of it", handling<&H::dribbler, &DribblerModel::friction>},
    {"dribbler", "mount_stiffness_N_per_m", kNumber, "N/m", kHandling.dribbler.mount_stiffness_N_per_m, 0,
     1e6, true, R, 0, "of the bar's mount, along the push", "spring balance",
     handling<&H::dribbler, &DribblerModel::mount_stiffness_N_per_m>},
    {"dribbler", "mount_damping_N_s_per_m", kNumber, "N s/m", kHandling.dribbler.mount_damping_N_s_per_m, 0,
     1e4, false, R, 0, "of the same", "film of a ball that comes in",
     handling<&H::dribbler, &DribblerModel::mount_damping_N_s_per_m>},
    {"dribbler", "inertia_kg_m2", kNumber, "kg m2", kHandling.dribbler.inertia_kg_m2, 0, 1, true, R, 0,
     "bar and rotor, at the bar", "run-up time", handling<&H::dribbler, &DribblerModel::inertia_kg_m2>},
    {"dribbler", "gear_ratio", kNumber, "1", kHandling.dribbler.gear_ratio, 0, 1000, true, R, 0,
     "rotor turns per turn of the bar", "count teeth", handling<&H::dribbler, &DribblerModel::gear_ratio>},
    {"dribbler", "resistance_ohm", kNumber, "ohm", kHandling.dribbler.resistance_ohm, 0, 1000, true, R, 0,
     "of its motor", "data sheet", handling<&H::dribbler, &DribblerModel::resistance_ohm>},
    {"dribbler", "torque_constant_Nm_per_A", kNumber, "N m/A", kHandling.dribbler.torque_constant_Nm_per_A, 0,
     100, true, R, 0, "of its motor", "data sheet",
     handling<&H::dribbler, &DribblerModel::torque_constant_Nm_per_A>},
    {"dribbler", "friction_Nm", kNumber, "N m", kHandling.dribbler.friction_Nm, 0, 10, false, R, 0,
     "bearings and belt, at the bar", "no-load current", handling<&H::dribbler, &DribblerModel::friction_Nm>},
    {"dribbler", "current_limit_A", kNumber, "A", kHandling.dribbler.current_limit_A, 0, 1000, true, R, 0,
     "of its bridge", "the bridge's setting", handling<&H::dribbler, &DribblerModel::current_limit_A>},
    {"break_beam", "forward_m", kNumber, "m", kHandling.beam.forward_m, -0.1, 0.2, false, R, 0,
     "ray before the front", "drawing", handling<&H::beam, &BreakBeam::forward_m>},
    {"break_beam", "height_m", kNumber, "m", kHandling.beam.height_m, 0, 0.2, false, R, 0, "above the floor",
     "drawing", handling<&H::beam, &BreakBeam::height_m>},
    {"break_beam", "reaction_s", kNumber, "s", kHandling.beam.reaction_s, 0, 1, false, R, 0,
     "from a change to its telling", "oscilloscope", handling<&H::beam, &BreakBeam::reaction_s>},
    {"break_beam", "false_rate_Hz", kNumber, "Hz", kHandling.beam.false_rate_Hz, 0, 1e4, false, R, 0,
     "false triggers per second", "count without a ball", handling<&H::beam, &BreakBeam::false_rate_Hz>},
    {"break_beam", "false_time_s", kNumber, "s", kHandling.beam.false_time_s, 0, 10, true, R, 0,
     "length of one", "oscilloscope", handling<&H::beam, &BreakBeam::false_time_s>},
    {"firmware", "command_timeout_s", kNumber, "s", 0.0, 0, 3600, false, R, 0,
     "the robot stops this long after the last command; 0: the firmware's own", "the firmware's setting",
     robot<&RobotModel::control_timeout_s>},
    {"firmware", "motor_loop", kChoice, "", 0.0, 0, 3, false, R, 0,
     "what the reference firmware gives its bridges: duties, or three legs by field-oriented or six-step "
     "control; emotional: duties, by BELBIC in place of PI",
     "", motor_loop, kMotorLoops},
    {"firmware", "radio", kText, "", kNone, 0, 0, false, R, 0,
     "radio format the robot speaks: ulaval-hermes …", ""},

    {"datasheet", "nominal_voltage_V", kNumber, "V", kNone, 0, 1000, true, M, 0,
     "voltage of the sheet's figures", "data sheet; for checking the model"},
    {"datasheet", "no_load_speed_rpm", kNumber, "rpm", kNone, 0, 1e6, true, M, 0, "at the nominal voltage",
     "data sheet; for checking the model"},
    {"datasheet", "no_load_current_A", kNumber, "A", kNone, 0, 1000, false, M, 0, "at the no-load speed",
     "data sheet; for checking the model"},
    {"datasheet", "stall_torque_Nm", kNumber, "N m", kNone, 0, 1000, true, M, 0, "at the nominal voltage",
     "data sheet; for checking the model"},
    {"datasheet", "speed_constant_rpm_per_V", kNumber, "rpm/V", kNone, 0, 1e6, true, M, 0,
     "the inverse of the back-EMF constant", "data sheet; for checking the model"},
    {"datasheet", "nominal_torque_Nm", kNumber, "N m", kNone, 0, 1000, true, M, 0,
     "largest torque it bears for long", "data sheet"},

    {"effects.coulomb_friction", "torque_Nm", kNumber, "N m", 0.0, 0, 100, false, R | A | M, 0,
     "friction at the rotor that holds still below it",
     "no-load current at low speed, times the torque constant", motor<&MotorParams::coulomb_friction_Nm>},
    {"effects.coulomb_friction", "torque_N", kNumber, "N", 0.0, 0, 1e6, false, L, 0,
     "friction force that holds still below it", "smallest force that moves the axis"},
};

}  // namespace

std::span<const ParameterRow> model_rows() { return kRows; }

const ParameterRow* find_model_row(std::string_view section, std::string_view key) {
  for (const ParameterRow& row : kRows) {
    if (row.section == section && row.key == key) return &row;
  }
  return nullptr;
}

bool is_model_section(std::string_view section) {
  if (section == "effects") return true;
  for (const ParameterRow& row : kRows) {
    if (row.section == section) return true;
    if (row.section.starts_with(section) && row.section.size() > section.size() &&
        row.section[section.size()] == '.' && !section.empty()) {
      return true;
    }
  }
  return false;
}

std::span<const std::string_view> effect_names() {
  static const std::vector<std::string_view> kNames = [] {
    std::vector<std::string_view> names;
    for (const EffectEntry* entry : all_effects()) names.push_back(entry->info->id);
    return names;
  }();
  return kNames;
}

std::string rig_names(std::uint32_t rigs) {
  std::string names;
  const auto add = [&](std::uint32_t bit, const char* name) {
    if ((rigs & bit) != 0) names += (names.empty() ? "" : ", ") + std::string(name);
  };
  add(kRigRobot, "robot");
  add(kRigAxis, "axis");
  add(kRigLinearAxis, "axis with linear = true");
  add(kRigMotor, "motor");
  return names;
}

}  // namespace omnihil

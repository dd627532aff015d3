#include "sim/core/model_rows.h"

#include <numbers>
#include <type_traits>
#include <vector>

#include "sim/core/effect_registry.h"

namespace omnihil {
namespace {

using enum ParameterKind;

template <auto Member>
void robot(RobotModel& m, std::span<const double> v) {
  using Field = std::remove_reference_t<decltype(m.*Member)>;
  m.*Member = static_cast<Field>(v.front());
}
template <auto Member>
void motor(RobotModel& m, std::span<const double> v) {
  using Field = std::remove_reference_t<decltype(m.motor.*Member)>;
  m.motor.*Member = static_cast<Field>(v.front());
}
template <auto Member>
void encoder(RobotModel& m, std::span<const double> v) {
  m.encoder.*Member = static_cast<int>(v.front());
}
template <auto Tyre, auto Member>
void tyre(RobotModel& m, std::span<const double> v) {
  (m.*Tyre).*Member = v.front();
}
void wheel_angles(RobotModel& m, std::span<const double> v) {
  for (std::size_t i = 0; i < m.wheel_angle_rad.size(); ++i) {
    m.wheel_angle_rad[i] = v[i] * std::numbers::pi / 180.0;
  }
}

constexpr std::uint32_t R = kRigRobot, A = kRigAxis, L = kRigLinearAxis, M = kRigMotor;
constexpr std::nullopt_t kNone = std::nullopt;
constexpr auto kLong = &RobotModel::tyre_longitudinal;
constexpr auto kLat = &RobotModel::tyre_lateral;
constexpr TyreCurve kLongDefault = kDefaultTyreLongitudinal, kLatDefault = kDefaultTyreLateral;

// section, key, kind, unit, otherwise, lower, upper, lower excluded, rigs, needed by, what, how, store
constexpr ParameterRow kRows[] = {
    {"", "format", kText, "", kNone, 0, 0, false, R | A | L | M, R | A | L | M, "\"omnihil-model/1\"", ""},
    {"", "rig", kText, "", kNone, 0, 0, false, R | A | L | M, R | A | L | M,
     "\"robot\" (four wheels on the floor), \"axis\" (one drive) or \"motor\" (a motor's own file)", ""},
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
    {"drive", "pwm_frequency_Hz", kNumber, "Hz", kNone, 0, 1e7, true, R | A | L, 0,
     "switching frequency of the bridge", "oscilloscope, or the firmware's timer setting"},
    {"servo", "kp_duty_per_rad", kNumber, "1/rad", kNone, 0, 1e6, true, A, 0,
     "duty per position error of a position servo", "the servo's register"},
    {"servo", "duty_limit", kNumber, "1", 1.0, 0, 1, true, A, 0, "largest duty of the servo",
     "the servo's register"},

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

    {"firmware", "command_timeout_s", kNumber, "s", 0.0, 0, 3600, false, R, 0,
     "the robot stops this long after the last command; 0: the firmware's own", "the firmware's setting",
     robot<&RobotModel::control_timeout_s>},
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

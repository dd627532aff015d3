#include "sim/robot/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "sim/law/effect_set.h"
#include "sim/law/symmetric.h"
#include "sim/robot/contact.h"
#include "sim/robot/electric_model.h"
#include "sim/robot/planar_law.h"
#include "sim/robot/robot_effects.h"

namespace omnihil {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// One number of a model: its value, where it may lie.
struct Field {
  const char* name;
  const char* unit;
  double value;
  double lowest;
  bool above;  // lowest itself is not allowed
  double highest = kInfinity;
};

std::vector<Field> fields_of(const RobotModel& m) {
  std::vector<Field> f = {
      {"mass_kg", "kg", m.mass_kg, 0, true},
      {"yaw_inertia_kg_m2", "kg m^2", m.yaw_inertia_kg_m2, 0, true},
      {"center_of_mass_height_m", "m", m.center_of_mass_height_m, 0, false},
      {"center_of_mass_x_m", "m", m.center_of_mass_x_m, -kInfinity, false},
      {"center_of_mass_y_m", "m", m.center_of_mass_y_m, -kInfinity, false},
      {"wheel_center_radius_m", "m", m.wheel_center_radius_m, 0, true},
      {"wheel_radius_m", "m", m.wheel_radius_m, 0, true},
      {"wheel_mass_kg", "kg", m.wheel_mass_kg, 0, true},
      {"wheel_inertia_kg_m2", "kg m^2", m.wheel_inertia_kg_m2, 0, false},
      {"gear_ratio", "rotor turns per wheel turn", m.gear_ratio, 0, true},
      {"tyre_longitudinal.extremum_slip", "", m.tyre_longitudinal.extremum_slip, 0, true},
      {"tyre_longitudinal.extremum_value", "", m.tyre_longitudinal.extremum_value, 0, true},
      {"tyre_longitudinal.asymptote_slip", "", m.tyre_longitudinal.asymptote_slip,
       m.tyre_longitudinal.extremum_slip, true},
      {"tyre_longitudinal.asymptote_value", "", m.tyre_longitudinal.asymptote_value, 0, false},
      {"tyre_lateral.extremum_slip", "", m.tyre_lateral.extremum_slip, 0, true},
      {"tyre_lateral.extremum_value", "", m.tyre_lateral.extremum_value, 0, false},
      {"tyre_lateral.asymptote_slip", "", m.tyre_lateral.asymptote_slip, m.tyre_lateral.extremum_slip, true},
      {"tyre_lateral.asymptote_value", "", m.tyre_lateral.asymptote_value, 0, false},
      {"slip_speed_floor_m_s", "m/s", m.slip_speed_floor_m_s, 0, true},
      {"motor.resistance_ohm", "ohm", m.motor.resistance_ohm, 0, true},
      {"motor.inductance_H", "H", m.motor.inductance_H, 0, false},
      {"motor.torque_constant_Nm_per_A", "N m/A", m.motor.torque_constant_Nm_per_A, 0, true},
      {"motor.rotor_inertia_kg_m2", "kg m^2", m.motor.rotor_inertia_kg_m2, 0, false},
      {"motor.viscous_friction_Nm_s_per_rad", "N m s/rad", m.motor.viscous_friction_Nm_s_per_rad, 0, false},
      {"motor.coulomb_friction_Nm", "N m", m.motor.coulomb_friction_Nm, 0, false},
      {"motor.current_limit_A", "A", m.motor.current_limit_A, 0, false},
      {"motor.duty_limit_ratio", "", m.motor.duty_limit_ratio, 0, true, 1},
      {"encoder.counts_per_turn", "counts", static_cast<double>(m.encoder.counts_per_turn), 0, true},
      {"bus_voltage_V", "V", m.bus_voltage_V, 0, true},
      {"control_timeout_s", "s", m.control_timeout_s, 0, false},
  };
  for (std::size_t i = 0; i < m.wheels; ++i)
    f.push_back({"wheel_angle_rad", "rad", m.wheel_angle_rad[i], -kInfinity, false});
  return f;
}

std::string range_of(const Field& f) {
  std::string text = f.lowest == -kInfinity ? "must be finite"
                     : f.above              ? fmt::format("must be more than {}", f.lowest)
                                            : fmt::format("must be {} or more", f.lowest);
  if (f.highest < kInfinity) text += fmt::format(" and at most {}", f.highest);
  return text;
}

bool in_range(const Field& f) {
  return std::isfinite(f.value) && (f.above ? f.value > f.lowest : f.value >= f.lowest) &&
         f.value <= f.highest;
}

Eigen::Matrix3d body_mass_matrix(const RobotModel& m) {
  const double sx = m.mass_kg * m.center_of_mass_x_m, sy = m.mass_kg * m.center_of_mass_y_m;
  Eigen::Matrix3d mass;
  mass << m.mass_kg, 0, -sy, 0, m.mass_kg, sx, -sy, sx, m.yaw_inertia_kg_m2;
  return mass;
}

// What each number may be and still not fit the others. Only for models whose numbers are in range.
void check_together(const RobotModel& m, std::vector<std::string>& out) {
  const WheelGeometry<double> g = wheel_geometry(m);
  const auto wheels = static_cast<double>(m.wheels);
  const double wheels_kg = wheels * m.wheel_mass_kg;
  if (wheels_kg >= m.mass_kg) {
    out.push_back(fmt::format(
        "wheel_mass_kg = {} kg: {} wheels weigh {} kg, as much as the whole robot's mass_kg = {} kg",
        m.wheel_mass_kg, m.wheels == 4 ? "four" : std::to_string(m.wheels), wheels_kg, m.mass_kg));
  }
  const double spin = spin_inertia_kg_m2(m);
  if (spin <= 0)
    out.push_back("wheel_inertia_kg_m2 and motor.rotor_inertia_kg_m2: one of them must be more than 0");
  const double offset2 =
      m.center_of_mass_x_m * m.center_of_mass_x_m + m.center_of_mass_y_m * m.center_of_mass_y_m;
  const double wheels_yaw =
      wheels * (0.5 * spin + m.wheel_mass_kg * m.wheel_center_radius_m * m.wheel_center_radius_m);
  const double needed = std::max(wheels_yaw, m.mass_kg * offset2);
  if (m.yaw_inertia_kg_m2 <= needed) {
    out.push_back(fmt::format(
        "yaw_inertia_kg_m2 = {} kg m^2: wheels and centre of mass alone make {:.6g} kg m^2; must be more",
        m.yaw_inertia_kg_m2, needed));
  }
  const auto rim = rim_matrix(g);
  const Eigen::Vector3d scale(1, 1, 1 / g.wheel_center_radius_m);
  const Eigen::Matrix3d spread = scale.asDiagonal() * (rim.transpose() * rim) * scale.asDiagonal();
  const Eigen::VectorXd spreads = symmetric_eigen(spread).values;
  constexpr double kNone = 1e-6;  // of rows of length about 1: rounding
  // Along parallel axles wheels without rollers are held by their own grip, about as large aside as ahead (half: a choice).
  constexpr double kNoRollers = 0.5;
  const bool differential = axles_are_parallel(g) && spreads(1) >= kNone &&
                            m.tyre_lateral.extremum_value >= kNoRollers * m.tyre_longitudinal.extremum_value;
  if (spreads(0) < kNone && !differential) {
    out.push_back(
        "wheel_angle_rad: these wheels cannot drive in every direction (rank of eq. 5 below 3), and "
        "tyre_lateral holds none of them sideways");
    return;
  }
  const ContactLaw<double> law = contact_law(m);
  double sum_N = 0;
  for (std::size_t i = 0; i < m.wheels; ++i) {
    sum_N += law.load.at_rest_N[i];
    if (!(law.load.at_rest_N[i] >= 0)) {
      out.push_back(
          fmt::format("center_of_mass_x_m = {} m, center_of_mass_y_m = {} m: wheel {} would carry {:.4g} N; "
                      "the centre of mass must lie within the wheels",
                      m.center_of_mass_x_m, m.center_of_mass_y_m, i, law.load.at_rest_N[i]));
    }
  }
  const double weight_N = m.mass_kg * kGravity_m_s2;
  if (!(std::abs(sum_N - weight_N) <= 1e-9 * weight_N)) {
    out.push_back(fmt::format("wheel loads sum to {:.12g} N instead of m g = {:.12g} N", sum_N, weight_N));
  }
}

// Load transfer is unique while the largest |G K| of contact.h stays below 1: every sign pattern of full
// grip.
void check_height(const RobotModel& m, std::vector<std::string>& out) {
  const ContactLaw<double> law = contact_law(m);
  double worst = 0;
  for (unsigned pattern = 0; pattern < 1u << m.wheels; ++pattern) {
    Eigen::Matrix2d gk = Eigen::Matrix2d::Zero();
    for (std::size_t i = 0; i < m.wheels; ++i) {
      const double f = (pattern >> i & 1u ? 1.0 : -1.0) * m.tyre_longitudinal.extremum_value;
      const Eigen::Vector2d force(-law.geometry.sin_angle[i] * f, law.geometry.cos_angle[i] * f);
      gk += force * Eigen::RowVector2d(law.load.per_force_x_ratio[i], law.load.per_force_y_ratio[i]);
    }
    worst = std::max(worst, gk.norm());
  }
  if (worst >= 1) {
    out.push_back(fmt::format(
        "center_of_mass_height_m = {} m with tyre_longitudinal.extremum_value = {}: the robot would tip "
        "over its wheels, which only the free body can show; on the plane height must be below {:.4g} m",
        m.center_of_mass_height_m, m.tyre_longitudinal.extremum_value, m.center_of_mass_height_m / worst));
  }
}

void check_steps(const PlantOptions& o, std::vector<std::string>& out) {
  if (o.mechanical_step_ns <= 0) {
    out.push_back(fmt::format("mechanical_step_ns = {}: must be more than 0", o.mechanical_step_ns));
  }
  if (o.electrical_step_ns <= 0) {
    out.push_back(fmt::format("electrical_step_ns = {}: must be more than 0", o.electrical_step_ns));
  } else if (o.mechanical_step_ns > 0 && o.mechanical_step_ns % o.electrical_step_ns != 0) {
    out.push_back(fmt::format("electrical_step_ns = {}: must divide mechanical_step_ns = {}",
                              o.electrical_step_ns, o.mechanical_step_ns));
  }
}

// The drives' periods fill the mechanics' step.
void check_periods(const ElectricModel& electric, std::int64_t step_ns, std::vector<std::string>& out) {
  const double frequency_Hz = electric.inverter.pwm_frequency_Hz;
  const double step_s = static_cast<double>(step_ns) * 1e-9, periods = frequency_Hz * step_s;
  if (step_ns <= 0 || (periods > 0.5 && std::abs(periods - std::round(periods)) <= 1e-9 * periods)) return;
  out.push_back(
      fmt::format("drive.pwm_frequency_Hz = {}: {} periods in the mechanical step of {} ns; must be a whole "
                  "number of them, "
                  "a multiple of {:g} Hz",
                  frequency_Hz, periods, step_ns, 1.0 / step_s));
}

}  // namespace

std::vector<std::string> robot_problems(const RobotModel& model) {
  std::vector<std::string> out;
  if (model.wheels < kMinWheels || model.wheels > kMaxWheels) {
    out.push_back(fmt::format("wheels = {}: must be {} to {}", model.wheels, kMinWheels, kMaxWheels));
    return out;
  }
  for (const Field& f : fields_of(model)) {
    if (!in_range(f)) out.push_back(fmt::format("{} = {} {}: {}", f.name, f.value, f.unit, range_of(f)));
  }
  if (model.encoder.direction != 1 && model.encoder.direction != -1) {
    out.push_back(fmt::format("encoder.direction = {}: must be 1 or -1", model.encoder.direction));
  }
  if (model.wheels > std::size_t{kWheels} && electrics_of(model).three_phase()) {
    out.push_back(fmt::format("drive.kind: three phases are simulated for up to {} wheels; these are {}",
                              kWheels, model.wheels));
  }
  for (std::string& problem : electric_problems(model)) out.push_back(std::move(problem));
  if (!out.empty()) return out;
  check_together(model, out);
  return out;
}

double stiffest_contact_rate(const RobotModel& model) {
  const ContactLaw<double> law = contact_law(model);
  const double load_N = *std::max_element(law.load.at_rest_N.begin(), law.load.at_rest_N.end());
  const double slope = std::max(steepest_grip(model.tyre_longitudinal), steepest_grip(model.tyre_lateral));
  const double damping_N_s_per_m = slope * load_N / model.slip_speed_floor_m_s;
  const double r = model.wheel_radius_m;
  const double along_1_kg = with_wheel_rows(model.wheels, [&](auto rows) {
    const auto rim = rim_matrix_of<rows()>(law.geometry);
    Eigen::MatrixXd mobility = rim * body_mass_matrix(model).inverse() * rim.transpose();
    mobility +=
        Eigen::MatrixXd::Identity(mobility.rows(), mobility.cols()) * (r * r / spin_inertia_kg_m2(model));
    return symmetric_eigen(mobility).values(mobility.rows() - 1);
  });
  const double rolling = damping_N_s_per_m * along_1_kg;
  if (!axles_are_parallel(law.geometry)) return rolling;
  // sideways all wheels act alike on the whole mass
  const double across = steepest_grip(model.tyre_lateral) * kGravity_m_s2 / model.slip_speed_floor_m_s;
  return std::max(rolling, across);
}

double explicit_limit(Integrator integrator) {
  return integrator == Integrator::kRungeKutta4 ? 2.785 : 2.0;  // real axis of the stability region
}

std::vector<std::string> plant_problems(std::span<const RobotModel> robots, const PlantOptions& options) {
  std::vector<std::string> out;
  check_steps(options, out);
  if (robots.empty()) out.push_back("no robot: at least one is needed");
  for (std::size_t n = 0; n < robots.size(); ++n) {
    std::vector<std::string> of_robot = robot_problems(robots[n]);
    if (of_robot.empty() && options.physics != Physics::kSimbodyFree) check_height(robots[n], of_robot);
    if (options.physics != Physics::kPlanar && robots[n].wheels != robots.front().wheels) {
      of_robot.push_back(
          fmt::format("{} wheels, and robot 0 has {}: in one plant of Simbody's all have as many; "
                      "Physics::kPlanar takes any",
                      robots[n].wheels, robots.front().wheels));
    }
    if (of_robot.empty() && options.physics == Physics::kSimbodyFree &&
        axles_are_parallel(wheel_geometry(robots[n]))) {
      of_robot.push_back("wheel_angle_rad: on wheels along one line a free body tips over; it has no caster");
    }
    if (has_shaft(robots[n]) &&
        !(robots[n].wheel_inertia_kg_m2 > 0 && robots[n].motor.rotor_inertia_kg_m2 > 0)) {
      of_robot.push_back(
          "effects between rotor and wheel (backlash, shaft_compliance) need wheel_inertia_kg_m2 and "
          "motor.rotor_inertia_kg_m2 to be more than 0");
    }
    if (of_robot.empty() && electrics_of(robots[n]).three_phase()) {
      check_periods(electrics_of(robots[n]), mechanics_step_ns(robots, options), of_robot);
    }
    if (of_robot.empty() && options.mechanical_step_ns > 0) {
      const RobotModel moved = models_of_mechanics(robots.subspan(n, 1)).front();
      const double rate = stiffest_contact_rate(moved), limit = explicit_limit(options.integrator);
      const std::int64_t step_ns = mechanics_step_ns(robots, options);
      const double step_s = static_cast<double>(step_ns) * 1e-9;
      if (!(rate * step_s < limit)) {
        of_robot.push_back(
            fmt::format("tyre_longitudinal and slip_speed_floor_m_s are too stiff for {} = {}: "
                        "the contact settles at {:.4g} 1/s; the step must be below {:.0f} ns",
                        step_ns == options.mechanical_step_ns ? "mechanical_step_ns" : "electrical_step_ns",
                        step_ns, rate, limit / rate * 1e9));
      }
    }
    for (const std::string& problem : of_robot) {
      out.push_back(fmt::format("robot {} \"{}\": {}", n, robots[n].name, problem));
    }
  }
  return out;
}

namespace {

// Numbers of the electrics, one after another; empty where there are none.
std::string electric_text(const RobotModel& m) {
  const ElectricModel& e = electrics_of(m);
  if (!e.any()) return "";
  const auto& b = e.battery;
  const auto& h = e.heat;
  const auto& s = e.current_sensor;
  std::string text = fmt::format(" {} {} {} {}", static_cast<int>(e.kind), static_cast<int>(e.pwm_mode),
                                 static_cast<int>(e.back_emf.shape), static_cast<int>(e.constant_for));
  text += fmt::format(" {} {} {}", m.motor.pole_pairs, e.angle.bits, b.cells);
  text += fmt::format(" {} {} {}", static_cast<int>(s.place), s.bits, b.takes_charge);
  for (const double value : {e.inverter.pwm_frequency_Hz,
                             e.inverter.dead_time_s,
                             e.inverter.switch_resistance_ohm,
                             e.inverter.diode_forward_V,
                             e.back_emf.flat_top_rad,
                             e.saliency_ratio,
                             e.inductance_saturation_per_A,
                             e.flux_saturation_per_A,
                             e.hall.mounting_error_rad,
                             e.hall.sensor_offset_rad[0],
                             e.hall.sensor_offset_rad[1],
                             e.hall.sensor_offset_rad[2],
                             e.hall.glitch_probability,
                             e.angle.zero_rad,
                             e.angle.eccentricity_rad,
                             e.angle.latency_s,
                             s.shunt_ohm,
                             s.amplifier_gain,
                             s.reference_V,
                             s.gain_error_ratio,
                             s.offset_V,
                             s.noise_sigma_V,
                             e.current_sample_ratio,
                             b.capacity_C,
                             b.resistance_ohm,
                             e.battery_charge_ratio,
                             e.bus_capacitance_F,
                             h.winding_to_housing_K_per_W,
                             h.housing_to_ambient_K_per_W,
                             h.winding_time_constant_s,
                             h.housing_time_constant_s,
                             h.copper_per_K,
                             h.magnet_per_K}) {
    text += fmt::format(" {}", value);
  }
  return text;
}

// What each effect is and its numbers, one after another.
std::string effects_text(std::span<const EffectUse> uses) {
  std::string text;
  for (const EffectUse& use : uses) {
    const EffectInfo& info = *use.entry->info;
    text += fmt::format("|{} {} {} {} {}", info.id, use.name, static_cast<int>(info.place), info.target,
                        info.equation);
    for (std::size_t i = 0; i < use.values.size(); ++i)
      text += fmt::format(" {} {}", info.params[i].name, use.values[i]);
  }
  return text;
}

}  // namespace

void require_valid(std::span<const RobotModel> robots, const PlantOptions& options) {
  std::string all;
  for (const std::string& problem : plant_problems(robots, options))
    all += (all.empty() ? "" : "\n") + problem;
  if (!all.empty()) throw std::invalid_argument(all);
}

std::uint64_t plant_fingerprint(std::span<const RobotModel> robots, const PlantOptions& options) {
  std::string text =
      fmt::format("{} {} {} {} {}", static_cast<int>(options.physics), static_cast<int>(options.integrator),
                  options.mechanical_step_ns, options.electrical_step_ns, options.seed);
  for (const RobotModel& m : robots) {
    text += fmt::format(";{} {} {} {}", m.name, m.encoder.direction, m.encoder.index_offset_counts,
                        m.rollers_per_wheel);
    for (const Field& f : fields_of(m)) text += fmt::format(" {}", f.value);
    text += electric_text(m);
    if (m.effects != nullptr) text += effects_text(*m.effects);
  }
  std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return hash;
}

}  // namespace omnihil

// The only owner of simulated state: all robots on the floor, their motors and their sensors.
//
//   Plant plant(robots, {.physics = Physics::kPlanar});
//   plant.write(0, drive);          // held until written again
//   plant.advance(1'000'000);       // 1 ms of virtual time, an integer number of mechanical steps
//   RobotSensors s = plant.sample_sensors(0);
//
// Bit-reproducible: state is a function of the models, the options and the sequence of calls.
// Effects of a model (RobotModel::effects) act where robot_effects.h and floor_effects.h say; without any,
// every number is what it would be had they never been written.
//
// One mechanical step: the floor's forces at its start (contact.h); per wheel the winding through the
// electrical sub-steps with that load held, and its friction (wheel_drive.h); the mechanics with the mean
// motor torque held (integrate.h over PlanarMechanics or Chassis); wheels that passed zero speed are settled.
// A robot whose model has electrics of its own (electric_model.h) goes through electric_wheels.h instead.
// Sensors: encoder counts of the rotor angle; gyro = yaw rate; accelerometer = the geometric centre's mean
// acceleration over the last mechanical step, in the level body frame; bus voltage = the model's constant;
// motor current = mean since that robot's last sample_sensors(), which begins a new mean and remembers the
// encoder counts it gave (it is therefore a call in the sequence above, and not const). A robot whose wheels
// are all held by friction and that slides slower than 1 pm/s stops exactly (planar joint).
// Contacts with robots, walls and the ball are the world's (sim/field/world.h), which steps this plant.
// Cannot represent: sensor noise, bias and filtering; a sagging bus
// without [battery] in the model or the effect battery_sag.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "firmware_iface/robot_io.h"
#include "sim/robot/electric_ports.h"
#include "sim/robot/planar_state.h"
#include "sim/robot/robot_faults.h"
#include "sim/robot/robot_model.h"

namespace omnihil {

enum class Physics : std::uint8_t {
  kSimbody,      // multibody, planar joint: the reference
  kSimbodyFree,  // multibody, free body on four compliant wheels: pitch, roll, wheel lift
  kPlanar,       // closed form of the planar joint: for fast-forward, fits and sweeps
};
enum class Integrator : std::uint8_t { kSemiImplicitEuler, kRungeKutta4 };

struct PlantOptions {
  Physics physics = Physics::kSimbody;
  Integrator integrator = Integrator::kRungeKutta4;
  std::int64_t mechanical_step_ns = 500'000;  // docs/robot-model.md has cost and error of others
  std::int64_t electrical_step_ns =
      50'000;  // winding and rotor, exact discretisation; divides the mechanical step
  std::uint64_t seed = 0;
};

// The true state of one robot: what no sensor on the robot can see. Field frame W, body frame B.
struct RobotTruth {
  double x_m = 0, y_m = 0, yaw_rad = 0;                            // geometric centre in W
  double v_forward_m_s = 0, v_left_m_s = 0, omega_body_rad_s = 0;  // of the geometric centre, in B
  PerWheel<double> theta_rotor_rad{};
  PerWheel<double> omega_rotor_rad_s{};
  PerWheel<double> theta_wheel_rad{};  // the rotor's over the gear, but for play and compliance
  PerWheel<double> omega_wheel_rad_s{};
  PerWheel<double> motor_current_A{};
  PerWheel<double> motor_torque_Nm{};          // at the rotor
  PerWheel<double> slip_longitudinal_ratio{};  // eq. (6), completed
  PerWheel<double> force_longitudinal_N{};     // floor on wheel, along the drive direction
  PerWheel<double> force_lateral_N{};
  PerWheel<double> load_N{};  // wheel load
};

// What the sensors of one robot show, of all its wheels: `board` is what firmware knows of, the first four.
struct PlantSensors {
  RobotSensors board{};
  PerWheel<std::int64_t> encoder_counts{};
  PerWheel<double> motor_current_A{};
};

// What a camera sees of one robot: pose of the geometric centre in W, as old as effects of timing make it.
struct VisionPose {
  double x_m = 0, y_m = 0, yaw_rad = 0;
};

struct PlantFault {
  std::int64_t now_ns = 0;
  int robot = 0;
  std::string_view signal;  // "duty_ratio", "pose", "omega_wheel_rad_s", "motor_current_A", …
  int index = 0;            // within the signal: wheel, or place in the pose
};

class Plant;
// Called after each mechanical step, within advance().
class StepListener {
 public:
  virtual ~StepListener() = default;
  virtual void after_step(Plant& plant, double step_s) = 0;
};

class Plant {
 public:
  // Robots in a row, 0.3 m apart along y, at rest; throws std::invalid_argument listing every problem of
  // models and options.
  Plant(std::span<const RobotModel> robots, const PlantOptions& options);
  ~Plant();
  Plant(Plant&&) noexcept;
  Plant& operator=(Plant&&) noexcept;

  int robot_count() const;
  const PlantOptions& options() const;
  std::int64_t now_ns() const;

  void set_pose(int robot, double x_m, double y_m, double yaw_rad);  // at rest there
  void write(int robot, const RobotDrive& drive);
  // All wheels of a robot of any number by duty, dribbler and kicker off.
  void write_duties(int robot, const PerWheel<double>& duty_ratio);
  // Three-phase robots, wheels in mode PHASES: whoever sets the legs within advance() (not owned, null:
  // nobody), or legs that stay until written again. What the board's sensors saw in the last PWM period.
  void set_motor_control(int robot, MotorControl* control);
  void write_legs(int robot, const MotorDrive& legs);
  MotorSensors motor_sensors(int robot) const;
  ElectricTruth electric_truth(int robot) const;
  // In force until set again; part of the state. A wheel that gets blocked stands at once.
  void set_faults(int robot, const RobotFaults& faults);
  const RobotFaults& faults(int robot) const;
  // Robots whose legs are set from outside, by whoever runs aside, take their electrics' periods through these (not owned,
  // null: one after the other). The same bits.
  void set_workers(Workers* workers);
  // Duration: a multiple of the mechanical step (std::logic_error).
  void advance(std::int64_t duration_ns, StepListener* listener = nullptr);
  // What contacts do between two mechanical steps: speeds change at once, wheels keep theirs; places are mended.
  PlanarState planar_state(int robot) const;
  double tilt_rad(int robot) const;  // of its chassis against the vertical; 0 but for a free body
  void add_velocity(int robot, double v_x_m_s, double v_y_m_s, double omega_rad_s);
  void shift(int robot, double x_m, double y_m);
  // What else draws on the robot's bus beside its wheels, until set again; matters where the model has a battery.
  void set_other_current(int robot, double current_A);
  // What the sensors show now. Changes state: ends the motor currents' averaging interval and begins the next.
  RobotSensors sample_sensors(int robot) { return sample_all(robot).board; }
  PlantSensors sample_all(int robot);
  RobotTruth truth(int robot) const;
  VisionPose vision(int robot) const;

  // Set once a state or an input stopped being finite: the plant stands still from then on.
  const std::optional<PlantFault>& fault() const;

  // Whole state as bytes; restoring it and advancing gives the same bits. Same models and options only.
  std::vector<std::uint8_t> save() const;
  bool restore(std::span<const std::uint8_t> bytes);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace omnihil

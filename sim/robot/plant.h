// The only owner of simulated state: all robots on the floor, their motors and their sensors.
//
//   Plant plant(robots, {.physics = Physics::kPlanar});
//   plant.write(0, drive);          // held until written again
//   plant.advance(1'000'000);       // 1 ms of virtual time, an integer number of mechanical steps
//   RobotSensors s = plant.read(0);
//
// Bit-reproducible: state is a function of the models, the options and the sequence of calls.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "firmware_iface/robot_io.h"
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
  std::int64_t mechanical_step_ns = 1'000'000;
  std::int64_t electrical_step_ns = 50'000;  // winding and rotor, exact discretisation; divides the mechanical step
  std::uint64_t seed = 0;
};

// The true state of one robot: what no sensor on the robot can see. Field frame W, body frame B.
struct RobotTruth {
  double x_m = 0, y_m = 0, yaw_rad = 0;                  // geometric centre in W
  double v_forward_m_s = 0, v_left_m_s = 0, omega_body_rad_s = 0;  // of the geometric centre, in B
  std::array<double, kWheels> theta_rotor_rad{};
  std::array<double, kWheels> omega_rotor_rad_s{};
  std::array<double, kWheels> omega_wheel_rad_s{};
  std::array<double, kWheels> motor_current_A{};
  std::array<double, kWheels> motor_torque_Nm{};          // at the rotor
  std::array<double, kWheels> slip_longitudinal_ratio{};  // eq. (6), completed
  std::array<double, kWheels> force_longitudinal_N{};     // floor on wheel, along the drive direction
  std::array<double, kWheels> force_lateral_N{};
  std::array<double, kWheels> load_N{};                   // wheel load
};

class Plant {
 public:
  // Robots with a pose each; throws std::invalid_argument listing every problem of models and options.
  Plant(std::span<const RobotModel> robots, const PlantOptions& options);
  ~Plant();
  Plant(Plant&&) noexcept;
  Plant& operator=(Plant&&) noexcept;

  int robot_count() const;
  const PlantOptions& options() const;
  std::int64_t now_ns() const;

  void set_pose(int robot, double x_m, double y_m, double yaw_rad);  // at rest there
  void write(int robot, const RobotDrive& drive);
  void advance(std::int64_t duration_ns);  // asserts: a multiple of the mechanical step
  RobotSensors read(int robot) const;
  RobotTruth truth(int robot) const;

  // Whole state as bytes; restoring it and advancing gives the same bits. Same models and options only.
  std::vector<std::uint8_t> save() const;
  bool restore(std::span<const std::uint8_t> bytes);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace omnihil

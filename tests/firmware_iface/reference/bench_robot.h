// A small robot written for these tests alone, independent of the product's simulation: four DC motors with
// winding, rotor and friction, rigidly coupled to a body that rolls without slip, or lifted off the floor.
//
//   winding   L di/dt = u - R i - k omega            body   (M + A^T A J/r^2) dv/dt = A^T tau_wheel / r
//   rotor     tau = k i - friction                   wheel  omega = A v / r
//
// Explicit Euler at 25 us, a tenth of the winding's time constant; A is the matrix of eq. (5) in its
// corrected form, M = diag(m, m, I).
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "firmware_iface/host_firmware.h"

namespace omnihil::test {

struct BenchRobotParams {
  RobotConfig config{};
  double mass_kg = 0, yaw_inertia_kg_m2 = 0, wheel_inertia_kg_m2 = 0;
  double rotor_inertia_kg_m2 = 0, inductance_H = 0;
  double viscous_Nm_s_per_rad = 0, coulomb_Nm = 0;
};

inline double degrees(double deg) { return deg * std::numbers::pi / 180.0; }

// Maxon EC 45 flat 50 W (251601) behind 3:1, 1024 lines.
inline BenchRobotParams geared_robot() {
  BenchRobotParams p;
  const double angles_deg[] = {55, 135, -135, -55};
  for (int w = 0; w < kWheels; ++w) p.config.wheel_angle_rad[w] = degrees(angles_deg[w]);
  p.config.wheel_radius_m = 0.0275;
  p.config.wheel_center_radius_m = 0.080;
  p.config.gear_ratio = 3.0;
  p.config.encoder_counts_per_rotor_turn = 4096;
  p.config.bus_voltage_nominal_V = 24.0;
  p.config.motor_resistance_ohm = 1.03;
  p.config.motor_torque_constant_Nm_per_A = 0.0335;
  p.mass_kg = 2.4;
  p.yaw_inertia_kg_m2 = 0.010;
  p.wheel_inertia_kg_m2 = 1.2e-5;
  p.rotor_inertia_kg_m2 = 1.35e-5;
  p.inductance_H = 0.572e-3;
  p.viscous_Nm_s_per_rad = 5e-6;
  p.coulomb_Nm = 4e-3;
  return p;
}

// Maxon EC-XFL 32 24 V on the wheel's own shaft, 2048 lines, geometry of a RoboTeam Twente robot.
inline BenchRobotParams direct_robot() {
  BenchRobotParams p;
  const double angles_deg[] = {-60, 60, 135, -135};
  for (int w = 0; w < kWheels; ++w) p.config.wheel_angle_rad[w] = degrees(angles_deg[w]);
  p.config.wheel_radius_m = 0.0274;
  p.config.wheel_center_radius_m = 0.0804;
  p.config.gear_ratio = 1.0;
  p.config.encoder_counts_per_rotor_turn = 8192;
  p.config.bus_voltage_nominal_V = 24.0;
  p.config.motor_resistance_ohm = 1.07;
  p.config.motor_torque_constant_Nm_per_A = 0.0328;
  p.mass_kg = 2.632;
  p.yaw_inertia_kg_m2 = 0.012;
  p.wheel_inertia_kg_m2 = 1.2e-5;
  p.rotor_inertia_kg_m2 = 1.0e-5;
  p.inductance_H = 0.3e-3;
  p.viscous_Nm_s_per_rad = 5e-6;
  p.coulomb_Nm = 5e-3;
  return p;
}

using Body = std::array<double, 3>;  // forward m/s, left m/s, rad/s

class BenchRobot {
 public:
  explicit BenchRobot(const BenchRobotParams& params)
      : p_(params), bus_V(params.config.bus_voltage_nominal_V) {}

  RobotSensors sensors() const {
    RobotSensors s{};
    s.now_us = now_us_;
    for (int w = 0; w < kWheels; ++w) {
      const double turns = theta_rotor_rad[w] / (2 * std::numbers::pi);
      const auto counts =
          static_cast<std::int64_t>(std::floor(turns * p_.config.encoder_counts_per_rotor_turn));
      s.encoder_counts[w] =  // wraps as the 64-bit counter of a board would
          static_cast<std::int64_t>(static_cast<std::uint64_t>(counts) +
                                    static_cast<std::uint64_t>(first_count));
      s.motor_current_A[w] = current_A[w];
    }
    s.bus_voltage_V = bus_V;
    s.gyro_z_rad_s = body[2];
    s.ball_seen = ball_seen;
    return s;
  }

  void advance_1ms(const RobotDrive& drive) {
    for (int n = 0; n < 40; ++n) step(drive, 25e-6);
    now_us_ += 1000;
  }

  double omega_wheel_rad_s(int w) const { return omega_rotor_rad_s[w] / p_.config.gear_ratio; }

  Body body{};
  double yaw_rad = 0;
  std::array<double, kWheels> theta_rotor_rad{}, omega_rotor_rad_s{}, current_A{};
  bool lifted = false;
  bool ball_seen = false;
  bool blocked = false;  // somebody holds the robot
  std::int64_t first_count = 0;

 private:
  double a(int w, int axis) const {
    const double angle = p_.config.wheel_angle_rad[w];
    return axis == 0 ? -std::sin(angle) : axis == 1 ? std::cos(angle) : p_.config.wheel_center_radius_m;
  }

  // Torque at the rotor, friction included (smoothed over 0.5 rad/s: good enough to move, not to hold).
  double rotor_torque_Nm(int w) const {
    const double omega = omega_rotor_rad_s[w];
    return p_.config.motor_torque_constant_Nm_per_A * current_A[w] - p_.viscous_Nm_s_per_rad * omega -
           p_.coulomb_Nm * std::tanh(omega / 0.5);
  }

  void step(const RobotDrive& drive, double dt) {
    const double k = p_.config.motor_torque_constant_Nm_per_A, g = p_.config.gear_ratio;
    for (int w = 0; w < kWheels; ++w) {
      if (drive.mode[w] == OMNIHIL_DRIVE_COAST) {
        current_A[w] = 0;
        continue;
      }
      const double u_V = drive.duty_ratio[w] * bus_V;
      current_A[w] += dt / p_.inductance_H *
                      (u_V - p_.config.motor_resistance_ohm * current_A[w] - k * omega_rotor_rad_s[w]);
    }
    if (blocked) {
      body = {};
      omega_rotor_rad_s = {};
    } else if (lifted) {
      const double inertia = p_.rotor_inertia_kg_m2 + p_.wheel_inertia_kg_m2 / (g * g);
      for (int w = 0; w < kWheels; ++w) omega_rotor_rad_s[w] += dt * rotor_torque_Nm(w) / inertia;
    } else {
      move_body(dt);
    }
    for (int w = 0; w < kWheels; ++w) theta_rotor_rad[w] += dt * omega_rotor_rad_s[w];
    yaw_rad += dt * body[2];
  }

  void move_body(double dt) {
    const double r = p_.config.wheel_radius_m, g = p_.config.gear_ratio;
    const double inertia_wheel = p_.wheel_inertia_kg_m2 + g * g * p_.rotor_inertia_kg_m2;
    double m[3][4] = {};  // mass matrix | generalised force
    m[0][0] = m[1][1] = p_.mass_kg;
    m[2][2] = p_.yaw_inertia_kg_m2;
    for (int w = 0; w < kWheels; ++w) {
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) m[i][j] += a(w, i) * a(w, j) * inertia_wheel / (r * r);
        m[i][3] += a(w, i) * g * rotor_torque_Nm(w) / r;
      }
    }
    m[0][3] += p_.mass_kg * body[2] * body[1];  // body frame: dv/dt = a - omega x v
    m[1][3] -= p_.mass_kg * body[2] * body[0];
    for (int i = 0; i < 3; ++i) {  // Gauss-Jordan; positive definite, no pivoting needed
      for (int row = 0; row < 3; ++row) {
        if (row == i) continue;
        const double factor = m[row][i] / m[i][i];
        for (int col = 0; col < 4; ++col) m[row][col] -= factor * m[i][col];
      }
    }
    for (int i = 0; i < 3; ++i) body[i] += dt * m[i][3] / m[i][i];
    for (int w = 0; w < kWheels; ++w) {
      omega_rotor_rad_s[w] = (a(w, 0) * body[0] + a(w, 1) * body[1] + a(w, 2) * body[2]) / r * g;
    }
  }

  BenchRobotParams p_;
  std::uint64_t now_us_ = 0;

 public:
  double bus_V;
};

// eq. (5), corrected
inline double wheel_speed(const RobotConfig& c, int w, const Body& v) {
  const double angle = c.wheel_angle_rad[w];
  return (-std::sin(angle) * v[0] + std::cos(angle) * v[1] + c.wheel_center_radius_m * v[2]) /
         c.wheel_radius_m;
}

// Robot and firmware together, one control period at a time.
struct Bench {
  explicit Bench(const BenchRobotParams& params)
      : config(params.config), robot(params), firmware(make_reference_firmware(params.config)) {}

  void send(const RobotCommand& command) { firmware->command(command, now_ns()); }
  void send_body(double forward, double left, double omega) {
    RobotCommand c{};
    c.mode = OMNIHIL_MODE_BODY_VELOCITY;
    c.v_forward_m_s = forward;
    c.v_left_m_s = left;
    c.omega_body_rad_s = omega;
    send(c);
  }
  void tick() {
    drive = firmware->tick(robot.sensors());
    robot.advance_1ms(drive);
    ++ms;
  }
  void run(int count) {
    for (int n = 0; n < count; ++n) tick();
  }
  // Keeps the command alive as a host at 50 Hz would.
  void run_with(const RobotCommand& command, int count) {
    for (int n = 0; n < count; ++n) {
      if (n % 20 == 0) send(command);
      tick();
    }
  }
  std::int64_t now_ns() const { return ms * 1'000'000; }
  bool coasting() const {
    return std::all_of(drive.mode, drive.mode + kWheels, [](auto m) { return m == OMNIHIL_DRIVE_COAST; });
  }

  RobotConfig config;
  BenchRobot robot;
  std::unique_ptr<HostFirmware> firmware;
  RobotDrive drive{};
  std::int64_t ms = 0;
};

inline RobotCommand body_command(double forward, double left, double omega) {
  RobotCommand c{};
  c.mode = OMNIHIL_MODE_BODY_VELOCITY;
  c.v_forward_m_s = forward;
  c.v_left_m_s = left;
  c.omega_body_rad_s = omega;
  return c;
}

}  // namespace omnihil::test

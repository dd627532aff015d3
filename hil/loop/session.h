// The one loop: five hops, one thread, one clock, no I/O. Bytes of the AI host and a duration go in, bytes
// for the AI host come out; clocks, devices and files belong to the callers (serve, replay, tests).
//
//   bytes -> RadioLink -> RobotCommand -> Firmware -> RobotDrive -> Plant
//   bytes <- RadioLink <- RobotFeedback <- Firmware <- RobotSensors <- Plant
//
// Deterministic: the same configuration and the same (time, bytes) sequence give the same bytes and states.
//
//   Session session(config, reference_firmware_for(config));
//   while (session.now_ns() < end_ns) session.step(host, answer);
//
// One step from t to t + step_ns, in this order: host bytes into the dongle at t; what has reached robots is
// handed to their firmware at t; then, at every control instant k * control_period of [t, t + step_ns), robot
// by robot in the order of their ids: read sensors, tick, write the bridges, radio frames and feedback to
// the dongle; the plant advances from one control instant to the next and to the end of the step; what has
// left the dongle by t + step_ns is given to the host. The control grid is absolute: it does not depend on
// the loop step, so a control period may be longer or shorter than a step.
// Two teams: the opponents' robots follow the first team's in every index, each team has its own dongle; an opponent with
// id n is robot kOpponentKey + n in observers and recordings.
// With several threads the ticks that are due at one instant may be taken apart (ports.h, tick_parts()): first each such
// robot's sensors are read, then the parts of all of them run side by side, then drives, frames and observers follow robot
// by robot as ever. The same bits.
// A firmware that drives phases gets its motor_tick() from the plant, once per PWM period, within its
// advance. Robots start at rest in a row: robot i of the list at x = 0, y = i * 0.5 m, looking along x (yaw
// 0).
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "firmware_iface/ports.h"
#include "hil/loop/air.h"
#include "hil/loop/timed_faults.h"
#include "protocols/radio_link.h"
#include "sim/field/world.h"

namespace omnihil {

inline constexpr int kOpponentKey = 32;

// What is on the floor beside the robots. Without any of it robots pass through each other and have no kicker: as runs
// were before there was a field.
struct FieldSetup {
  bool contacts = false;                        // robots have bodies, kickers, dribblers, break beams
  const FieldSize* size = nullptr;              // with boards and goals; null: an open floor
  std::optional<std::array<double, 2>> ball_m;  // where it lies at the start; none: until it is put somewhere
  Carpet carpet{};
  double ball_lift_coefficient = 0.0;  // Magnus
};

// The other team. Its robots stand opposite, 2 m away along x, looking back.
struct Opponents {
  std::string radio_format;  // of its own dongle; empty: none, commands come past the radio
  std::vector<RobotModel> robots;
  std::vector<int> robot_ids;  // ascending
};

struct SessionConfig {
  std::string radio_format;        // id, "ulaval-hermes"
  std::vector<RobotModel> robots;  // one per robot id, in the same order
  std::vector<int> robot_ids;      // ascending
  Team team = Team::kBlue;
  PlantOptions plant;
  std::int64_t step_ns = 1'000'000;            // one loop step
  std::uint64_t epoch_ms = 1'700'000'000'000;  // Unix time at virtual time 0
  AirOptions air;                              // what the radio does to packets; drawn from plant.seed
  FieldSetup field;
  Opponents opponents;
  std::vector<TimedFault> faults;  // of both teams
  std::vector<std::uint8_t>
      from;         // World::save() of the same robots: they begin there; empty: in a row, at rest
  int threads = 1;  // that emulated boards may run on; no result depends on it
};

// The other team as if it were the only one: for what makes its firmware.
SessionConfig opponents_alone(const SessionConfig& config);

// One robot at one control tick, for recordings, status lines and checks.
struct RobotSample {
  int robot_id = 0;  // an opponent's: kOpponentKey + id
  RobotDrive drive{};
  RobotSensors sensors{};
  RobotFeedback feedback{};
  RobotTruth truth{};
  VisionPose vision{};                // what a camera would see at this tick
  std::span<const double> watched{};  // of its firmware, as Session::set_watch() says
};

enum class FieldInput : std::uint8_t { kPushed, kPresent, kBall, kMovers };

class SessionObserver {
 public:
  virtual ~SessionObserver() = default;
  virtual void host_bytes(std::int64_t, std::span<const std::uint8_t>) {}    // host -> dongle, as fed in
  virtual void dongle_bytes(std::int64_t, std::span<const std::uint8_t>) {}  // dongle -> host, as they leave
  virtual void opponents_bytes(std::int64_t, std::span<const std::uint8_t>) {}  // their host -> their dongle
  virtual void delivery(std::int64_t, const Delivery&) {}                       // reached a robot
  virtual void robot_tick(std::int64_t, const RobotSample&) {}                  // after a control tick
  virtual void host_closed(std::int64_t) {}
  // Past the radio: a command to a robot's firmware; a robot put down at x, y (m) and yaw (rad).
  virtual void command(std::int64_t, int /*robot_id*/, const RobotCommand&) {}
  virtual void placed(std::int64_t, int /*robot_id*/, double, double, double) {}
  // kPushed: v_x, v_y (m/s, field frame), omega (rad/s); kPresent: 1 or 0; kBall: position, velocity, spin, or nothing
  // when it was taken away (robot_id 0); kMovers: as in mover_values.h (robot_id 0).
  virtual void field_input(std::int64_t, FieldInput, int /*robot_id*/, std::span<const double>) {}
  // Once per step, after it, where there is a field; and what happened on it.
  virtual void world(std::int64_t, const World&) {}
};

// Reads values out of a robot's firmware after each of its control ticks.
class FirmwareWatch {
 public:
  virtual ~FirmwareWatch() = default;
  virtual std::span<const double> read(int robot_index, Firmware& firmware) = 0;
};

class Session {
 public:
  using FirmwareMaker = std::function<std::unique_ptr<Firmware>(const RobotConfig&)>;
  // Throws std::invalid_argument naming every problem of the configuration. `opponents_firmware`: empty: as the first
  // team's.
  Session(SessionConfig config, const FirmwareMaker& make_firmware,
          const FirmwareMaker& opponents_firmware = {});
  ~Session();

  std::int64_t now_ns() const;
  const SessionConfig& config() const;
  const Plant& plant() const;
  const World& world() const;
  int robot_count() const;               // of both teams
  int robot_key(int robot_index) const;  // id, or kOpponentKey + id
  const RobotModel& model(int robot_index) const;
  const RadioLink& link() const;
  const RadioLink* opponents_link() const;  // null: they have no dongle
  AirCounts air() const;                    // of the first team's; none without one
  const Firmware& firmware(int robot_index) const;
  void set_observer(SessionObserver* observer);      // not owned; may be null
  void set_watch(FirmwareWatch* watch);              // likewise
  FirmwareMemory* firmware_memory(int robot_index);  // null: it shows none
  FirmwareChip* firmware_chip(int robot_index);      // null: none that can be broken

  // One loop step of config().step_ns. `host` arrived before the step; what leaves the dongle during it is
  // appended to `out`. Throws std::runtime_error naming time, robot and signal if a state is not finite.
  void step(std::span<const std::uint8_t> host, std::vector<std::uint8_t>& out);
  // The same with both dongles.
  void step(std::span<const std::uint8_t> host, std::vector<std::uint8_t>& out,
            std::span<const std::uint8_t> opponents_host, std::vector<std::uint8_t>& opponents_out);
  void host_closed();
  // Past the radio: a command as the firmware's command() takes it; faults of the robot (robot_faults.h).
  void command(int robot_index, const RobotCommand& command);
  void set_faults(int robot_index, const RobotFaults& faults);
  // A robot put down somewhere, at rest; its encoders go on from where they are.
  void set_pose(int robot_index, double x_m, double y_m, double yaw_rad);
  void set_velocity(int robot_index, double v_x_m_s, double v_y_m_s, double omega_rad_s);
  void set_present(int robot_index, bool present);
  void put_ball(const Vector3& position, const Vector3& velocity, const Vector3& spin = {0, 0, 0});
  void take_ball_away();
  void set_movers(std::span<const Mover> movers);
  // All of the world back to what World::save() gave of the same Session; time, radio and firmware go on. False: not of it.
  // Encoder counts and shafts, as firmware sees them, go on from where they were. Not seen by observers.
  bool set_world(std::span<const std::uint8_t> saved);
  // Gain sets that came over the air and that a robot's firmware refused.
  std::uint64_t gains_refused() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace omnihil

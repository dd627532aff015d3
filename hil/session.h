// The one loop: five hops, one thread, one clock, no I/O. Bytes of the AI host and a duration go in, bytes
// for the AI host come out; clocks, devices and files belong to the callers (serve, replay, tests).
//
//   bytes -> RadioLink -> RobotCommand -> Firmware -> RobotDrive -> Plant -> RobotSensors -> Firmware -> RadioLink -> bytes
//
// Deterministic: the same configuration and the same (time, bytes) sequence give the same bytes and states.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "firmware_iface/ports.h"
#include "protocols/radio_link.h"
#include "sim/robot/plant.h"

namespace omnihil {

struct SessionConfig {
  std::string radio_format;           // id, "ulaval-hermes"
  std::vector<RobotModel> robots;     // one per robot id, in the same order
  std::vector<int> robot_ids;         // ascending
  Team team = Team::kBlue;
  PlantOptions plant;
  std::int64_t step_ns = 1'000'000;   // one loop step
  std::uint64_t epoch_ms = 1'700'000'000'000;  // Unix time at virtual time 0
};

// One robot at one control tick, for recordings, status lines and checks.
struct RobotSample {
  int robot_id = 0;
  RobotDrive drive{};
  RobotSensors sensors{};
  RobotFeedback feedback{};
  RobotTruth truth{};
};

class SessionObserver {
 public:
  virtual ~SessionObserver() = default;
  virtual void host_bytes(std::int64_t, std::span<const std::uint8_t>) {}    // host -> dongle, as fed in
  virtual void dongle_bytes(std::int64_t, std::span<const std::uint8_t>) {}  // dongle -> host, as they leave
  virtual void delivery(std::int64_t, const Delivery&) {}                    // reached a robot
  virtual void robot_tick(std::int64_t, const RobotSample&) {}               // after a control tick
  virtual void host_closed(std::int64_t) {}
};

class Session {
 public:
  using FirmwareMaker = std::function<std::unique_ptr<Firmware>(const RobotConfig&)>;
  // Throws std::invalid_argument naming every problem of the configuration.
  Session(SessionConfig config, const FirmwareMaker& make_firmware);
  ~Session();

  std::int64_t now_ns() const;
  const SessionConfig& config() const;
  const Plant& plant() const;
  const RadioLink& link() const;
  const Firmware& firmware(int robot_index) const;
  void set_observer(SessionObserver* observer);  // not owned; may be null

  // One loop step of config().step_ns. `host` arrived before the step; what leaves the dongle during it is
  // appended to `out`. Throws std::runtime_error naming time, robot and signal if a state is not finite.
  void step(std::span<const std::uint8_t> host, std::vector<std::uint8_t>& out);
  void host_closed();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace omnihil

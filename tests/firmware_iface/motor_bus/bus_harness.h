// A robot of the plant whose motors hang on a motor bus, and the test as the main board at the other end.
#pragma once
#include <gtest/gtest.h>

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "firmware_iface/motor_bus/motor_bus_firmware.h"
#include "hil/loop/session.h"
#include "hil/recording/session_setup.h"

namespace omnihil::test {

inline std::vector<std::uint8_t> hex(std::string_view text) {
  std::vector<std::uint8_t> bytes;
  int high = -1;
  for (const char c : text) {
    if (c == ' ') continue;
    const int digit = c <= '9' ? c - '0' : (c | 0x20) - 'a' + 10;
    if (high >= 0) bytes.push_back(static_cast<std::uint8_t>(high * 16 + digit));
    high = high >= 0 ? -1 : digit;
  }
  return bytes;
}

inline BusFrame frame(std::uint32_t id, std::string_view text) {
  BusFrame f;
  f.id = id;
  for (const std::uint8_t byte : hex(text)) f.data[f.size++] = byte;
  return f;
}
inline BusFrame fd_frame(std::uint32_t id, std::string_view text) {
  BusFrame f = frame(id, text);
  f.extended = id > 0x7FF;
  f.fd = f.bitrate_switch = true;
  return f;
}
inline BusFrame remote_frame(std::uint32_t id) {
  BusFrame f = can_frame(id, 0);
  f.remote = true;
  return f;
}

inline std::vector<std::uint8_t> data_of(const BusFrame& f) {
  return {f.data.begin(), f.data.begin() + f.size};
}

// Both ends of a wire without delay.
struct Wire {
  std::deque<BusFrame> to_motors, from_motors;
  // The last frame with that id; the frame is taken off the wire, and all before it. Empty: none came.
  BusFrame last(std::uint32_t id) {
    BusFrame found;
    found.id = ~0U;
    for (const BusFrame& f : from_motors) {
      if (f.id == id) found = f;
    }
    from_motors.clear();
    return found;
  }
};

class WireEnd final : public FrameWire {
 public:
  explicit WireEnd(std::shared_ptr<Wire> wire) : wire_(std::move(wire)) {}
  std::string_view name() const override { return "test"; }
  bool read(BusFrame& f) override {
    if (wire_->to_motors.empty()) return false;
    f = wire_->to_motors.front();
    wire_->to_motors.pop_front();
    return true;
  }
  bool write(const BusFrame& f) override {
    wire_->from_motors.push_back(f);
    return true;
  }

 private:
  std::shared_ptr<Wire> wire_;
};

struct BusRig {
  std::shared_ptr<Wire> wire = std::make_shared<Wire>();
  std::unique_ptr<Session> session;
  const MotorBusFirmware* firmware = nullptr;
  std::vector<std::uint8_t> sink;

  explicit BusRig(std::string_view bus, MotorBusSetup setup = {}, BusShaft shaft = BusShaft::kRotor,
                  const std::string& model = "omni_default") {
    const MotorBusKind* kind = find_motor_bus(bus);
    SessionSetup words;
    words.model = load_robot_model(model, {OMNIHIL_SOURCE_DIR "/models"}).bundle;
    words.radio_format = "ulaval-hermes";
    words.robot_ids = {0};
    words.plant.physics = Physics::kPlanar;
    session = std::make_unique<Session>(session_config(words), [&](const RobotConfig& config) {
      auto made =
          std::make_unique<MotorBusFirmware>(*kind, setup, shaft, config, std::make_unique<WireEnd>(wire));
      firmware = made.get();
      return made;
    });
  }
  void send(const BusFrame& f) { wire->to_motors.push_back(f); }
  void run_ms(int ms, const std::function<void()>& every_ms = {}) {
    for (int i = 0; i < ms; ++i) {
      if (every_ms) every_ms();
      session->step({}, sink);
    }
  }
  double rotor_turns_s(std::size_t wheel) const {
    return session->plant().truth(0).omega_rotor_rad_s[wheel] / (2.0 * 3.14159265358979);
  }
  double gear() const { return session->config().robots[0].gear_ratio; }
  std::uint64_t count(BusVerdict verdict) const {
    return firmware->counts().received[static_cast<std::size_t>(verdict)];
  }
};

}  // namespace omnihil::test

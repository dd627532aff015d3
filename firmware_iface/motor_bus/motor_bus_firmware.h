// The motor controllers of a bus as the "firmware" of a robot: the main board outside closes the loop.
//
//   MotorBusFirmware firmware(*find_motor_bus("odrive"), setup, BusShaft::kRotor, config, std::move(wire));
//   RobotDrive drive = firmware.tick(sensors);      // frames in, inner loops, frames out
//
// One tick per 0.5 ms: frames that have arrived, in order; sensors; timeouts and inner loops; answers.
// Commands of the radio have no effect: the main board has its own. Pure but for the wire that it is given.
// Cannot: bit timing, arbitration, error frames, bus-off; inner loops of tens of kHz.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "firmware_iface/motor_bus/frame_wire.h"
#include "firmware_iface/motor_bus/motor_bus.h"
#include "firmware_iface/ports.h"

namespace omnihil {

struct BusCounts {
  std::array<std::uint64_t, static_cast<std::size_t>(BusVerdict::kCount)> received{};
  std::uint64_t sent = 0;
  std::uint64_t not_sent = 0;  // the wire or the queue took no more
};

class MotorBusFirmware final : public Firmware {
 public:
  static constexpr std::int64_t kPeriod_ns = 500'000;

  MotorBusFirmware(const MotorBusKind& kind, const MotorBusSetup& setup, BusShaft shaft,
                   const RobotConfig& config, std::unique_ptr<FrameWire> wire);

  std::string_view name() const override { return name_; }
  std::string_view radio_format() const override { return {}; }
  std::int64_t control_period_ns() const override { return kPeriod_ns; }
  void command(const RobotCommand&, std::int64_t) override {}
  void radio_receive(std::span<const std::uint8_t>, std::int64_t) override {}
  std::size_t radio_transmit(std::span<std::uint8_t>) override { return 0; }
  bool set_gains(const RobotGains&) override { return false; }
  RobotGains gains() const override { return {}; }
  RobotDrive tick(const RobotSensors& sensors) override;
  RobotFeedback feedback() const override { return feedback_; }
  std::string_view failure() const override { return failure_; }
  std::vector<std::string> report() const override;

  BusCounts counts() const;
  std::uint64_t timeouts() const { return bus_->timeouts(); }

 private:
  std::string name_;
  MotorBusSetup setup_;
  double gear_ratio_;
  BusShaft shaft_;
  std::array<MotorAxis, kWheels> axes_;
  FrameQueue out_;
  std::unique_ptr<FrameWire> wire_;
  std::string failure_;
  std::unique_ptr<MotorBus> bus_;
  BusCounts counts_;
  RobotFeedback feedback_{};
};

}  // namespace omnihil

#include "firmware_iface/motor_bus/motor_bus_firmware.h"

namespace omnihil {
namespace {
constexpr int kMaxFramesPerTick = 512;  // so that a flood cannot stop the loop
}

MotorBusFirmware::MotorBusFirmware(const MotorBusKind& kind, const MotorBusSetup& setup, BusShaft shaft,
                                   const RobotConfig& config, std::unique_ptr<FrameWire> wire)
    : name_("motor bus " + std::string(kind.id)),
      setup_(setup),
      gear_ratio_(config.gear_ratio),
      shaft_(shaft),
      wire_(std::move(wire)) {
  constexpr double kPeriod_s = static_cast<double>(kPeriod_ns) * 1e-9;
  axes_.fill(MotorAxis(config, shaft, kPeriod_s));
  if (setup_.first_id < 0) setup_.first_id = kind.default_first_id;
  if (setup_.watchdog_s < 0.0) setup_.watchdog_s = kind.default_watchdog_s;
  bus_ = kind.make({axes_, out_, setup_, kPeriod_s});
}

RobotDrive MotorBusFirmware::tick(const RobotSensors& sensors) {
  const auto now_ns = static_cast<std::int64_t>(sensors.now_us) * 1000;
  for (std::size_t m = 0; m < kWheels; ++m) {
    const std::size_t wheel = setup_.order[m];
    axes_[m].sense(sensors.encoder_counts[wheel], sensors.motor_current_A[wheel], sensors.bus_voltage_V);
  }
  BusFrame frame;
  for (int n = 0; n < kMaxFramesPerTick && wire_->read(frame); ++n) {
    ++counts_.received[static_cast<std::size_t>(bus_->receive(frame, now_ns))];
  }
  bus_->tick(now_ns);
  while (out_.pop(frame)) ++(wire_->write(frame) ? counts_.sent : counts_.not_sent);
  if (failure_.empty() && wire_->error()) {
    failure_ = std::string(wire_->name()) + ": " + wire_->error().message();
  }
  RobotDrive drive{};
  feedback_.now_us = sensors.now_us;
  feedback_.battery_V = sensors.bus_voltage_V;
  for (std::size_t m = 0; m < kWheels; ++m) {
    const std::size_t wheel = setup_.order[m];
    axes_[m].drive(drive.mode[wheel], drive.duty_ratio[wheel]);
    feedback_.duty_ratio[wheel] = drive.duty_ratio[wheel];
    feedback_.omega_wheel_rad_s[wheel] =
        axes_[m].omega_shaft_rad_s() / (shaft_ == BusShaft::kRotor ? gear_ratio_ : 1.0);
  }
  return drive;
}

BusCounts MotorBusFirmware::counts() const {
  BusCounts all = counts_;
  all.not_sent += out_.dropped();
  return all;
}

std::vector<std::string> MotorBusFirmware::report() const {
  const BusCounts all = counts();
  std::uint64_t refused = 0;
  std::string causes;
  for (auto v = static_cast<std::size_t>(BusVerdict::kWrongKind); v < all.received.size(); ++v) {
    if (all.received[v] == 0) continue;
    refused += all.received[v];
    causes += (causes.empty() ? " (" : ", ") + std::string(to_string(static_cast<BusVerdict>(v))) + " " +
              std::to_string(all.received[v]);
  }
  if (!causes.empty()) causes += ")";
  std::vector<std::string> lines{name_ + ": " + std::to_string(all.received[0]) + " frames taken, " +
                                 std::to_string(all.received[1]) + " for others, " + std::to_string(refused) +
                                 " refused" + causes};
  lines.push_back("frames sent " + std::to_string(all.sent) + ", not taken by the wire " +
                  std::to_string(all.not_sent) + "; motors stopped by time-out " +
                  std::to_string(bus_->timeouts()));
  for (std::string& line : wire_->report()) lines.push_back(std::move(line));
  return lines;
}

}  // namespace omnihil

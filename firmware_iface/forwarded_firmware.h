// A firmware that hands all calls on to another one, for whoever changes or watches a few of them.
//
//   struct Counted final : ForwardedFirmware {
//     using ForwardedFirmware::ForwardedFirmware;
//     RobotDrive tick(const RobotSensors& s) override { return ++ticks, inner().tick(s); }
//     int ticks = 0;
//   };
//
// Its ticks are whole, its bridges have a duty each: parts of a tick, phases, memory, chip and report are handed on by who wants
// them.
#pragma once
#include <memory>
#include <utility>

#include "firmware_iface/ports.h"

namespace omnihil {

class ForwardedFirmware : public Firmware {
 public:
  explicit ForwardedFirmware(std::unique_ptr<Firmware> inner) : inner_(std::move(inner)) {}

  std::string_view name() const override { return inner_->name(); }
  std::string_view radio_format() const override { return inner_->radio_format(); }
  std::int64_t control_period_ns() const override { return inner_->control_period_ns(); }
  void command(const RobotCommand& c, std::int64_t now_ns) override { inner_->command(c, now_ns); }
  void radio_receive(std::span<const std::uint8_t> frame, std::int64_t now_ns) override {
    inner_->radio_receive(frame, now_ns);
  }
  std::size_t radio_transmit(std::span<std::uint8_t> out) override { return inner_->radio_transmit(out); }
  bool set_gains(const RobotGains& gains) override { return inner_->set_gains(gains); }
  RobotGains gains() const override { return inner_->gains(); }
  void shafts(const RobotShafts& exact) override { inner_->shafts(exact); }
  RobotDrive tick(const RobotSensors& sensors) override { return inner_->tick(sensors); }
  RobotFeedback feedback() const override { return inner_->feedback(); }
  std::string_view failure() const override { return inner_->failure(); }

 protected:
  Firmware& inner() { return *inner_; }
  const Firmware& inner() const { return *inner_; }

 private:
  std::unique_ptr<Firmware> inner_;
};

}  // namespace omnihil

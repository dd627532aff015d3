// An image's boards as a prediction runs them: switched on boot_s before its first tick, told their commands in their radio's
// frames, heard by the same way.
//
//   BootedImage firmware(std::move(boards), find_radio_format("ulaval-hermes"), config, 1.0);
//   firmware.command(command, now_ns);
//   RobotDrive drive = firmware.tick(sensors);           // the first one lets boot_s pass before it
//   firmware.feedback().omega_wheel_rad_s[0];            // as the image's own telemetry has told them; now_us 0: it tells none
//
// Wheel speeds that the image sends by radio, all four of them, are its feedback, at its rate and in its packets' steps, held
// from packet to packet. Cannot: read other quantities of its telemetry.
#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "firmware_iface/ports.h"
#include "hil/dataset/radio_ear.h"
#include "hil/loop/radio_front.h"

namespace omnihil {

class BootedImage final : public Firmware {
 public:
  // radio null: its board is told wheel speeds.
  BootedImage(std::unique_ptr<Firmware> image, const RadioFormat* radio, const RobotConfig& config,
              double boot_s);

  std::string_view name() const override { return image_->name(); }
  std::string_view radio_format() const override { return {}; }
  std::int64_t control_period_ns() const override { return image_->control_period_ns(); }
  void command(const RobotCommand& command, std::int64_t) override { heard_.push_back(command); }
  void radio_receive(std::span<const std::uint8_t>, std::int64_t) override {}
  std::size_t radio_transmit(std::span<std::uint8_t>) override { return 0; }
  bool set_gains(const RobotGains&) override { return false; }
  RobotGains gains() const override { return {}; }
  void shafts(const RobotShafts& exact) override { exact_ = exact; }
  RobotDrive tick(const RobotSensors& sensors) override;
  RobotFeedback feedback() const override { return told_; }
  bool drives_phases() const override { return image_->drives_phases(); }
  std::string_view failure() const override { return failure_.empty() ? image_->failure() : failure_; }
  std::vector<std::string> report() const override { return image_->report(); }

 private:
  std::int64_t now_ns() const { return ticks_ * image_->control_period_ns(); }
  void boot(const RobotSensors& sensors);
  RobotDrive turn(RobotSensors sensors, const RobotShafts& shafts);
  void listen();

  std::unique_ptr<Firmware> image_;
  std::unique_ptr<RadioFront> radio_;
  std::unique_ptr<RadioEar> ear_;
  std::vector<RobotCommand> heard_;  // since the tick before
  RobotShafts exact_{};
  RobotFeedback told_{};
  std::int64_t ticks_ = 0, boot_ticks_ = 0;
  std::string failure_;
  std::array<std::uint8_t, 512> frame_{};
};

}  // namespace omnihil

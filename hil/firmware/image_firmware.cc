#include "hil/firmware/image_firmware.h"

#include <memory>
#include <utility>

#include "firmware_iface/mcu/board/mcu_firmware.h"
#include "hil/firmware/image_files.h"

namespace omnihil {
namespace {
struct Image {
  mcu::BoardSpec board;
  mcu::ElfImage elf;
};

class ImageFirmware final : public Firmware {
 public:
  ImageFirmware(std::shared_ptr<const Image> image, const RobotConfig& config)
      : image_(std::move(image)), mcu_(image_->board, image_->elf, config) {}

  std::string_view name() const override { return mcu_.name(); }
  std::string_view radio_format() const override { return mcu_.radio_format(); }
  std::int64_t control_period_ns() const override { return mcu_.control_period_ns(); }
  void command(const RobotCommand& c, std::int64_t now_ns) override { mcu_.command(c, now_ns); }
  void radio_receive(std::span<const std::uint8_t> f, std::int64_t now_ns) override {
    mcu_.radio_receive(f, now_ns);
  }
  std::size_t radio_transmit(std::span<std::uint8_t> out) override { return mcu_.radio_transmit(out); }
  bool set_gains(const RobotGains& gains) override { return mcu_.set_gains(gains); }
  RobotGains gains() const override { return mcu_.gains(); }
  void shafts(const RobotShafts& exact) override { mcu_.shafts(exact); }
  RobotDrive tick(const RobotSensors& sensors) override { return mcu_.tick(sensors); }
  RobotFeedback feedback() const override { return mcu_.feedback(); }
  bool drives_phases() const override { return mcu_.drives_phases(); }
  MotorDrive motor_tick(const MotorSensors& sensors) override { return mcu_.motor_tick(sensors); }
  std::uint64_t missed_control_periods() const override { return mcu_.missed_control_periods(); }
  std::string_view failure() const override {
    for (int b = 0; b < mcu_.boards(); ++b) {
      if (mcu_.board(b).machine().stopped()) return "the emulated core has locked up";
    }
    return {};
  }
  std::vector<std::string> report() const override {
    std::vector<std::string> lines;
    for (int b = 0; b < mcu_.boards(); ++b) {
      const std::string whose = mcu_.boards() > 1 ? "board " + std::to_string(b) + ": " : "";
      for (const std::string& line : board_report(mcu_.board(b), image_->elf)) lines.push_back(whose + line);
    }
    return lines;
  }

 private:
  std::shared_ptr<const Image> image_;
  mcu::McuFirmware mcu_;
};
}  // namespace

Session::FirmwareMaker image_firmware(const std::string& image_file, const std::string& board_file) {
  auto image = std::make_shared<Image>();
  read_image_files(
      image_file, board_file,
      [&](std::span<const std::uint8_t> bytes, std::vector<std::string>& problems) {
        mcu::read_elf(bytes, image->elf, problems);
      },
      [&](const std::string& text, std::vector<mcu::BoardProblem>& problems) {
        if (auto board = mcu::read_board(text, board_file, problems)) image->board = std::move(*board);
      });
  return [image](const RobotConfig& config) -> std::unique_ptr<Firmware> {
    return std::make_unique<ImageFirmware>(image, config);
  };
}

}  // namespace omnihil

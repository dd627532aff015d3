#include "hil/firmware/image_firmware.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "firmware_iface/mcu/board/boards_chip.h"
#include "firmware_iface/mcu/board/boards_memory.h"
#include "firmware_iface/mcu/board/mcu_firmware.h"
#include "hil/firmware/image_files.h"
#include "hil/text/merged_lines.h"

namespace omnihil {
namespace {
struct Image {
  std::string board_file;
  mcu::BoardSpec board;
  mcu::ElfImage elf;
};

class ImageFirmware final : public Firmware {
 public:
  ImageFirmware(std::shared_ptr<const Image> image, const RobotConfig& config,
                const ImageListeners& listeners, std::shared_ptr<ImageObserver> observer)
      : image_(std::move(image)),
        observer_(std::move(observer)),
        mcu_(image_->board, image_->elf, config),
        memory_(mcu_, image_->elf),
        chip_(mcu_, image_->elf) {
    if (observer_) observer_->begins(mcu_, image_->elf, config.robot_id);
    for (int b = 0; b < mcu_.boards(); ++b) {
      if (!image_->board.ports.empty()) {
        ports_.push_back(std::make_unique<BoardPorts>(
            mcu_.board(b),
            BoardPortsOptions{config.robot_id, b, image_->board_file, listeners.on_line, &buses_}));
      }
      if (listeners.on_board)
        listeners.on_board({config.robot_id, b, mcu_.boards(), mcu_.board(b), image_->elf});
    }
  }
  ~ImageFirmware() override {
    if (observer_) observer_->ends(mcu_);
  }
  ImageFirmware(const ImageFirmware&) = delete;
  ImageFirmware& operator=(const ImageFirmware&) = delete;

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
  RobotDrive tick(const RobotSensors& sensors) override {
    for (const auto& ports : ports_) ports->pump();
    return mcu_.tick(sensors);
  }
  RobotFeedback feedback() const override { return mcu_.feedback(); }
  bool drives_phases() const override { return mcu_.drives_phases(); }
  MotorDrive motor_tick(const MotorSensors& sensors) override { return mcu_.motor_tick(sensors); }
  std::uint64_t missed_control_periods() const override { return mcu_.missed_control_periods(); }
  FirmwareMemory* memory() override { return &memory_; }
  FirmwareChip* chip() override { return &chip_; }
  std::string_view failure() const override {
    for (int b = 0; b < mcu_.boards(); ++b) {
      if (!failure_.empty()) break;
      failure_ = board_failure(mcu_.board(b), image_->elf);
    }
    return failure_;
  }
  std::vector<std::string> report() const override {
    if (mcu_.boards() == 1) return with_ports(board_report(mcu_.board(0), image_->elf));
    std::vector<LinesOf> boards;
    for (int b = 0; b < mcu_.boards(); ++b) boards.push_back({b, board_report(mcu_.board(b), image_->elf)});
    return with_ports(merge_lines("board", "boards", boards));
  }

 private:
  std::vector<std::string> with_ports(std::vector<std::string> lines) const {
    for (std::size_t b = 0; b < ports_.size(); ++b) {
      for (const std::string& line : ports_[b]->report())
        lines.push_back(ports_.size() == 1 ? line : fmt::format("board {}: {}", b, line));
    }
    return lines;
  }

  std::shared_ptr<const Image> image_;
  std::shared_ptr<ImageObserver> observer_;
  mcu::McuFirmware mcu_;
  mcu::BoardsMemory memory_;
  mcu::BoardsChip chip_;
  BoardBuses buses_;
  std::vector<std::unique_ptr<BoardPorts>> ports_;  // of each board; none: it has no ports
  mutable std::string failure_;                     // once it has failed
};
}  // namespace

Session::FirmwareMaker image_firmware(const std::string& image_file, const std::string& board_file,
                                      std::string_view served, ImageListeners listeners,
                                      std::shared_ptr<ImageObserver> observer) {
  auto image = std::make_shared<Image>();
  image->board_file = board_file;
  read_image_files(
      image_file, board_file,
      [&](std::span<const std::uint8_t> bytes, std::vector<std::string>& problems) {
        mcu::read_elf(bytes, image->elf, problems);
      },
      [&](const std::string& text, std::vector<mcu::BoardProblem>& problems) {
        if (auto board = mcu::read_board(text, board_file, problems, served_radio(served)))
          image->board = std::move(*board);
        for (mcu::BoardProblem& problem : port_problems(image->board, board_file))
          problems.push_back(std::move(problem));
      });
  return [image, listeners = std::move(listeners),
          observer](const RobotConfig& config) -> std::unique_ptr<Firmware> {
    return std::make_unique<ImageFirmware>(image, config, listeners, observer);
  };
}

}  // namespace omnihil

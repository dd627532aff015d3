#include "hil/firmware/image_firmware.h"

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <utility>

#include "firmware_iface/mcu/board/boards_chip.h"
#include "firmware_iface/mcu/board/boards_memory.h"
#include "firmware_iface/mcu/board/mcu_firmware.h"
#include "hil/firmware/card_files.h"
#include "hil/firmware/image_files.h"
#include "hil/text/merged_lines.h"

namespace omnihil {
namespace {
struct Image {
  std::string board_file;
  mcu::BoardSpec board;
  mcu::ElfImage elf;
  std::shared_ptr<CardWriters> card_writers = std::make_shared<CardWriters>();
};

class ImageFirmware final : public Firmware {
 public:
  ImageFirmware(std::shared_ptr<const Image> image, const RobotConfig& config,
                const ImageListeners& listeners, std::shared_ptr<ImageObserver> observer)
      : image_(std::move(image)),
        listeners_(listeners),
        observer_(std::move(observer)),
        cards_(image_->board_file, config.robot_id, listeners.ports ? image_->card_writers : nullptr),
        mcu_(image_->board, image_->elf, config,
             [this](const mcu::DeviceEntry& entry, int board) { return cards_.open(entry, board); }),
        memory_(mcu_, image_->elf),
        chip_(mcu_, image_->elf) {
    if (observer_) observer_->begins(mcu_, image_->elf, config.robot_id);
    said_.resize(static_cast<std::size_t>(mcu_.boards()));
    for (int b = 0; b < mcu_.boards(); ++b) {
      if (!image_->board.ports.empty() && listeners.ports) {
        ports_.push_back(std::make_unique<BoardPorts>(
            mcu_.board(b), BoardPortsOptions{config.robot_id, b, image_->board_file, keeper_of_lines(),
                                             listeners.typed, &buses_}));
      }
      if (listeners.on_board)
        listeners.on_board({config.robot_id, b, mcu_.boards(), mcu_.board(b), image_->elf});
    }
  }
  ~ImageFirmware() override {
    if (observer_) observer_->ends(mcu_);
    for (const std::string& problem : cards_.save(mcu_)) std::fprintf(stderr, "%s\n", problem.c_str());
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
    pump();
    return mcu_.tick(sensors);
  }
  // Boards on one bus are one part: what one sends may reach the next within the same period. None where somebody looks on
  // or waits for a place of the program, whose doings are not this robot's alone.
  std::size_t tick_parts() const override {
    if (observer_) return 0;
    for (int b = 0; b < mcu_.boards(); ++b) {
      if (mcu_.board(b).machine().debugged() || mcu_.board(b).machine().awaits_visit()) return 0;
    }
    return buses_.empty() ? mcu_.tick_parts() : 1;
  }
  void begin_tick(const RobotSensors& sensors) override {
    pump();
    mcu_.begin_tick(sensors);
  }
  void run_part(std::size_t part) override {
    if (buses_.empty()) return mcu_.run_part(part);
    for (std::size_t each = 0; each < mcu_.tick_parts(); ++each) mcu_.run_part(each);
  }
  RobotDrive end_tick() override { return mcu_.end_tick(); }
  void tell() override {
    for (auto& lines : said_) {
      for (const Said& line : lines) listeners_.on_line(line.robot_id, line.board, line.port, line.text);
      lines.clear();
    }
  }
  RobotFeedback feedback() const override { return mcu_.feedback(); }
  bool drives_phases() const override { return mcu_.drives_phases(); }
  bool runs_in_phase_periods() const override { return mcu_.runs_in_phase_periods(); }
  PhaseLegs phase_period(const PhasePeriod& period) override { return mcu_.phase_period(period); }
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
  struct Said {
    std::uint32_t robot_id;
    int board;
    std::string port, text;
  };

  void pump() {
    for (const auto& ports : ports_) ports->pump();
    tell();
  }

  // Lines wait for tell(), but under a debugger, who wants to see them as they are said.
  ConsoleListener keeper_of_lines() {
    if (!listeners_.on_line) return {};
    return [this](std::uint32_t robot_id, int board, const std::string& port, const std::string& line) {
      if (mcu_.board(board).machine().debugged()) return listeners_.on_line(robot_id, board, port, line);
      said_[static_cast<std::size_t>(board)].push_back({robot_id, board, port, line});
    };
  }

  std::vector<std::string> with_ports(std::vector<std::string> lines) const {
    for (std::size_t b = 0; b < ports_.size(); ++b) {
      for (const std::string& line : ports_[b]->report())
        lines.push_back(ports_.size() == 1 ? line : fmt::format("board {}: {}", b, line));
    }
    return lines;
  }

  std::shared_ptr<const Image> image_;
  ImageListeners listeners_;
  std::shared_ptr<ImageObserver> observer_;
  std::vector<std::vector<Said>> said_;  // by board, since tell()
  CardFiles cards_;
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
        if (auto board = mcu::read_board(text, board_file, problems, board_context(board_file, served)))
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

#include "hil/firmware/avr_firmware.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <stdexcept>

#include "hil/firmware/avr_board.h"
#include "hil/firmware/avr_memory.h"
#include "hil/firmware/image_files.h"
#include "hil/text/merged_lines.h"

namespace omnihil {
namespace {

constexpr double kTwoPi = 6.283185307179586;

struct Image {
  mcu::AvrBoardSpec board;
  mcu::AvrImage bytes;
};

class AvrFirmware final : public Firmware {
 public:
  AvrFirmware(std::shared_ptr<const Image> image, const RobotConfig& config, double deadline_s)
      : image_(std::move(image)),
        name_(fmt::format("image on {} ({})", image_->board.name, image_->board.chip->name)),
        config_(config) {
    for (const mcu::AvrMotor& motor : image_->board.motors) {
      boards_.push_back(std::make_unique<AvrBoard>(image_->board, motor, image_->bytes, config, deadline_s));
    }
    world_.bus_voltage_V = config.bus_voltage_nominal_V;
  }

  std::string_view name() const override { return name_; }
  std::string_view radio_format() const override { return image_->board.radio_format; }
  std::int64_t control_period_ns() const override { return image_->board.coupling_ns; }
  void command(const RobotCommand&, std::int64_t) override {}
  void radio_receive(std::span<const std::uint8_t> frame, std::int64_t) override {
    for (const auto& board : boards_) board->receive(frame);
  }
  std::size_t radio_transmit(std::span<std::uint8_t> out) override {
    if (sent_.empty()) return 0;
    const std::size_t n = std::min(sent_.front().size(), out.size());
    std::copy_n(sent_.front().begin(), n, out.begin());
    sent_.pop_front();
    return n;
  }
  bool set_gains(const RobotGains&) override { return false; }
  RobotGains gains() const override { return {}; }
  void shafts(const RobotShafts& exact) override { exact_ = exact; }
  RobotDrive tick(const RobotSensors& sensors) override;
  RobotFeedback feedback() const override { return feedback_; }
  std::uint64_t missed_control_periods() const override {
    std::uint64_t sum = 0;
    for (const auto& board : boards_) sum += board->missed_control_periods();
    return sum;
  }
  FirmwareMemory* memory() override { return &memory_; }
  std::string_view failure() const override { return failure_; }
  std::vector<std::string> report() const override {
    std::vector<LinesOf> boards;
    for (const auto& board : boards_) boards.push_back({board->wheel(), board->notes()});
    return merge_lines("board of wheel", "boards of wheels", boards);
  }

 private:
  void look(const RobotSensors& sensors);

  std::shared_ptr<const Image> image_;
  std::string name_, failure_;
  RobotConfig config_;
  std::vector<std::unique_ptr<AvrBoard>> boards_;
  AvrMemory memory_{boards_, image_->bytes.main};
  RobotShafts exact_{};
  mcu::WorldState world_;
  std::int64_t counts_before_[kWheels]{};
  bool looked_ = false;
  std::deque<std::vector<std::uint8_t>> sent_;
  RobotFeedback feedback_{};
};

// The world at this tick. Where the sensed counts are not those of the exact shaft, the boards see the sensed
// ones, moving as fast as they last did.
void AvrFirmware::look(const RobotSensors& sensors) {
  world_.at_ns = static_cast<std::int64_t>(sensors.now_us) * 1000;
  const double per_count_rad = kTwoPi / config_.encoder_counts_per_rotor_turn;
  const double period_s = 1e-9 * static_cast<double>(control_period_ns());
  for (std::size_t w = 0; w < kWheels; ++w) {
    world_.theta_rotor_rad[w] = exact_.theta_rotor_rad[w];
    world_.omega_rotor_rad_s[w] = exact_.omega_rotor_rad_s[w];
    world_.motor_current_A[w] = sensors.motor_current_A[w];
    const auto exact_counts =
        static_cast<std::int64_t>(std::floor(exact_.theta_rotor_rad[w] / per_count_rad));
    const std::int64_t off = sensors.encoder_counts[w] - exact_counts;
    if (off > 1 || off < -1) {
      const std::int64_t moved = looked_ ? sensors.encoder_counts[w] - counts_before_[w] : 0;
      world_.theta_rotor_rad[w] = (static_cast<double>(sensors.encoder_counts[w]) + 0.5) * per_count_rad;
      world_.omega_rotor_rad_s[w] = static_cast<double>(moved) * per_count_rad / period_s;
    }
    counts_before_[w] = sensors.encoder_counts[w];
  }
  looked_ = true;
  world_.bus_voltage_V = sensors.bus_voltage_V;
}

RobotDrive AvrFirmware::tick(const RobotSensors& sensors) {
  look(sensors);
  RobotDrive drive{};
  feedback_ = feedback_of(exact_, sensors, config_.gear_ratio);
  const std::int64_t end_ns = world_.at_ns + control_period_ns();
  for (const auto& board : boards_) board->begin(world_, end_ns);
  memory_.finish_all();
  for (const auto& board : boards_) {
    const auto w = static_cast<std::size_t>(board->wheel());
    drive.mode[w] = board->drive().driven ? OMNIHIL_DRIVE_DUTY : OMNIHIL_DRIVE_COAST;
    drive.duty_ratio[w] = feedback_.duty_ratio[w] = board->drive().driven ? board->drive().duty_ratio : 0.0;
    for (auto& frame : board->sent()) sent_.push_back(std::move(frame));
    board->sent().clear();
    if (failure_.empty()) failure_ = board->failure();
  }
  return drive;
}

}  // namespace

Session::FirmwareMaker avr_firmware(const std::string& image_file, const std::string& board_file,
                                    double deadline_s, std::string_view served) {
  auto image = std::make_shared<Image>();
  read_image_files(
      image_file, board_file,
      [&](std::span<const std::uint8_t> bytes, std::vector<std::string>& problems) {
        mcu::read_avr_image(bytes, image->bytes, problems);
      },
      [&](const std::string& text, std::vector<mcu::BoardProblem>& problems) {
        if (auto board = mcu::read_avr_board(text, board_file, problems, board_context(board_file, served)))
          image->board = std::move(*board);
      });
  return [image, deadline_s](const RobotConfig& config) -> std::unique_ptr<Firmware> {
    try {
      return std::make_unique<AvrFirmware>(image, config, deadline_s);
    } catch (const std::runtime_error& missing) {
      throw std::invalid_argument(missing.what());
    }
  };
}

}  // namespace omnihil

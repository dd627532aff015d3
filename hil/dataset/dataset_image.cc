#include "hil/dataset/dataset_image.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "hil/dataset/booted_image.h"
#include "hil/dataset/firmware_trial.h"
#include "hil/firmware/open_firmware.h"
#include "hil/loop/radio_front.h"
#include "identify/predict/firmware_loop.h"
#include "identify/predict/robot_record.h"

namespace omnihil {
namespace {

struct ImageOnBoard {
  Session::FirmwareMaker make;
  RobotConfig config;
  const RadioFormat* radio = nullptr;  // null: its board is told wheel speeds
  double boot_s = 0.0;
};

class ImageSource final : public FirmwareSource {
 public:
  explicit ImageSource(ImageOnBoard of) : of_(std::move(of)) {}
  std::unique_ptr<Firmware> fresh() const override {
    return std::make_unique<BootedImage>(of_.make(of_.config), of_.radio, of_.config, of_.boot_s);
  }
  double counts_per_rotor_turn() const override { return of_.config.encoder_counts_per_rotor_turn; }

 private:
  ImageOnBoard of_;
};

// Which of the two files it is about, line by line, is in the text.
void refuse_files(const std::string& text, std::vector<FirmwareRefusal>& refused) {
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    const std::string line = text.substr(from, end - from);
    if (!line.empty())
      refused.push_back({line.starts_with("firmware ") ? "firmware" : "board", line,
                         "an image and its board file (docs/mcu-boards.md)"});
    from = end + 1;
  }
}

bool by_radio(const Run& run) { return run.signal("duty_1") == nullptr; }

// The first command that the format has no packet for.
std::string unsayable(const RadioFormat& format, std::span<const Run> runs) {
  for (const Run& run : runs) {
    if (!by_radio(run)) continue;
    const RadioCommands radio = radio_commands(run, kWheels);
    for (std::size_t k = 0; k < run.time_s.size(); ++k) {
      if (!radio.said(k) || can_say(format, radio_command(radio.value[k], radio.frame))) continue;
      const bool body = radio.frame == CommandFrame::kBodyVelocity;
      return fmt::format("{} at {} s: radio format \"{}\" has no packet for {} {:.4g}", run.file,
                         run.time_s[k], format.id,
                         body ? "the velocity (m/s, m/s, rad/s)" : "the wheel speeds (rad/s)",
                         fmt::join(std::span(radio.value[k]).first(radio.count), ", "));
    }
  }
  return {};
}

std::uint32_t mode_of(std::span<const Run> runs) {
  const auto run = std::find_if(runs.begin(), runs.end(), by_radio);
  const bool wheels = run != runs.end() && radio_commands(*run, kWheels).frame == CommandFrame::kWheelSpeeds;
  return wheels ? OMNIHIL_MODE_WHEEL_SPEED : OMNIHIL_MODE_BODY_VELOCITY;
}

// Of the radio, before anything runs.
bool radio_serves(const DatasetFirmware& firmware, std::string_view decodes, ImageOnBoard& image,
                  std::span<const Run> runs, std::vector<FirmwareRefusal>& refused) {
  if (!firmware.radio.empty() && firmware.radio != decodes) {
    refused.push_back({"radio",
                       decodes.empty()
                           ? fmt::format("board {} has no radio", firmware.board)
                           : fmt::format("board {} decodes another format: [radio] format = \"{}\"",
                                         firmware.board, decodes),
                       "the format in which the commands were sent; a board that decodes it"});
    return false;
  }
  if (decodes.empty()) return true;
  image.radio = find_radio_format(decodes);
  std::string problem;
  if (image.radio == nullptr || !image.radio->has_dongle()) {
    problem = fmt::format("[radio] format = \"{}\" has no dongle that would send commands", decodes);
  } else {
    problem = unsayable(*image.radio, runs);
  }
  if (!problem.empty())
    refused.push_back({"board", problem, "a radio format that says the record's commands"});
  return problem.empty();
}

std::string why_not(const FirmwareSource& source, const ImageOnBoard& image, std::uint32_t mode) {
  const std::unique_ptr<Firmware> firmware = source.fresh();
  const std::vector<double> asked = FirmwareTrial(*firmware, image.config, 1.0, mode).run();
  if (!firmware->failure().empty()) return std::string(firmware->failure());
  if (!asks_nothing(asked)) return {};
  std::string what = fmt::format(
      "asks nothing of the bridges when it is commanded to drive, {:g} s after it was switched on",
      image.boot_s);
  constexpr std::size_t kShown = 3;
  const std::vector<std::string> report = firmware->report();
  for (std::size_t n = 0; n < std::min(report.size(), kShown); ++n) what += "; " + report[n];
  return what;
}

}  // namespace

std::shared_ptr<const FirmwareSource> open_dataset_image(const DatasetFirmware& firmware,
                                                         const RobotConfig& config, std::span<const Run> runs,
                                                         std::vector<FirmwareRefusal>& refused) {
  try {
    FirmwareChoice choice{.file = firmware.file, .board = firmware.board};
    choice.listeners.ports = false;
    ImageOnBoard image{.make = open_firmware(choice, {}), .config = config, .boot_s = firmware.boot_s};
    const std::unique_ptr<Firmware> one = image.make(config);
    if (one->drives_phases()) {
      refused.push_back({"board", "sets the legs of three-phase bridges, of which a prediction has none",
                         "boards whose bridges have a duty each; [controller], or a library"});
      return nullptr;
    }
    if (!radio_serves(firmware, one->radio_format(), image, runs, refused)) return nullptr;
    auto source = std::make_shared<const ImageSource>(image);
    const std::string problem = why_not(*source, image, mode_of(runs));
    if (problem.empty()) return source;
    refused.push_back({"firmware", problem, "an image that drives; boot_s, if it takes longer to start"});
  } catch (const std::invalid_argument& problems) {
    refuse_files(problems.what(), refused);
  }
  return nullptr;
}

}  // namespace omnihil

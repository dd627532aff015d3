#include "hil/dataset/dataset_firmware.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "firmware_iface/host_firmware.h"
#include "hil/dataset/dataset_image.h"
#include "hil/dataset/firmware_trial.h"
#include "hil/firmware/guarded_firmware.h"
#include "hil/firmware/open_firmware.h"

namespace omnihil {
namespace {

class LibrarySource final : public FirmwareSource {
 public:
  LibrarySource(std::shared_ptr<void> library, const omnihil_firmware_api* api, const RobotConfig& config)
      : library_(std::move(library)), api_(api), config_(config) {}
  std::unique_ptr<Firmware> fresh() const override { return std::make_unique<HostFirmware>(api_, config_); }
  double counts_per_rotor_turn() const override { return config_.encoder_counts_per_rotor_turn; }

 private:
  std::shared_ptr<void> library_;
  const omnihil_firmware_api* api_;
  RobotConfig config_;
};

std::vector<double> tried(const FirmwareSource& source, const RobotConfig& config) {
  const std::unique_ptr<Firmware> firmware = source.fresh();
  return FirmwareTrial(*firmware, config, 1.0).run();
}

bool same(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

// In a process of its own.
std::vector<double> tried_apart(const std::string& file, const RobotConfig& config, std::string& problem) {
  GuardedFirmware firmware({.library = file}, config);
  std::vector<double> asked = FirmwareTrial(firmware, config, 1.0).run();
  problem = firmware.failure();
  return asked;
}

std::shared_ptr<const FirmwareSource> load(const std::string& file, const RobotConfig& config) {
  const std::string path = std::filesystem::absolute(file).string();
  std::shared_ptr<void> library(::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL), [](void* handle) {
    if (handle != nullptr) ::dlclose(handle);
  });
  if (library == nullptr) throw std::invalid_argument(std::string("cannot be loaded: ") + ::dlerror());
  using Get = const omnihil_firmware_api* (*)(std::uint32_t);
  const auto get = reinterpret_cast<Get>(::dlsym(library.get(), "omnihil_firmware_get"));
  if (get == nullptr) throw std::invalid_argument("exports no omnihil_firmware_get");
  return std::make_shared<LibrarySource>(std::move(library), get(OMNIHIL_FIRMWARE_ABI), config);
}

std::string why_not(const std::vector<double>& apart, const FirmwareSource& source,
                    const RobotConfig& config) {
  if (asks_nothing(apart)) return "asks nothing of the bridges when it is commanded to drive";
  const std::unique_ptr<Firmware> one = source.fresh(), two = source.fresh();
  FirmwareTrial in_turn(*one, config, 1.0), other(*two, config, -0.7);
  const std::vector<double> alone = tried(source, config);
  for (int n = 0; n < FirmwareTrial::kTicks; ++n) in_turn.step(), other.step();
  const bool repeats =
      same(apart, alone) && same(apart, tried(source, config)) && same(apart, in_turn.asked());
  return repeats ? ""
                 : "keeps state outside of the state block that it is given (global or static variables): a "
                   "second one does "
                   "not do what the first did; put them into the block (docs/firmware.md)";
}

std::shared_ptr<const FirmwareSource> open_library(const std::string& file, const RobotConfig& config,
                                                   std::string& problem) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(file, code)) {
    problem = "there is no such file";
    return nullptr;
  }
  try {
    const std::vector<double> apart = tried_apart(file, config, problem);
    if (!problem.empty()) return nullptr;
    std::shared_ptr<const FirmwareSource> source = load(file, config);
    problem = why_not(apart, *source, config);
    return problem.empty() ? source : nullptr;
  } catch (const std::invalid_argument& not_loaded) {
    problem = not_loaded.what();
    return nullptr;
  }
}

}  // namespace

std::shared_ptr<const FirmwareSource> open_dataset_firmware(const DatasetFirmware& firmware,
                                                            const RobotConfig& config,
                                                            std::span<const Run> runs,
                                                            std::vector<FirmwareRefusal>& refused) {
  if (is_image(firmware.file)) {
    if (!firmware.board.empty()) return open_dataset_image(firmware, config, runs, refused);
    refused.push_back({"board", "is missing: the firmware is a microcontroller image",
                       "the board file that it runs on (docs/mcu-boards.md), or --board"});
    return nullptr;
  }
  std::string problem;
  auto source = open_library(firmware.file, config, problem);
  if (!problem.empty())
    refused.push_back({"firmware", problem,
                       "a library of this computer with omnihil_firmware_get (docs/firmware.md), or a "
                       "microcontroller image with its board"});
  if (!firmware.board.empty()) {
    refused.push_back(
        {"board", "has nothing to do: the firmware is no microcontroller image", "an image beside it"});
    source = nullptr;
  }
  return source;
}

}  // namespace omnihil

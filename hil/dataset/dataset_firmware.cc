#include "hil/dataset/dataset_firmware.h"

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "firmware_iface/host_firmware.h"
#include "hil/firmware/guarded_firmware.h"

namespace omnihil {
namespace {

// A prime: a counter that a library keeps from one trial to the next would otherwise stand where it stood.
constexpr int kTrialTicks = 997;

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

// A second or so of a robot on a stand: wheels that follow their duty as a first order lag, told of every 20 ticks.
class Trial {
 public:
  Trial(Firmware& firmware, const RobotConfig& config, double level)
      : firmware_(firmware), config_(config), level_(level) {}

  void step() {
    constexpr double kFree_rad_s = 300.0, kLag = 0.02;  // of a rotor at full duty, and per tick: any
    const std::int64_t period_ns = firmware_.control_period_ns(), now_ns = ++ticks_ * period_ns;
    if (ticks_ % 20 == 1) {
      RobotCommand c{};
      c.mode = OMNIHIL_MODE_BODY_VELOCITY;
      c.v_forward_m_s = level_ * std::sin(0.01 * ticks_);
      c.v_left_m_s = 0.5 * level_;
      c.omega_body_rad_s = level_ * std::cos(0.013 * ticks_);
      firmware_.command(c, now_ns);
    }
    RobotSensors s{};
    s.now_us = static_cast<std::uint64_t>(now_ns / 1000);
    s.bus_voltage_V = config_.bus_voltage_nominal_V;
    const double counts_per_rad = config_.encoder_counts_per_rotor_turn / 6.283185307179586;
    for (std::size_t i = 0; i < kWheels; ++i) {
      turned_rad_[i] += 1e-9 * static_cast<double>(period_ns) * omega_rad_s_[i];
      s.encoder_counts[i] = static_cast<std::int64_t>(std::floor(counts_per_rad * turned_rad_[i]));
    }
    const RobotDrive d = firmware_.tick(s);
    for (std::size_t i = 0; i < kWheels; ++i) {
      const double duty = d.mode[i] == OMNIHIL_DRIVE_DUTY ? d.duty_ratio[i] : 0.0;
      omega_rad_s_[i] += kLag * (kFree_rad_s * duty - omega_rad_s_[i]);
      asked_.push_back(duty);
    }
  }
  std::vector<double> run() {
    for (int n = 0; n < kTrialTicks; ++n) step();
    return asked_;
  }
  const std::vector<double>& asked() const { return asked_; }

 private:
  Firmware& firmware_;
  const RobotConfig& config_;
  double level_;
  int ticks_ = 0;
  std::array<double, kWheels> turned_rad_{}, omega_rad_s_{};
  std::vector<double> asked_;
};

std::vector<double> tried(const FirmwareSource& source, const RobotConfig& config) {
  const std::unique_ptr<Firmware> firmware = source.fresh();
  return Trial(*firmware, config, 1.0).run();
}

bool same(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

// In a process of its own.
std::vector<double> tried_apart(const std::string& file, const RobotConfig& config, std::string& problem) {
  GuardedFirmware firmware({.library = file}, config);
  std::vector<double> asked = Trial(firmware, config, 1.0).run();
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
  if (std::all_of(apart.begin(), apart.end(), [](double v) { return v == 0.0; }))
    return "asks nothing of the bridges when it is commanded to drive";
  const std::unique_ptr<Firmware> one = source.fresh(), two = source.fresh();
  Trial in_turn(*one, config, 1.0), other(*two, config, -0.7);
  const std::vector<double> alone = tried(source, config);
  for (int n = 0; n < kTrialTicks; ++n) in_turn.step(), other.step();
  const bool repeats =
      same(apart, alone) && same(apart, tried(source, config)) && same(apart, in_turn.asked());
  return repeats ? ""
                 : "keeps state outside of the state block that it is given (global or static variables): a "
                   "second one does "
                   "not do what the first did; put them into the block (docs/firmware.md)";
}

}  // namespace

std::shared_ptr<const FirmwareSource> open_dataset_firmware(const std::string& file,
                                                            const RobotConfig& config, std::string& problem) {
  problem.clear();
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
  } catch (const std::invalid_argument& refused) {
    problem = refused.what();
    return nullptr;
  }
}

}  // namespace omnihil

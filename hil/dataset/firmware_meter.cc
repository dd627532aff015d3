#include "hil/dataset/firmware_meter.h"

#include <chrono>
#include <mutex>
#include <utility>

#include "firmware_iface/forwarded_firmware.h"
#include "identify/predict/firmware_source.h"

namespace omnihil {

struct FirmwareMeter::Shared {
  std::mutex mutex;
  FirmwareUse seen;
};

class FirmwareMeter::Metered final : public ForwardedFirmware {
 public:
  Metered(std::unique_ptr<Firmware> of, std::shared_ptr<Shared> shared)
      : ForwardedFirmware(std::move(of)), shared_(std::move(shared)) {}
  Metered(const Metered&) = delete;
  Metered& operator=(const Metered&) = delete;
  ~Metered() override {
    if (ticks_ == 0) return;
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began_;
    const std::scoped_lock lock(shared_->mutex);
    FirmwareUse& seen = shared_->seen;
    ++seen.simulations;
    seen.wall_s += took.count();
    seen.simulated_s += 1e-9 * static_cast<double>(ticks_ * inner().control_period_ns());
    if (inner().failure().empty()) return;
    if (seen.failed++ == 0) seen.failure = inner().failure();
  }

  RobotDrive tick(const RobotSensors& sensors) override {
    if (ticks_++ == 0) began_ = std::chrono::steady_clock::now();
    return inner().tick(sensors);
  }
  std::vector<std::string> report() const override { return inner().report(); }

 private:
  std::shared_ptr<Shared> shared_;
  std::chrono::steady_clock::time_point began_;
  std::int64_t ticks_ = 0;
};

class FirmwareMeter::Source final : public FirmwareSource {
 public:
  Source(std::shared_ptr<const FirmwareSource> of, std::shared_ptr<Shared> shared)
      : of_(std::move(of)), shared_(std::move(shared)) {}
  std::unique_ptr<Firmware> fresh() const override {
    return std::make_unique<Metered>(of_->fresh(), shared_);
  }
  double counts_per_rotor_turn() const override { return of_->counts_per_rotor_turn(); }

 private:
  std::shared_ptr<const FirmwareSource> of_;
  std::shared_ptr<Shared> shared_;
};

FirmwareMeter::FirmwareMeter(Dataset& dataset) : shared_(std::make_shared<Shared>()) {
  if (dataset.firmware)
    dataset.firmware = std::make_shared<const Source>(std::move(dataset.firmware), shared_);
}

FirmwareUse FirmwareMeter::seen() const {
  const std::scoped_lock lock(shared_->mutex);
  return shared_->seen;
}

}  // namespace omnihil

// A firmware whose time is taken: what it is, and how much of the processor's time its ticks take.
//
//   std::int64_t spent_ns = 0;
//   TimedFirmware timed(std::move(firmware), spent_ns);
//
// Its ticks are whole: they run one after the other, so that a time is one robot's.
#pragma once
#include <time.h>

#include <cstdint>
#include <memory>
#include <utility>

#include "firmware_iface/forwarded_firmware.h"

namespace omnihil {

// Of this thread, in processor time: what else the computer does is not in it.
inline std::int64_t thread_now_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

class TimedFirmware final : public ForwardedFirmware {
 public:
  TimedFirmware(std::unique_ptr<Firmware> inner, std::int64_t& spent_ns)
      : ForwardedFirmware(std::move(inner)), spent_ns_(spent_ns) {}

  RobotDrive tick(const RobotSensors& sensors) override {
    const Timed timed(spent_ns_);
    return inner().tick(sensors);
  }
  bool drives_phases() const override { return inner().drives_phases(); }
  MotorDrive motor_tick(const MotorSensors& sensors) override {
    const Timed timed(spent_ns_);
    return inner().motor_tick(sensors);
  }
  bool runs_in_phase_periods() const override { return inner().runs_in_phase_periods(); }
  PhaseLegs phase_period(const PhasePeriod& period) override {
    const Timed timed(spent_ns_);
    return inner().phase_period(period);
  }
  FirmwareChip* chip() override { return inner().chip(); }

 private:
  struct Timed {
    explicit Timed(std::int64_t& spent_ns) : spent(spent_ns) {}
    ~Timed() { spent += thread_now_ns() - since_ns; }
    Timed(const Timed&) = delete;
    Timed& operator=(const Timed&) = delete;
    std::int64_t& spent;
    std::int64_t since_ns = thread_now_ns();
  };

  std::int64_t& spent_ns_;
};

}  // namespace omnihil

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

#include "hil/loop/session.h"

namespace omnihil {

// Of this thread, in processor time: what else the computer does is not in it.
inline std::int64_t thread_now_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

class TimedFirmware final : public Firmware {
 public:
  TimedFirmware(std::unique_ptr<Firmware> inner, std::int64_t& spent_ns)
      : inner_(std::move(inner)), spent_ns_(spent_ns) {}

  std::string_view name() const override { return inner_->name(); }
  std::string_view radio_format() const override { return inner_->radio_format(); }
  std::int64_t control_period_ns() const override { return inner_->control_period_ns(); }
  void command(const RobotCommand& c, std::int64_t now_ns) override { inner_->command(c, now_ns); }
  void radio_receive(std::span<const std::uint8_t> frame, std::int64_t now_ns) override {
    inner_->radio_receive(frame, now_ns);
  }
  std::size_t radio_transmit(std::span<std::uint8_t> out) override { return inner_->radio_transmit(out); }
  bool set_gains(const RobotGains& gains) override { return inner_->set_gains(gains); }
  RobotGains gains() const override { return inner_->gains(); }
  void shafts(const RobotShafts& exact) override { inner_->shafts(exact); }
  RobotDrive tick(const RobotSensors& sensors) override {
    const Timed timed(spent_ns_);
    return inner_->tick(sensors);
  }
  RobotFeedback feedback() const override { return inner_->feedback(); }
  bool drives_phases() const override { return inner_->drives_phases(); }
  MotorDrive motor_tick(const MotorSensors& sensors) override {
    const Timed timed(spent_ns_);
    return inner_->motor_tick(sensors);
  }
  std::string_view failure() const override { return inner_->failure(); }
  FirmwareChip* chip() override { return inner_->chip(); }

 private:
  struct Timed {
    explicit Timed(std::int64_t& spent_ns) : spent(spent_ns) {}
    ~Timed() { spent += thread_now_ns() - since_ns; }
    Timed(const Timed&) = delete;
    Timed& operator=(const Timed&) = delete;
    std::int64_t& spent;
    std::int64_t since_ns = thread_now_ns();
  };

  std::unique_ptr<Firmware> inner_;
  std::int64_t& spent_ns_;
};

}  // namespace omnihil

// A second or so of a robot on a stand, to see what a firmware does before it is trusted with predictions: wheels that follow
// their duty as a first order lag, told of a velocity every 20 ticks.
//
//   std::vector<double> asked = FirmwareTrial(*firmware, config, 1.0).run();      // duties, wheel by wheel, tick by tick
#pragma once
#include <array>
#include <vector>

#include "firmware_iface/ports.h"

namespace omnihil {

class FirmwareTrial {
 public:
  // A prime: a counter that a library keeps from one trial to the next would otherwise stand where it stood.
  static constexpr int kTicks = 997;

  // `level`: m/s and rad/s, about; `frame`: OMNIHIL_MODE_BODY_VELOCITY or OMNIHIL_MODE_WHEEL_SPEED.
  FirmwareTrial(Firmware& firmware, const RobotConfig& config, double level,
                std::uint32_t mode = OMNIHIL_MODE_BODY_VELOCITY)
      : firmware_(firmware), config_(config), level_(level), mode_(mode) {}

  void step();
  // kTicks of them, or until it no longer answers.
  std::vector<double> run();
  const std::vector<double>& asked() const { return asked_; }

 private:
  RobotCommand command() const;

  Firmware& firmware_;
  const RobotConfig& config_;
  double level_;
  std::uint32_t mode_;
  int ticks_ = 0;
  std::array<double, kWheels> turned_rad_{}, omega_rad_s_{};
  std::vector<double> asked_;
};

bool asks_nothing(const std::vector<double>& asked);

}  // namespace omnihil

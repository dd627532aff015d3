#include "hil/loop/air_loss.h"

#include <cmath>
#include <numbers>

#include "sim/law/random.h"

namespace omnihil {
namespace {

constexpr std::uint64_t kStream = stream_of("air_loss");
constexpr std::uint64_t kNormalStream = stream_of("air_loss_distance");

}  // namespace

// m = 1 + (2/pi) atan(0.4 (d - 5)), eq. (2), in percent
double distance_loss_mean(double distance_m) {
  return (1.0 + 2.0 / std::numbers::pi * std::atan(0.4 * (distance_m - 5.0))) / 100.0;
}

// sigma = 0.03 log(1 + d/5), eq. (3), in percent
double distance_loss_sigma(double distance_m) { return 0.03 * std::log(1.0 + distance_m / 5.0) / 100.0; }

AirLoss::AirLoss(const AirOptions& options, std::uint64_t seed,
                 std::function<std::pair<double, double>(int)> position, std::function<bool(int)> silent)
    : options_(options), seed_(seed), position_(std::move(position)), silent_(std::move(silent)) {}

double AirLoss::draw() { return uniform(seed_, kStream, drawn_++); }

bool AirLoss::lost_in_burst(int robot_id, AirWay way) {
  bool& bad = bad_[{robot_id, way}];
  // Geometric lengths: leaving a state of mean length n has probability 1/n per packet.
  const double leave = 1.0 / (bad ? options_.burst_bad_packets : options_.burst_good_packets);
  if (draw() < leave) bad = !bad;
  return bad && draw() < options_.burst_share;
}

bool AirLoss::lost(int robot_id, AirWay way) {
  bool gone = false;
  if (options_.share > 0.0) gone = draw() < options_.share || gone;
  if (options_.by_distance) {
    const auto [x_m, y_m] = position_(robot_id);
    const double d_m = std::hypot(x_m - options_.x_m, y_m - options_.y_m);
    const double share =
        distance_loss_mean(d_m) + distance_loss_sigma(d_m) * gaussian(seed_, kNormalStream, drawn_);
    gone = draw() < share || gone;
  }
  if (options_.burst_bad_packets > 0.0) gone = lost_in_burst(robot_id, way) || gone;
  if (options_.others_load > 0.0) gone = draw() < 1.0 - std::exp(-2.0 * options_.others_load) || gone;
  if (silent_ && silent_(robot_id)) gone = true;
  (way == AirWay::kToRobot ? counts_.sent_to_robot : counts_.sent_to_host) += 1;
  if (gone) (way == AirWay::kToRobot ? counts_.to_robot : counts_.to_host) += 1;
  return gone;
}

}  // namespace omnihil

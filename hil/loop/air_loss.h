// Packets lost on the air: a share of all, by distance, in bursts, by collision with other senders.
//
//   AirLoss air({.by_distance = true, .x_m = -4.5}, 7, [](int) { return std::pair(1.0, 0.0); });    // positions
//   air.lost(3, AirWay::kToRobot);
//   air.counts().to_robot;                                   // lost so far
//
// share        of all packets, independent of each other
// by_distance  from a transmitter at (x, y): Bakhshandeh Babarsad and Sharbafi 2012, eqs. (2), (3):
//                m = 1 + (2/pi) atan(0.4 (d - 5)),  sigma = 0.03 log(1 + d/5)
//              read as percent of packets (the paper gives no unit; 0.3 % beside the transmitter, 2 % far away), d in m,
//              sigma as standard deviation of the share from packet to packet, log natural, none below zero
// bursts       Gilbert 1960, Elliott 1963: two states with mean lengths in packets, losing nothing and burst_share;
//              one chain per robot and way
// others       senders that do not listen first: a packet collides with probability 1 - exp(-2 G), G their offered load
//              in packet times (Abramson 1970, pure ALOHA)
// Each is a chance of its own; a packet passes only when it passes all. Pure: drawn from the seed and the packet's number.
// Cannot: delay, repeat or reorder packets, or change bits; a dongle's own repeats are packets of their own here.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "protocols/radio_air.h"

namespace omnihil {

struct AirOptions {
  double share = 0.0;  // 0 to 1
  bool by_distance = false;
  double x_m = 0.0, y_m = 0.0;                                                  // of the transmitter
  double burst_good_packets = 0.0, burst_bad_packets = 0.0, burst_share = 0.0;  // 0: no bursts
  double others_load = 0.0;

  bool any() const { return share > 0.0 || by_distance || burst_bad_packets > 0.0 || others_load > 0.0; }
  bool operator==(const AirOptions&) const = default;
};

// What is wrong with them, a line each.
std::vector<std::string> air_problems(const AirOptions& options);

// Eqs. (2), (3) of the seed paper, as shares.
double distance_loss_mean(double distance_m);
double distance_loss_sigma(double distance_m);

struct AirCounts {
  std::uint64_t to_robot = 0, to_host = 0;            // lost
  std::uint64_t sent_to_robot = 0, sent_to_host = 0;  // all
};

class AirLoss : public RadioAir {
 public:
  // `position`: x and y in m of a robot.
  AirLoss(const AirOptions& options, std::uint64_t seed,
          std::function<std::pair<double, double>(int)> position);

  bool lost(int robot_id, AirWay way) override;
  const AirCounts& counts() const { return counts_; }

 private:
  double draw();
  bool lost_in_burst(int robot_id, AirWay way);

  AirOptions options_;
  std::uint64_t seed_;
  std::uint64_t drawn_ = 0;
  std::function<std::pair<double, double>(int)> position_;
  std::map<std::pair<int, AirWay>, bool> bad_;  // state of each chain
  AirCounts counts_;
};

}  // namespace omnihil

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
// A dongle's own repeats are packets of their own here. Late packets and wrong bits: air_delay.h, air_bits.h.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <utility>

#include "hil/loop/air_options.h"
#include "protocols/radio_air.h"

namespace omnihil {

// Eqs. (2), (3) of the seed paper, as shares.
double distance_loss_mean(double distance_m);
double distance_loss_sigma(double distance_m);

struct AirLossCounts {
  std::uint64_t to_robot = 0, to_host = 0;            // lost
  std::uint64_t sent_to_robot = 0, sent_to_host = 0;  // all
};

class AirLoss {
 public:
  // `position`: x and y in m of a robot. `silent`: whether nothing passes to and from it now; empty: never.
  AirLoss(const AirOptions& options, std::uint64_t seed,
          std::function<std::pair<double, double>(int)> position, std::function<bool(int)> silent = {});

  bool lost(int robot_id, AirWay way);
  const AirLossCounts& counts() const { return counts_; }

 private:
  double draw();
  bool lost_in_burst(int robot_id, AirWay way);

  AirOptions options_;
  std::uint64_t seed_;
  std::uint64_t drawn_ = 0;
  std::function<std::pair<double, double>(int)> position_;
  std::function<bool(int)> silent_;
  std::map<std::pair<int, AirWay>, bool> bad_;  // state of each chain
  AirLossCounts counts_;
};

}  // namespace omnihil

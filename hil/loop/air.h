// The air as a bench has it: packets lost, late, twice, out of order, with wrong bits. The dongles ask it (radio_air.h).
//
//   Air air({.share = 0.02, .bit_error_rate = 1e-5}, 7, [](int) { return std::pair(1.0, 0.0); });    // positions
//   link_config.air = &air;
//   air.counts().to_robot;                                   // lost so far
#pragma once
#include "hil/loop/air_bits.h"
#include "hil/loop/air_delay.h"
#include "hil/loop/air_loss.h"
#include "protocols/radio_air.h"

namespace omnihil {

struct AirCounts : AirLossCounts, AirDelayCounts {
  std::array<std::uint64_t, 2> refused{}, slipped{}, crowded{};  // by way
};

class Air final : public RadioAir {
 public:
  // `position`: x and y in m of a robot. `silent`: whether nothing passes to and from it now; empty: never.
  Air(const AirOptions& options, std::uint64_t seed, std::function<std::pair<double, double>(int)> position,
      std::function<bool(int)> silent = {})
      : loss_(options, seed, std::move(position), std::move(silent)),
        delay_(options, seed),
        bits_(options.bit_error_rate, seed) {}

  bool lost(int robot_id, AirWay way) override { return loss_.lost(robot_id, way); }
  AirFate fate(int robot_id, AirWay way, std::int64_t at_ns) override {
    if (loss_.lost(robot_id, way)) return {.copies = 0};
    return delay_.fate(robot_id, way, at_ns);
  }
  bool flip(std::span<std::uint8_t> packet) override { return bits_.flip(packet); }
  void judged(AirWay way, AirVerdict verdict) override {
    const auto i = static_cast<std::size_t>(way);
    (verdict == AirVerdict::kRefused   ? judged_.refused
     : verdict == AirVerdict::kSlipped ? judged_.slipped
                                       : judged_.crowded)[i] += 1;
  }
  AirCounts counts() const {
    AirCounts counts = judged_;
    static_cast<AirLossCounts&>(counts) = loss_.counts();
    static_cast<AirDelayCounts&>(counts) = delay_.counts();
    return counts;
  }

 private:
  AirLoss loss_;
  AirDelay delay_;
  AirBits bits_;
  AirCounts judged_;
};

}  // namespace omnihil

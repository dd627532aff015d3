// Which control ticks of a robot are kept: the first, and every Nth after it. The same rule for the file
// and for a replay, so that both keep the same ticks.
//
//   SampleDecimation decimation({0, 1}, 10);
//   if (decimation.keep(robot_id)) …
#pragma once
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace omnihil {

inline constexpr std::int64_t kBallEvery_ns = 10'000'000;  // of `w` lines: a camera's rate and a half

class SampleDecimation {
 public:
  SampleDecimation(std::vector<int> robot_ids, int every)
      : ids_(std::move(robot_ids)), to_skip_(ids_.size(), 0), every_(std::max(1, every)) {}

  int every() const { return every_; }

  // Call once per control tick. A robot that is not in the list is never kept.
  bool keep(int robot_id) {
    const auto at = std::find(ids_.begin(), ids_.end(), robot_id);
    if (at == ids_.end()) return false;
    int& to_skip = to_skip_[static_cast<std::size_t>(at - ids_.begin())];
    if (to_skip-- > 0) return false;
    to_skip = every_ - 1;
    return true;
  }

 private:
  std::vector<int> ids_;
  std::vector<int> to_skip_;  // per robot, until the next one that is kept
  int every_;
};

}  // namespace omnihil

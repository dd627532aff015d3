#include "hil/loop/clock_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace omnihil {

void ClockLine::add(double sent_s, double arrived_s) {
  const Point p{sent_s, arrived_s - sent_s};
  if (!points_.empty() && std::abs(p.late_s - points_.back().late_s) > kJump_s) {
    points_.clear();
    hull_.clear();
    sum_sent_s_ = 0.0;
    ++set_anew_;
  }
  if (!points_.empty() && p.sent_s <= points_.back().sent_s)
    return;  // another camera's, or one that was overtaken
  points_.push_back(p);
  sum_sent_s_ += p.sent_s - points_.front().sent_s;
  const auto above = [&](const Point& a, const Point& b) {  // b lies on or above the line from a to p
    return (b.late_s - a.late_s) * (p.sent_s - a.sent_s) >= (p.late_s - a.late_s) * (b.sent_s - a.sent_s);
  };
  while (hull_.size() > 1 && above(hull_[hull_.size() - 2], hull_.back())) hull_.pop_back();
  hull_.push_back(p);
}

ClockFit ClockLine::fit() const {
  ClockFit fit;
  fit.set_anew = set_anew_;
  fit.messages = points_.size();
  if (points_.empty()) return fit;
  fit.at_s = points_.front().sent_s + sum_sent_s_ / static_cast<double>(points_.size());
  if (points_.back().sent_s - points_.front().sent_s < kLeastSpan_s) {
    const auto quickest = std::min_element(
        hull_.begin(), hull_.end(), [](const Point& a, const Point& b) { return a.late_s < b.late_s; });
    fit.offset_s = quickest->late_s;
  } else {
    std::size_t k = 1;
    while (k + 1 < hull_.size() && hull_[k].sent_s < fit.at_s) ++k;
    const Point &a = hull_[k - 1], &b = hull_[k];
    fit.drift_ratio = (b.late_s - a.late_s) / (b.sent_s - a.sent_s);
    fit.offset_s = a.late_s + fit.drift_ratio * (fit.at_s - a.sent_s);
  }
  std::vector<double> beyond;
  for (const Point& p : points_)
    beyond.push_back(p.late_s - fit.offset_s - fit.drift_ratio * (p.sent_s - fit.at_s));
  const auto middle = beyond.begin() + static_cast<std::ptrdiff_t>(beyond.size() / 2);
  std::nth_element(beyond.begin(), middle, beyond.end());
  fit.delay_p50_s = *middle;
  return fit;
}

std::string clock_words(const std::map<unsigned, ClockLine>& cameras, double unix_start_s) {
  std::string out;
  for (const auto& [camera, line] : cameras) {
    const ClockFit fit = line.fit();
    const std::string drift = fit.drift_ratio == 0.0
                                  ? "too short to tell a drift"
                                  : fmt::format("drifts by {:+.2f} ppm", -1e6 * fit.drift_ratio);
    out += fmt::format(
        "camera {}: {} frames; its clock is {:+.3f} s from this computer's, {}; half of the frames within "
        "{:.1f} ms of the "
        "quickest{}\n",
        camera, fit.messages, -fit.offset_s - unix_start_s, drift, 1e3 * fit.delay_p50_s,
        fit.set_anew > 0 ? "; it was set anew on the way" : "");
  }
  return out;
}

}  // namespace omnihil

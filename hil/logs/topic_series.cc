#include "hil/logs/topic_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace omnihil {

void TopicSeries::add(const std::string& name, std::int64_t time_ns, double value, const std::string& unit) {
  if (time_ns < 0) {
    ++untimed_;
    return;
  }
  const auto [it, is_new] = index_.try_emplace(name, samples_.size());
  if (is_new) samples_.push_back({name, unit, {}, {}});
  Samples& s = samples_[it->second];
  s.time_ns.push_back(time_ns);
  s.value.push_back(value);
}

LogTable TopicSeries::table(LogFormat format) const {
  LogTable out;
  out.format = format;
  std::int64_t first = std::numeric_limits<std::int64_t>::max();
  for (const Samples& s : samples_)
    first = std::min(first, *std::min_element(s.time_ns.begin(), s.time_ns.end()));
  std::shared_ptr<const std::vector<double>> clock;
  const Samples* before = nullptr;
  for (const Samples& s : samples_) {
    if (before == nullptr || before->time_ns != s.time_ns) {
      std::vector<double> time_s;
      time_s.reserve(s.time_ns.size());
      for (const std::int64_t t : s.time_ns) time_s.push_back(static_cast<double>(t - first) / 1e9);
      clock = std::make_shared<const std::vector<double>>(std::move(time_s));
    }
    before = &s;
    out.series.push_back({s.name, s.unit, s.value, clock});
  }
  if (untimed_ > 0) out.notes.push_back(fmt::format("{} values with an impossible time left out", untimed_));
  return out;
}

}  // namespace omnihil

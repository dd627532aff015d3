#include "hil/observe/wave_log.h"

#include <algorithm>

namespace omnihil {

int WaveLog::add(const std::string& scope, const std::string& name, WaveKind kind, unsigned bits,
                 WaveValue first, bool shown) {
  if (options_.levels_only && kind != WaveKind::kLevel) return -1;
  if (!passes_filter(options_.filter, scope + "." + name)) return -1;
  if (kind == WaveKind::kReal) bits = 64;
  signals_.push_back({scope, name, kind, bits, first, first, shown});
  return static_cast<int>(signals_.size()) - 1;
}

void WaveLog::put(int signal, std::int64_t at_ns, WaveValue value) {
  if (signal < 0) return;
  WaveSignal& of = signals_[static_cast<std::size_t>(signal)];
  if (of.last == value) return;
  of.last = value;
  of.shown = true;
  events_.push_back({at_ns, signal, value});
  reaches(at_ns);
  for (; events_.size() > options_.most; dropped_ = true) forget();
}

void WaveLog::reaches(std::int64_t at_ns) {
  newest_ns_ = std::max(newest_ns_, at_ns);
  const auto keep_ns = static_cast<std::int64_t>(options_.last_s * 1e9);
  while (keep_ns > 0 && !events_.empty() && events_.front().at_ns < newest_ns_ - keep_ns) forget();
}

void WaveLog::forget() {
  const WaveEvent& first = events_.front();
  signals_[static_cast<std::size_t>(first.signal)].first = first.value;
  gone_ns_ = std::max(gone_ns_, first.at_ns);
  events_.pop_front();
}

std::int64_t WaveLog::from_ns() const {
  const auto keep_ns = static_cast<std::int64_t>(options_.last_s * 1e9);
  return std::max(keep_ns > 0 ? newest_ns_ - keep_ns : 0, gone_ns_);
}

void WaveLog::clear() {
  signals_.clear();
  events_.clear();
  newest_ns_ = gone_ns_ = 0;
  dropped_ = false;
}

}  // namespace omnihil

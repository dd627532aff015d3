#include "hil/wire/pacer.h"

#include <algorithm>

namespace omnihil {
namespace {
constexpr std::int64_t kNsPerS = 1'000'000'000;
}

Pacer::Pacer(const LinePace& pace, std::size_t capacity_bytes) : pace_(pace), ring_(capacity_bytes) {}

// floor(busy_ns * baud / (bits_per_byte * 1e9)), split into whole seconds and the rest so that nothing
// overflows: 64 bits hold it for 10 Gbit/s and years of busy line.
std::int64_t Pacer::crossed(std::int64_t busy_ns) const {
  if (busy_ns <= 0) return 0;
  const std::int64_t bits_in_whole_s = (busy_ns / kNsPerS) * pace_.baud;
  const std::int64_t whole_bytes = bits_in_whole_s / pace_.bits_per_byte;
  const std::int64_t rest_bits = bits_in_whole_s % pace_.bits_per_byte;
  return whole_bytes +
         (rest_bits * kNsPerS + (busy_ns % kNsPerS) * pace_.baud) / (pace_.bits_per_byte * kNsPerS);
}

std::size_t Pacer::push(std::span<const std::uint8_t> bytes, std::int64_t now_ns) {
  const std::size_t n = std::min(bytes.size(), room());
  if (n == 0) return 0;
  if (count_ == 0) {  // the line was idle: its last byte crossed before now
    busy_since_ns_ = now_ns;
    sent_in_period_ = 0;
  }
  for (std::size_t i = 0; i < n; ++i) ring_[(head_ + count_ + i) % ring_.size()] = bytes[i];
  count_ += n;
  return n;
}

void Pacer::pop(std::int64_t now_ns, std::vector<std::uint8_t>& out) {
  if (count_ == 0) return;
  std::int64_t due = static_cast<std::int64_t>(count_);
  if (pace_.baud > 0) due = std::min(due, crossed(now_ns - busy_since_ns_) - sent_in_period_);
  for (std::int64_t i = 0; i < due; ++i) {
    out.push_back(ring_[head_]);
    head_ = (head_ + 1) % ring_.size();
  }
  if (due <= 0) return;
  count_ -= static_cast<std::size_t>(due);
  sent_in_period_ += due;
}

void Pacer::clear() {
  head_ = 0;
  count_ = 0;
}

}  // namespace omnihil

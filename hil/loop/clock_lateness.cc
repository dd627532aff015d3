#include "hil/loop/clock_lateness.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace omnihil {

// Values below 2 * 2^kSubBits have a bucket each; above, the leading kSubBits + 1 bits pick it.
int LatenessHistogram::bucket(std::uint64_t ns) {
  const int shift = std::max(0, static_cast<int>(std::bit_width(ns)) - (kSubBits + 1));
  return (shift << kSubBits) + static_cast<int>(ns >> shift);
}

std::int64_t LatenessHistogram::upper_edge_ns(int bucket) {
  const int shift = std::max(0, (bucket >> kSubBits) - 1);
  const auto mantissa = static_cast<std::uint64_t>(bucket - (shift << kSubBits));
  return static_cast<std::int64_t>(((mantissa + 1) << shift) - 1);  // the last one is 2^63 - 1
}

void LatenessHistogram::add(std::int64_t late_ns) {
  late_ns = std::max<std::int64_t>(late_ns, 0);
  ++buckets_[static_cast<std::size_t>(bucket(static_cast<std::uint64_t>(late_ns)))];
  ++count_;
  max_ns_ = std::max(max_ns_, late_ns);
}

std::int64_t LatenessHistogram::quantile_ns(double quantile) const {
  if (count_ == 0) return 0;
  const auto wanted = static_cast<std::uint64_t>(std::ceil(quantile * static_cast<double>(count_)));
  std::uint64_t seen = 0;
  for (int b = 0; b < kBuckets; ++b) {
    seen += buckets_[static_cast<std::size_t>(b)];
    if (seen >= wanted && seen > 0) return std::min(upper_edge_ns(b), max_ns_);
  }
  return max_ns_;
}

}  // namespace omnihil

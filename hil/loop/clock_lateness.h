// How late things were: a histogram of durations with fixed memory, for p50, p99 and max of millions.
//
//   LatenessHistogram late;
//   late.add(36'000);
//   late.quantile_ns(0.99);
//
// Log-linear buckets, 32 to each power of two: a quantile is the upper edge of its bucket, at most 1/32
// (3.2 %) too large, never too small; below 64 ns and at max it is exact.
#pragma once
#include <array>
#include <cstdint>

namespace omnihil {

class LatenessHistogram {
 public:
  void add(std::int64_t late_ns);  // negative counts as 0
  std::uint64_t count() const { return count_; }
  std::int64_t max_ns() const { return max_ns_; }
  // Smallest edge below or at which at least `quantile` of all samples lie; 0 when there are none.
  std::int64_t quantile_ns(double quantile) const;

 private:
  static constexpr int kSubBits = 5;
  static constexpr int kBuckets = (64 - kSubBits) << kSubBits;
  static int bucket(std::uint64_t ns);
  static std::int64_t upper_edge_ns(int bucket);

  std::array<std::uint64_t, kBuckets> buckets_{};
  std::uint64_t count_ = 0;
  std::int64_t max_ns_ = 0;
};

}  // namespace omnihil

// Long signals made short for a chart without losing a peak, and packed for a page.
//
//   const ThinClock clock = thin_clock(time_s, 1000);          // at most 1000 intervals
//   const std::vector<double> y = thinned(clock, measured);    // two values per interval: least and greatest
//   const PackedSeries p = packed(y);                          // 16-bit steps between p.low and p.high, base64
//
// A signal with at most two samples per interval is kept sample by sample. In an interval the two extremes
// stand in the order in which they came, a quarter and three quarters through it: an instant is true to half
// an interval. Packing is true to 1/65000 of the signal's range.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace omnihil {

struct ThinClock {
  std::vector<double> time_s;      // of the values kept, from the first sample on
  std::vector<std::size_t> first;  // of interval k: samples first[k] up to first[k + 1]
  bool exact = true;               // every sample is kept
  double interval_s = 0.0;         // 0: exact
};

ThinClock thin_clock(std::span<const double> time_s, std::size_t intervals);

std::vector<double> thinned(const ThinClock& clock, std::span<const double> values);

struct PackedSeries {
  double low = 0.0;
  double high = 0.0;
  std::string base64;  // little-endian 16-bit: 0 is no value, 1 is low, 65535 is high
};

PackedSeries packed(std::span<const double> values);

// Little-endian 32-bit floats.
std::string packed_floats(std::span<const double> values);

}  // namespace omnihil

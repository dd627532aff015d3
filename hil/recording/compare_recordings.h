// Says where two runs differ: packets of the dongle field by field, samples column by column.
//
//   RecordingComparison c = compare_recordings(recorded, replayed, format, tolerances);
//   if (!c.agrees()) std::cout << c.first->text();
//   // "3.020 s, robot 2: true_v_forward_m_s: recorded 0.98, replayed 1.02 m/s (tolerance 0.005)"
//
// A recording that was cut off is compared as far as it goes. Columns that only one side has are not
// compared, and are listed.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "hil/recording/compare_recordings_tolerance.h"
#include "hil/recording/recording.h"

namespace omnihil {

struct Difference {
  std::int64_t now_ns = 0;
  int robot_id = -1;     // -1: not of one robot
  std::string what;      // "true_x_m", "packet BATTERIE_RESPONSE field decivolts", "packets"
  std::string recorded;  // both values as text
  std::string replayed;
  std::string unit;
  double tolerance = 0.0;

  std::string text() const;
};

struct SignalSummary {
  std::string name;  // a column without its wheel number, or MESSAGE.FIELD
  std::string unit;
  double tolerance = 0.0;
  std::uint64_t values = 0;
  std::uint64_t beyond = 0;  // values that differ by more than the tolerance
  double largest = 0.0;      // difference
  std::int64_t largest_ns = 0;
  int largest_robot = -1;
  std::string largest_column;  // with its wheel number; empty of a packet's field
  double sum_of_squares = 0.0;

  double rms() const;
  double over_tolerance()
      const;  // largest by tolerance; of a tolerance of zero infinite, or zero where alike
};

struct RecordingComparison {
  std::optional<Difference> first;  // the earliest beyond its tolerance
  std::vector<SignalSummary> signals;
  std::vector<std::string> not_compared;  // columns of the recording that are unknown here
  std::uint64_t samples = 0;
  std::uint64_t packets = 0;
  std::uint64_t bytes = 0;
  bool bytes_identical = false;    // of the dongle, with their times
  bool samples_identical = false;  // every bit of every compared value

  bool agrees() const { return !first.has_value(); }
  std::uint64_t values() const;
};

RecordingComparison compare_recordings(const Recording& recorded, const Recording& replayed,
                                       const RadioFormat& format, const Tolerances& tolerances);

// The dongle's bytes with their times, chunks of one time joined: what "identical bytes back" compares.
struct TimedBytes {
  std::int64_t now_ns = 0;
  std::vector<std::uint8_t> bytes;
  bool operator==(const TimedBytes&) const = default;
};
std::vector<TimedBytes> dongle_bytes_of(const Recording& recording);

// The first difference of the bytes themselves; `recorded` may be the beginning of `replayed` when it was
// cut.
std::optional<Difference> first_byte_difference(const Recording& recorded, const Recording& replayed);

}  // namespace omnihil

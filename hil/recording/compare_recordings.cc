#include "hil/recording/compare_recordings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hil/recording/compare_recordings_parts.h"
#include "hil/text/recording_text.h"

namespace omnihil {

std::string Difference::text() const {
  std::string out = fmt::format("{:.6f} s, ", static_cast<double>(now_ns) / 1e9);
  out += robot_id >= 0 ? fmt::format("robot {}: ", robot_id) : std::string("dongle: ");
  out += fmt::format("{}: recorded {}, replayed {}", what, recorded, replayed);
  if (!unit.empty() && unit != "1") out += " " + unit;
  out += " (tolerance ";
  append_number(out, tolerance);
  return out + ")";
}

double SignalSummary::rms() const {
  return values == 0 ? 0.0 : std::sqrt(sum_of_squares / static_cast<double>(values));
}

double SignalSummary::over_tolerance() const {
  if (tolerance > 0.0) return largest / tolerance;
  return largest > 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
}

std::uint64_t RecordingComparison::values() const {
  std::uint64_t sum = 0;
  for (const SignalSummary& signal : signals) sum += signal.values;
  return sum;
}

std::size_t DifferenceNotes::signal(const std::string& name, std::string_view unit, double tolerance) {
  const auto [at, is_new] = index_.try_emplace(name, result_.signals.size());
  if (is_new) {
    SignalSummary summary;
    summary.name = name;
    summary.unit = std::string(unit);
    summary.tolerance = tolerance;
    result_.signals.push_back(std::move(summary));
  }
  return at->second;
}

void DifferenceNotes::value(std::size_t index, double difference, std::int64_t now_ns, int robot_id,
                            std::string_view column) {
  SignalSummary& summary = result_.signals[index];
  ++summary.values;
  summary.sum_of_squares += difference * difference;
  if (difference > summary.tolerance) ++summary.beyond;
  if (difference > summary.largest) {
    summary.largest = difference;
    summary.largest_ns = now_ns;
    summary.largest_robot = robot_id;
    summary.largest_column = column;
  }
}

void DifferenceNotes::differs(Difference difference) {
  if (!result_.first || difference.now_ns < result_.first->now_ns) result_.first = std::move(difference);
}

std::vector<TimedBytes> dongle_bytes_of(const Recording& recording) {
  std::vector<TimedBytes> all;
  for (const RecordedChunk& chunk : recording.chunks) {
    if (chunk.kind != RecordedChunk::Kind::kDongleBytes) continue;
    if (all.empty() || all.back().now_ns != chunk.now_ns) all.push_back({chunk.now_ns, {}});
    all.back().bytes.insert(all.back().bytes.end(), chunk.bytes.begin(), chunk.bytes.end());
  }
  return all;
}

std::optional<Difference> first_byte_difference(const Recording& recorded, const Recording& replayed) {
  const std::vector<TimedBytes> a = dongle_bytes_of(recorded);
  const std::vector<TimedBytes> b = dongle_bytes_of(replayed);
  const auto nothing = std::string("nothing");
  for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
    if (i >= a.size() && !recorded.complete) return std::nullopt;
    if (i < a.size() && i < b.size() && a[i] == b[i]) continue;
    Difference difference;
    difference.what = "bytes";
    difference.recorded = i < a.size() ? to_hex(a[i].bytes) : nothing;
    difference.replayed = i < b.size() ? to_hex(b[i].bytes) : nothing;
    difference.now_ns =
        std::min(i < a.size() ? a[i].now_ns : b[i].now_ns, i < b.size() ? b[i].now_ns : a[i].now_ns);
    if (i < a.size() && i < b.size() && a[i].now_ns != b[i].now_ns) {
      difference.recorded += fmt::format(" at {} ns", a[i].now_ns);
      difference.replayed += fmt::format(" at {} ns", b[i].now_ns);
    }
    return difference;
  }
  return std::nullopt;
}

RecordingComparison compare_recordings(const Recording& recorded, const Recording& replayed,
                                       const RadioFormat& format, const Tolerances& tolerances) {
  RecordingComparison result;
  DifferenceNotes notes(result);
  compare_packets(recorded, replayed, format, tolerances, result, notes);
  const std::optional<Difference> bytes = first_byte_difference(recorded, replayed);
  result.bytes_identical = !bytes.has_value();
  // Only what no packet's field shows is named as bytes: a checksum, a chunk that left earlier.
  if (tolerances.exact && bytes && !result.first) notes.differs(*bytes);
  compare_samples(recorded, replayed, tolerances, result, notes);
  return result;
}

}  // namespace omnihil

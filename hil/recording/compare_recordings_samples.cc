#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "hil/recording/compare_recordings_parts.h"
#include "hil/recording/recorded_samples.h"
#include "hil/text/recording_text.h"

namespace omnihil {
namespace {

struct Column {
  std::string name;
  std::string unit;
  std::size_t recorded = 0;  // its place in either side's samples
  std::size_t replayed = 0;
  double tolerance = 0.0;
  bool is_angle = false;
  std::size_t signal = 0;
};

bool is_angle(const std::string& name) {
  const auto& columns = sample_columns();
  return std::any_of(columns.begin(), columns.end(),
                     [&](const SampleColumn& column) { return column.name == name && column.is_angle; });
}

std::vector<Column> common_columns(const RecordingHeader& recorded, const RecordingHeader& replayed,
                                   const Tolerances& tolerances, RecordingComparison& result,
                                   DifferenceNotes& notes) {
  std::vector<Column> columns;
  for (std::size_t i = 0; i < recorded.columns.size(); ++i) {
    const std::string& name = recorded.columns[i];
    const auto at = std::find(replayed.columns.begin(), replayed.columns.end(), name);
    const auto k = static_cast<std::size_t>(at - replayed.columns.begin());
    if (at == replayed.columns.end() || replayed.units[k] != recorded.units[i]) {
      result.not_compared.push_back(name);
      continue;
    }
    Column column{
        name, recorded.units[i], i, k, tolerances.of_column(name, recorded.units[i]), is_angle(name), 0};
    column.signal = notes.signal(std::string(without_wheel(name)), column.unit, column.tolerance);
    columns.push_back(std::move(column));
  }
  return columns;
}

double difference_of(const Column& column, double a, double b) {
  const double difference = a - b;
  // Angles: the short way round, |a - b| modulo 2 pi.
  return std::abs(column.is_angle ? std::remainder(difference, 2.0 * std::numbers::pi) : difference);
}

std::string number_text(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

std::string place_text(const RecordedChunk* sample) {
  if (sample == nullptr) return "none";
  return "robot " + std::to_string(sample->robot_id) + " at " + std::to_string(sample->now_ns) + " ns";
}

}  // namespace

void compare_samples(const Recording& recorded, const Recording& replayed, const Tolerances& tolerances,
                     RecordingComparison& result, DifferenceNotes& notes) {
  const auto a = samples_of(recorded);
  const auto b = samples_of(replayed);
  const auto columns = common_columns(recorded.header, replayed.header, tolerances, result, notes);
  result.samples_identical = true;
  if (a.empty()) return;  // the bytes alone were recorded
  const std::size_t count = recorded.complete ? std::max(a.size(), b.size()) : a.size();
  for (std::size_t i = 0; i < count; ++i) {
    const RecordedChunk* left = i < a.size() ? a[i] : nullptr;
    const RecordedChunk* right = i < b.size() ? b[i] : nullptr;
    if (left == nullptr || right == nullptr || left->now_ns != right->now_ns ||
        left->robot_id != right->robot_id) {
      result.samples_identical = false;
      const RecordedChunk* here = left != nullptr ? left : right;
      notes.differs({here->now_ns, here->robot_id, "sample", place_text(left), place_text(right), "", 0.0});
      return;  // from here on the samples are out of step
    }
    ++result.samples;
    for (const Column& column : columns) {
      const double x = left->sample[column.recorded];
      const double y = right->sample[column.replayed];
      const double difference = difference_of(column, x, y);
      const bool same_bits = std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
      result.samples_identical = result.samples_identical && same_bits;
      notes.value(column.signal, difference, left->now_ns, left->robot_id, column.name);
      if (tolerances.exact ? same_bits : difference <= column.tolerance) continue;
      notes.differs({left->now_ns, left->robot_id, column.name, number_text(x), number_text(y), column.unit,
                     column.tolerance});
    }
  }
}

}  // namespace omnihil

#include "hil/check/compare_versions.h"

#include <fmt/format.h>

#include <map>

namespace omnihil {
namespace {

std::map<std::string, const SignalSummary*> by_name(const RecordingComparison& comparison) {
  std::map<std::string, const SignalSummary*> found;
  for (const SignalSummary& signal : comparison.signals) found[signal.name] = &signal;
  return found;
}

}  // namespace

VersionsComparison compare_versions(const Recording& recording, const RadioFormat& format,
                                    const ReplayOptions& a, const ReplayOptions& b,
                                    const Tolerances& tolerances) {
  VersionsComparison out;
  out.a = run_again(recording, a);
  out.b = run_again(recording, b);
  const RecordingComparison to_a = compare_recordings(recording, out.a.answer, format, tolerances);
  const RecordingComparison to_b = compare_recordings(recording, out.b.answer, format, tolerances);
  const RecordingComparison between = compare_recordings(out.a.answer, out.b.answer, format, tolerances);
  const auto of_a = by_name(to_a), of_b = by_name(to_b);
  out.first = between.first;
  for (const SignalSummary& signal : between.signals) {
    const auto in_a = of_a.find(signal.name), in_b = of_b.find(signal.name);
    if (in_a == of_a.end() || in_b == of_b.end()) continue;
    out.rows.push_back({signal.name, signal.unit, in_a->second->rms(), in_b->second->rms(), signal.rms(),
                        signal.largest, signal.tolerance});
  }
  return out;
}

std::string versions_table(const VersionsComparison& both) {
  std::string text = fmt::format("{:<36} {:>12} {:>12} {:>12} {:>12} {:<6} {}\n", "signal", "A off, RMS",
                                 "B off, RMS", "A to B, RMS", "largest", "unit", "closer");
  for (const VersionRow& row : both.rows) {
    // A difference of both within the tolerance is none.
    const bool apart = row.between_largest > row.tolerance;
    const char* closer = !apart ? "" : row.a_rms < row.b_rms ? "A" : row.b_rms < row.a_rms ? "B" : "";
    text += fmt::format("{:<36} {:>12.3g} {:>12.3g} {:>12.3g} {:>12.3g} {:<6} {}\n", row.signal, row.a_rms,
                        row.b_rms, row.between_rms, row.between_largest, row.unit, closer);
  }
  return text;
}

}  // namespace omnihil

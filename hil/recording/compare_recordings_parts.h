// The two halves of compare_recordings, and how they note what they find. Not for others to include.
#pragma once
#include <map>

#include "hil/recording/compare_recordings.h"

namespace omnihil {

class DifferenceNotes {
 public:
  explicit DifferenceNotes(RecordingComparison& result) : result_(result) {}

  // The place of a signal in result.signals; made at the first call.
  std::size_t signal(const std::string& name, std::string_view unit, double tolerance);
  void value(std::size_t signal, double difference, std::int64_t now_ns, int robot_id,
             std::string_view column = {});
  // Keeps the earliest; of two at one time the one that was noted first.
  void differs(Difference difference);

 private:
  RecordingComparison& result_;
  std::map<std::string, std::size_t, std::less<>> index_;
};

void compare_samples(const Recording& recorded, const Recording& replayed, const Tolerances& tolerances,
                     RecordingComparison& result, DifferenceNotes& notes);
void compare_packets(const Recording& recorded, const Recording& replayed, const RadioFormat& format,
                     const Tolerances& tolerances, RecordingComparison& result, DifferenceNotes& notes);

}  // namespace omnihil

#include "hil/recording/recorded_samples.h"

#include <algorithm>

namespace omnihil {

std::size_t column_place(const RecordingHeader& header, std::string_view name) {
  return static_cast<std::size_t>(std::ranges::find(header.columns, name) - header.columns.begin());
}

std::vector<const RecordedChunk*> samples_of(const Recording& recording, std::optional<int> robot_id) {
  std::vector<const RecordedChunk*> samples;
  for (const RecordedChunk& chunk : recording.chunks) {
    if (chunk.kind == RecordedChunk::Kind::kSample && chunk.robot_id == robot_id.value_or(chunk.robot_id))
      samples.push_back(&chunk);
  }
  return samples;
}

}  // namespace omnihil

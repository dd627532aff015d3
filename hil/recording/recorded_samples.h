// The samples of a recording, and where a column stands in them.
//
//   const std::size_t duty = column_place(recording.header, "duty_ratio_1");    // columns.size(): there is none
//   for (const RecordedChunk* sample : samples_of(recording)) std::cout << sample->sample[duty];
#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "hil/recording/recording.h"

namespace omnihil {

std::size_t column_place(const RecordingHeader& header, std::string_view name);

// In their order; of one robot or of all. Valid as long as the recording is.
std::vector<const RecordedChunk*> samples_of(const Recording& recording, std::optional<int> robot_id = {});

}  // namespace omnihil

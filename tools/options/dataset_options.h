// Help of options that all verbs have which hold a model against a measurement.
#pragma once

namespace omnihil {

inline constexpr const char* kFirmwareSays =
    "library (.so) that makes duties of a robot's commands in the prediction, in place of the dataset's own";

}  // namespace omnihil

// One signal of a recording over time: a column of one robot, or a field of its packets.
//
//   SignalSeries series = signal_series(recording, format, "RobotFeedback.batteryLevel", 3);
#pragma once
#include <string_view>
#include <vector>

#include "hil/recording/recording.h"
#include "protocols/radio_format.h"

namespace omnihil {

struct SignalSeries {
  std::vector<double> time_s;
  std::vector<double> value;
};

// `name`: a column of the header, or MESSAGE.FIELD of the format. Empty where there is none of it. Packets that
// carry no robot are taken with robot -1.
SignalSeries signal_series(const Recording& recording, const RadioFormat& format, std::string_view name,
                           int robot_id);

}  // namespace omnihil

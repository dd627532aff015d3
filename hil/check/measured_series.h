// What a recording says that a real robot could have said: its telemetry, or its sensors tick by tick.
//
//   std::vector<MeasuredSeries> all = measured_series(recording, format, measured_by(recording));
//   std::vector<double> model = values_at(other, all[0].time_s);     // of the same series in another recording
//
// With samples: encoder rate, motor current, supply, gyro and accelerometer of each wheel and robot; else the physical
// fields of the dongle's packets. Truth, flags, counters and clocks stay out; counts are taken as rates, and angles not
// at all: the direction of a velocity near zero is noise without bound.
#pragma once
#include <string>
#include <vector>

#include "hil/recording/recording.h"
#include "protocols/radio_format.h"

namespace omnihil {

struct MeasuredSeries {
  std::string name;  // a column, or MESSAGE.FIELD
  std::string unit;
  int robot_id = -1;
  double step = 0.0;  // resolution of the field; 0: none known
  std::vector<double> time_s;
  std::vector<double> value;
};

enum class MeasuredBy : std::uint8_t { kSensors, kTelemetry };
// Sensors where the recording has samples.
MeasuredBy measured_by(const Recording& recording);
std::vector<MeasuredSeries> measured_series(const Recording& recording, const RadioFormat& format,
                                            MeasuredBy by);

// The value held since the last one at or before each time; NaN before the first.
std::vector<double> values_at(const MeasuredSeries& series, const std::vector<double>& time_s);

}  // namespace omnihil

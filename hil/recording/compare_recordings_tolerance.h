// How far two runs may differ and still agree: absolute tolerances, in the unit of the signal.
//
//   Tolerances tolerances;                                  // the table below
//   tolerances.read("true_x_m = 0.002", "line 1", &format, problems);   // as in a file or on the command line
//
// A setting is KEY = VALUE, most particular first:
//   true_omega_wheel_rad_s_2      one column
//   true_omega_wheel_rad_s        that column of all four wheels
//   RobotFeedback.batteryLevel    one field of one packet of the radio format
//   unit:rad/s                    every column and field of that unit
//   packet_time_s                 when a packet leaves the dongle
// A field of a packet may besides differ by one step of its own resolution. Whole-number fields without a
// unit (flags, ids, counters) and text must be equal unless a setting names them.
//
// The table is made to let another compiler or mathematical library pass (last digits, an encoder count that
// falls the other way), and to refuse a robot that drives differently: values are a guess by the sizes that
// matter on a field, not a measurement of a real robot.
#pragma once
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "protocols/radio_format.h"

namespace omnihil {

struct UnitTolerance {
  std::string_view unit;
  double tolerance;
};
std::span<const UnitTolerance> default_tolerances();
inline constexpr double kDefaultPacketTime_s = 0.001;

struct Tolerances {
  bool exact = false;  // bytes identical, samples identical in every bit; settings do not matter
  std::map<std::string, double, std::less<>> settings;

  double of_column(std::string_view name, std::string_view unit) const;
  double of_field(std::string_view message, const Field& field) const;
  double packet_time_s() const;

  // One KEY=VALUE (blanks around either are fine). `format` may be null: then no packet fields are known.
  // Appends to `problems` what is wrong, beginning with `place`.
  void read(std::string_view setting, const std::string& place, const RadioFormat* format,
            std::vector<std::string>& problems);
  // A text of settings, one per line; '#' begins a comment.
  void read_file(std::string_view text, const std::string& name, const RadioFormat* format,
                 std::vector<std::string>& problems);
};

// "true_omega_wheel_rad_s" of "true_omega_wheel_rad_s_2"; the name itself where there is no wheel number.
std::string_view without_wheel(std::string_view column);

// The default table as text, for --help and documentation.
std::string default_tolerance_text();

}  // namespace omnihil

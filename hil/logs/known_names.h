// Names of columns whose meaning is known: those that a format's documents define, and those that are usual.
//
//   const KnownName* k = known_name(LogFormat::kVesc, "erpm");        // {"erpm", "velocity", "erpm", …}
//   usual_signal("Motor Current", rig_axis());                        // "motor_current"
//
// Sources: ODrive: docs.odriverobotics.com (API reference: turns, turns/s, A, V, N m). moteus: mjbots.github.io/moteus
// (registers: revolutions, revolutions/s at the output, A, V, N m) and its diagnostic names. VESC: the columns of VESC
// Tool's realtime log. SimpleFOC: docs.simplefoc.com (library units, monitoring). Cannot: know what a user's own
// firmware calls things.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "hil/logs/log_table.h"
#include "identify/record/dataset.h"

namespace omnihil {

struct KnownName {
  std::string_view column;  // whole, or behind the last "."
  std::string_view signal;  // empty: left out, for the reason in `why`
  std::string_view unit;
  int rank = 0;  // of several columns for one signal the lowest is taken
  bool imposed = false;
  std::string_view why = "";
};

const KnownName* known_name(LogFormat format, std::string_view column);

// The signal of a usual name (letters and digits alone count); "": none. Of rig "robot" names end in the wheel's number
// 1 to 4.
std::string usual_signal(std::string_view name, const Rig& rig);
// The signals that go by one name: "voltage" may be the motor's or the supply's. Empty: it is none of those.
std::vector<std::string> ambiguous_signals(std::string_view name, const Rig& rig);

}  // namespace omnihil

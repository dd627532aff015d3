// How much of a core a bench will need in real time, before it starts: measured on this computer, now.
//
//   const ServeLoad load = measured_load(config);
//   std::cout << load_words(load);        // "about 7 % of a core (measured: …)"
//
// Measured: 100 ms of simulated time of the same robots in a session of its own, driving, with this program's firmware; where
// that is much, once more in closed form. Left out: what firmware from outside takes (its processes, images on boards, boards on
// the desk) and what the host and the recording take.
#pragma once
#include <string>

#include "hil/loop/session.h"

namespace omnihil {

struct ServeLoad {
  double core_ratio = 0.0;    // of processor time to simulated time; 0: not measured
  double planar_ratio = 0.0;  // the same with Physics::kPlanar, where it would help; 0: not measured
  bool planar = false;        // already is
  int robots = 0;
};

// Nothing where such a session cannot be made.
ServeLoad measured_load(const SessionConfig& config);

// Empty: nothing was measured. More than one line where this computer will not keep up: what to change.
std::string load_words(const ServeLoad& load);

}  // namespace omnihil

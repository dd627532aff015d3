// How much of a core a bench will need in real time, before it starts: measured on this computer, now.
//
//   const ServeLoad load = measured_load(config, {first, opponents});
//   std::cout << load_words(load);        // "about 7 % of a core (measured: …)"
//
// Measured: 100 ms of simulated time of the same robots in a session of its own, driving, on one thread; what each robot's
// emulated boards take of it; where the whole is much, once more in closed form. Left out: what other firmware from outside
// takes (its processes, AVR boards, boards on the desk: this program's firmware stands in for it), a firmware that takes longer
// to begin than these 120 ms, and what the host and the recording take. How it will be on several cores is worked out: what
// boards take is shared out, all else stays on one.
#pragma once
#include <string>
#include <vector>

#include "hil/loop/session.h"

namespace omnihil {

struct ServeLoad {
  double core_ratio = 0.0;    // of processor time to simulated time; 0: not measured
  double planar_ratio = 0.0;  // the same with Physics::kPlanar, where it would help; 0: not measured
  bool planar = false;        // already is
  int robots = 0;
  struct Share {
    int key = 0;              // robot, or kOpponentKey + robot
    double core_ratio = 0.0;  // what its boards take
  };
  std::vector<Share> boards = {};  // of robots with emulated boards
  int threads = 1;

  double busiest_core_ratio() const;  // of `threads` cores
};

struct LoadFirmware {
  Session::FirmwareMaker first, opponents;  // empty: this program's
};

// Nothing where such a session cannot be made.
ServeLoad measured_load(const SessionConfig& config, const LoadFirmware& firmware = {});

// Empty: nothing was measured. More than one line where boards are emulated: what they take; and where this computer will not
// keep up: what to change.
std::string load_words(const ServeLoad& load);

}  // namespace omnihil

// Progress report of a long computation, passed to the caller's function while it runs.
//
//   options.progress = [](const Progress& p) { return p.share < 0.2; };   // false: stop with what is known
#pragma once
#include <string>

namespace omnihil {

struct Progress {
  std::string doing;   // "refitting cogging"
  double share = 0.0;  // of the work, 0 to 1
};

}  // namespace omnihil

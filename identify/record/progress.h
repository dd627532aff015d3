// How far a long computation is; asked for by who runs it, told while it runs.
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

// Tyre curve of one direction of an omni wheel: grip over slip, given by its extremum and its asymptote.
#pragma once

namespace omnihil {

// grip(slip) rises to extremum_value at extremum_slip, falls to asymptote_value at asymptote_slip and
// stays there; odd in slip. Values are friction coefficients (force over wheel load).
struct TyreCurve {
  double extremum_slip = 0.0;
  double extremum_value = 0.0;
  double asymptote_slip = 0.0;
  double asymptote_value = 0.0;
};

}  // namespace omnihil

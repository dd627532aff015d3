// Where an imposed motion does not say which torque it needs.
//
//   std::vector<bool> still = standing_still(position, 1.5e-3, 10, 5);  // true: within ten rows it moves a count at most
//   std::vector<bool> jumps = unresolved_jumps(torque, 0.2, 1e-4, 10);  // true: within ten samples of such a jump
//
// At rest dry friction takes whatever is asked, up to what holds: no law of the motion says how much. And a torque that jumps
// between two rows may have acted from any instant between them: the mean from row to row is known to the jump over sqrt(12)
// (uniform), of which a low pass of band b (share of half the rate) shows b at most.
// Cannot: say what holds (a breakaway torque shows where the motion begins); see a jump that the rows around it follow.
#pragma once
#include <span>
#include <vector>

#include "identify/predict/predictor.h"

namespace omnihil {

// [n] from n positions in any unit: rows of a window of `window` steps in which it stays within `limit`, and
// `margin` to either side.
std::vector<bool> standing_still(std::span<const double> position, double limit, std::size_t window,
                                 std::size_t margin);

// [n] from n torques; `band` as above, 0 to 1; `sigma`: 1-sigma of the compared torque in the torque's unit; `margin`: of the
// low pass to either side of a jump. None where that would be more than half of the record: its input is made of jumps.
std::vector<bool> unresolved_jumps(std::span<const double> torque, double band, double sigma,
                                   std::size_t margin);

// Takes these samples ([n] each; empty: none) out of what is compared, keeps them in `with_undetermined`, and says so.
void leave_out_undetermined(const std::vector<bool>& still, const std::vector<bool>& jumps,
                            ComparedSignal& signal);

}  // namespace omnihil

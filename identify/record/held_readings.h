// A sensor that is slower than the rows it is logged in: each of its readings stands in several rows until the next.
//
//   double n = rows_held({&position_1, &position_2});   // runs of one signal; 10.0: a new reading in every tenth row
//   if (n > 0.0) empty_repeats(position_1);
//
// Law: a reading changes when the sensor gives one, so the rows from change to change are always as many, however fast
// the motion. Of a coarse sensor they are the fewer the faster it moves, and it changes by single steps; a reading
// that repeats by chance does so for geometrically distributed rows, of which no number but one has most. Validity:
// twenty changes, most of them of more than two of the sensor's steps. Cannot: tell a slow sensor whose readings go by
// one or two steps from a coarse one.
#pragma once
#include <vector>

#include "identify/record/signal_list.h"

namespace omnihil {

// Is a signal of this row looked at: a fit takes a reading of it, one by one. Not what is imposed, nor the speed of a motor
// with Hall sensors: their held window is known by its repeats (counted_speed.h).
bool may_be_held(const SignalRow& row, bool imposed, bool has_halls);

// Rows from reading to reading, the median; 0: every row has its own, or that cannot be told. NaN: not measured.
double rows_held(const std::vector<const std::vector<double>*>& runs);

// What repeats the reading before it becomes NaN.
void empty_repeats(std::vector<double>& values);

}  // namespace omnihil

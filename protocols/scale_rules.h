// The rules by which numbers become the integers of kScaled fields: each team's own arithmetic, by name.
//
//   const ScaleRule* rule = find_scale_rule("nearest");   // as a table in a file names it; nullptr when unknown
//
// In a table: scaled("vx", 12, Sign::kTwosComplement, kEvenSteps, -6.0, 6.0, "m/s", "velocity").
// A rule knows its field: limits lo and hi, width, sign. What lies beyond the limits is the rule's `beyond`.
#pragma once
#include <span>

#include "protocols/field_table.h"

namespace omnihil {

extern const ScaleRule kNearest;          // hi at the largest count, 0 at 0, to the nearest
extern const ScaleRule kWhole;            // count = trunc(x), clamped
extern const ScaleRule kThirds;           // rocos: levels of a third, clamped
extern const ScaleRule kAroundHalf;       // ibis: 7FFFh is 0
extern const ScaleRule kTwentieths;       // ibis
extern const ScaleRule kEvenSteps;        // ER-Force 2025: lo at the lowest count, hi at the highest, clamped
extern const ScaleRule kEvenStepsAround;  // the same, wrapped: angles
// ER-Force's transceiver: count = trunc(highest count / hi * x) in float32, clamped; two with 8000h for no number.
extern const ScaleRule kTruncated;
extern const ScaleRule kTruncatedOrNone;
extern const ScaleRule kTruncatedAroundOrNone;  // wrapped: angles
extern const ScaleRule kHundredths;             // count = trunc(100 x) in float32, clamped
extern const ScaleRule kThousandths;            // RoboJackets: count = trunc(1000 x) in float32, clamped

std::span<const ScaleRule* const> scale_rules();
const ScaleRule* find_scale_rule(std::string_view name);

}  // namespace omnihil

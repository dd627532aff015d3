// A field seen from above, as a self-contained SVG: lines and boards, the ways of robots and ball, kicks, touches, goals.
//
//   std::string svg = field_picture(trace, {.title = "kick and goal"});
//
// Robots are drawn where they began (thin) and where they ended (filled), the first team in its colour, opponents in the
// other, real ones of a mixed match grey; a ball in the air has a dotted way. Without a field the picture is as large as what moved.
#pragma once
#include <string>

#include "hil/loop/field_trace.h"

namespace omnihil {

struct FieldPictureOptions {
  std::string title;
  double width_px = 900.0;
};

std::string field_picture(const FieldTrace& trace, const FieldPictureOptions& options);

}  // namespace omnihil

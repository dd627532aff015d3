// Force over slip of a robot's wheels as a self-contained SVG: points, means of bins, curve and its band.
//
//   std::string svg = tyre_picture(found, "pushes of the carpet");
#pragma once
#include <string>

#include "identify/tyre/tyre_identification.h"

namespace omnihil {

std::string tyre_picture(const TyreIdentification& found, const std::string& title);

}  // namespace omnihil

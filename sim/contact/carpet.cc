// What numbers a carpet may have.
#include <fmt/format.h>

#include <cmath>

#include "sim/contact/ball.h"

namespace omnihil {

std::vector<std::string> carpet_problems(const Carpet& carpet) {
  std::vector<std::string> problems;
  const auto within = [&](const char* name, double value, double least, double most) {
    if (!(value >= least && value <= most))
      problems.push_back(fmt::format("carpet: {} {:g}, allowed: {:g} to {:g}", name, value, least, most));
  };
  within("sliding friction", carpet.sliding_friction, 0.0, 2.0);
  within("rolling resistance", carpet.rolling_resistance, 0.0, 1.0);
  within("spinning friction", carpet.spinning_friction, 0.0, 1.0);
  within("restitution", carpet.restitution, 0.0, 1.0);
  within("nap", carpet.nap_ratio, 0.0, 0.95);  // at 1 its force would push the ball on
  within("nap's direction in rad", carpet.nap_rad, -7.0, 7.0);
  for (const CarpetPatch& p : carpet.patches) {
    within("patch: ratio of sliding", p.sliding_ratio, 0.0, 100.0);
    within("patch: ratio of rolling", p.rolling_ratio, 0.0, 100.0);
    if (!(p.x_from_m < p.x_to_m && p.y_from_m < p.y_to_m) ||
        !std::isfinite(p.x_to_m - p.x_from_m + p.y_to_m - p.y_from_m))
      problems.push_back(
          fmt::format("carpet: patch x {:g} to {:g}, y {:g} to {:g}: allowed: from below to, in m",
                      p.x_from_m, p.x_to_m, p.y_from_m, p.y_to_m));
  }
  return problems;
}

}  // namespace omnihil

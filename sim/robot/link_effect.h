// The description of a link: what a robot's mechanics puts last into the chains of a drive, by its name, to
// tell the drive something or to learn from it. Not an effect that users see; always on.
//
//   static constexpr EffectInfo kInfo = link_info("Link between drive and plant", "level += …", "source.cc");
#pragma once
#include <string_view>

#include "sim/law/effect.h"

namespace omnihil {

inline constexpr EffectParam kAlwaysOn[] = {
    {.name = "on", .unit = "1", .typical = 1, .upper = 1, .what = "always on", .how = "never seen by users"}};

constexpr EffectInfo link_info(std::string_view title, std::string_view equation, std::string_view source) {
  return {.id = "~wheel",
          .title = title,
          .equation = equation,
          .source = source,
          .cannot = "",
          .place = Place::kTorque,
          .reveals = "",
          .visible = "",
          .params = kAlwaysOn};
}

}  // namespace omnihil

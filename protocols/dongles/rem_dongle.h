// RoboTeam Twente's base station: USB with SX1280 radios; raw packets, 60 Hz polling of 16 robots. For every
// version of REM: `format` says which. Behaviour, timing and sources: docs/dongles.md.
//
//   RadioFormat format{.id = "roboteam-rem-v8", .dongle = make_rem_dongle, …};
#pragma once
#include "protocols/radio_format.h"

namespace omnihil {

std::unique_ptr<RadioLink> make_rem_dongle(const RadioFormat& format, const RadioLinkConfig& config);

}  // namespace omnihil

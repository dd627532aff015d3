// RoboCup ULaval's dongle: a USB CDC stick with an nRF24 behind it; COBS frames, one at a time over the air.
// Behaviour, timing and sources: docs/dongles.md.
//
//   RadioFormat format{.id = "ulaval-hermes", .dongle = make_hermes_dongle, …};
#pragma once
#include "protocols/radio_format.h"

namespace omnihil {

std::unique_ptr<RadioLink> make_hermes_dongle(const RadioFormat& format, const RadioLinkConfig& config);

}  // namespace omnihil

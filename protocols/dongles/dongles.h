// The dongles: what sits in the host's USB port and the air behind it, one factory per kind. A radio format
// names one of these as its `make_link`.
//
//   RadioFormat::make_link = [](const RadioLinkConfig& c) { return make_rem_dongle(kFormat_x, c); };
//
// Behaviour, timing and sources: docs/dongles.md. Both are pure functions of (bytes, times, feedback); their
// queues are bounded and nothing is allocated once the link has been built and its buffers have grown.
#pragma once
#include <memory>

#include "protocols/radio_format.h"
#include "protocols/radio_link.h"

namespace omnihil {

// RoboCup ULaval: USB CDC stick with an nRF24 behind it; COBS frames, one at a time over the air.
// Uses the tables of the registered format "ulaval-hermes".
std::unique_ptr<RadioLink> make_hermes_dongle(const RadioLinkConfig& config);

// RoboTeam Twente: USB base station with SX1280 radios; raw packets, 60 Hz polling of 16 robots.
// `format` selects v8 or v5 and must outlive the link.
std::unique_ptr<RadioLink> make_rem_dongle(const RadioFormat& format, const RadioLinkConfig& config);

}  // namespace omnihil

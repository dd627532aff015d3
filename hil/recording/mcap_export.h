// A recording as an MCAP file, which Foxglove and PlotJuggler open: every sample and every packet as JSON messages.
//
//   const std::string bytes = mcap_of(recording, format, packet_to_json);
//
// Topics: /robotN (the sample columns), /host/MESSAGE and /dongle/MESSAGE (fields by the team's names). Schemas are JSON
// schemas with the units in their descriptions. Chunks of a second, not compressed, with message and chunk indexes and
// statistics, so that a reader can seek. Times are Unix time by the recording's epoch.
// Source: MCAP specification, mcap.dev/spec (version 0). Cannot: attachments, checksums (all 0, which is "none").
#pragma once
#include <functional>
#include <string>

#include "hil/recording/recording.h"
#include "protocols/radio_format.h"

namespace omnihil {

using PacketToJson = std::function<std::string(const Values&)>;

std::string mcap_of(const Recording& recording, const RadioFormat& format, const PacketToJson& to_json);

}  // namespace omnihil

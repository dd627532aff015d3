// Opens a wire by its URL, whatever kind it is. The one door to hil/wire/kinds.
//
//   const WireUrl url = read_wire_url("./dongle", "pty");
//   for (const std::string& problem : wire_problems(url, WireForm::kBytes)) …      // of the words alone
//   WireProblem problem;
//   std::unique_ptr<ByteWire> wire = open_byte_wire(url, {{"listen", "1"}}, problem);
//
// The last list holds what this use of a wire takes where the URL says nothing; names that the kind does not
// have are passed over.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "hil/wire/wire_kind.h"

namespace omnihil {

enum class WireForm { kBytes, kFrames, kEither };

std::vector<std::string> wire_problems(const WireUrl& url, WireForm form);
std::unique_ptr<ByteWire> open_byte_wire(const WireUrl& url, const WireQuery& usual, WireProblem& problem);
std::unique_ptr<FrameWire> open_frame_wire(const WireUrl& url, const WireQuery& usual, WireProblem& problem);

// "pty:PATH, serial:DEVICE"
std::string known_wires(WireForm form);

}  // namespace omnihil

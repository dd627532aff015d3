// A wire for bytes by its URL, as an option gave it: opened, or every problem thrown with the option's name.
//
//   std::unique_ptr<ByteWire> dongle = open_end("/dev/ttyACM0", "serial", "DEVICE");
#pragma once
#include <memory>
#include <string>

#include "hil/wire/byte_wire.h"

namespace omnihil {

// `bare`: the kind of a path without one. std::invalid_argument: not understood; std::system_error: cannot be opened.
std::unique_ptr<ByteWire> open_end(const std::string& text, const char* bare, const char* option);

}  // namespace omnihil

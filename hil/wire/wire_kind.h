// A kind of wire: its scheme, what it is, its parameters and how it is opened. One kind, one file in kinds/; the
// list is generated from that folder.
//
//   const WireKind& wire_loop() {
//     static constexpr WireKind kKind{.scheme = "loop", .says = "…", .address = "name", .example = "loop:a",
//                                     .open_bytes = [](const WireUrl& url, WireProblem& problem) -> std::unique_ptr<ByteWire> { … }};
//     return kKind;
//   }
//
// A kind opens bytes or frames. What it is given is checked: the scheme and an address are there, every
// parameter has an allowed value.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <system_error>

#include "firmware_iface/motor_bus/frame_wire.h"
#include "hil/wire/byte_wire.h"
#include "hil/wire/wire_url.h"

namespace omnihil {

// Why a wire could not be opened: what, and the system's reason where it is one of the system.
struct WireProblem {
  std::string what;
  std::error_code code;
  std::string text() const { return code ? what + ": " + code.message() : what; }
};

struct WireParameter {
  std::string_view name, says, usual;         // "baud", "baud rate", "115200"
  std::int64_t low = 0, high = 0;             // of a number
  std::span<const std::string_view> words{};  // what is allowed in its place; empty: a number

  bool allows(std::string_view value) const;
  std::string allowed() const;  // "9600 to 12000000", "none, even"
};

struct WireKind {
  std::string_view scheme, says;
  std::string_view address, example;  // what the address is: "device"; "serial:/dev/ttyACM0"
  std::span<const WireParameter> parameters{};
  std::unique_ptr<ByteWire> (*open_bytes)(const WireUrl&, WireProblem&) = nullptr;
  std::unique_ptr<FrameWire> (*open_frames)(const WireUrl&, WireProblem&) = nullptr;
};

std::span<const WireKind* const> wire_kinds();
const WireKind* find_wire_kind(std::string_view scheme);

// 0 or 1.
inline constexpr std::string_view kWireNoYes[] = {"0", "1"};

}  // namespace omnihil

// The name of a wire: scheme:address?parameter=value&parameter=value. Pure text.
//
//   WireUrl url = read_wire_url("serial:/dev/ttyACM0?baud=9600");   // {"serial", "/dev/ttyACM0", {{"baud", "9600"}}}
//   WireUrl path = read_wire_url("./dongle", "pty");   // a bare path: {"pty", "./dongle", {}}
//
// A text with '/' before its first ':', or without ':', is a path, whatever stands in it. Spellings from
// before there was one way of naming wires:
//
//   serial:DEVICE,BAUD          serial:DEVICE?baud=BAUD
//   canfd:INTERFACE             can:INTERFACE?fd=1
//   uart:PATH                   pty:PATH{motor}                       (motor buses)
//   serial:A,B,C,D              serial:A, serial:B, serial:C, serial:D  (motor buses)
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace omnihil {

using WireQuery = std::vector<std::pair<std::string, std::string>>;

struct WireUrl {
  std::string scheme;  // empty: it has none
  std::string address;
  WireQuery query;

  std::string text() const;
  const std::string* find(std::string_view parameter) const;  // nullptr: not given
  // Of a parameter that is there and was checked (hil/wire/open_wire.h).
  const std::string& word(std::string_view parameter) const { return *find(parameter); }
  int number(std::string_view parameter) const;
};

// Whether a text that may be a file's name, too, is meant as a wire: a word and ':' before any '/'.
bool looks_like_wire(std::string_view text);
WireUrl read_wire_url(const std::string& text, std::string_view scheme_of_bare_path = {});

// The wires of a motor bus with a line per motor: "{motor}" is filled with 0, 1, ... Empty: there is neither
// "{motor}" nor a list.
std::vector<WireUrl> read_motor_wires(const std::string& text, int motors);

// "{id}" in `text` by a number.
std::string with_number(std::string text, std::string_view place, std::uint32_t number);

}  // namespace omnihil

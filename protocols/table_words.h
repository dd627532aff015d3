// The words that stand for the enumerations of a packet table, in files: emit/toml.cc writes them, hil/radio_file reads them.
//
//   const std::string_view word = kKindWords[0];   // "integer", by the number of the enumeration's value
#pragma once
#include <string_view>

namespace omnihil {

inline constexpr std::string_view kRadioFileFormat = "omnihil-radio/1";

// In the order of the enumerations.
inline constexpr std::string_view kKindWords[] = {"integer", "constant", "type",     "length",  "float32",
                                                  "ranged",  "scaled",   "reserved", "checksum"};
inline constexpr std::string_view kSignWords[] = {"none", "twos-complement", "magnitude"};
inline constexpr std::string_view kCauseWords[] = {"constant", "version", "address"};
inline constexpr std::string_view kBitOrderWords[] = {"msb first", "lsb first"};
inline constexpr std::string_view kDirectionWords[] = {"to robot",  "from robot",  "both",
                                                       "to dongle", "from dongle", "inside"};
inline constexpr std::string_view kFieldRoleWords[] = {"none",        "robot",      "robot bits", "team",
                                                       "team yellow", "all robots", "for dongle", "for host"};
inline constexpr std::string_view kMessageRoleWords[] = {
    "none",           "header only", "filler",           "command",
    "single command", "kill",        "set gains",        "get gains",
    "gains",          "announce",    "acknowledge",      "feedback",
    "state info",     "text",        "configure dongle", "ask dongle"};
inline constexpr std::string_view kCarrierWords[] = {"usb", "uart", "udp", "spi", "can"};
inline constexpr std::string_view kFramingWords[] = {"none", "cobs", "list", "protobuf"};
// By OMNIHIL_MODE_*.
inline constexpr std::string_view kAsksWords[] = {"coast", "body velocity", "wheel speed", "wheel duty"};
inline constexpr std::string_view kFrameWords[] = {"robot", "field"};

}  // namespace omnihil

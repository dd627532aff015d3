// What is generated from the tables of a format, as text: documentation, a C header, a Wireshark dissector, a file.
//
//   std::cout << emit_markdown(*find_radio_format("ulaval-hermes"));
#pragma once
#include <string>

#include "protocols/radio_format.h"

namespace omnihil {

// A page for people: carrier, notes, and per packet a picture of its bytes and a table of its fields.
std::string emit_markdown(const RadioFormat& format);

// Macros alone, for firmware in plain C. With P = the id in capitals, '_' for every other character:
//   P_MESSAGE_TYPE, P_MESSAGE_BYTES (fields only, without framing),
//   P_MESSAGE_FIELD_BIT, P_MESSAGE_FIELD_BITS, and P_MESSAGE_FIELD_CONST of a constant field;
//   P_MESSAGE_FIELD_SIGNED of two's complement, …_SIGN_BIT of a sign bit and magnitude; of a scaled field
//   …_PER_COUNT and …_AT_0: number = AT_0 + PER_COUNT * integer.
// "cmd[2]" becomes CMD_2. Bit 0 is the lowest bit of byte 0 where P_MESSAGE_LSB_FIRST is 1, else the highest.
std::string emit_c_header(const RadioFormat& format);

// A dissector in Lua: registers the format as a protocol to be chosen with "Decode As" on UDP and USER DLTs.
std::string emit_wireshark(const RadioFormat& format);

// The messages of a CAN format as a DBC file, those of nodes 0 to 3 where the id holds a node. Only of Carrier::Kind::kCan.
std::string emit_dbc(const RadioFormat& format);

// The tables as a file that `--format` takes (hil/radio_file). Only where no_toml_reason is empty.
std::string emit_toml(const RadioFormat& format);
// What tables alone cannot say of this format; empty: they say all of it.
std::string no_toml_reason(const RadioFormat& format);

// "cmd[2]" -> "CMD_2": capitals and digits, one '_' for every run of other characters, none at the end.
std::string c_macro_name(std::string_view name);

}  // namespace omnihil

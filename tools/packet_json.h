// Packets as JSON objects with the team's own field names: the bridge of `encode` and `decode`.
//
//   {"robot": 3, "vx": 1.0, "cmd": [0, 0, 0, 0], "charge": true}
//
// Elements "cmd[0]", "cmd[1]", … of a table are one JSON array "cmd"; fields of unit "bool" are true and
// false; the text of a message with a text tail is "text", one character per byte (Latin-1). Fields left out
// are 0; type, constants, length and checksum need not be given.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "protocols/field_table.h"

namespace omnihil {

struct PacketFromJson {
  Values values;
  std::string text;                   // where values.text points
  std::vector<std::string> problems;  // empty: values may be encoded
};

// Fills `out` from a JSON object and reports every problem: field, value, what is allowed, nearest spelling.
void packet_from_json(const nlohmann::json& object, const Message& message, PacketFromJson& out);

// {"packet":"SPEED_MOVE","fields":{…}} on one line. Floats have the fewest digits that give the same float32.
std::string packet_to_json(const Values& values);

// "0 to 30 m/s", "a whole number, 0 to 255", …
std::string allowed_text(const Field& field, const Message& message);

}  // namespace omnihil

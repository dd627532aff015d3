// Hex, JSON and golden packets for the tests of the radio formats.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "protocols/radio_format.h"

namespace omnihil {

using Bytes = std::vector<std::uint8_t>;

inline Bytes from_hex(const std::string& hex) {
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

inline std::string to_hex(const Bytes& bytes) {
  std::string hex;
  for (std::uint8_t byte : bytes) {
    hex += "0123456789abcdef"[byte >> 4];
    hex += "0123456789abcdef"[byte & 15];
  }
  return hex;
}

inline void set_from_json(Values& values, const std::string& field, const nlohmann::json& given) {
  const int index = values.message->field_index(field);
  ASSERT_GE(index, 0) << values.message->name << " has no field " << field;
  Value& value = values.fields[static_cast<std::size_t>(index)];
  if (given.is_null()) {
    value = {.number = std::numeric_limits<double>::quiet_NaN(), .raw = 0};
    return;
  }
  value.number = given.is_boolean() ? (given.get<bool>() ? 1.0 : 0.0) : given.get<double>();
  // Integers above 2^53 do not fit a double.
  value.raw = given.is_number_unsigned() ? given.get<std::uint64_t>() : 0;
}

// `given` is the value of the field `path`, or an array or object of fields below it.
inline void set_all_from_json(Values& values, const std::string& path, const nlohmann::json& given) {
  if (given.is_array()) {
    for (std::size_t i = 0; i < given.size(); ++i) {
      set_all_from_json(values, path + "[" + std::to_string(i) + "]", given[i]);
    }
  } else if (given.is_object()) {
    for (const auto& [key, value] : given.items()) {
      set_all_from_json(values, path.empty() ? key : path + "." + key, value);
    }
  } else {
    set_from_json(values, path, given);
  }
}

// Values of `message` from the team's own names. `text` must outlive the result.
inline Values values_from_json(const Message& message, nlohmann::json given, std::string& text) {
  Values values;
  values.message = &message;
  if (message.text_tail && given.contains("text")) {
    text = given.at("text").get<std::string>();
    values.text = text;
    given.erase("text");
  }
  set_all_from_json(values, "", given);
  return values;
}

struct GoldenPacket {
  const RadioFormat* format = nullptr;
  const Message* message = nullptr;
  nlohmann::json given;
  Bytes frame;
};

// Every packet type of every format; the bytes come from the team's own encoder, or from a second implementation,
// written in another language from the formats' descriptions.
inline std::vector<GoldenPacket> golden_packets() {
  std::vector<GoldenPacket> packets;
  std::ifstream file(OMNIHIL_SOURCE_DIR "/tests/protocols/golden/packets.jsonl");
  for (std::string line; std::getline(file, line);) {
    const nlohmann::json row = nlohmann::json::parse(line);
    GoldenPacket packet;
    packet.format = find_radio_format(row.at("format").get<std::string>());
    packet.message = packet.format->find(row.at("packet").get<std::string>());
    packet.given = row.at("in");
    packet.frame = from_hex(row.at("hex").get<std::string>());
    packets.push_back(packet);
  }
  return packets;
}

// The folder of reference data, "" when there is none.
inline std::string shared_folder() {
  const char* path = std::getenv("OMNIHIL_SHARED");
  if (path == nullptr || !std::ifstream(std::string(path) + "/vectors/README.md")) return "";
  return path;
}

inline nlohmann::json read_json(const std::string& path) {
  std::ifstream file(path);
  return nlohmann::json::parse(file);
}

// decode(encode(decode(frame))) is decode(frame), and the bytes come back; refused frames name a cause.
// True when the frame was accepted.
inline bool survives_round_trip(const RadioFormat& format, const Bytes& frame) {
  const DecodeResult first = format.decode(frame);
  if (first.error != PacketError::kNone) {
    EXPECT_NE(to_string(first.error), "?");
    return false;
  }
  Bytes again;
  const auto encoded = format.encode(first.values, again);
  EXPECT_EQ(encoded.error, PacketError::kNone) << to_hex(frame) << " field " << encoded.field;
  EXPECT_EQ(to_hex(again), to_hex(frame));
  const DecodeResult second = format.decode(again);
  EXPECT_EQ(second.error, PacketError::kNone);
  EXPECT_EQ(second.values.message, first.values.message);
  EXPECT_EQ(second.values.text, first.values.text);
  for (std::size_t i = 0; i < first.values.message->fields.size(); ++i) {
    EXPECT_EQ(second.values.fields[i].raw, first.values.fields[i].raw);
    const double number = first.values.fields[i].number;  // NaN where its flag says that it says nothing
    EXPECT_EQ(std::isnan(second.values.fields[i].number), std::isnan(number));
    if (!std::isnan(number)) {
      EXPECT_EQ(second.values.fields[i].number, number);
    }
  }
  return true;
}

}  // namespace omnihil

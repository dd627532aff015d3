// One [[packet]] of a radio format's file, and its fields.
//
//   PacketReader reader(keys, tables);
//   for (const toml::table& packet : packets) reader.read(packet);    // tables.messages, problems of the keys
#pragma once
#include <optional>

#include "hil/radio_file/radio_tables.h"
#include "hil/text/toml_keys.h"

namespace omnihil {

std::optional<std::int64_t> whole_number(TomlKeys& keys, const toml::table& table, const std::string& path,
                                         std::string_view key, std::int64_t lo, std::int64_t hi);

class PacketReader {
 public:
  PacketReader(TomlKeys& keys, RadioTables& out) : keys_(keys), out_(out) {}
  void read(const toml::table& packet);

 private:
  void fields(const toml::table& packet, const std::string& path, Message& message);
  Field field(const toml::table& row, const std::string& path, const Message& message);
  void number(const toml::table& row, const std::string& path, const Message& message, Field& field);
  void by_kind(const toml::table& row, const std::string& path, Field& field);
  void limits(const toml::table& row, const std::string& path, bool needed, Field& field);
  void sum(const toml::table& row, const std::string& path, Field& field);
  void robot_side(const toml::table& row, const std::string& path, Field& field);

  TomlKeys& keys_;
  RadioTables& out_;
};

}  // namespace omnihil

// rosbag2's SQLite storage (.db3): tables `topics` and `messages`; from ROS 2 Iron on `message_definitions` as well. Source:
// rosbag2_storage_sqlite3 of ros2/rosbag2.
#include <fmt/format.h>
#include <sqlite3.h>

#include <map>
#include <memory>

#include "hil/logs/bag_topics.h"
#include "hil/logs/log_formats.h"

namespace omnihil {
namespace {

using Database = std::unique_ptr<sqlite3, int (*)(sqlite3*)>;
using Statement = std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)>;

Statement prepared(const Database& database, const char* sql, const std::string& path) {
  sqlite3_stmt* made = nullptr;
  if (sqlite3_prepare_v2(database.get(), sql, -1, &made, nullptr) != SQLITE_OK)
    throw BadLog(fmt::format("{}: is no bag of rosbag2: {}; allowed: tables topics and messages", path,
                             sqlite3_errmsg(database.get())));
  return {made, sqlite3_finalize};
}

// A text or bytes of the row that the statement stands at.
std::string_view cell(const Statement& s, int column) {
  const void* bytes = sqlite3_column_blob(s.get(), column);
  const int size = sqlite3_column_bytes(s.get(), column);
  return bytes == nullptr ? std::string_view{}
                          : std::string_view(static_cast<const char*>(bytes), static_cast<std::size_t>(size));
}

bool next_row(const Statement& s, const Database& database, const std::string& path) {
  const int code = sqlite3_step(s.get());
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  throw BadLog(fmt::format("{}: cannot be read on: {}", path, sqlite3_errmsg(database.get())));
}

std::map<std::string, std::string, std::less<>> definitions_of(const Database& database,
                                                               const std::string& path) {
  std::map<std::string, std::string, std::less<>> out;
  const Statement has =
      prepared(database, "SELECT 1 FROM sqlite_master WHERE name = 'message_definitions'", path);
  if (!next_row(has, database, path)) return out;
  const Statement rows = prepared(
      database, "SELECT topic_type, encoding, encoded_message_definition FROM message_definitions", path);
  while (next_row(rows, database, path)) {
    if (cell(rows, 1) == "ros2msg") out[std::string(cell(rows, 0))] = cell(rows, 2);
  }
  return out;
}

}  // namespace

LogTable read_rosbag_sqlite(const std::string& path) {
  sqlite3* made = nullptr;
  const int code = sqlite3_open_v2(path.c_str(), &made, SQLITE_OPEN_READONLY, nullptr);
  const Database database(made, sqlite3_close);
  if (code != SQLITE_OK)
    throw BadLog(
        fmt::format("{}: cannot be opened: {}", path, made != nullptr ? sqlite3_errmsg(made) : "no memory"));
  const auto definitions = definitions_of(database, path);
  BagTopics bag(path);
  const Statement topics =
      prepared(database, "SELECT id, name, serialization_format, type FROM topics", path);
  while (next_row(topics, database, path)) {
    const auto definition = definitions.find(cell(topics, 3));
    bag.define(static_cast<std::uint64_t>(sqlite3_column_int64(topics.get(), 0)),
               std::string(cell(topics, 1)), std::string(cell(topics, 2)), std::string(cell(topics, 3)),
               definition == definitions.end() ? std::string_view{} : definition->second);
  }
  const Statement messages =
      prepared(database, "SELECT topic_id, timestamp, data FROM messages ORDER BY timestamp, id", path);
  while (next_row(messages, database, path))
    bag.add(static_cast<std::uint64_t>(sqlite3_column_int64(messages.get(), 0)),
            sqlite3_column_int64(messages.get(), 1), cell(messages, 2));
  return bag.table(LogFormat::kRosbag);
}

}  // namespace omnihil

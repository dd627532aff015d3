// The binary formats that can be read: how each begins, and its reader.
//
//   for (const BinaryLog& format : binary_logs())
//     if (format.begins(head)) const LogTable log = format.read("run.ulg");      // throws BadLog
//
// What of a file is not numbers (strings, pictures, other encodings) is left out and counted in the notes.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "hil/logs/log_table.h"

namespace omnihil {

struct BinaryLog {
  bool (*begins)(std::string_view head);
  LogTable (*read)(const std::string& path);
};
std::span<const BinaryLog> binary_logs();

LogTable read_mat_log(const std::string& path);
LogTable read_wpilog(const std::string& path);
LogTable read_ulog(const std::string& path);
LogTable read_mcap_log(const std::string& path);
LogTable read_rosbag_sqlite(const std::string& path);

}  // namespace omnihil

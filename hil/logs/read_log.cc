#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "hil/logs/csv_log.h"
#include "hil/logs/log_formats.h"
#include "hil/logs/log_table.h"
#include "hil/text/text_file.h"

namespace omnihil {
namespace {

constexpr std::size_t kHead = 16'384;  // enough for the header of a wide table and rows below it

std::string head_of(const std::string& path) {
  if (!std::filesystem::is_regular_file(path)) return "";
  std::ifstream file(path, std::ios::binary);
  std::string head(kHead, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return head;
}

const BinaryLog* binary_of(std::string_view head) {
  for (const BinaryLog& format : binary_logs()) {
    if (format.begins(head)) return &format;
  }
  return nullptr;
}

}  // namespace

std::string log_format_name(LogFormat format) {
  switch (format) {
    case LogFormat::kCsv:
      return "CSV";
    case LogFormat::kOdrive:
      return "ODrive CSV";
    case LogFormat::kMoteus:
      return "moteus CSV";
    case LogFormat::kVesc:
      return "VESC Tool CSV";
    case LogFormat::kSimpleFoc:
      return "SimpleFOC monitor";
    case LogFormat::kMat:
      return "MATLAB";
    case LogFormat::kWpilog:
      return "wpilog";
    case LogFormat::kUlog:
      return "ULog";
    case LogFormat::kMcap:
      return "MCAP";
    case LogFormat::kRosbag:
      return "rosbag2 (SQLite)";
  }
  return "";
}

bool looks_like_log(const std::string& path) {
  const std::string head = head_of(path);
  if (binary_of(head) != nullptr) return true;
  // The lines of a radio log have a sign between time and bytes.
  const std::string_view first = std::string_view(head).substr(0, head.find('\n'));
  if (first.find(" > ") != std::string_view::npos || first.find(" < ") != std::string_view::npos)
    return false;
  return looks_like_table(head);
}

LogTable read_log(const std::string& path, const LogOptions& options) {
  const std::string head = head_of(path);
  if (const BinaryLog* format = binary_of(head)) return format->read(path);
  std::string error;
  const std::string text = read_text_file(path, error);
  if (!error.empty()) throw std::system_error(std::make_error_code(std::errc::io_error), path + ": " + error);
  if (text.find('\0') != std::string::npos)
    throw BadLog(path +
                 ": is no text and none of the known formats; allowed: CSV, MATLAB .mat, wpilog, ULog, MCAP, "
                 "rosbag2 (SQLite)");
  return parse_csv_log(text, path, options);
}

}  // namespace omnihil

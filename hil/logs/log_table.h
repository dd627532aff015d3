// A log of another tool, read: named series of numbers with their times, before anybody says what they mean.
//
//   LogTable log = read_log("run.ulg", {});                  // throws BadLog with file, place, what is allowed
//   for (const LogSeries& s : log.series) std::puts(s.name.c_str());
//
// Series of a table share its rows and have no clock of their own: one of them is the time. Series of topics (wpilog,
// ULog, bags) each have their own. A missing value is NaN. Nothing is converted here: values are as logged.
#pragma once
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace omnihil {

class BadLog : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

struct LogSeries {
  std::string name;           // "axis0.vel_estimate", "/joint_states.velocity[0]"
  std::string unit;           // as the file says it; empty: it does not
  std::vector<double> value;  // NaN: missing
  std::shared_ptr<const std::vector<double>>
      time_s;  // of each value, seconds from the log's own zero; null: by rows
};

enum class LogFormat : std::uint8_t {
  kCsv,
  kOdrive,
  kMoteus,
  kVesc,
  kSimpleFoc,
  kMat,
  kWpilog,
  kUlog,
  kMcap,
  kRosbag
};
std::string log_format_name(LogFormat format);  // "ODrive CSV"

struct LogTable {
  LogFormat format = LogFormat::kCsv;
  std::vector<LogSeries> series;
  std::vector<std::string> notes;  // what was left out or taken for granted, counted
  bool by_rows() const { return !series.empty() && series.front().time_s == nullptr; }
};

struct LogOptions {
  std::vector<std::string> columns;  // names of a table without a header line; empty: as the format has them
};

// Which format it is, is told by how the file begins (and by the names of a table's columns), not by its name.
LogTable read_log(const std::string& path, const LogOptions& options);

// A table of numbers that is no capture, by its first lines; or one of the binary formats.
bool looks_like_log(const std::string& path);

}  // namespace omnihil

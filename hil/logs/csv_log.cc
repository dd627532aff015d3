#include "hil/logs/csv_log.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "hil/logs/units.h"

namespace omnihil {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

// Of SimpleFOC's motor.monitor(): the order in which the library prints what monitor_variables asks for, by default
// target, voltage q, velocity, angle. Currents are printed in milliamperes (SimpleFOClibrary 2.x, FOCMotor.cpp;
// docs.simplefoc.com/monitoring).
constexpr std::array<std::string_view, 7> kMonitorAll = {
    "target",         "voltage.q [V]",    "voltage.d [V]", "current.q [mA]",
    "current.d [mA]", "velocity [rad/s]", "angle [rad]"};
constexpr std::array<std::string_view, 4> kMonitorUsual = {"target", "voltage.q [V]", "velocity [rad/s]",
                                                           "angle [rad]"};

std::string_view trimmed_cell(std::string_view cell) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!cell.empty() && blank(cell.front())) cell.remove_prefix(1);
  while (!cell.empty() && blank(cell.back())) cell.remove_suffix(1);
  if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') cell = cell.substr(1, cell.size() - 2);
  return cell;
}

std::vector<std::string_view> cells_of(std::string_view line, char separator) {
  std::vector<std::string_view> out;
  if (separator == ' ') {
    std::size_t at = 0;
    while ((at = line.find_first_not_of(" \t\r", at)) != std::string_view::npos) {
      const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
      out.push_back(line.substr(at, end - at));
      at = end;
    }
    return out;
  }
  bool quoted = false;
  std::size_t from = 0;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i < line.size() && (quoted || line[i] != separator)) continue;
    out.push_back(trimmed_cell(line.substr(from, i - from)));
    from = i + 1;
  }
  return out;
}

// A number, a truth, or an empty cell; none: a word.
std::optional<double> number_of(std::string_view cell, bool decimal_comma) {
  if (cell.empty() || cell == "nan" || cell == "NaN" || cell == "null" || cell == "None") return kMissing;
  if (cell == "true" || cell == "True") return 1.0;
  if (cell == "false" || cell == "False") return 0.0;
  std::string text(cell);
  if (decimal_comma) std::replace(text.begin(), text.end(), ',', '.');
  const char* begin = text.data() + (text.front() == '+' ? 1 : 0);
  double value = 0.0;
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return std::isfinite(value) ? value : kMissing;
}

bool is_remark(std::string_view line) {
  return line.starts_with("#") || line.starts_with("//") || line.starts_with("MOT:") || line.starts_with("%");
}

// "1,2,3;" as MATLAB ends its rows: behind a table of commas the semicolon separates nothing.
std::string_view without_row_end(std::string_view line) {
  const bool only = line.ends_with(';') && line.find(';') + 1 == line.size();
  if (only && line.find(',') != std::string_view::npos) line.remove_suffix(1);
  return line;
}

// Lines with their numbers, remarks and empty ones left out.
struct Line {
  std::size_t number;
  std::string_view text;
};
std::vector<Line> lines_of(std::string_view text, std::size_t& remarks) {
  std::vector<Line> out;
  std::size_t number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++number;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (line.find_first_not_of(" \t;,") == std::string_view::npos) continue;
    line = without_row_end(line);
    if (is_remark(line)) {
      ++remarks;
    } else {
      out.push_back({number, line});
    }
  }
  return out;
}

char separator_of(const std::vector<Line>& lines) {
  for (const char c : {';', '\t', ','}) {
    const std::string_view first = lines.front().text,
                           last = lines[std::min<std::size_t>(lines.size() - 1, 3)].text;
    if (first.find(c) != std::string_view::npos && last.find(c) != std::string_view::npos) return c;
  }
  return ' ';
}

bool all_numbers(const std::vector<std::string_view>& cells, bool decimal_comma) {
  return std::all_of(cells.begin(), cells.end(),
                     [&](std::string_view c) { return number_of(c, decimal_comma).has_value(); });
}

std::vector<std::string> names_without_header(std::size_t count, const std::string& name,
                                              const LogOptions& options, LogTable& log) {
  if (!options.columns.empty()) {
    if (options.columns.size() == count) return options.columns;
    throw BadLog(fmt::format("{}: --columns has {} names, the table {} columns; allowed: one name a column",
                             name, options.columns.size(), count));
  }
  if (count == kMonitorAll.size() || count == kMonitorUsual.size()) {
    log.format = LogFormat::kSimpleFoc;
    log.notes.push_back(fmt::format(
        "{}: no header line and {} columns: taken for SimpleFOC's monitor (--columns says otherwise)", name,
        count));
    if (count == kMonitorAll.size()) return {kMonitorAll.begin(), kMonitorAll.end()};
    return {kMonitorUsual.begin(), kMonitorUsual.end()};
  }
  throw BadLog(
      fmt::format("{}: has no header line; allowed: --columns with {} names, such as --columns t_s,duty,rpm",
                  name, count));
}

LogFormat table_format(const std::vector<std::string>& names) {
  const auto has = [&](std::string_view part) {
    return std::any_of(names.begin(), names.end(),
                       [&](const std::string& n) { return n.find(part) != std::string::npos; });
  };
  if (has("ms_today") && has("erpm")) return LogFormat::kVesc;
  if (has("vel_estimate") || has("pos_estimate") || has("Iq_measured")) return LogFormat::kOdrive;
  if (has("servo_stats.") || (has("Q_CURRENT") && has("VELOCITY"))) return LogFormat::kMoteus;
  return LogFormat::kCsv;
}

void drop_wordy_columns(LogTable& log, const std::vector<std::size_t>& words, const std::string& name) {
  std::vector<LogSeries> kept;
  std::vector<std::string> dropped;
  for (std::size_t i = 0; i < log.series.size(); ++i) {
    const bool any = std::any_of(log.series[i].value.begin(), log.series[i].value.end(),
                                 [](double v) { return std::isfinite(v); });
    if (any) {
      if (words[i] > 0)
        log.notes.push_back(fmt::format("{}: {}: {} cells are no numbers: taken as missing", name,
                                        log.series[i].name, words[i]));
      kept.push_back(std::move(log.series[i]));
    } else {
      dropped.push_back(log.series[i].name);
    }
  }
  if (!dropped.empty())
    log.notes.push_back(
        fmt::format("{}: columns without a number left out: {}", name, fmt::join(dropped, ", ")));
  log.series = std::move(kept);
}

// Lines below the header that have no number either (units, short names) belong to it. The one whose cells are units
// for the most part says the columns' units. Lines of other widths are the table's faults, and are left to it.
void read_further_heads(std::vector<Line>& lines, char separator, bool decimal_comma, const std::string& name,
                        LogTable& log) {
  std::size_t heads = 0;
  for (; heads < lines.size(); ++heads) {
    std::vector<std::string_view> cells = cells_of(lines[heads].text, separator);
    if (cells.size() == log.series.size() + 1 && cells.back().empty()) cells.pop_back();
    const auto filled =
        cells.size() - static_cast<std::size_t>(std::ranges::count(cells, std::string_view{}));
    const auto is_number = [&](std::string_view c) { return !c.empty() && number_of(c, decimal_comma); };
    if (cells.size() != log.series.size() || filled == 0 || std::ranges::any_of(cells, is_number)) break;
    if (2 * static_cast<std::size_t>(std::ranges::count_if(cells, is_unit)) < filled) continue;
    for (std::size_t i = 0; i < cells.size(); ++i) log.series[i].unit = is_unit(cells[i]) ? cells[i] : "";
  }
  if (heads > 0)
    log.notes.push_back(fmt::format("{}: {} below the header {} no number: part of it", name,
                                    heads > 1 ? fmt::format("{} lines", heads) : "a line",
                                    heads > 1 ? "have" : "has"));
  lines.erase(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(heads));
}

}  // namespace

bool looks_like_table(std::string_view head) {
  if (head.find('\0') != std::string_view::npos) return false;
  std::size_t remarks = 0;
  std::vector<Line> lines = lines_of(head, remarks);
  if (lines.size() < 2) return false;
  if (lines.size() > 2) lines.pop_back();  // may be cut
  const char separator = separator_of(lines);
  const std::vector<std::string_view> row = cells_of(lines.back().text, separator);
  const bool comma = separator == ';';
  return row.size() >= 2 &&
         std::count_if(row.begin(), row.end(),
                       [&](std::string_view c) { return number_of(c, comma).has_value(); }) >= 2 &&
         cells_of(lines.front().text, separator).size() == row.size();
}

LogTable parse_csv_log(std::string_view text, const std::string& name, const LogOptions& options) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  LogTable log;
  std::size_t remarks = 0;
  std::vector<Line> lines = lines_of(text, remarks);
  if (lines.size() < 2)
    throw BadLog(
        fmt::format("{}: has {} lines; allowed: a header line and rows of numbers", name, lines.size()));
  const char separator = separator_of(lines);
  // With semicolons a comma can only be a decimal mark.
  const bool decimal_comma = separator == ';';
  std::vector<std::string_view> head = cells_of(lines.front().text, separator);
  const bool headless = all_numbers(head, decimal_comma);
  if (!headless && !head.empty() && head.back().empty()) head.pop_back();  // "a;b;" has two columns
  std::vector<std::string> names = headless ? names_without_header(head.size(), name, options, log)
                                            : std::vector<std::string>(head.begin(), head.end());
  if (!headless) {
    log.format = table_format(names);
    lines.erase(lines.begin());
  }
  for (const std::string& column : names) {
    if (std::count(names.begin(), names.end(), column) > 1)
      throw BadLog(fmt::format("{}:1: column \"{}\" stands twice; allowed: each name once", name, column));
    LogSeries& series = log.series.emplace_back();
    series.name = column;
    series.value.reserve(lines.size());
  }
  if (!headless) read_further_heads(lines, separator, decimal_comma, name, log);
  std::vector<std::size_t> words(names.size());
  for (std::size_t l = 0; l < lines.size(); ++l) {
    std::vector<std::string_view> row = cells_of(lines[l].text, separator);
    if (row.size() == names.size() + 1 && row.back().empty()) row.pop_back();
    if (row.size() != names.size()) {
      // A logger that was switched off leaves half a line.
      if (l + 1 == lines.size() && row.size() < names.size()) {
        log.notes.push_back(fmt::format("{}:{}: the last line is cut: left out", name, lines[l].number));
        break;
      }
      throw BadLog(fmt::format("{}:{}: {} cells; allowed: {}, as the header has", name, lines[l].number,
                               row.size(), names.size()));
    }
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::optional<double> value = number_of(row[i], decimal_comma);
      words[i] += !value;
      log.series[i].value.push_back(value.value_or(kMissing));
    }
  }
  if (remarks > 0) log.notes.push_back(fmt::format("{}: {} lines of remarks left out", name, remarks));
  drop_wordy_columns(log, words, name);
  if (log.series.empty() || log.series.front().value.empty())
    throw BadLog(name + ": has no numbers; allowed: a header line and rows of numbers");
  return log;
}

}  // namespace omnihil

#include "hil/text/csv_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "hil/text/recording_text.h"
#include "hil/text/text_file.h"

namespace omnihil {
namespace {

constexpr std::size_t kNoColumn = std::numeric_limits<std::size_t>::max();
constexpr std::size_t kProblemsShown = 10;  // per file; the rest is counted
constexpr double kLargest = 1e15;           // no sensor counts further: 2^50

ModelProblem of_file(const std::string& file, std::string what) {
  ModelProblem problem;
  problem.file = file;
  problem.what = std::move(what);
  return problem;
}

std::string_view trimmed(std::string_view cell) {
  while (!cell.empty() && (cell.front() == ' ' || cell.front() == '\t')) cell.remove_prefix(1);
  while (!cell.empty() && (cell.back() == ' ' || cell.back() == '\t' || cell.back() == '\r')) {
    cell.remove_suffix(1);
  }
  return cell;
}

// Cuts the next cell off `rest`. False: there is none.
bool next_cell(std::string_view& rest, bool& at_end, std::string_view& cell) {
  if (at_end) return false;
  std::size_t comma = 0;
  const std::size_t first = rest.find_first_not_of(" \t");
  if (first != std::string_view::npos && rest[first] == '"') {
    const std::size_t close = rest.find('"', first + 1);
    comma = close == std::string_view::npos ? std::string_view::npos : rest.find(',', close);
  } else {
    comma = rest.find(',');
  }
  cell = trimmed(rest.substr(0, comma));
  if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') cell = cell.substr(1, cell.size() - 2);
  at_end = comma == std::string_view::npos;
  if (!at_end) rest.remove_prefix(comma + 1);
  return true;
}

std::string no_number(std::string_view cell, double value, std::errc error) {
  if (error == std::errc() && !std::isfinite(value))
    return "is not finite; leave the cell empty where nothing was measured";
  if (error == std::errc::result_out_of_range || (error == std::errc() && std::abs(value) > kLargest))
    return fmt::format("is too large or too small for a number here; allowed: up to {:g}", kLargest);
  if (cell.find(';') != std::string_view::npos) return "is no number; cells are separated by commas";
  return "is no number; allowed: a number such as -1.5 or 2e-3, or an empty cell (not measured)";
}

class CsvReader {
 public:
  CsvReader(std::string_view text, const std::string& name, std::vector<ModelProblem>& problems)
      : text_(text), name_(name), problems_(problems), before_(problems.size()) {}

  CsvTable read(const std::vector<std::string>& wanted) {
    if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
    if (text_.starts_with("\xFF\xFE") || text_.starts_with("\xFE\xFF") ||
        text_.substr(0, 4096).find('\0') != std::string_view::npos) {
      say(1, 1, "", "", "is not plain text (UTF-8)", "save it as CSV, UTF-8");
      return std::move(table_);
    }
    read_header(wanted);
    if (problems_.size() == before_) read_rows(wanted.size());
    if (hidden_ > 0) {
      problems_.push_back(of_file(name_, fmt::format("{} more problems of this kind in the file", hidden_)));
    }
    table_.readable = problems_.size() == before_;
    return std::move(table_);
  }

 private:
  void say(std::size_t line, std::size_t column, std::string key, std::string_view value, std::string what,
           std::string allowed) {
    if (problems_.size() - before_ >= kProblemsShown) {
      ++hidden_;
      return;
    }
    problems_.push_back({.file = name_,
                         .line = static_cast<int>(line),
                         .column = static_cast<int>(column),
                         .key = std::move(key),
                         .value = value.empty() ? "" : in_quotes(value),
                         .what = std::move(what),
                         .allowed = std::move(allowed)});
  }

  bool next_line(std::string_view& line) {
    if (text_.empty()) return false;
    const std::size_t end = text_.find('\n');
    line = text_.substr(0, end);
    text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
    ++line_;
    return true;
  }

  void read_header(const std::vector<std::string>& wanted) {
    std::string_view line, cell;
    if (!next_line(line) || trimmed(line).empty()) {
      say(1, 1, "", "", "has no header line", "the first line names the columns");
      return;
    }
    std::string_view rest = line;
    for (bool at_end = false; next_cell(rest, at_end, cell);) table_.header.emplace_back(cell);
    at_.assign(table_.header.size(), kNoColumn);
    table_.columns.resize(wanted.size());
    for (std::size_t w = 0; w < wanted.size(); ++w) {
      const auto found = std::find(table_.header.begin(), table_.header.end(), wanted[w]);
      if (found == table_.header.end()) continue;
      if (std::find(found + 1, table_.header.end(), wanted[w]) != table_.header.end()) {
        say(1, 1, wanted[w], "", "two columns have this name", "each column that is used needs its own name");
      }
      at_[static_cast<std::size_t>(found - table_.header.begin())] = w;
      table_.columns[w].emplace();
    }
    if (table_.header.size() == 1 && line.find_first_of(";\t") != std::string_view::npos) {
      say(1, 1, "", "",
          line.find(';') != std::string_view::npos ? "is separated by semicolons" : "is separated by tabs",
          "commas between cells and a point as decimal mark are needed");
    }
    const auto missing = [](const auto& column) { return !column.has_value(); };
    if (table_.header.size() > 1 && std::all_of(table_.columns.begin(), table_.columns.end(), missing)) {
      say(1, 1, "", line.substr(0, 40), "the first line names none of the columns that the channels ask for",
          fmt::format("needed: {}", fmt::join(wanted, ", ")));
    }
    double number = 0.0;
    const auto is_number = [&](const std::string& name) { return parse_number(name, number); };
    if (!table_.header.empty() && std::all_of(table_.header.begin(), table_.header.end(), is_number)) {
      say(1, 1, "", line.substr(0, 40), "has numbers in place of a header line",
          "the first line names the columns");
    }
  }

  void read_rows(std::size_t wanted) {
    // A guess at the number of rows from the first one saves growing.
    const std::size_t rows = text_.size() / std::max<std::size_t>(1, text_.find('\n') + 1) + 1;
    for (auto& column : table_.columns) {
      if (column) column->reserve(rows);
    }
    row_.resize(wanted);
    std::size_t empty = 0;
    for (std::string_view line; next_line(line);) {
      if (line.empty() || line == "\r") {
        ++empty;
        continue;
      }
      table_.empty_lines += std::exchange(empty, 0);
      read_row(line);
    }
    if (table_.line.empty() && problems_.size() == before_)
      say(line_, 1, "", "", "has a header but no rows", "at least one row is needed");
  }

  void read_row(std::string_view line) {
    std::string_view rest = line, cell;
    std::size_t count = 0;
    for (bool at_end = false; next_cell(rest, at_end, cell); ++count) {
      if (count >= at_.size() || at_[count] == kNoColumn) continue;
      row_[at_[count]] = number(cell, static_cast<std::size_t>(cell.data() - line.data()) + 1, count);
    }
    if (count != at_.size()) {
      say(line_, 1, "", "", fmt::format("has {} cells, the header has {}", count, at_.size()),
          "every row needs one cell per column; an empty cell is allowed");
    }
    table_.line.push_back(static_cast<std::uint32_t>(line_));
    for (std::size_t w = 0; w < row_.size(); ++w) {
      if (table_.columns[w]) table_.columns[w]->push_back(row_[w]);
    }
  }

  double number(std::string_view cell, std::size_t column, std::size_t index) {
    if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
    const std::size_t sign = cell.front() == '+' ? 1 : 0;
    double value = 0.0;
    const auto [end, error] = std::from_chars(cell.data() + sign, cell.data() + cell.size(), value);
    if (error == std::errc() && end == cell.data() + cell.size() && std::abs(value) <= kLargest) return value;
    const std::errc kind = end == cell.data() + cell.size() ? error : std::errc::invalid_argument;
    say(line_, column, table_.header[index], cell, no_number(cell, value, kind), "");
    return std::numeric_limits<double>::quiet_NaN();
  }

  std::string_view text_;
  const std::string& name_;
  std::vector<ModelProblem>& problems_;
  std::size_t before_;
  std::size_t hidden_ = 0;
  std::size_t line_ = 0;
  std::vector<std::size_t> at_;  // of each column of the file, its place in `wanted`
  std::vector<double> row_;
  CsvTable table_;
};

}  // namespace

CsvTable parse_csv(std::string_view text, const std::string& shown_name,
                   const std::vector<std::string>& wanted, std::vector<ModelProblem>& problems) {
  return CsvReader(text, shown_name, problems).read(wanted);
}

CsvTable read_csv(const std::string& path, const std::vector<std::string>& wanted,
                  std::vector<ModelProblem>& problems) {
  std::string error;
  const std::string text = read_text_file(path, error);
  if (!error.empty()) {
    problems.push_back(of_file(path, error));
    return {};
  }
  return parse_csv(text, path, wanted, problems);
}

}  // namespace omnihil

#include "hil/capture/timed_csv.h"

#include <fmt/format.h>

#include <algorithm>

#include "hil/capture/capture_lines.h"
#include "hil/capture/decimal_time.h"
#include "hil/text/recording_text.h"

namespace omnihil {
namespace {

using Cells = std::vector<std::string_view>;

char separator_of(std::string_view line) {
  for (const char c : {';', '\t', ','})
    if (line.find(c) != std::string_view::npos) return c;
  return 0;
}

std::string_view trimmed(std::string_view cell) {
  constexpr std::string_view kAround = " \t\"'";
  const std::size_t first = cell.find_first_not_of(kAround);
  if (first == std::string_view::npos) return {};
  return cell.substr(first, cell.find_last_not_of(kAround) - first + 1);
}

Cells cells_of(std::string_view line, char separator) {
  Cells cells;
  for (;;) {
    const std::size_t end = line.find(separator);
    cells.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return cells;
    line.remove_prefix(end + 1);
  }
}

bool parse_loose_hex(std::string_view cell, std::vector<std::uint8_t>& bytes) {
  std::string digits;
  for (std::size_t i = 0; i < cell.size(); ++i) {
    const bool is_prefix =
        cell[i] == '0' && i + 1 < cell.size() && (cell[i + 1] == 'x' || cell[i + 1] == 'X');
    if (is_prefix)
      ++i;
    else if (cell[i] != ' ' && cell[i] != ':')
      digits += cell[i];
  }
  return !digits.empty() && parse_hex(digits, bytes);
}

CaptureWay way_of(std::string_view cell) {
  const std::string word = lower_case(cell);
  if (word == ">" || word == "host" || word == "tx" || word == "out") return CaptureWay::kFromHost;
  if (word == "<" || word == "dongle" || word == "rx" || word == "in" || word == "robot")
    return CaptureWay::kToHost;
  return CaptureWay::kUnknown;
}

constexpr std::size_t kNoColumn = ~std::size_t{0};

struct Columns {
  std::size_t time = 0, hex = 1, way = 2, can_id = kNoColumn, from_port = kNoColumn, to_port = kNoColumn;
};

// False: the line is no header.
bool read_header(const Cells& cells, Columns& columns, std::int64_t& unit_ns) {
  std::size_t named = 0;
  Columns found{kNoColumn, kNoColumn, kNoColumn};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string name = lower_case(cells[i]);
    if (name.starts_with("time") || name == "t") {
      found.time = i;
      const auto says = [&](const char* unit) {
        return name.ends_with("_" + std::string(unit)) ||
               name.find("[" + std::string(unit) + "]") != std::string::npos ||
               name.find("(" + std::string(unit) + ")") != std::string::npos;
      };
      if (says("ns")) unit_ns = 1;
      if (says("us")) unit_ns = kMicrosecond_ns;
      if (says("ms")) unit_ns = kMillisecond_ns;
      if (says("s")) unit_ns = kSecond_ns;
    } else if (name.starts_with("hex") || name.starts_with("data") || name.starts_with("bytes")) {
      found.hex = i;
    } else if (name == "way" || name.starts_with("dir")) {
      found.way = i;
      continue;
    } else if (name == "can_id" || name == "from_port" || name == "to_port") {
      (name == "can_id" ? found.can_id : name == "to_port" ? found.to_port : found.from_port) = i;
      continue;
    } else {
      continue;
    }
    ++named;
  }
  if (named < 2 || found.time == kNoColumn || found.hex == kNoColumn) return false;
  columns = found;
  return true;
}

// Where the row has such cells: a CAN frame by its id, else a UDP packet by its ports. False: a cell that is none.
bool take_carrier(const Cells& cells, const Columns& columns, Captured& piece) {
  const auto cell = [&](std::size_t column) {
    return column < cells.size() ? cells[column] : std::string_view();
  };
  if (const std::string_view id = cell(columns.can_id); !id.empty()) {
    piece.carrier = CaptureCarrier::kCan;
    piece.extended = id.size() > 3;
    piece.fd = piece.bytes.size() > 8;
    return parse_hex_number(id, piece.can_id) && piece.can_id <= (piece.extended ? 0x1FFF'FFFFU : 0x7FFU);
  }
  const std::string_view from = cell(columns.from_port), to = cell(columns.to_port);
  if (from.empty() && to.empty()) return true;
  piece.carrier = CaptureCarrier::kUdp;
  return parse_number_of_base(from, 10, piece.from_port) && parse_number_of_base(to, 10, piece.to_port);
}

bool parse_row(const Cells& cells, const Columns& columns, std::int64_t unit_ns, Captured& piece) {
  if (cells.size() <= columns.time || cells.size() <= columns.hex) return false;
  if (!parse_decimal_time(cells[columns.time], unit_ns, piece.at_ns)) return false;
  if (columns.way < cells.size()) piece.way = way_of(cells[columns.way]);
  const bool is_hex = parse_loose_hex(cells[columns.hex], piece.bytes);
  if (!take_carrier(cells, columns, piece)) return false;
  return is_hex || (piece.carrier == CaptureCarrier::kCan && cells[columns.hex].empty());
}

}  // namespace

bool looks_like_timed_csv(std::string_view first_line) {
  const char separator = separator_of(first_line);
  if (separator == 0) return false;
  const Cells cells = cells_of(first_line, separator);
  Columns columns;
  std::int64_t unit_ns = kSecond_ns;
  Captured piece;
  return cells.size() >= 2 &&
         (read_header(cells, columns, unit_ns) || parse_row(cells, columns, unit_ns, piece));
}

Capture read_timed_csv(const std::string& text, const std::string& name, std::int64_t time_unit_ns) {
  Capture capture;
  CaptureNotes notes(name);
  Columns columns;
  std::int64_t unit_ns = kSecond_ns;
  char separator = 0;
  for_each_line(text, notes, [&](std::string_view line, std::size_t number, bool is_cut) {
    if (trimmed(line).empty() || line.starts_with('#')) return;
    const bool is_first = separator == 0;
    if (is_first) separator = separator_of(line);
    const Cells cells = cells_of(line, separator == 0 ? ',' : separator);
    if (is_first && read_header(cells, columns, unit_ns)) return;
    Captured piece;
    if (!parse_row(cells, columns, time_unit_ns != 0 ? time_unit_ns : unit_ns, piece))
      return notes.count("no row of time and hex: left out", number);
    if (is_cut) notes.count("no line end behind the last line: taken as whole", number);
    if (piece.at_ns >= kUnixFrom_ns) capture.unix_time = true;
    capture.pieces.push_back(std::move(piece));
  });
  sort_by_time(capture, notes);
  capture.notes = notes.list();
  return capture;
}

std::string write_timed_csv(std::span<const Captured> pieces) {
  const auto any = [&](CaptureCarrier carrier) {
    return std::ranges::any_of(pieces, [&](const Captured& each) { return each.carrier == carrier; });
  };
  const bool can = any(CaptureCarrier::kCan), udp = any(CaptureCarrier::kUdp);
  std::string out =
      fmt::format("time_s,way{}{},hex\n", can ? ",can_id" : "", udp ? ",from_port,to_port" : "");
  std::int64_t last_ns = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Captured& each = pieces[i];
    if (each.at_ns < last_ns)
      throw BadCapture(
          fmt::format("row {}: time: found {} ns, allowed: {} ns or later", i + 1, each.at_ns, last_ns));
    last_ns = each.at_ns;
    const bool is_can = each.carrier == CaptureCarrier::kCan, is_udp = each.carrier == CaptureCarrier::kUdp;
    const char* way = each.way == CaptureWay::kFromHost ? ">" : each.way == CaptureWay::kToHost ? "<" : "";
    out += fmt::format("{},{}", decimal_time(each.at_ns, 9), way);
    if (can) out += !is_can ? "," : fmt::format(",{:0{}X}", each.can_id, each.extended ? 8 : 3);
    if (udp) out += !is_udp ? ",," : fmt::format(",{},{}", each.from_port, each.to_port);
    out += ',' + to_hex(each.bytes) + '\n';
  }
  return out;
}

}  // namespace omnihil

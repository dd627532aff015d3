#include "hil/capture/candump.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "hil/capture/capture_lines.h"
#include "hil/capture/decimal_time.h"
#include "hil/text/recording_text.h"

namespace omnihil {
namespace {

constexpr std::uint32_t kErrorFrame = 0x2000'0000, kMostStandard = 0x7FF, kMostExtended = 0x1FFF'FFFF;

enum class Stamp : std::uint8_t { kNone, kSeconds, kDate };

struct Line {
  Stamp stamp = Stamp::kNone;
  std::string_view interface;
  Captured frame;
  const char* left_out = nullptr;  // why this frame is not taken
};

bool take_id(std::string_view text, Line& line) {
  if (text.size() != 3 && text.size() != 8) return false;
  if (!parse_hex_number(text, line.frame.can_id)) return false;
  line.frame.extended = text.size() == 8;
  if ((line.frame.can_id & kErrorFrame) != 0) {
    line.left_out = "error frame: left out";
    return true;
  }
  return line.frame.can_id <= (line.frame.extended ? kMostExtended : kMostStandard);
}

// "044#2A36", "123##1AABB", "123#R4"
bool take_log_frame(std::string_view word, Line& line) {
  const std::size_t mark = word.find('#');
  if (mark == std::string_view::npos) return false;
  if (std::ranges::count(word, '#') > 2) {
    line.left_out = "CAN XL: left out";
    return true;
  }
  if (!take_id(word.substr(0, mark), line)) return false;
  std::string_view data = word.substr(mark + 1);
  if (data.starts_with('#')) {
    std::uint32_t flags = 0;
    if (data.size() < 2 || !parse_hex_number(data.substr(1, 1), flags)) return false;
    line.frame.fd = true;
    line.frame.bitrate_switch = (flags & 1) != 0;  // CANFD_BRS
    data.remove_prefix(2);
  } else if (data.starts_with('R') || data.starts_with('r')) {
    line.left_out = "remote frame: left out";
    return true;
  }
  if (const std::size_t raw = data.find('_'); raw != std::string_view::npos)
    data = data.substr(0, raw);  // raw DLC 9 to 15
  std::string digits(data);
  std::erase(digits, '.');  // "11.22.33" is allowed
  return (digits.empty() || parse_hex(digits, line.frame.bytes)) &&
         is_can_length(line.frame.bytes.size(), line.frame.fd);
}

// "044 [2] 2A 36", with "RX - -" or "TX B E" before it
bool take_console_frame(std::span<const std::string_view> words, Line& line) {
  const auto bracket =
      std::ranges::find_if(words, [](std::string_view word) { return word.starts_with('['); });
  if (bracket == words.end() || bracket == words.begin() || !bracket->ends_with(']')) return false;
  if (!take_id(*(bracket - 1), line)) return false;
  for (auto word = words.begin(); word != bracket - 1; ++word) {
    if (*word == "RX" || *word == "TX")
      line.frame.way = *word == "TX" ? CaptureWay::kFromHost : CaptureWay::kToHost;
    if (*word == "B") line.frame.bitrate_switch = true;
  }
  const std::string_view size = bracket->substr(1, bracket->size() - 2);
  std::uint32_t count = 0;
  if (!parse_number_of_base(size, 10, count)) return false;
  line.frame.fd = size.size() == 2;  // "[02]": CAN FD in candump's print
  line.frame.bitrate_switch = line.frame.bitrate_switch && line.frame.fd;
  auto byte = bracket + 1;
  if (byte != words.end() && *byte == "remote") {
    line.left_out = "remote frame: left out";
    return true;
  }
  for (std::uint32_t i = 0; i < count; ++i, ++byte) {
    std::uint32_t value = 0;
    if (byte == words.end() || byte->size() != 2 || !parse_hex_number(*byte, value)) return false;
    line.frame.bytes.push_back(static_cast<std::uint8_t>(value));
  }
  return is_can_length(line.frame.bytes.size(), line.frame.fd);
}

bool take_stamp(std::string_view inside, Line& line) {
  if (inside.find('-') != std::string_view::npos) {
    line.stamp = Stamp::kDate;
    return parse_date_line(inside, line.frame.at_ns);
  }
  line.stamp = Stamp::kSeconds;
  return parse_decimal_time(inside, kSecond_ns, line.frame.at_ns);
}

std::optional<Line> parse_line(std::string_view text) {
  Line line;
  line.frame.carrier = CaptureCarrier::kCan;
  if (const std::size_t open = text.find_first_not_of(" \t");
      open != std::string_view::npos && text[open] == '(') {
    const std::size_t close = text.find(')', open);
    if (close == std::string_view::npos || !take_stamp(text.substr(open + 1, close - open - 1), line))
      return {};
    text.remove_prefix(close + 1);
  }
  const std::vector<std::string_view> words = words_of(text);
  if (words.size() < 2) return {};
  line.interface = words[0];
  if (words[1].find('#') != std::string_view::npos) {
    if (!take_log_frame(words[1], line)) return {};
    if (words.size() > 3 || (words.size() == 3 && words[2] != "R" && words[2] != "T")) return {};
    if (words.size() == 3) line.frame.way = words[2] == "T" ? CaptureWay::kFromHost : CaptureWay::kToHost;
    return line;
  }
  if (!take_console_frame(std::span(words).subspan(1), line)) return {};
  return line;
}

// Stamps of -t d are differences to the line before. Where time went on, the second half of the stamps would be above the
// first half's middle, also when a few lines are out of order.
bool are_differences(std::span<const std::int64_t> stamps_ns) {
  if (stamps_ns.size() < 3 || stamps_ns[0] != 0 || std::ranges::is_sorted(stamps_ns)) return false;
  stamps_ns = stamps_ns.subspan(1);  // 0 either way
  const auto half = static_cast<std::ptrdiff_t>(stamps_ns.size() / 2);
  std::vector<std::int64_t> first(stamps_ns.begin(), stamps_ns.begin() + half);
  std::ranges::nth_element(first, first.begin() + half / 2);
  return std::ranges::min(stamps_ns.subspan(static_cast<std::size_t>(half))) <
         first[static_cast<std::size_t>(half / 2)];
}

// `stamps_ns` are those of all frames; of the taken ones `places` says where.
void sum_differences(const std::vector<std::int64_t>& stamps_ns, const std::vector<std::size_t>& places,
                     Capture& capture, CaptureNotes& notes) {
  if (capture.unix_time || !are_differences(stamps_ns)) return;
  std::int64_t now_ns = 0;
  for (std::size_t i = 0, taken = 0; i < stamps_ns.size(); ++i) {
    now_ns = std::min(now_ns + stamps_ns[i], kMostTime_ns);
    if (taken < places.size() && places[taken] == i) capture.pieces[taken++].at_ns = now_ns;
  }
  notes.say("time stamps fall: taken as differences (candump -t d)");
}

}  // namespace

bool looks_like_candump(std::string_view first_line) { return parse_line(first_line).has_value(); }

bool is_can_length(std::size_t bytes, bool fd) {
  if (bytes <= 8) return true;
  return fd && (bytes == 12 || bytes == 16 || bytes == 20 || bytes == 24 || bytes == 32 || bytes == 48 ||
                bytes == 64);
}

Capture read_candump(const std::string& text, const std::string& name) {
  Capture capture;
  CaptureNotes notes(name);
  std::vector<std::int64_t> stamps_ns;
  std::vector<std::size_t> places;
  std::vector<std::string> interfaces;
  for_each_line(text, notes, [&](std::string_view raw, std::size_t number, bool is_cut) {
    if (words_of(raw).empty() || raw.starts_with('#')) return;
    if (is_cut) return notes.count("the last line is cut: left out", number);
    auto line = parse_line(raw);
    if (!line) return notes.count("no frame of candump: left out", number);
    if (line->stamp == Stamp::kNone) {
      notes.count("no time stamp: taken at the time of the frame before", number);
      line->frame.at_ns = stamps_ns.empty() ? 0 : stamps_ns.back();
    }
    stamps_ns.push_back(line->frame.at_ns);
    if (line->left_out != nullptr) return notes.count(line->left_out, number);
    if (line->stamp == Stamp::kDate) notes.say("dates without a time zone: read as UTC");
    if (line->stamp == Stamp::kDate || line->frame.at_ns >= kUnixFrom_ns) capture.unix_time = true;
    if (std::ranges::find(interfaces, line->interface) == interfaces.end())
      interfaces.emplace_back(line->interface);
    places.push_back(stamps_ns.size() - 1);
    capture.pieces.push_back(std::move(line->frame));
  });
  if (interfaces.size() > 1)
    notes.say(
        fmt::format("frames of several interfaces are taken together: {}", fmt::join(interfaces, ", ")));
  sum_differences(stamps_ns, places, capture, notes);
  sort_by_time(capture, notes);
  capture.notes = notes.list();
  return capture;
}

void check_can_pieces(std::span<const Captured> pieces) {
  std::int64_t last_ns = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Captured& each = pieces[i];
    const auto refuse = [&](const std::string& what) {
      throw BadCapture(fmt::format("frame {}: {}", i + 1, what));
    };
    if (each.carrier != CaptureCarrier::kCan) refuse("found no CAN frame, allowed: CAN frames");
    if (each.can_id > (each.extended ? kMostExtended : kMostStandard))
      refuse(fmt::format("id: found {:X}, allowed: 0 to {:X}", each.can_id,
                         each.extended ? kMostExtended : kMostStandard));
    if (!is_can_length(each.bytes.size(), each.fd))
      refuse(fmt::format("length: found {}, allowed: 0 to 8, of CAN FD 12, 16, 20, 24, 32, 48, 64",
                         each.bytes.size()));
    if (each.at_ns < last_ns)
      refuse(fmt::format("time: found {} ns, allowed: {} ns or later", each.at_ns, last_ns));
    last_ns = each.at_ns;
  }
}

std::string write_candump(std::span<const Captured> pieces, const std::string& interface) {
  check_can_pieces(pieces);
  std::string out;
  for (const Captured& each : pieces) {
    out += fmt::format("({}) {} ", decimal_time(each.at_ns, 6), interface);
    out += each.extended ? fmt::format("{:08X}#", each.can_id) : fmt::format("{:03X}#", each.can_id);
    if (each.fd) out += fmt::format("#{:X}", each.bitrate_switch ? 1 : 0);
    for (const std::uint8_t byte : each.bytes) out += fmt::format("{:02X}", byte);
    if (each.way != CaptureWay::kUnknown) out += each.way == CaptureWay::kFromHost ? " T" : " R";
    out += '\n';
  }
  return out;
}

}  // namespace omnihil

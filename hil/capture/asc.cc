#include "hil/capture/asc.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "hil/capture/candump.h"
#include "hil/capture/capture_lines.h"
#include "hil/capture/decimal_time.h"

namespace omnihil {
namespace {

using Words = std::vector<std::string_view>;
constexpr std::array<std::uint8_t, 16> kLengths{0, 1,  2,  3,  4,  5,  6,  7,
                                                8, 12, 16, 20, 24, 32, 48, 64};  // by DLC, ISO 11898-1

bool is_way(std::string_view word) { return lower_case(word) == "rx" || lower_case(word) == "tx"; }
bool is_number(std::string_view word) {
  return !word.empty() && std::ranges::all_of(word, [](char c) { return c >= '0' && c <= '9'; });
}

// The line from that one of its words on.
std::string_view from(std::string_view line, std::string_view word) {
  return line.substr(static_cast<std::size_t>(word.data() - line.data()));
}

class AscReader {
 public:
  AscReader(const std::string& name, std::int64_t time_unit_ns) : notes_(name), unit_ns_(time_unit_ns) {}

  void take(std::string_view line, std::size_t number, bool is_cut) {
    const Words words = words_of(line);
    if (words.empty()) return;
    if (is_cut) return notes_.count("the last line is cut: left out", number);
    if (take_header(line, words)) return;
    std::int64_t stamp_ns = 0;
    if (!parse_decimal_time(words[0], unit(), stamp_ns) || words.size() < 2)
      return notes_.count("no line of an ASC log: left out", number);
    take_stamp(stamp_ns);
    const std::int64_t at_ns = now_ns_ + start_ns_.value_or(0);
    if (at_ns > kMostTime_ns) return notes_.count("a time after the year 2096: left out", number);
    Captured frame;
    frame.carrier = CaptureCarrier::kCan;
    frame.at_ns = at_ns;
    const char* left_out = words[1] == "CANFD" ? take_fd(words, frame) : take_classic(words, frame);
    if (left_out != nullptr) return notes_.count(left_out, number);
    if (capture_.pieces.empty() || channel_.empty())
      channel_ = std::string(words[words[1] == "CANFD" ? 2 : 1]);
    if (words[words[1] == "CANFD" ? 2 : 1] != channel_)
      notes_.say("frames of several channels are taken together");
    capture_.pieces.push_back(std::move(frame));
  }

  Capture finish() {
    if (!base_said_) notes_.say("no \"base hex\" or \"base dec\": read as hex");
    if (start_ns_) {
      capture_.unix_time = true;
      notes_.say("a date without a time zone: read as UTC");
    } else {
      notes_.say("no date: times count from the start of the log");
    }
    sort_by_time(capture_, notes_);
    capture_.notes = notes_.list();
    return std::move(capture_);
  }

 private:
  std::int64_t unit() const { return unit_ns_ != 0 ? unit_ns_ : kSecond_ns; }

  void take_unit(const std::string& lower) {
    for (const char* word : {"in ms", "[ms]", "(ms)", "millisecond"}) {
      if (unit_ns_ != 0 || lower.find(word) == std::string::npos) continue;
      unit_ns_ = kMillisecond_ns;
      notes_.say("times are in milliseconds, as the file says");
    }
  }

  void take_stamp(std::int64_t stamp_ns) {
    // Times of a later trigger block go on from those before, or begin again at its own date.
    if (block_ns_ && stamp_ns < now_ns_ && !relative_) start_ns_ = block_ns_;
    block_ns_.reset();
    now_ns_ = std::min(relative_ ? now_ns_ + stamp_ns : stamp_ns, kMostTime_ns);
    any_stamp_ = true;
  }

  void take_date(std::string_view text) {
    std::int64_t ns = 0;
    if (!parse_date_line(text, ns))
      return notes_.say("date not understood: " + std::string(text.substr(0, 60)));
    (any_stamp_ ? block_ns_ : start_ns_) = ns;
  }

  bool take_header(std::string_view line, const Words& words) {
    const std::string lower = lower_case(line), first = lower_case(words[0]);
    if (first.starts_with("//") || first == "#") {
      take_unit(lower);
      return true;
    }
    if (first == "date") {
      if (words.size() > 1) take_date(from(line, words[1]));
    } else if (first == "begin" && words.size() > 2) {
      take_date(from(line, words[2]));  // "Begin Triggerblock DATE": the times count from there
    } else if (first == "base") {
      base_said_ = words.size() > 1 && (lower_case(words[1]) == "hex" || lower_case(words[1]) == "dec");
      base_ = base_said_ && lower_case(words[1]) == "dec" ? 10 : 16;
      relative_ = lower.find("relative") != std::string::npos;
      take_unit(lower);
    } else {
      return first == "begin" || first == "end" || first == "internal" || first == "no";
    }
    return true;
  }

  bool take_id(std::string_view word, Captured& frame) const {
    frame.extended = word.ends_with('x') || word.ends_with('X');
    if (frame.extended) word.remove_suffix(1);
    return parse_number_of_base(word, base_, frame.can_id) &&
           frame.can_id <= (frame.extended ? 0x1FFF'FFFFU : 0x7FFU);
  }

  const char* take_bytes(const Words& words, std::size_t from, std::size_t count, Captured& frame) const {
    for (std::size_t i = 0; i < count; ++i) {
      std::uint32_t byte = 0;
      if (from + i >= words.size() || !parse_number_of_base(words[from + i], base_, byte) || byte > 255)
        return "fewer bytes than its length says: left out";
      frame.bytes.push_back(static_cast<std::uint8_t>(byte));
    }
    return nullptr;
  }

  static void take_way(std::string_view word, Captured& frame) {
    frame.way = lower_case(word) == "tx" ? CaptureWay::kFromHost : CaptureWay::kToHost;
  }

  // TIME CHANNEL ID Rx d DLC BYTES…
  const char* take_classic(const Words& words, Captured& frame) const {
    constexpr const char* kOther = "an event that is no CAN frame: left out";
    if (!is_number(words[1]) || words.size() < 3) return kOther;
    if (lower_case(words[2]).starts_with("errorframe")) return "error frame: left out";
    if (words.size() < 5 || !is_way(words[3])) return kOther;
    if (!take_id(words[2], frame)) return "an id that is no number of the log's base, or too large: left out";
    take_way(words[3], frame);
    if (lower_case(words[4]) == "r") return "remote frame: left out";
    std::uint32_t dlc = 0;
    if (lower_case(words[4]) != "d" || words.size() < 6 || !parse_number_of_base(words[5], base_, dlc) ||
        dlc > 15)
      return kOther;
    return take_bytes(words, 6, std::min<std::size_t>(dlc, 8), frame);
  }

  // TIME CANFD CHANNEL Rx ID [NAME] BRS ESI DLC LENGTH BYTES…
  const char* take_fd(const Words& words, Captured& frame) const {
    constexpr const char* kOther = "a line of CAN FD that is no frame: left out";
    if (words.size() < 9 || !is_way(words[3])) return kOther;
    take_way(words[3], frame);
    if (lower_case(words[4]).starts_with("errorframe")) return "error frame: left out";
    if (!take_id(words[4], frame)) return "an id that is no number of the log's base, or too large: left out";
    // A name may stand before the bit rate switch.
    const std::size_t at = words[5] == "0" || words[5] == "1" ? 5 : 6;
    std::uint32_t dlc = 0, length = 0;
    if (words.size() < at + 4 || !parse_number_of_base(words[at + 2], base_, dlc) || dlc >= kLengths.size())
      return kOther;
    if (!parse_number_of_base(words[at + 3], 10, length) || length > kLengths[dlc]) return kOther;
    if (length == 0 && dlc != 0) return "remote frame: left out";
    frame.bitrate_switch = words[at] == "1";
    frame.fd = true;
    return take_bytes(words, at + 4, length, frame);
  }

  Capture capture_;
  CaptureNotes notes_;
  std::int64_t unit_ns_ = 0;  // 0: not said yet
  std::int64_t now_ns_ = 0;
  std::optional<std::int64_t> start_ns_;  // Unix time of stamp 0
  std::optional<std::int64_t> block_ns_;  // of a later trigger block whose first stamp is yet to come
  bool any_stamp_ = false;
  std::string channel_;
  int base_ = 16;
  bool base_said_ = false, relative_ = false;
};

}  // namespace

bool looks_like_asc(std::string_view first_line) {
  const Words words = words_of(first_line);
  if (words.empty()) return false;
  const std::string first = lower_case(words[0]);
  if (first == "date" || (first == "base" && words.size() > 1) || (first == "begin" && words.size() > 1))
    return true;
  std::int64_t ns = 0;
  if (words.size() < 5 || !parse_decimal_time(words[0], kSecond_ns, ns)) return false;
  return is_way(words[3]);
}

Capture read_asc(const std::string& text, const std::string& name, std::int64_t time_unit_ns) {
  AscReader reader(name, time_unit_ns);
  CaptureNotes ends(name);
  for_each_line(text, ends, [&](std::string_view line, std::size_t number, bool is_cut) {
    reader.take(line, number, is_cut);
  });
  Capture capture = reader.finish();
  const auto more = ends.list();
  capture.notes.insert(capture.notes.end(), more.begin(), more.end());
  return capture;
}

std::string write_asc(std::span<const Captured> pieces) {
  check_can_pieces(pieces);
  const std::int64_t start_ns = pieces.empty() ? 0 : pieces.front().at_ns / kMillisecond_ns * kMillisecond_ns;
  const std::string date = date_line(start_ns);
  std::string out = fmt::format(
      "date {}\nbase hex  timestamps absolute\nno internal events logged\nBegin Triggerblock {}\n"
      "   0.000000 Start of measurement\n",
      date, date);
  for (const Captured& each : pieces) {
    const std::string id = fmt::format("{:X}{}", each.can_id, each.extended ? "x" : "");
    const char* way = each.way == CaptureWay::kFromHost ? "Tx" : "Rx";
    const auto code = std::ranges::find(kLengths, each.bytes.size()) - kLengths.begin();
    out += fmt::format("{:>11} ", decimal_time(each.at_ns - start_ns, 6));
    if (each.fd) {
      out += fmt::format("CANFD   1 {} {} {} 0 {:x} {}", way, id, each.bitrate_switch ? 1 : 0, code,
                         each.bytes.size());
    } else {
      out += fmt::format("1  {:<15} {}   d {:x}", id, way, code);
    }
    for (const std::uint8_t byte : each.bytes) out += fmt::format(" {:02X}", byte);
    out += each.fd ? " 0 0 1000 0 0 0 0 0\n" : "\n";  // duration, length, flags and timings are not known
  }
  return out + "End TriggerBlock\n";
}

}  // namespace omnihil

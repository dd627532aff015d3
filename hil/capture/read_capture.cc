#include "hil/capture/read_capture.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "hil/capture/asc.h"
#include "hil/capture/candump.h"
#include "hil/capture/capture_lines.h"
#include "hil/capture/decimal_time.h"
#include "hil/capture/pcap.h"
#include "hil/capture/timed_csv.h"
#include "hil/text/recording_text.h"

namespace omnihil {
namespace {

// As our wire for bytes over CAN uses them (hil/wire/can_byte_wire.h).
constexpr std::uint32_t kUsualCanToBoard = 0x7E0, kUsualCanFromBoard = 0x7E8;

// The first line that says something: no comment of '#', not empty.
std::string_view first_line(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    const bool is_comment = line.starts_with('#') || line.starts_with("//");
    if (!is_comment && !words_of(line).empty())
      return line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return {};
}

using Counts = std::map<std::uint32_t, std::size_t>;  // id or port, how many pieces

std::string list_of(const Counts& counts, const char* form) {
  std::vector<std::string> each;
  for (const auto& [key, count] : counts) each.push_back(fmt::format(fmt::runtime(form), key, count));
  return fmt::format("{}", fmt::join(each, ", "));
}

// The only port that packets go to, or of two that talk to each other the one that was spoken to first.
std::uint16_t dongle_port(const Capture& capture, const CaptureFilter& filter, HostBytes& out,
                          const std::string& name) {
  if (filter.udp_port) return *filter.udp_port;
  Counts to;
  const Captured* first = nullptr;
  bool one_talk = true;
  for (const Captured& each : capture.pieces) {
    if (each.carrier != CaptureCarrier::kUdp) continue;
    if (first == nullptr) first = &each;
    ++to[each.to_port];
    one_talk = one_talk && ((each.from_port == first->from_port && each.to_port == first->to_port) ||
                            (each.from_port == first->to_port && each.to_port == first->from_port));
  }
  if (to.size() > 1 && !one_talk) {
    throw BadCapture(name +
                     ": UDP port of the dongle: found none, allowed: " + list_of(to, "{} ({} packets)"));
  }
  out.notes.push_back(fmt::format("{}: UDP port {} is taken as the dongle's", name, first->to_port));
  return first->to_port;
}

struct CanIds {
  std::uint32_t to = kUsualCanToBoard, back = kUsualCanFromBoard;
  bool has_back = true;
};

CanIds can_ids(const Capture& capture, const CaptureFilter& filter, HostBytes& out, const std::string& name) {
  Counts ids;
  for (const Captured& each : capture.pieces)
    if (each.carrier == CaptureCarrier::kCan) ++ids[each.can_id];
  if (filter.can_id || filter.can_back_id)
    return {filter.can_id.value_or(~0U), filter.can_back_id.value_or(~0U), filter.can_back_id.has_value()};
  if (ids.contains(kUsualCanToBoard) || ids.contains(kUsualCanFromBoard)) return {};
  if (ids.size() > 1)
    throw BadCapture(name + ": CAN id of the host: found none, allowed: " + list_of(ids, "{:X} ({} frames)"));
  out.notes.push_back(fmt::format("{}: CAN id {:X} is taken as the host's", name, ids.begin()->first));
  return {ids.begin()->first, ~0U, false};
}

}  // namespace

std::optional<std::uint32_t> parse_can_id(const std::string& text) {
  std::uint32_t id = 0;
  const std::string_view digits = text.starts_with("0x") || text.starts_with("0X")
                                      ? std::string_view(text).substr(2)
                                      : std::string_view(text);
  if (!parse_hex_number(digits, id) || id > 0x1FFF'FFFF) return {};
  return id;
}

bool is_capture(const std::string& text) {
  if (looks_like_pcap(text)) return true;
  const std::string_view line = first_line(text);
  return looks_like_asc(line) || looks_like_candump(line) || looks_like_timed_csv(line);
}

Capture read_capture(const std::string& text, const std::string& name, const CaptureFilter& filter) {
  if (looks_like_pcap(text)) return read_pcap(text, name);
  const std::string_view line = first_line(text);
  if (looks_like_asc(line)) return read_asc(text, name, filter.time_unit_ns);
  if (looks_like_candump(line)) return read_candump(text, name);
  if (looks_like_timed_csv(line)) return read_timed_csv(text, name, filter.time_unit_ns);
  throw BadCapture(name + ": found " + in_quotes(line) +
                   ", allowed: pcap, pcapng, candump, asc, CSV of time and hex");
}

HostBytes host_bytes(const Capture& capture, const CaptureFilter& filter, const std::string& name) {
  HostBytes out;
  out.notes = capture.notes;
  out.unix_time = capture.unix_time;
  const auto has = [&](CaptureCarrier carrier) {
    return std::ranges::any_of(capture.pieces, [&](const Captured& each) { return each.carrier == carrier; });
  };
  const std::uint16_t port =
      has(CaptureCarrier::kUdp) ? dongle_port(capture, filter, out, name) : std::uint16_t{0};
  const CanIds ids = has(CaptureCarrier::kCan) ? can_ids(capture, filter, out, name) : CanIds{};
  std::size_t others = 0;
  for (const Captured& each : capture.pieces) {
    CaptureWay way = each.way;
    if (each.carrier == CaptureCarrier::kUdp) {
      way = each.to_port == port ? CaptureWay::kFromHost : CaptureWay::kToHost;
      if (each.to_port != port && each.from_port != port) way = CaptureWay::kUnknown;
    } else if (each.carrier == CaptureCarrier::kCan) {
      way = each.can_id == ids.to ? CaptureWay::kFromHost : CaptureWay::kToHost;
      if (each.can_id != ids.to && (!ids.has_back || each.can_id != ids.back)) way = CaptureWay::kUnknown;
    }
    if (each.carrier != CaptureCarrier::kSerial && way == CaptureWay::kUnknown) {
      ++others;
      continue;
    }
    if (each.bytes.empty()) continue;  // a CAN frame of length 0
    out.pieces.push_back(each);
    out.pieces.back().way = way;
  }
  if (others > 0)
    out.notes.push_back(fmt::format("{}: {} packets or frames of others: left out", name, others));
  if (out.pieces.empty())
    throw BadCapture(
        name + ": found no bytes of host or dongle" +
        (out.notes.empty() ? std::string() : "\n" + fmt::format("{}", fmt::join(out.notes, "\n"))));
  out.start_ns = out.pieces.front().at_ns;
  for (Captured& each : out.pieces) each.at_ns -= out.start_ns;
  return out;
}

std::vector<Captured> as_can_frames(std::span<const Captured> pieces) {
  constexpr std::size_t kMostBytes = 8;
  std::vector<Captured> frames;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const Captured& piece = pieces[k];
    if (piece.carrier == CaptureCarrier::kCan) {
      frames.push_back(piece);
      continue;
    }
    if (piece.way == CaptureWay::kUnknown)
      throw BadCapture(fmt::format("piece {}: way: found none, allowed: from the host, to the host", k + 1));
    Captured frame;
    frame.at_ns = piece.at_ns;
    frame.way = piece.way;
    frame.carrier = CaptureCarrier::kCan;
    frame.can_id = piece.way == CaptureWay::kFromHost ? kUsualCanToBoard : kUsualCanFromBoard;
    for (std::size_t at = 0; at < piece.bytes.size(); at += kMostBytes) {
      const auto from = piece.bytes.begin() + static_cast<std::ptrdiff_t>(at);
      const std::size_t count = std::min(kMostBytes, piece.bytes.size() - at);
      frame.bytes.assign(from, from + static_cast<std::ptrdiff_t>(count));
      frames.push_back(frame);
    }
  }
  return frames;
}

}  // namespace omnihil

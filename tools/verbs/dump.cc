// omnihil dump FILE: every packet of a recording or a capture in words, a line each.
#include <fmt/format.h>

#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "hil/capture/decimal_time.h"
#include "hil/loop/console_line.h"
#include "hil/recording/capture_import.h"
#include "hil/recording/recorded_packets.h"
#include "hil/recording/recording_reader.h"
#include "hil/recording/replay_report.h"
#include "hil/text/recording_text.h"
#include "tools/command_line.h"
#include "tools/exit_codes.h"
#include "tools/format_argument.h"
#include "tools/guarded.h"
#include "tools/options/capture_options.h"
#include "tools/packet_json.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

struct DumpWords {
  std::string recording, format_file, message, radio;
  CaptureWords capture;
  int robot = -1;
  double from_s = 0.0, to_s = 1e12;
  bool hex = false;
};

std::string line_of(const PassedPacket& passed, const RadioFormat& format, bool hex) {
  const auto& bytes = passed.packet.frame.bytes;
  const DecodeResult decoded = format.decode(bytes);
  std::string text = fmt::format("{:12.6f} {} ", static_cast<double>(passed.packet.now_ns) / 1e9,
                                 passed.from_host ? '>' : '<');
  if (passed.packet.frame.understood) {
    text += packet_to_json(decoded.values);
  } else {
    text += fmt::format("refused ({})", to_string(decoded.error));
  }
  if (hex || !passed.packet.frame.understood) text += "  " + to_hex(bytes);
  return text;
}

// "    1.250000 | robot 3 board 1 USART2: boot"
std::string console_text(const RecordedChunk& chunk) {
  return fmt::format("{:12.6f} | {} {}: {}", static_cast<double>(chunk.now_ns) / 1e9,
                     board_words(chunk.robot_id, chunk.board), chunk.port, chunk.text);
}

// Of a capture without a radio format: its pieces in hex, with what carried them.
int dump_pieces(const DumpWords& words, const Capture& capture) {
  const std::int64_t start_ns = capture.pieces.empty() ? 0 : capture.pieces.front().at_ns;
  if (capture.unix_time) fmt::print("# from {} s of Unix time on\n", decimal_time(start_ns, 9));
  for (const Captured& piece : capture.pieces) {
    const double at_s = static_cast<double>(piece.at_ns - start_ns) / 1e9;
    if (at_s < words.from_s || at_s > words.to_s) continue;
    std::string by;
    if (piece.carrier == CaptureCarrier::kCan) by = fmt::format("can {:X} ", piece.can_id);
    if (piece.carrier == CaptureCarrier::kUdp)
      by = fmt::format("udp {} to {} ", piece.from_port, piece.to_port);
    const char way = piece.way == CaptureWay::kFromHost ? '>' : piece.way == CaptureWay::kToHost ? '<' : '?';
    fmt::print("{:12.6f} {} {}{}\n", at_s, way, by, to_hex(piece.bytes));
  }
  return kExitOk;
}

int dump_packets(const DumpWords& words, const Recording& recording, const RadioFormat& format) {
  if (!words.message.empty() && message_or_complain(format, words.message) == nullptr) return kExitBadInput;
  std::vector<const RecordedChunk*>
      said;  // what boards said, between the packets; with --packet it is left out
  for (const RecordedChunk& chunk : recording.chunks) {
    const double at_s = static_cast<double>(chunk.now_ns) / 1e9;
    if (chunk.kind == RecordedChunk::Kind::kConsole && words.message.empty() && at_s >= words.from_s &&
        at_s <= words.to_s && (words.robot < 0 || chunk.robot_id == words.robot))
      said.push_back(&chunk);
  }
  auto next_said = said.begin();
  const auto say_until = [&](std::int64_t now_ns) {
    for (; next_said != said.end() && (*next_said)->now_ns <= now_ns; ++next_said)
      fmt::print("{}\n", console_text(**next_said));
  };
  for (const PassedPacket& passed : all_packets(recording, format)) {
    say_until(passed.packet.now_ns);
    const double at_s = static_cast<double>(passed.packet.now_ns) / 1e9;
    if (at_s < words.from_s || at_s > words.to_s) continue;
    const bool asks = words.robot >= 0 || !words.message.empty();
    if (asks) {
      if (!passed.packet.frame.understood) continue;
      const DecodeResult decoded = format.decode(passed.packet.frame.bytes);
      if (words.robot >= 0 && packet_robot(decoded.values) != words.robot) continue;
      if (!words.message.empty() && decoded.values.message->name != words.message) continue;
    }
    fmt::print("{}\n", line_of(passed, format, words.hex));
  }
  say_until(std::numeric_limits<std::int64_t>::max());
  return kExitOk;
}

int dump_capture(const DumpWords& words) {
  const CaptureFilter filter = capture_filter(words.capture);
  const Capture capture = load_capture(words.recording, filter);
  if (words.radio.empty() && words.format_file.empty()) {
    if (words.robot >= 0 || !words.message.empty())
      throw std::invalid_argument(
          "--radio: found none, allowed: the format of the packets, which --robot and --packet need");
    print_notes(capture.notes);
    return dump_pieces(words, capture);
  }
  const RadioFormat* format = format_or_complain(words.radio, words.format_file);
  if (format == nullptr) return kExitBadInput;
  CaptureImport log = import_capture(capture, filter, *format, words.recording, 1);
  print_notes(log.notes);
  if (log.unix_time) fmt::print("# from {} s of Unix time on\n", decimal_time(log.start_ns, 9));
  Recording recording;
  recording.chunks = std::move(log.chunks);
  recording.complete = true;
  return dump_packets(words, recording, *format);
}

int run_dump(const DumpWords& words) {
  if (is_capture_file(words.recording)) return dump_capture(words);
  if (!words.format_file.empty() && format_file_or_complain(words.format_file) == nullptr)
    return kExitBadInput;
  const Recording recording = load_recording(std::filesystem::path(words.recording));
  const RadioFormat* format = format_or_complain(recording.header.radio_format);
  if (format == nullptr) return kExitBadInput;
  fmt::print("# {}\n", recording_line(recording));
  return dump_packets(words, recording, *format);
}

}  // namespace

void add_verb_dump(Verb& program, VerbResult& result) {
  auto words = std::make_shared<DumpWords>();
  Verb verb = program.add_subcommand("dump", "the packets of a recording or a capture in words, a line each");
  verb.add_option("FILE", words->recording,
                  "recording that serve --record wrote, or candump, asc, pcap, pcapng, CSV of time and hex")
      .required();
  verb.add_option("--format", words->format_file,
                  "radio format of the recording from this file, where it was made with one");
  verb.add_option("--radio", words->radio, "radio format of a capture (default: its bytes in hex)");
  add_capture_options(verb, words->capture);
  verb.add_option("--robot", words->robot, "packets of this robot only").range(0, 255);
  verb.add_option("--packet", words->message, "packets of this name only");
  verb.add_option("--from", words->from_s, "from this time on, in s").not_negative();
  verb.add_option("--to", words->to_s, "up to this time, in s").not_negative();
  verb.add_flag("--hex", words->hex, "with their bytes");
  verb.footer(
      "TIME_S > what the host wrote, < what the dongle gave it, at the time of the last byte; bytes that are "
      "no packet "
      "say why.");
  verb.callback([words, &result] { result.exit_code = guarded("dump", [&] { return run_dump(*words); }); });
}

}  // namespace omnihil

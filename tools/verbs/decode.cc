// omnihil decode FORMAT: hex lines of whole wire frames to JSON lines.
#include <cstdio>
#include <iostream>
#include <string>

#include "protocols/packet_list.h"
#include "tools/command_line.h"
#include "tools/exit_codes.h"
#include "tools/format_argument.h"
#include "tools/packet_json.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

constexpr const char* kExample =
    "Reads one whole frame in hex per line (spaces and ':' between bytes are allowed) and prints one JSON "
    "line each:\n"
    "{\"packet\": NAME, \"fields\": {...}}, or {\"error\": CAUSE, \"field\": NAME} for a frame that is "
    "refused.\n"
    "A frame that lists several packets is {\"packets\": [...]}.\n"
    "Exit code 2 if a line was no hex. Example:\n"
    "  echo 0301fe03024101010101010480bf0101010100 | omnihil decode ulaval-hermes";

int digit_of(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// False when a character is no hex digit or one digit is missing.
bool bytes_from_hex(const std::string& line, std::vector<std::uint8_t>& bytes) {
  bytes.clear();
  int high = -1;
  for (char c : line) {
    if (high < 0 && (c == ' ' || c == '\t' || c == '\r' || c == ':')) continue;
    const int digit = digit_of(c);
    if (digit < 0) return false;
    if (high < 0) {
      high = digit;
    } else {
      bytes.push_back(static_cast<std::uint8_t>(16 * high + digit));
      high = -1;
    }
  }
  return high < 0;
}

std::string json_of(const DecodeResult& result) {
  if (result.error == PacketError::kNone) return packet_to_json(result.values);
  std::string out = "{\"error\":\"" + std::string(to_string(result.error)) + "\"";
  if (!result.field.empty()) out += ",\"field\":\"" + std::string(result.field) + "\"";
  return out + "}";
}

// Of a frame that lists other than one packet.
std::string json_of_list(const RadioFormat& format, std::span<const std::uint8_t> frame, std::size_t count) {
  std::string out = "{\"packets\":[";
  for (std::size_t i = 0; i < count; ++i)
    out += (i > 0 ? "," : "") + json_of(decode_listed(format, frame, i));
  return out + "]}";
}

struct Arguments {
  std::string format;
  std::string file;
};

int run(const Arguments& arguments) {
  const RadioFormat* format = format_or_complain(arguments.format, arguments.file);
  if (format == nullptr) return kExitBadInput;
  int exit_code = kExitOk;
  std::string line;
  std::vector<std::uint8_t> frame;
  for (int line_number = 1; std::getline(std::cin, line); ++line_number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    if (bytes_from_hex(line, frame)) {
      const std::size_t count = listed_packets(*format, frame).value_or(1);
      std::cout << (count == 1 ? json_of(format->decode(frame)) : json_of_list(*format, frame, count))
                << std::endl;
    } else {
      std::cout << "{\"error\":\"not hex\"}" << std::endl;
      std::fprintf(stderr, "omnihil decode: line %d: not hex: %s\n", line_number, line.c_str());
      exit_code = kExitBadInput;
    }
  }
  return exit_code;
}

}  // namespace

void add_verb_decode(Verb& program, VerbResult& result) {
  auto arguments = std::make_shared<Arguments>();
  Verb verb = program.add_subcommand("decode", "radio packets in hex to JSON lines");
  const Option format =
      verb.add_option("FORMAT", arguments->format, "radio format, e.g. ulaval-hermes; see `omnihil formats`");
  verb.add_option("--format", arguments->file, "the format from this file (docs/radio/own-format.md)")
      .excludes(format);
  verb.footer(kExample);
  verb.callback([arguments, &result] { result.exit_code = run(*arguments); });
}

}  // namespace omnihil

// omnihil encode FORMAT PACKET: JSON objects, one per line, to hex lines of whole wire frames.
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
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
    "Reads JSON objects with the team's own field names, one per line, and prints one hex line for each: "
    "the\n"
    "whole frame as it stands on the wire. Fields left out are 0; type, version, length and checksum are "
    "filled in.\n"
    "Of a format whose frames list packets, an array of objects is one frame.\n"
    "A bad line is named on the error output, with what is allowed; the other lines are still printed.\n"
    "Example:\n"
    "  echo '{\"robot\": 3, \"vx\": 1.0}' | omnihil encode ulaval-hermes SPEED_MOVE";

struct Arguments {
  std::string format;
  std::string packet;
  std::string file;
};

// One line in, one hex line out; what is wrong with the line otherwise.
std::vector<std::string> encode_line(const std::string& line, const RadioFormat& format,
                                     const Message& message, std::string& hex) {
  const nlohmann::json object = nlohmann::json::parse(line, nullptr, false);
  if (object.is_discarded()) return {"not JSON: " + line};
  // An array is a frame that lists packets.
  const bool is_list = object.is_array() && format.list != nullptr;
  const std::size_t count = is_list ? object.size() : 1;
  std::vector<PacketFromJson> packets(count);
  std::vector<Values> values;
  for (std::size_t i = 0; i < count; ++i) {
    packet_from_json(is_list ? object[i] : object, message, packets[i]);
    if (!packets[i].problems.empty()) return packets[i].problems;
    values.push_back(packets[i].values);
  }
  std::vector<std::uint8_t> frame;
  const auto [error, field] = encode_list(format, values, frame);
  if (error != PacketError::kNone) {
    return {"field '" + std::string(field) + "': refused: " + std::string(to_string(error))};
  }
  hex.clear();
  for (std::uint8_t byte : frame) {
    constexpr char kDigits[] = "0123456789abcdef";
    hex += kDigits[byte >> 4];
    hex += kDigits[byte & 15];
  }
  return {};
}

int run(const Arguments& arguments) {
  const RadioFormat* format = format_or_complain(arguments.format, arguments.file);
  if (format == nullptr) return kExitBadInput;
  // With a file the only word is the packet.
  const bool has_file = !arguments.file.empty();
  const std::string& packet = has_file ? arguments.format : arguments.packet;
  if (packet.empty() || (has_file && !arguments.packet.empty())) {
    std::fprintf(stderr, "omnihil encode: FORMAT PACKET are required, or --format FILE PACKET\n");
    return kExitBadInput;
  }
  const Message* message = message_or_complain(*format, packet);
  if (message == nullptr) return kExitBadInput;
  int exit_code = kExitOk;
  std::string line;
  std::string hex;
  for (int line_number = 1; std::getline(std::cin, line); ++line_number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const auto problems = encode_line(line, *format, *message, hex);
    for (const std::string& problem : problems) {
      std::fprintf(stderr, "omnihil encode: line %d: %s\n", line_number, problem.c_str());
      exit_code = kExitBadInput;
    }
    if (problems.empty()) std::cout << hex << std::endl;
  }
  return exit_code;
}

}  // namespace

void add_verb_encode(Verb& program, VerbResult& result) {
  auto arguments = std::make_shared<Arguments>();
  Verb verb = program.add_subcommand("encode", "JSON lines to radio packets in hex");
  verb.add_option("FORMAT", arguments->format, "radio format, e.g. ulaval-hermes; see `omnihil formats`");
  verb.add_option("PACKET", arguments->packet, "the team's name of the packet, e.g. SPEED_MOVE");
  verb.add_option("--format", arguments->file,
                  "the format from this file (docs/radio/own-format.md); then PACKET alone");
  verb.footer(kExample);
  verb.callback([arguments, &result] { result.exit_code = run(*arguments); });
}

}  // namespace omnihil

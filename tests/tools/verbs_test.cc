// The verbs encode, decode and formats, as a user runs them.
#include <sys/wait.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <sstream>

#include "hil/wire/wire_kind.h"
#include "protocols/emit/emit.h"
#include "tests/protocols/team_vectors.h"

namespace omnihil {
namespace {

using nlohmann::json;

struct Output {
  int exit_code = -1;
  std::string out;
  std::string err;
};

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

class Verbs : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(OMNIHIL_PROGRAM)) GTEST_SKIP() << "the program omnihil is not built";
    std::string pattern = (std::filesystem::temp_directory_path() / "omnihil-verbs-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override {
    if (!folder_.empty()) std::filesystem::remove_all(folder_);
  }

  Output run(const std::string& arguments, const std::string& input) const {
    std::ofstream(folder_ / "in", std::ios::binary) << input;
    const std::string command = std::string("'") + OMNIHIL_PROGRAM + "' " + arguments + " < '" +
                                (folder_ / "in").string() + "' > '" + (folder_ / "out").string() + "' 2> '" +
                                (folder_ / "err").string() + "'";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(folder_ / "out"), text_of(folder_ / "err")};
  }

  std::filesystem::path folder_;
};

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST_F(Verbs, EncodeGivesTheBytesOfEveryGoldenPacket) {
  for (const RadioFormat* format : radio_formats()) {
    for (const Message& message : format->messages) {
      std::string input;
      std::string expected;
      for (const GoldenPacket& packet : golden_packets()) {
        if (packet.message != &message) continue;
        input += packet.given.dump() + "\n";
        expected += to_hex(packet.frame) + "\n";
      }
      const Output result = run("encode " + std::string(format->id) + " " + std::string(message.name), input);
      EXPECT_EQ(result.exit_code, 0) << result.err;
      EXPECT_EQ(result.out, expected) << message.name;
      EXPECT_EQ(result.err, "");
    }
  }
}

TEST_F(Verbs, DecodeGivesPacketAndFieldsOfEveryGoldenPacket) {
  for (const RadioFormat* format : radio_formats()) {
    std::string input;
    std::vector<GoldenPacket> packets;
    for (const GoldenPacket& packet : golden_packets()) {
      if (packet.format != format) continue;
      input += to_hex(packet.frame) + "\n";
      packets.push_back(packet);
    }
    const Output result = run("decode " + std::string(format->id), input);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const auto lines = lines_of(result.out);
    ASSERT_EQ(lines.size(), packets.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const json line = json::parse(lines[i]);
      EXPECT_EQ(line.at("packet"), packets[i].message->name);
      for (const auto& [name, value] : packets[i].given.items()) {
        const json& field = line.at("fields").at(name);
        if (value.is_boolean() || value.is_number_integer() || value.is_string()) {
          EXPECT_EQ(field, value) << lines[i];
        } else {
          EXPECT_EQ(field.is_array(), value.is_array()) << name;
        }
      }
    }
  }
}

TEST_F(Verbs, WhatDecodePrintsEncodeTakes) {
  const RadioFormat& format = *find_radio_format("ulaval-hermes");
  for (const GoldenPacket& packet : golden_packets()) {
    if (packet.format != &format) continue;
    const Output decoded = run("decode ulaval-hermes", to_hex(packet.frame) + "\n");
    const json fields = json::parse(decoded.out).at("fields");
    const Output encoded =
        run("encode ulaval-hermes " + std::string(packet.message->name), fields.dump() + "\n");
    EXPECT_EQ(encoded.out, to_hex(packet.frame) + "\n") << decoded.out;
  }
}

TEST_F(Verbs, DecodePrintsFloatsWithTheFewestDigitsOfAFloat32) {
  const Output result =
      run("encode ulaval-hermes SPEED_MOVE", "{\"robot\":1,\"vx\":0.1,\"vy\":-0.0,\"vtheta\":3}\n");
  const Output decoded = run("decode ulaval-hermes", result.out);
  EXPECT_EQ(decoded.out,
            "{\"packet\":\"SPEED_MOVE\",\"fields\":{\"robot\":1,\"vx\":0.1,\"vy\":-0.0,\"vtheta\":3.0}}\n");
}

TEST_F(Verbs, EncodeNamesEveryProblemOfABadLineAndStillPrintsTheGoodOnes) {
  const Output result = run("encode roboteam-rem-v8 REM_RobotCommand",
                            "{\"rho\": 1}\n"
                            "{\"rho\": 40, \"tohRobotId\": 3, \"doKick\": \"yes\", \"toRobotId\": 16}\n"
                            "not json\n"
                            "\n"
                            "[1, 2]\n"
                            "{\"rho\": 2, \"remVersion\": 5}\n"
                            "{\"rho\": 3}\n");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(lines_of(result.out).size(), 2u);
  for (const char* problem :
       {"line 2: field 'rho': 40 is not allowed; allowed: 0 to 30 m/s",
        "line 2: field 'tohRobotId': REM_RobotCommand has no such field; did you mean 'toRobotId'?",
        "line 2: field 'doKick': \"yes\" is not allowed; allowed: a whole number, 0 to 1",
        "line 2: field 'toRobotId': 16 is not allowed; allowed: a whole number, 0 to 15",
        "line 3: not JSON: not json", "line 5: not a JSON object: [1,2]",
        "line 6: field 'remVersion': 5 is not allowed; allowed: 8"}) {
    EXPECT_NE(result.err.find(problem), std::string::npos) << problem << "\n" << result.err;
  }
  EXPECT_EQ(lines_of(result.err).size(), 7u) << result.err;
}

TEST_F(Verbs, EncodeRefusesNumbersThatNoFloat32Holds) {
  const Output result = run("encode ulaval-hermes SPEED_MOVE",
                            "{\"vx\": 1e300}\n{\"vx\": 1e999}\n{\"vx\": NaN}\n{\"vx\": null}\n");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(lines_of(result.err).size(), 4u) << result.err;
  EXPECT_NE(result.err.find("line 1: field 'vx': 1e+300 is not allowed; allowed: any finite float32 m/s"),
            std::string::npos)
      << result.err;
}

TEST_F(Verbs, EncodeTellsOfAFieldThatMayNotBeLeftOut) {
  const Output result = run("encode roboteam-rem-v8 REM_RobotFeedback", "{}\n");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("field 'batteryLevel': missing; allowed: 15 to 30 V"), std::string::npos)
      << result.err;
}

TEST_F(Verbs, EncodeTakesArraysOfTheRightLengthOnly) {
  const Output result = run("encode ulaval-hermes OPEN_LOOP_COMMAND", "{\"cmd\": [1, 2, 3]}\n{\"cmd\": 1}\n");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("line 1: field 'cmd': [1,2,3] is not allowed; allowed: an array of 4 numbers"),
            std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find("line 2: field 'cmd'"), std::string::npos) << result.err;
}

TEST_F(Verbs, DecodeNamesCauseAndFieldOfARefusedFrame) {
  const Output result =
      run("decode roboteam-rem-v8",
          "2180 \n21000050000000000000 0b\n210000800000000000000c\n21:00:00:80:00:00:00:00:00:00:0B\n");
  EXPECT_EQ(result.exit_code, 0);
  const auto lines = lines_of(result.out);
  ASSERT_EQ(lines.size(), 4u) << result.out;
  EXPECT_EQ(lines[0], "{\"error\":\"too short\"}");
  EXPECT_EQ(lines[1], "{\"error\":\"version\",\"field\":\"remVersion\"}");
  EXPECT_EQ(lines[2], "{\"error\":\"length\",\"field\":\"payloadSize\"}");
  EXPECT_EQ(json::parse(lines[3]).at("packet"), "REM_Packet");
}

TEST_F(Verbs, DecodeTellsOfALineThatIsNoHex) {
  const Output result = run("decode ulaval-hermes", "0301fe0102ff00\nxyz\n030\n");
  EXPECT_EQ(result.exit_code, 2);
  const auto lines = lines_of(result.out);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(json::parse(lines[0]).at("packet"), "PING_REQUEST");
  EXPECT_EQ(lines[1], "{\"error\":\"not hex\"}");
  EXPECT_EQ(lines[2], "{\"error\":\"not hex\"}");
  EXPECT_NE(result.err.find("line 2: not hex"), std::string::npos);
}

TEST_F(Verbs, UnknownFormatsAndPacketsAreExplained) {
  for (const std::string arguments :
       {"encode ulaval-hermez PING_REQUEST", "decode ulaval-hermez", "formats ulaval-hermez"}) {
    const Output result = run(arguments, "");
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find("did you mean 'ulaval-hermes'?"), std::string::npos) << result.err;
  }
  const Output result = run("encode ulaval-hermes SPEEDMOVE", "");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("did you mean 'SPEED_MOVE'?"), std::string::npos) << result.err;
}

TEST_F(Verbs, FormatsListsAllAndPrintsWhatWasAskedFor) {
  const Output list = run("formats", "");
  EXPECT_EQ(list.exit_code, 0);
  for (const RadioFormat* format : radio_formats()) {
    const std::string id(format->id);
    EXPECT_NE(list.out.find(id), std::string::npos);
    EXPECT_EQ(run("formats " + id, "").out, emit_markdown(*format));
    EXPECT_EQ(run("formats " + id + " --wireshark", "").out, emit_wireshark(*format));
    EXPECT_EQ(run("formats " + id + " --c-header", "").out, emit_c_header(*format));
  }
  EXPECT_EQ(run("formats --wireshark", "").exit_code, 2);
}

// Every format that tables alone can say, from its own file: encode, decode and formats print the very same.
TEST_F(Verbs, AFormatFromItsFileIsTheFormat) {
  int formats = 0;
  for (const RadioFormat* format : radio_formats()) {
    const std::string id(format->id);
    const Output file = run("formats " + id + " --toml", "");
    if (!format->own_codec.empty()) {
      EXPECT_EQ(file.exit_code, 2) << id;
      EXPECT_NE(
          file.err.find(id + ": its codec is more than its tables: it " + std::string(format->own_codec)),
          std::string::npos)
          << file.err;
      continue;
    }
    ++formats;
    const std::string path = (folder_ / (id + ".toml")).string();
    std::ofstream(path, std::ios::binary) << file.out;
    const std::string by_file = " --format '" + path + "' ";
    for (const char* what : {"", "--wireshark", "--c-header", "--toml"}) {
      EXPECT_EQ(run("formats" + by_file + what, "").out, run("formats " + id + " " + what, "").out)
          << id << what;
    }
    std::string hex = "zz\n00\n";
    std::map<std::string, std::string> given;
    for (const GoldenPacket& packet : golden_packets()) {
      if (packet.format != format) continue;
      hex += to_hex(packet.frame) + "\n" + to_hex(packet.frame) + "00\n";
      given[std::string(packet.message->name)] += packet.given.dump() + "\n{\"no such field\": 1}\n[]\n";
    }
    const auto expect_same = [&](const std::string& verb, const std::string& word, const std::string& input) {
      const Output by_id = run(verb + " " + id + word, input), by_table = run(verb + by_file + word, input);
      EXPECT_EQ(by_table.out, by_id.out) << id;
      EXPECT_EQ(by_table.err, by_id.err) << id;
      EXPECT_EQ(by_table.exit_code, by_id.exit_code) << id;
    };
    expect_same("decode", "", hex);
    for (const auto& [packet, lines] : given) expect_same("encode", " " + packet, lines);
  }
  EXPECT_EQ(formats, static_cast<int>(radio_formats().size()));
}

TEST_F(Verbs, WhatIsSpokenInsideARobotIsNoRadioAndOnlyCanFormatsAreDbcFiles) {
  const Output served = run("serve --radio thunderbots-spi", "");
  EXPECT_EQ(served.exit_code, 2);
  EXPECT_NE(served.err.find("thunderbots-spi is spoken between boards of a robot"), std::string::npos)
      << served.err;
  EXPECT_EQ(run("formats odrive-can --dbc", "").out, emit_dbc(*find_radio_format("odrive-can")));
  const Output radio = run("formats ulaval-hermes --dbc", "");
  EXPECT_EQ(radio.exit_code, 2);
  EXPECT_EQ(radio.out, "");
}

TEST_F(Verbs, AFaultyFormatFileIsNamedByLineAndNothingIsDone) {
  const std::string path = (folder_ / "x.toml").string();
  std::ofstream(path) << "format = \"omnihil-radio/1\"\nid = \"x\"\ntitle = \"X\"\nframing = \"slip\"\n";
  for (const std::string verb : {"encode", "decode", "formats", "serve"}) {
    const Output result = run(verb + " --format '" + path + "'" + (verb == "encode" ? " GO" : ""), "");
    EXPECT_EQ(result.exit_code, 2) << verb;
    EXPECT_NE(result.err.find("x.toml:4:11: framing = \"slip\": is not allowed here"), std::string::npos)
        << verb << ": " << result.err;
    EXPECT_EQ(result.out, "") << verb;
  }
  EXPECT_EQ(run("encode", "").exit_code, 2);
  EXPECT_EQ(run("decode", "").exit_code, 2);
  EXPECT_EQ(run("encode ulaval-hermes", "").exit_code, 2);
  EXPECT_EQ(run("serve --radio ulaval-hermes --format '" + path + "'", "").exit_code, 2);
}

TEST_F(Verbs, WiresListsEveryKindWithItsParameters) {
  const Output list = run("wires", "");
  EXPECT_EQ(list.exit_code, 0);
  for (const WireKind* kind : wire_kinds()) {
    EXPECT_NE(list.out.find(kind->example), std::string::npos) << list.out;
    EXPECT_NE(list.out.find(kind->says), std::string::npos) << list.out;
    for (const WireParameter& parameter : kind->parameters)
      EXPECT_NE(list.out.find(parameter.allowed()), std::string::npos) << list.out;
  }
}

// What decode prints of a packet against what the team's decoder says.
void expect_fields(const json& fields, const json& expected, const std::string& name) {
  if (expected.is_object()) {
    for (const auto& [key, value] : expected.items()) expect_fields(fields.at(key), value, name + "." + key);
  } else if (expected.is_array()) {
    for (std::size_t i = 0; i < expected.size(); ++i) expect_fields(fields.at(i), expected[i], name);
  } else if (expected.is_boolean() || fields.is_boolean() || expected.is_null() || fields.is_null()) {
    EXPECT_EQ(fields, expected) << name;
  } else {
    EXPECT_EQ(fields.get<float>(), expected.get<float>()) << name;
  }
}

TEST_F(Verbs, EveryFormatAgreesWithItsTeamsVectors) {
  if (shared_folder().empty()) GTEST_SKIP() << "OMNIHIL_SHARED does not name the folder of reference data";
  for (const TeamFile& file : team_files()) {
    std::map<std::string, std::pair<std::string, std::string>> by_packet;  // lines in, hex out
    std::string all_hex;
    const std::vector<TeamRow> rows = team_rows(file);
    for (const TeamRow& row : rows) {
      all_hex += row.hex + "\n";
      const std::string name = row.packets.empty() ? "" : row.packets[0].name;
      if (name.empty()) continue;
      json list;
      for (const TeamPacket& packet : row.packets) list.push_back(packet.given);
      auto& [given, hex] = by_packet[name];
      given += (row.packets.size() == 1 ? row.packets[0].given : list).dump() + "\n";
      hex += row.hex + "\n";
    }
    for (const auto& [name, lines] : by_packet) {
      const Output encoded = run("encode " + file.format + " " + name, lines.first);
      EXPECT_EQ(encoded.out, lines.second) << file.format << " " << name << "\n"
                                           << encoded.err.substr(0, 300);
    }
    const auto decoded = lines_of(run("decode " + file.format, all_hex).out);
    ASSERT_EQ(decoded.size(), rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const json line = json::parse(decoded[i]);
      for (std::size_t k = 0; k < rows[i].packets.size(); ++k) {
        const json& packet = rows[i].packets.size() == 1 ? line : line.at("packets").at(k);
        EXPECT_EQ(packet.value("packet", ""), rows[i].packets[k].name) << decoded[i];
        if (packet.contains("fields")) {
          expect_fields(packet.at("fields"), rows[i].packets[k].decoded, file.format + " " + rows[i].hex);
        }
      }
    }
  }
}

TEST_F(Verbs, EncodeAndDecodeAgreeWithTheTeamsVectors) {
  const std::string shared = shared_folder();
  if (shared.empty()) GTEST_SKIP() << "OMNIHIL_SHARED does not name the folder of reference data";
  const json file = read_json(shared + "/vectors/roboteam-rem-v8.json");
  for (const auto& [name, packet] : file.at("packets").items()) {
    std::string given;
    std::string hex;
    for (const json& row : packet.at("vectors")) {
      given += row.at("in").dump() + "\n";
      hex += row.at("hex").get<std::string>() + "\n";
    }
    EXPECT_EQ(run("encode roboteam-rem-v8 " + name, given).out, hex) << name;
    const auto lines = lines_of(run("decode roboteam-rem-v8", hex).out);
    ASSERT_EQ(lines.size(), packet.at("vectors").size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const json fields = json::parse(lines[i]).at("fields");
      const json& expected = packet.at("vectors")[i].at("decoded");
      ASSERT_EQ(fields.size(), expected.size());
      for (const auto& [field, value] : expected.items()) {
        EXPECT_EQ(fields.at(field).get<float>(), value.get<float>()) << name << "." << field;
        if (value.is_number_integer()) {
          EXPECT_EQ(fields.at(field), value) << name << "." << field;
        }
      }
    }
  }
}

}  // namespace
}  // namespace omnihil

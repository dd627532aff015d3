// Packets made by the teams' own programs, from the folder of reference data.
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <set>

#include "protocols/codec.h"
#include "protocols/packet_list.h"
#include "tests/protocols/team_vectors.h"

namespace omnihil {
namespace {

using nlohmann::json;

#define SKIP_WITHOUT_SHARED()                 \
  const std::string shared = shared_folder(); \
  if (shared.empty()) GTEST_SKIP() << "OMNIHIL_SHARED does not name the folder of reference data"

bool same_float32(double a, double b) { return static_cast<float>(a) == static_cast<float>(b); }

// A decoded field, or the fields below an array or object, against what the team's decoder says of it.
void expect_value(const Values& values, const std::string& name, const json& expected) {
  if (expected.is_array()) {
    for (std::size_t i = 0; i < expected.size(); ++i) {
      expect_value(values, name + "[" + std::to_string(i) + "]", expected[i]);
    }
    return;
  }
  if (expected.is_object()) {
    for (const auto& [key, each] : expected.items()) expect_value(values, name + "." + key, each);
    return;
  }
  const int index = values.message->field_index(name);
  ASSERT_GE(index, 0) << values.message->name << " has no field " << name;
  const Field& field = values.message->fields[static_cast<std::size_t>(index)];
  const Value& value = values.fields[static_cast<std::size_t>(index)];
  const bool is_whole = field.kind != FieldKind::kFloat32 && field.kind != FieldKind::kRanged32 &&
                        field.kind != FieldKind::kScaled;
  if (expected.is_null()) {
    EXPECT_TRUE(std::isnan(value.number)) << name;
  } else if (expected.is_boolean()) {
    EXPECT_EQ(value.raw != 0, expected.get<bool>()) << name;
  } else if (is_whole && field.sign != Sign::kNone) {
    EXPECT_EQ(integer_of(field, value.raw), expected.get<std::int64_t>())
        << values.message->name << "." << name;
  } else if (is_whole && expected.is_number_integer()) {
    EXPECT_EQ(value.raw, expected.get<std::uint64_t>()) << values.message->name << "." << name;
  } else {
    EXPECT_TRUE(same_float32(value.number, expected.get<double>()))
        << values.message->name << "." << name << ": " << value.number << " instead of " << expected;
  }
}

void expect_both_ways(const RadioFormat& format, const std::string& packet, const json& given,
                      const json& decoded, const std::string& hex) {
  const Message* message = format.find(packet);
  ASSERT_NE(message, nullptr) << packet;
  std::string text;
  Bytes frame;
  const auto encoded = format.encode(values_from_json(*message, given, text), frame);
  EXPECT_EQ(encoded.error, PacketError::kNone) << packet << " field " << encoded.field;
  EXPECT_EQ(to_hex(frame), hex) << packet << " " << given;
  const DecodeResult result = format.decode(from_hex(hex));
  ASSERT_EQ(result.error, PacketError::kNone) << packet << " field " << result.field;
  EXPECT_EQ(result.values.message, message);
  for (const auto& [name, value] : decoded.items()) expect_value(result.values, name, value);
}

// All fields that people see are named in the team's own packet, and the reverse.
void expect_same_names(const Message& message, const json& decoded) {
  for (const Field& field : message.fields) {
    const std::string key(field.name.substr(0, field.name.find('[')));
    EXPECT_EQ(decoded.contains(key), !field.envelope) << message.name << "." << key;
  }
}

int check_rem(const std::string& id) {
  const RadioFormat& format = *find_radio_format(id);
  const json file = read_json(shared_folder() + "/vectors/" + id + ".json");
  int rows = 0;
  EXPECT_EQ(file.at("packets").size(), format.messages.size());
  for (const auto& [name, packet] : file.at("packets").items()) {
    const Message* message = format.find(name);
    if (message == nullptr) {
      ADD_FAILURE() << name;
      continue;
    }
    EXPECT_EQ(message->type, packet.at("type").get<std::uint32_t>()) << name;
    EXPECT_EQ(message->size_bytes, packet.at("size").get<int>()) << name;
    expect_same_names(*message, packet.at("vectors").at(0).at("decoded"));
    for (const json& row : packet.at("vectors")) {
      expect_both_ways(format, name, row.at("in"), row.at("decoded"), row.at("hex").get<std::string>());
      ++rows;
    }
  }
  return rows;
}

// A frame with all that it lists.
void expect_row_both_ways(const RadioFormat& format, const TeamRow& row) {
  SCOPED_TRACE(std::string(format.id) + " " + row.hex);
  const Bytes frame = from_hex(row.hex);
  ASSERT_EQ(listed_packets(format, frame), row.packets.size());
  std::vector<Values> values, again;
  std::string text;
  for (std::size_t i = 0; i < row.packets.size(); ++i) {
    const Message* message = format.find(row.packets[i].name);
    ASSERT_NE(message, nullptr) << row.packets[i].name;
    values.push_back(values_from_json(*message, row.packets[i].given, text));
    const DecodeResult result = decode_listed(format, frame, i);
    ASSERT_EQ(result.error, PacketError::kNone) << result.field;
    EXPECT_EQ(result.values.message, message);
    for (const auto& [name, value] : row.packets[i].decoded.items()) expect_value(result.values, name, value);
    again.push_back(result.values);
  }
  for (const std::vector<Values>* packets : {&values, &again}) {
    Bytes out;
    const auto encoded = encode_list(format, *packets, out);
    EXPECT_EQ(encoded.error, PacketError::kNone) << encoded.field;
    EXPECT_EQ(to_hex(out), row.hex);
  }
}

TEST(TeamVectors, EveryRowBothWays) {
  SKIP_WITHOUT_SHARED();
  for (const TeamFile& file : team_files()) {
    const RadioFormat* format = find_radio_format(file.format);
    ASSERT_NE(format, nullptr) << file.format;
    const std::vector<TeamRow> rows = team_rows(file);
    for (const TeamRow& row : rows) expect_row_both_ways(*format, row);
    EXPECT_EQ(rows.size(), file.rows) << file.format;
    std::printf("%s: %zu packets both ways\n", file.format.c_str(), rows.size());
  }
}

// What the unmodified firmware of a wheel answered while it drove a simulated motor: the structs of its wire.
TEST(TeamVectors, RepliesOfAteamsWheelFirmwareDecodeAndComeBack) {
  SKIP_WITHOUT_SHARED();
  const RadioFormat& format = *find_radio_format("ateam-rnp-stspin-2025");
  const json file = read_json(shared + "/vectors/ateam-wheel-firmware-io.json");
  std::set<double> set_points;
  int motion = 0, params = 0, settled = 0;
  for (const json& row : file.at("closed_loop").at("frames")) {
    const Bytes frame = from_hex(row.at(1).get<std::string>());
    ASSERT_TRUE(survives_round_trip(format, frame)) << row;
    const Values values = format.decode(frame).values;
    if (values.message->name == "uart_motor_response_motion") {
      set_points.insert(values.number("vel_setpoint"));
      // In the last half second at 100 rad/s the unfiltered speed is the filtered one; as counts it would be 3 times.
      const double at_s = std::stod(row.at(0).get<std::string>());
      if (at_s > 0.7 && at_s < 1.2) {
        const double omega_rad_s = values.number("vel_enc_estimate");
        EXPECT_NEAR(values.number("encoder_delta"), omega_rad_s, 0.05 * omega_rad_s) << row;
        ++settled;
      }
      ++motion;
    } else {
      EXPECT_EQ(values.message->name, "uart_motor_response_params");
      EXPECT_EQ(values.number("version[1]"), 1.0);
      EXPECT_EQ(values.number("vel_pid_imax[0]"), 5.5);
      ++params;
    }
  }
  EXPECT_EQ(set_points, (std::set<double>{-200.0, 0.0, 100.0}));
  EXPECT_EQ(motion, 394);
  EXPECT_GT(settled, 50);
  EXPECT_EQ(params, 1);
}

// What went in and out of the unmodified firmware of ibis' motor boards: frames of its CAN bus.
TEST(TeamVectors, FramesOfIbisMotorBoardsDecodeAndComeBack) {
  SKIP_WITHOUT_SHARED();
  const RadioFormat& format = *find_radio_format("ibis-orion-can");
  const json file = read_json(shared + "/vectors/ibis-f303-firmware-io.json");
  std::map<std::string, int> seen;
  const auto check = [&](const json& said) {
    const Bytes data = from_hex(said.at("data"));
    Bytes frame(16);
    const auto id = said.at("id").get<std::uint32_t>();
    for (std::size_t i = 0; i < 4; ++i) frame[i] = static_cast<std::uint8_t>(id >> 8 * i);
    frame[4] = static_cast<std::uint8_t>(data.size());
    std::copy(data.begin(), data.end(), frame.begin() + 8);
    ASSERT_TRUE(survives_round_trip(format, frame)) << said;
    const Values values = format.decode(frame).values;
    float first = 0.0F;
    std::memcpy(&first, data.data(), sizeof first);
    const std::string name(values.message->name);
    if (name == "set_speed" || name == "motor_state") {
      EXPECT_EQ(values.number("motor"), id & 3u);
      EXPECT_TRUE(same_float32(values.number("speed"), first)) << said;
    }
    ++seen[name];
  };
  int rows = 0;
  for (const json& row : file.at("rows")) {
    for (const char* way : {"can_in", "can_out"}) {
      for (const json& said : row.at(way)) check(said), ++rows;
    }
    const json& speeds = row.at("cmd_rps");
    EXPECT_EQ(row.at("can_in").size(), speeds.size());
  }
  for (const json& said : file.at("telemetry").at("frames")) check(said), ++rows;
  EXPECT_EQ(rows, 32 * 4 + 27);
  EXPECT_EQ(seen["set_speed"], 64);
  for (const char* name :
       {"motor_state", "motor_battery", "motor_temperature", "motor_current", "motor_constant"})
    EXPECT_GT(seen[name], 0) << name;
  std::printf("ibis-orion-can: %d frames both ways\n", rows);
}

// Each file of the folder goes both ways in one of these tests, and each loader reads one that is there.
TEST(TeamVectors, NoFileOfTheFolderIsForgotten) {
  SKIP_WITHOUT_SHARED();
  // By the tests of their own above and below.
  std::set<std::string> gone_through{"roboteam-rem-v8.json",         "roboteam-rem-v5.json",
                                     "ulaval-hermes.json",           "ulaval-strategyai-host-stream.json",
                                     "ateam-wheel-firmware-io.json", "ibis-f303-firmware-io.json"};
  for (const TeamFile& file : team_files()) {
    file.load([&](const char* name) {
      gone_through.insert(name);
      return read_json(shared + "/vectors/" + name);
    });
  }
  std::set<std::string> there;
  for (const auto& entry : std::filesystem::directory_iterator(shared + "/vectors")) {
    if (entry.path().extension() == ".json") there.insert(entry.path().filename());
  }
  EXPECT_EQ(there, gone_through);
}

TEST(TeamVectors, RemV8BothWays) {
  SKIP_WITHOUT_SHARED();
  const int rows = check_rem("roboteam-rem-v8");
  EXPECT_EQ(rows, 17 * 12);
  std::printf("roboteam-rem-v8: %d packets both ways\n", rows);
}

TEST(TeamVectors, RemV5BothWays) {
  SKIP_WITHOUT_SHARED();
  const int rows = check_rem("roboteam-rem-v5");
  EXPECT_EQ(rows, 16 * 12);
  std::printf("roboteam-rem-v5: %d packets both ways\n", rows);
}

TEST(TeamVectors, HermesBothWays) {
  SKIP_WITHOUT_SHARED();
  const RadioFormat& format = *find_radio_format("ulaval-hermes");
  const json file = read_json(shared + "/vectors/ulaval-hermes.json");
  int rows = 0;
  for (const json& row : file.at("vectors")) {
    const std::string packet = row.at("type").get<std::string>();
    expect_both_ways(format, packet, row.at("in"), row.at("in"), row.at("wire").get<std::string>());
    expect_same_names(*format.find(packet), row.at("in"));
    ++rows;
  }
  EXPECT_EQ(rows, 93);
  std::printf("ulaval-hermes: %d packets both ways\n", rows);
}

TEST(TeamVectors, HermesBadFramesAreRefusedWithTheirCause) {
  SKIP_WITHOUT_SHARED();
  const RadioFormat& format = *find_radio_format("ulaval-hermes");
  const json file = read_json(shared + "/vectors/ulaval-hermes.json");
  std::map<std::string, PacketError> expected{{"robot_reply_ok", PacketError::kNone},
                                              {"bad_version", PacketError::kVersion},
                                              {"other_destination", PacketError::kAddress}};
  for (const json& row : file.at("negative")) {
    const std::string name = row.at("name").get<std::string>();
    ASSERT_TRUE(expected.contains(name)) << name;
    EXPECT_EQ(format.decode(from_hex(row.at("wire").get<std::string>())).error, expected.at(name)) << name;
  }
}

TEST(TeamVectors, TheRealHostsStreamDecodesWithoutOneRefusal) {
  SKIP_WITHOUT_SHARED();
  const RadioFormat& format = *find_radio_format("ulaval-hermes");
  const json file = read_json(shared + "/vectors/ulaval-strategyai-host-stream.json");
  PacketCounts counts;
  for (const json& row : file.at("sessions").at("lineup")) {
    const Bytes frame = from_hex(row.at(1).get<std::string>());
    const DecodeResult result = format.decode(frame);
    counts.count(result.error);
    ASSERT_EQ(result.error, PacketError::kNone) << to_hex(frame);
    EXPECT_EQ(result.values.message->name, "SPEED_MOVE_ADVANCE");
    EXPECT_LE(result.values.number("robot"), 5.0);
    EXPECT_TRUE(survives_round_trip(format, frame));
  }
  EXPECT_EQ(counts.good, 1035u);
  EXPECT_EQ(counts.refused(), 0u);
  std::printf("host stream: %llu frames good, %llu refused\n", static_cast<unsigned long long>(counts.good),
              static_cast<unsigned long long>(counts.refused()));
}

}  // namespace
}  // namespace omnihil

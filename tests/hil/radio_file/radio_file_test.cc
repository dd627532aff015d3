// Formats out into files and back: the same bytes, refusals, pages and dongle; what tables cannot say is said.
#include "hil/radio_file/radio_file.h"

#include <cmath>
#include <map>
#include <random>
#include <set>

#include "protocols/emit/emit.h"
#include "protocols/packet_list.h"
#include "tests/protocols/dongles/links_harness.h"
#include "tests/protocols/team_vectors.h"

namespace omnihil {
namespace {

// A built-in format, written into a file's text and read again.
const RadioFormat& reloaded(const RadioFormat& format) {
  static std::map<std::string_view, const RadioFormat*> known;
  const RadioFormat*& again = known[format.id];
  if (again != nullptr) return *again;
  const RadioFile file = read_radio_file(emit_toml(format), std::string(format.id) + ".toml");
  for (const ModelProblem& problem : file.problems) ADD_FAILURE() << problem.text();
  EXPECT_NE(file.format, nullptr) << format.id;
  again = file.format == nullptr ? &format : file.format;
  return *again;
}

std::vector<const RadioFormat*> of_tables_alone() {
  std::vector<const RadioFormat*> formats;
  for (const RadioFormat* format : radio_formats()) {
    if (no_toml_reason(*format).empty()) formats.push_back(format);
  }
  return formats;
}

bool same_number(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

// What one of them says of a frame the other says, too.
void expect_same_decoding(const RadioFormat& a, const RadioFormat& b, const Bytes& frame) {
  ASSERT_EQ(listed_packets(a, frame), listed_packets(b, frame)) << to_hex(frame);
  for (std::size_t i = 0; i < listed_packets(a, frame).value_or(1); ++i) {
    const DecodeResult x = decode_listed(a, frame, i), y = decode_listed(b, frame, i);
    ASSERT_EQ(x.error, y.error) << a.id << " " << to_hex(frame);
    EXPECT_EQ(x.field, y.field) << a.id << " " << to_hex(frame);
    if (x.error != PacketError::kNone) continue;
    ASSERT_EQ(x.values.message->name, y.values.message->name);
    for (std::size_t f = 0; f < x.values.message->fields.size(); ++f) {
      EXPECT_EQ(x.values.fields[f].raw, y.values.fields[f].raw);
      EXPECT_TRUE(same_number(x.values.fields[f].number, y.values.fields[f].number));
    }
  }
}

TEST(RadioFile, TablesSayAllOfEveryBuiltInFormat) {
  for (const RadioFormat* format : radio_formats()) EXPECT_EQ(no_toml_reason(*format), "") << format->id;
  EXPECT_GE(radio_formats().size(), 17u);
}

// What code adds to its tables is named; here a format that says that it does.
TEST(RadioFile, AFormatWhoseCodecIsMoreThanItsTablesIsNamedWithTheReason) {
  RadioFormat format = *find_radio_format("rocos-serial-25");
  format.own_codec = "does more";
  EXPECT_EQ(no_toml_reason(format), "its codec is more than its tables: it does more");
}

TEST(RadioFile, PagesDissectorsHeadersAndTheFileItselfComeBackAsTheyWere) {
  for (const RadioFormat* format : of_tables_alone()) {
    const RadioFormat& again = reloaded(*format);
    EXPECT_EQ(emit_markdown(again), emit_markdown(*format)) << format->id;
    EXPECT_EQ(emit_wireshark(again), emit_wireshark(*format)) << format->id;
    EXPECT_EQ(emit_c_header(again), emit_c_header(*format)) << format->id;
    EXPECT_EQ(emit_toml(again), emit_toml(*format)) << format->id;
    EXPECT_EQ(again.max_frame_bytes, format->max_frame_bytes) << format->id;
    EXPECT_EQ(again.command_drives, format->command_drives) << format->id;
  }
}

TEST(RadioFile, GoldenPacketsHaveTheSameBytesBothWays) {
  int packets = 0;
  for (const GoldenPacket& packet : golden_packets()) {
    if (!no_toml_reason(*packet.format).empty()) continue;
    const RadioFormat& again = reloaded(*packet.format);
    std::string text;
    Bytes frame;
    const Message* message = again.find(packet.message->name);
    ASSERT_NE(message, nullptr);
    ASSERT_EQ(again.encode(values_from_json(*message, packet.given, text), frame).error, PacketError::kNone);
    EXPECT_EQ(to_hex(frame), to_hex(packet.frame)) << again.id << " " << message->name;
    expect_same_decoding(*packet.format, again, packet.frame);
    EXPECT_TRUE(survives_round_trip(again, packet.frame));
    ++packets;
  }
  EXPECT_GT(packets, 80);
}

TEST(RadioFile, DamagedAndRandomFramesAreRefusedForTheSameCauseAndField) {
  std::mt19937_64 random(20260201);
  for (const GoldenPacket& packet : golden_packets()) {
    if (!no_toml_reason(*packet.format).empty()) continue;
    const RadioFormat& again = reloaded(*packet.format);
    for (std::size_t size = 0; size < packet.frame.size(); ++size)
      expect_same_decoding(
          *packet.format, again,
          Bytes(packet.frame.begin(), packet.frame.begin() + static_cast<std::ptrdiff_t>(size)));
    for (std::size_t bit = 0; bit < 8 * packet.frame.size(); ++bit) {
      Bytes frame = packet.frame;
      frame[bit / 8] = static_cast<std::uint8_t>(frame[bit / 8] ^ (1u << (bit % 8)));
      expect_same_decoding(*packet.format, again, frame);
    }
    for (int i = 0; i < 50; ++i) {
      Bytes frame = packet.frame;
      for (int k = 0; k < 3; ++k) frame[random() % frame.size()] = static_cast<std::uint8_t>(random());
      expect_same_decoding(*packet.format, again, frame);
    }
  }
}

TEST(RadioFile, TheTeamsOwnPacketsHaveTheSameBytesBothWays) {
  if (shared_folder().empty()) GTEST_SKIP() << "OMNIHIL_SHARED does not name the folder of reference data";
  std::map<std::string, std::size_t> rows;
  for (const TeamFile& file : team_files()) {
    const RadioFormat& format = *find_radio_format(file.format);
    if (!no_toml_reason(format).empty()) continue;
    const RadioFormat& again = reloaded(format);
    for (const TeamRow& row : team_rows(file)) {
      const Bytes frame = from_hex(row.hex);
      expect_same_decoding(format, again, frame);
      std::vector<Values> values;
      std::string text;
      for (const TeamPacket& packet : row.packets)
        values.push_back(values_from_json(*again.find(packet.name), packet.given, text));
      Bytes out;
      EXPECT_EQ(encode_list(again, values, out).error, PacketError::kNone) << row.hex;
      EXPECT_EQ(to_hex(out), row.hex);
      ++rows[file.format];
    }
    EXPECT_EQ(rows[file.format], file.rows);
    std::printf("%s by its file: %zu packets both ways\n", file.format.c_str(), rows[file.format]);
  }
  EXPECT_EQ(rows.size(), team_files().size());
}

// One command of each kind through both dongles: the same reaches the robot and the host.
TEST(RadioFile, TheDongleIsTheBuiltInOne) {
  for (const RadioFormat* format : of_tables_alone()) {
    if (!format->has_dongle()) continue;
    const RadioFormat& again = reloaded(*format);
    int said = 0;
    for (const std::uint32_t mode :
         {OMNIHIL_MODE_BODY_VELOCITY, OMNIHIL_MODE_WHEEL_SPEED, OMNIHIL_MODE_COAST}) {
      for (const unsigned flags : {0u, 1u, 3u}) {  // the robot's frame, the field's, with a heading
        RobotCommand command{};
        command.mode = mode, command.flags = flags;
        command.v_forward_m_s = 1.25, command.v_left_m_s = -0.5;
        Bytes bytes, same_bytes;
        const bool can = format->encode_command(command, {.robot_id = 5}, bytes);
        EXPECT_EQ(again.encode_command(command, {.robot_id = 5}, same_bytes), can);
        EXPECT_EQ(bytes, same_bytes);
        if (!can) continue;
        ++said;
        Bench a(*format, {.robot_ids = {5}}), b(again, {.robot_ids = {5}});
        for (Bench* bench : {&a, &b}) {
          bench->boot_robots();
          bench->step();
          bench->write(bytes);
          bench->run_to(20 * kMs);
        }
        EXPECT_TRUE(same(a.sink.heard, b.sink.heard)) << format->id;
        EXPECT_EQ(a.to_host, b.to_host) << format->id;
      }
    }
    EXPECT_GT(said, 0) << format->id;
  }
}

}  // namespace
}  // namespace omnihil

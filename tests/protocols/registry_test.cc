#include <algorithm>
#include <filesystem>
#include <set>

#include "protocols/emit/emit.h"
#include "tests/protocols/packet_util.h"

namespace omnihil {
namespace {

TEST(Registry, HoldsOneFormatPerFileSortedById) {
  std::vector<std::string> from_files;
  for (const auto& entry : std::filesystem::directory_iterator(OMNIHIL_SOURCE_DIR "/protocols/teams")) {
    if (entry.path().extension() != ".cc") continue;
    std::string id = entry.path().stem();
    std::replace(id.begin(), id.end(), '_', '-');
    from_files.push_back(id);
  }
  std::sort(from_files.begin(), from_files.end());
  std::vector<std::string> registered;
  for (const RadioFormat* format : radio_formats()) registered.emplace_back(format->id);
  EXPECT_EQ(registered, from_files);
  EXPECT_GE(registered.size(), 3u);
}

TEST(Registry, FindsFormatsAndPacketsByName) {
  for (const RadioFormat* format : radio_formats()) {
    EXPECT_EQ(find_radio_format(format->id), format);
    for (const Message& message : format->messages) EXPECT_EQ(format->find(message.name), &message);
    EXPECT_EQ(format->find("no such packet"), nullptr);
  }
  EXPECT_EQ(find_radio_format("no-such-format"), nullptr);
}

TEST(Registry, EveryFormatSaysWhatItIs) {
  for (const RadioFormat* format : radio_formats()) {
    EXPECT_FALSE(format->title.empty());
    EXPECT_NE(format->source.find("https://"), std::string_view::npos) << format->id;
    EXPECT_FALSE(format->notes.empty());
    // The tables are all of the codec, or it says what else there is.
    EXPECT_EQ(format->own_decode == nullptr, format->own_codec.empty()) << format->id;
    EXPECT_EQ(format->own_encode == nullptr, format->own_codec.empty()) << format->id;
    EXPECT_NE(format->encode_command, nullptr);
    // Packets between boards of a robot alone have no dongle, and no command.
    const bool inside = std::ranges::all_of(
        format->messages, [](const Message& each) { return each.direction == Direction::kInside; });
    EXPECT_EQ(format->command_drives == 0u, inside) << format->id;
    EXPECT_EQ(format->has_dongle(), !inside) << format->id;
    for (const Message& message : format->messages) {
      EXPECT_FALSE(message.what.empty()) << message.name;
      EXPECT_LE(message.size_bytes, format->max_frame_bytes) << message.name;
      for (const Field& field : message.fields) {
        EXPECT_FALSE(field.what.empty()) << message.name << "." << field.name;
        EXPECT_LE(field.lo, field.hi) << message.name << "." << field.name;
        if (field.kind == FieldKind::kRanged32) {
          EXPECT_LT(field.lo, field.hi) << field.name;
          EXPECT_LE(field.bits, 32) << field.name;
        }
        EXPECT_EQ(field.kind == FieldKind::kScaled, field.scale != nullptr)
            << message.name << "." << field.name;
        EXPECT_TRUE(field.kind != FieldKind::kScaled || field.lo < field.hi) << field.name;
        EXPECT_TRUE(field.check == nullptr || field.kind == FieldKind::kChecksum) << field.name;
        EXPECT_TRUE(field.sign == Sign::kNone || field.bits >= 2) << field.name;
      }
    }
  }
}

TEST(Registry, NamesAndTypesAreUniqueAndPacketsAreTiled) {
  for (const RadioFormat* format : radio_formats()) {
    std::set<std::string_view> names;
    std::set<std::uint32_t> types;
    EXPECT_TRUE(all_tiled(format->messages)) << format->id;
    for (const Message& message : format->messages) {
      EXPECT_TRUE(names.insert(message.name).second) << message.name;
      EXPECT_TRUE(types.insert(message.type).second) << message.name;
      std::set<std::string_view> fields;
      for (const Field& field : message.fields) {
        EXPECT_TRUE(fields.insert(field.name).second) << message.name << "." << field.name;
        EXPECT_EQ(message.field_index(field.name), &field - message.fields.data());
      }
      EXPECT_EQ(message.field_index("no such field"), -1);
    }
  }
}

TEST(Registry, TheLongestFrameIsTheStatedOne) {
  // HERMES: 21 bytes of OPEN_LOOP_COMMAND, one COBS code, the delimiter.
  EXPECT_EQ(find_radio_format("ulaval-hermes")->max_frame_bytes, 21 + 1 + 1);
  for (const GoldenPacket& packet : golden_packets()) {
    EXPECT_LE(packet.frame.size(), static_cast<std::size_t>(packet.format->max_frame_bytes));
  }
}

TEST(CHeader, DefinesEveryMacroOnce) {
  for (const RadioFormat* format : radio_formats()) {
    std::istringstream header(emit_c_header(*format));
    std::set<std::string> names;
    for (std::string line; std::getline(header, line);) {
      if (!line.starts_with("#define")) continue;
      const std::string name = line.substr(8, line.find(' ', 8) - 8);
      EXPECT_TRUE(names.insert(name).second) << name;
    }
    // The guard; type, length and bit order of a packet; place and width of a field, its constant, sign, scale.
    std::size_t expected = 1;
    for (const Message& message : format->messages) {
      expected += 3;
      for (const Field& field : message.fields) {
        if (field.tag != 0) {  // its number alone
          expected += 1;
          continue;
        }
        expected += field.kind == FieldKind::kConst ? 3 : 2;
        if (field.sign != Sign::kNone) expected += 1;
        if (field.kind == FieldKind::kScaled) expected += 2;
      }
    }
    EXPECT_EQ(names.size(), expected) << format->id;
  }
}

TEST(CHeader, HoldsThePlacesOfTheTable) {
  const std::string header = emit_c_header(*find_radio_format("ulaval-hermes"));
  for (const char* line : {"#define ULAVAL_HERMES_OPEN_LOOP_COMMAND_TYPE 0x04u\n",
                           "#define ULAVAL_HERMES_OPEN_LOOP_COMMAND_BYTES 21\n",
                           "#define ULAVAL_HERMES_OPEN_LOOP_COMMAND_CMD_2_BIT 104\n",
                           "#define ULAVAL_HERMES_OPEN_LOOP_COMMAND_CMD_2_BITS 32\n",
                           "#define ULAVAL_HERMES_SPEED_MOVE_SOURCE_CONST 0xFEu\n",
                           "#define ULAVAL_HERMES_SPEED_MOVE_ADVANCE_CHARGE_BIT 143\n"}) {
    EXPECT_NE(header.find(line), std::string::npos) << line;
  }
}

TEST(CHeader, MacroNamesAreCapitalsDigitsAndSingleUnderscores) {
  EXPECT_EQ(c_macro_name("cmd[2]"), "CMD_2");
  EXPECT_EQ(c_macro_name("roboteam-rem-v8"), "ROBOTEAM_REM_V8");
  EXPECT_EQ(c_macro_name("wheelController_1"), "WHEELCONTROLLER_1");
}

}  // namespace
}  // namespace omnihil

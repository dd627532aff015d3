// What a main board says to its wheels' boards, as tables of the board file.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <string>

#include "firmware_iface/mcu/stm32/can.h"
#include "tests/firmware_iface/mcu/board/boards_for_tests.h"
#include "tests/firmware_iface/mcu/board/dialects_for_tests.h"

namespace omnihil::mcu {
namespace {

const std::string kHead = kTwoMotorBoard + "[wheel_commands]\n";

// The dialect ibis-orion-can, as the docs have it in a board file.
const std::string kIbis = R"(via = "CAN1"
period_ms = 2

[[wheel_commands.frame]]
id = 0x100
bytes = 8

[[wheel_commands.frame.field]]
at = 0
type = "f32"
per_rad_s = 0.15915494309189535
)";

std::optional<BoardSpec> read(const std::string& rest, std::vector<BoardProblem>& problems) {
  return read_board(kHead + rest, "b.toml", problems);
}

WheelWords words_of(const std::string& rest) {
  std::vector<BoardProblem> problems;
  const auto spec = read(rest, problems);
  for (const BoardProblem& p : problems) ADD_FAILURE() << p.text();
  return spec ? spec->wheel_commands.words : WheelWords{};
}

std::vector<BusFrame> said(const WheelWords& words, const WordMoment& moment,
                           std::span<const double> speeds) {
  std::vector<BusFrame> frames;
  speak(words, moment, speeds, frames);
  return frames;
}

std::vector<std::uint8_t> bytes_of(const BusFrame& frame) {
  return {frame.bytes().begin(), frame.bytes().end()};
}

using Bytes = std::vector<std::uint8_t>;

TEST(WheelWords, TheTableOfTheDocsSaysWhatTheDialectSays) {
  const WheelWords words = words_of(kIbis), dialect = dialect_words("ibis-orion-can", 2);
  EXPECT_EQ(words.period_ns, 2'000'000);
  EXPECT_EQ(words.period_ns, dialect.period_ns);
  const std::array<double, 2> speeds{-37.3, 800.0};
  const auto ours = said(words, {1, 2, 0}, speeds), theirs = said(dialect, {1, 2, 0}, speeds);
  ASSERT_EQ(ours.size(), 2u);
  ASSERT_EQ(theirs.size(), 2u);
  for (std::size_t i = 0; i < ours.size(); ++i) {
    EXPECT_EQ(ours[i].id, 0x102 + i);
    EXPECT_EQ(theirs[i].id, ours[i].id);
    EXPECT_EQ(bytes_of(theirs[i]), bytes_of(ours[i]));
  }
}

// rpm in 16 bits, the most significant first, both wheels in one frame of a board: 1 rad/s is 60 / (2 pi) rpm.
TEST(WheelWords, AFrameForABoardHasEachWheelWhereItStandsAndEndsAtItsBounds) {
  const WheelWords words = words_of(R"(via = "CAN1"
period_ms = 5

[[wheel_commands.frame]]
each = "board"
id = 0x12340
extended = true
bytes = 6
field = [
  { at = 0, type = "i16", big_endian = true, per_rad_s = 9.549296585513721, wheel = 1 },
  { at = 2, type = "i16", per_rad_s = 9.549296585513721, wheel = 0 },
  { at = 5, type = "u8", value = 7 },
]
)");
  const std::array<double, 2> speeds{-10.0, 1e6};  // -95.49 rpm is -95
  const auto frames = said(words, {1, 2, 0}, speeds);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].id, 0x12341u);
  EXPECT_TRUE(frames[0].extended);
  EXPECT_EQ(bytes_of(frames[0]), (Bytes{0x7F, 0xFF, 0xA1, 0xFF, 0, 7}));
}

WheelWords one_frame(const std::string& keys) {
  return words_of("via = \"CAN1\"\nperiod_ms = 2\nframe = [{ id = 1, each = \"board\", " + keys + " }]\n");
}
constexpr std::array<double, 2> kStill{};

// 13 to 15 and round again; every second period from 4 ms on, so that n = (t - 4 ms) / 4 ms.
TEST(WheelWords, ACounterGoesRoundWithTheTime) {
  const WheelWords words = one_frame(R"(bytes = 2, every_ms = 4, from_ms = 4, until_ms = 20, field = [
             { at = 0, type = "u8", shift = 4, counter = { first = 13, last = 15, step = 2 } },
             { at = 0, type = "u8", bits = 4, value = 0xA },
             { at = 1, type = "u8", counter = {} }])");
  std::vector<Bytes> heard;
  for (std::int64_t t_ms = 0; t_ms < 30; t_ms += 2) {
    for (const BusFrame& frame : said(words, {0, 0, t_ms * 1'000'000}, kStill))
      heard.push_back(bytes_of(frame));
  }
  // 13, 13 + 2, then 4 more is 17: one round of three less, 14.
  EXPECT_EQ(heard, (std::vector<Bytes>{{0xDA, 0}, {0xFA, 1}, {0xEA, 2}, {0xDA, 3}}));
}

TEST(WheelWords, ACounterOfOneByteIsZeroAfter256Frames) {
  const WheelWords words = one_frame("bytes = 3, field = [{ at = 1, type = \"u8\", counter = {} }]");
  EXPECT_EQ(bytes_of(said(words, {0, 0, 2'000'000LL * 255}, kStill).at(0)), (Bytes{0, 0xFF, 0}));
  EXPECT_EQ(bytes_of(said(words, {0, 0, 2'000'000LL * 256}, kStill).at(0)), (Bytes{0, 0, 0}));
}

// The check values of the catalogue of CRCs are those of the digits "123456789".
TEST(WheelWords, ChecksumsAreThoseOfTheCatalogue) {
  const auto last_bytes = [](const std::string& type, const std::string& checksum, int bytes) {
    std::string fields;
    for (int i = 0; i < 9; ++i)
      fields +=
          "{ at = " + std::to_string(i) + ", type = \"u8\", value = " + std::to_string('1' + i) + " }, ";
    const WheelWords words =
        words_of("via = \"USART1\"\nperiod_ms = 2\nframe = [{ bytes = " + std::to_string(9 + bytes) +
                 ", each = \"board\", field = [" + fields + "{ at = 9, " + type + ", checksum = { " +
                 checksum + " } }] }]\n");
    const auto frames = said(words, {}, kStill);
    EXPECT_EQ(frames.size(), 1u) << checksum;
    if (frames.size() != 1) return Bytes{};
    const Bytes all = bytes_of(frames[0]);
    return Bytes{all.begin() + 9, all.end()};
  };
  const std::string u8 = "type = \"u8\"", u16 = "type = \"u16\"", high_first = u16 + ", big_endian = true",
                    u32 = "type = \"u32\"";
  EXPECT_EQ(last_bytes(u8, "kind = \"sum\"", 1), (Bytes{0xDD}));  // 9 x 0x35 = 477 = 0x1DD
  EXPECT_EQ(last_bytes(u16, "kind = \"sum\"", 2), (Bytes{0xDD, 0x01}));
  EXPECT_EQ(last_bytes(u8, "kind = \"sum\", xor_out = 0xFF", 1), (Bytes{0x22}));  // its complement
  EXPECT_EQ(last_bytes(u8, "kind = \"sum\", start = 2, over = [0, 1]", 1), (Bytes{'1' + '2' + 2}));
  EXPECT_EQ(last_bytes(u8, "kind = \"xor\"", 1), (Bytes{0x31}));  // 1 ^ 2 ^ … ^ 9 = 1, nine times 0x30
  EXPECT_EQ(last_bytes(high_first, "kind = \"crc\", polynomial = 0x1021", 2), (Bytes{0x31, 0xC3}));
  EXPECT_EQ(last_bytes(u16, "kind = \"crc16-xmodem\"", 2), (Bytes{0xC3, 0x31}));
  // CRC-16/MODBUS, CRC-8/SMBUS, CRC-16/GENIBUS, CRC-32/ISO-HDLC, CRC-24/OPENPGP
  EXPECT_EQ(last_bytes(u16, "kind = \"crc\", polynomial = 0x8005, start = 0xFFFF, reflected = true", 2),
            (Bytes{0x37, 0x4B}));
  EXPECT_EQ(last_bytes(u8, "kind = \"crc\", polynomial = 0x07", 1), (Bytes{0xF4}));
  EXPECT_EQ(
      last_bytes(high_first, "kind = \"crc\", polynomial = 0x1021, start = 0xFFFF, xor_out = 0xFFFF", 2),
      (Bytes{0xD6, 0x4E}));
  EXPECT_EQ(last_bytes(u32,
                       "kind = \"crc\", polynomial = 0x04C11DB7, start = 0xFFFFFFFF, reflected = true, "
                       "xor_out = 0xFFFFFFFF",
                       4),
            (Bytes{0x26, 0x39, 0xF4, 0xCB}));
  EXPECT_EQ(last_bytes(u32 + ", bits = 24", "kind = \"crc\", polynomial = 0x864CFB, start = 0xB704CE", 4),
            (Bytes{0x02, 0xCF, 0x21, 0x00}));
}

// A sum over what stands behind it, a speed and a counter, and an exclusive or over all that.
TEST(WheelWords, ChecksumsComeLastAndInTheirOrder) {
  const WheelWords words = one_frame(R"(bytes = 5, field = [
    { at = 0, type = "u8", checksum = { kind = "sum", over = [1, 3] } },
    { at = 4, type = "u8", checksum = { kind = "xor" } },
    { at = 1, type = "i16", per_rad_s = 1.0 },
    { at = 3, type = "u8", counter = {} }])");
  const std::array<double, 2> speeds{0x0103, 0.0};
  EXPECT_EQ(bytes_of(said(words, {0, 0, 14'000'000}, speeds).at(0)),
            (Bytes{3 + 1 + 7, 3, 1, 7, (3 + 1 + 7) ^ 3 ^ 1 ^ 7}));
}

TEST(WheelWords, AStartSequenceEndsAndTheSpeedsFollow) {
  const WheelWords words = words_of(R"(via = "CAN1"
period_ms = 10
[[wheel_commands.frame]]
each = "board"
id = 0x10
bytes = 1
until_ms = 20
field = [{ at = 0, type = "u8", value = 8 }]
[[wheel_commands.frame]]
id = 0x20
bytes = 1
from_ms = 20
)");
  std::vector<std::uint32_t> ids;
  for (std::int64_t t_ms = 0; t_ms <= 30; t_ms += 10) {
    for (const BusFrame& frame : said(words, {0, 0, t_ms * 1'000'000}, kStill)) ids.push_back(frame.id);
  }
  EXPECT_EQ(ids, (std::vector<std::uint32_t>{0x10, 0x10, 0x20, 0x21, 0x20, 0x21}));
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(WheelWords, NamesWhatIsWrongInATable) {
  const char* const kCases[][3] = {
      {"at = 0", "at = 5", "wheel_commands.frame[0].field[0].at"},
      {"\"f32\"", "\"f16\"", "wheel_commands.frame[0].field[0].type"},
      {"per_rad_s = 0.15915494309189535", "", "wheel_commands.frame[0].field[0]"},
      {"per_rad_s", "wheel = 1\nper_rad_s", "wheel_commands.frame[0].field[0].wheel"},
      {"per_rad_s", "value = 1\nper_rad_s", "wheel_commands.frame[0].field[0].per_rad_s"},
      {"type = \"f32\"\nper_rad_s = 0.15915494309189535", "type = \"u8\"\nvalue = 256",
       "wheel_commands.frame[0].field[0].value"},
      {"bytes = 8", "bytes = 9", "wheel_commands.frame[0].bytes"},
      {"id = 0x100", "id = 0x7FE", "wheel_commands.frame[0].id"},
      {"id = 0x100", "", "wheel_commands.frame[0].id"},
      {"period_ms = 2", "", "wheel_commands.period_ms"},
      {"\"CAN1\"", "\"CAN7\"", "wheel_commands.via"},
      {"period_ms = 2", "period_ms = 2\ndialect = \"ibis-orion-can\"", "wheel_commands.dialect"},
      {"at = 0", "at = 0\nshift = 3", "wheel_commands.frame[0].field[0].shift"},
      {"bytes = 8", "bytes = 8\nevery_ms = 3", "wheel_commands.frame[0].every_ms"},
      {"bytes = 8", "bytes = 8\nfrom_ms = 4\nuntil_ms = 4", "wheel_commands.frame[0].until_ms"}};
  for (const auto& [from, to, key] : kCases) {
    std::vector<BoardProblem> problems;
    EXPECT_FALSE(read(with(kIbis, from, to), problems)) << to;
    ASSERT_FALSE(problems.empty()) << to;
    EXPECT_NE(problems[0].text().find(key), std::string::npos) << problems[0].text();
  }
}

TEST(WheelWords, NamesWhatIsWrongWithCountersAndChecksums) {
  const std::string field = "wheel_commands.frame[0].field[0]";
  const std::string kCases[][3] = {
      {"3", "wheel_commands.frame[0].field", "not a list of tables"},
      {"{ at = 0, type = \"u8\", counter = 3 }", field + ".counter", "not a table"},
      {"{ at = 0, type = \"i8\", counter = {} }", field + ".type", "u8, u16, u32"},
      {"{ at = 0, type = \"u8\", counter = { last = 256 } }", field + ".counter.last", "0 to 255"},
      {"{ at = 0, type = \"u8\", counter = { first = 9, last = 8 } }", field + ".counter.last", "10 to 255"},
      {"{ at = 0, type = \"u8\", counter = { step = 0 } }", field + ".counter.step", "1 or more"},
      {"{ at = 0, type = \"u8\", counter = { wrap = 3 } }", field + ".counter.wrap", "first, last, step"},
      {"{ at = 0, type = \"u8\", bits = 9, value = 1 }", field + ".bits", "1 to 8"},
      {"{ at = 0, type = \"u8\", bits = 4, value = 16 }", field + ".value", "0 to 15"},
      {"{ at = 7, type = \"u8\", value = 1, checksum = { kind = \"sum\" } }", field + ".checksum",
       "beside value"},
      {"{ at = 7, type = \"u8\", checksum = { kind = \"md5\" } }", field + ".checksum.kind", "crc16-xmodem"},
      {"{ at = 7, type = \"u8\", checksum = {} }", field + ".checksum.kind", "missing"},
      {"{ at = 7, type = \"u8\", checksum = { kind = \"crc16-xmodem\" } }", field + ".checksum.kind",
       "a field of 16 bits"},
      {"{ at = 7, type = \"u8\", checksum = { kind = \"crc\" } }", field + ".checksum.polynomial", "missing"},
      {"{ at = 7, type = \"u8\", checksum = { kind = \"crc\", polynomial = 0x107 } }",
       field + ".checksum.polynomial", "0 to 255"},
      {"{ at = 7, type = \"u8\", checksum = { kind = \"sum\", polynomial = 7 } }",
       field + ".checksum.polynomial", "not of a CRC"},
      {"{ at = 7, type = \"u8\", checksum = { kind = \"sum\", over = [0, 7] } }", field + ".checksum.over",
       "it covers itself"},
      {"{ at = 7, type = \"u8\", checksum = { kind = \"sum\", over = [3, 8] } }", field + ".checksum.over",
       "0 to 7, without 7 to 7"},
      {"{ at = 7, type = \"u8\", checksum = { kind = \"sum\", over = 3 } }", field + ".checksum.over",
       "no range of bytes"},
      {"{ at = 2, type = \"u16\", value = 1 }, { at = 3, type = \"u8\", value = 1 }",
       "wheel_commands.frame[0].field[1].at", "another field has byte 3"}};
  for (const auto& [fields, key, what] : kCases) {
    std::vector<BoardProblem> problems;
    EXPECT_FALSE(
        read("via = \"CAN1\"\nperiod_ms = 2\nframe = [{ id = 1, bytes = 8, field = [" + fields + "] }]\n",
             problems))
        << fields;
    ASSERT_EQ(problems.size(), 1u) << fields;
    EXPECT_EQ(problems[0].key, key) << fields;
    EXPECT_NE(problems[0].text().find(what), std::string::npos) << problems[0].text();
    EXPECT_NE(problems[0].line, 0u) << fields;
  }
}

BoardContext with_text(const std::string& text) {
  return {.find_dialect = [text](const std::string& name) {
    return DialectFile{.path = name, .text = text, .error = {}, .allowed = {}};
  }};
}

const std::string kDialect =
    "format = \"omnihil-dialect/1\"\nname = \"n\"\nport = \"can\"\nperiod_ms = 4\n"
    "frame = [{ id = 1, bytes = 2, field = [{ at = 0, type = \"i16\", per_rad_s = 1 }] }]\n";
const std::string kNamed = kHead + "dialect = \"mine.toml\"\nvia = \"CAN1\"\n";

TEST(WheelWords, ADialectIsAFile) {
  std::vector<BoardProblem> problems;
  const auto spec = read_board(kNamed, "b.toml", problems, with_text(kDialect));
  for (const BoardProblem& problem : problems) ADD_FAILURE() << problem.text();
  ASSERT_TRUE(spec);
  EXPECT_EQ(spec->wheel_commands.words.period_ns, 4'000'000);
  EXPECT_EQ(spec->wheel_commands.words.frames.size(), 1u);
  EXPECT_FALSE(spec->wheel_commands.serial);
}

// Each fault of it with its own file and line; the board's end of it with the board's.
TEST(WheelWords, NamesWhatIsWrongWithADialect) {
  const struct {
    std::string board, from, to, expected;
  } kCases[] = {
      {kNamed, "omnihil-dialect/1", "omnihil-board/1",
       "mine.toml:1: format = 'omnihil-board/1': unknown; allowed: omnihil-dialect/1"},
      {kNamed, "\"can\"", "\"spi\"", "mine.toml:3: port = 'spi': unknown; allowed: serial, can"},
      {kNamed, "bytes = 2", "bytes = 9", "mine.toml:5: frame[0].bytes = 9: out of range; allowed: 1 to 8"},
      {kNamed, "period_ms = 4", "period_ms = 4\nvia = 1", "mine.toml:5: via = 1: unknown key"},
      {kNamed, "frame = [", "frame = ]", "mine.toml:5: not TOML"},
      {with(kNamed, "CAN1", "USART1"), "", "",
       "b.toml:16: wheel_commands.via = 'USART1': not a CAN of the chip"},
      {with(kNamed, "via", "period_ms = 2\nvia"), "", "",
       "b.toml:16: wheel_commands.period_ms = 2: beside a dialect"},
      {with(kNamed, "name = \"test\"", "name = \"test\"\ncoupling_us = 300"), "", "",
       "its period is no multiple of coupling_us; allowed: 300 us times"},
  };
  for (const auto& c : kCases) {
    std::vector<BoardProblem> problems;
    EXPECT_FALSE(read_board(c.board, "b.toml", problems,
                            with_text(c.from.empty() ? kDialect : with(kDialect, c.from, c.to))))
        << c.expected;
    ASSERT_FALSE(problems.empty()) << c.expected;
    EXPECT_NE(problems[0].text().find(c.expected), std::string::npos) << problems[0].text();
  }
}

TEST(WheelWords, ADialectThatIsNotThereIsNamedWithThoseThatAre) {
  std::vector<BoardProblem> problems;
  EXPECT_FALSE(read_board(kNamed, "b.toml", problems, with_dialects()));
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].text(),
            "b.toml:15: wheel_commands.dialect = 'mine.toml': unknown; allowed: those that there are");
}

// A speed of 7 rad/s behind a gear of 3 is 21 of the motor, here its backward, every 2 ms.
TEST(WheelWords, TheMainBoardSaysThemByTheBoardsCan) {
  OMNIHIL_NEED_IMAGES();
  const auto firmware = wheels_firmware(
      "[wheel_commands]\nvia = \"CAN1\"\nreversed = true\nperiod_ms = 2\n"
      "frame = [{ id = 0x100, bytes = 2, field = [{ at = 0, type = \"i16\", per_rad_s = 1 }] }]\n");
  ASSERT_NE(firmware, nullptr);
  std::vector<CanFrame> heard;
  firmware->board().chip().find<CanPort>("CAN1")->watch_frames(
      [&heard](const CanPass& pass) { heard.push_back(pass.frame); });
  RobotCommand command{};
  command.mode = OMNIHIL_MODE_WHEEL_SPEED;
  command.omega_wheel_rad_s[0] = 7.0;
  firmware->command(command, 0);
  RobotSensors sensors{};
  for (int tick = 1; tick <= 20; ++tick) {
    sensors.now_us += 500;
    firmware->tick(sensors);
  }
  EXPECT_EQ(firmware->commands_ignored(), 0u);
  ASSERT_EQ(heard.size(), 5u);
  for (const CanFrame& frame : heard) {
    EXPECT_EQ(frame.id, 0x100u);
    EXPECT_EQ(frame.bytes, 2);
    EXPECT_EQ(static_cast<std::int16_t>(frame.data[0] | frame.data[1] << 8), -21);
  }
}

}  // namespace
}  // namespace omnihil::mcu

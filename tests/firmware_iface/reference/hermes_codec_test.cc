// The C receiver in the firmware and the C++ codec read the same table: they must agree on every frame.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "firmware_iface/reference/radio_hermes.h"
#include "protocols/radio_format.h"
#include "tests/firmware_iface/reference/hermes_frames.h"

namespace omnihil::test {
namespace {

constexpr std::uint8_t kRobot = 5;

struct Receiver {
  explicit Receiver(std::uint8_t robot = kRobot) { hermes_radio_init(&radio, robot); }
  // Packets completed by these bytes.
  std::vector<hermes_message> feed(const Bytes& bytes) {
    std::vector<hermes_message> messages;
    for (std::uint8_t byte : bytes) {
      hermes_message message{};
      if (hermes_radio_byte(&radio, byte, &message)) messages.push_back(message);
    }
    return messages;
  }
  std::uint32_t refused() const {
    std::uint32_t sum = 0;
    for (std::uint32_t count : radio.refused) sum += count;
    return sum;
  }
  hermes_radio radio{};
};

const RadioFormat& format() { return *find_radio_format("ulaval-hermes"); }

// The cause under which the firmware counts what the codec calls `error`.
hermes_refusal counterpart(PacketError error) {
  switch (error) {
    case PacketError::kTooShort:
      return HERMES_TOO_SHORT;
    case PacketError::kTooLong:
      return HERMES_TOO_LONG;
    case PacketError::kFraming:
      return HERMES_FRAMING;
    case PacketError::kChecksum:
      return HERMES_CHECKSUM;
    case PacketError::kVersion:
      return HERMES_VERSION;
    case PacketError::kUnknownType:
      return HERMES_UNKNOWN_TYPE;
    case PacketError::kConstant:
      return HERMES_SOURCE;
    case PacketError::kNotFinite:
      return HERMES_NOT_FINITE;
    case PacketError::kAddress:
      return HERMES_DIRECTION;  // an answer, with another destination
    default:
      return HERMES_REFUSALS;
  }
}

void expect_same_fields(const hermes_message& c, const Values& cpp) {
  const auto same = [&cpp](std::string_view field, double value) {
    EXPECT_EQ(value, cpp.number(field)) << field;
  };
  const std::string_view name = cpp.message->name;
  if (name == "SPEED_MOVE" || name == "SPEED_MOVE_ADVANCE") {
    same("vx", c.vx_m_s);
    same("vy", c.vy_m_s);
    same("vtheta", c.vtheta_rad_s);
  }
  if (name == "SPEED_MOVE_ADVANCE") {
    same("dribbler", c.dribbler);
    same("charge", c.charge);
    same("kick_force", c.kick_force);
  } else if (name == "SET_REGISTER") {
    same("register", c.register_id);
    same("value", c.value);
  } else if (name == "OPEN_LOOP_COMMAND") {
    for (int w = 0; w < 4; ++w) same("cmd[" + std::to_string(w) + "]", c.duty_ratio[w]);
  }
}

// One frame through both. The codec knows all directions and addresses; the robot only its own.
void expect_agreement(const Bytes& frame) {
  Receiver receiver;
  const std::vector<hermes_message> messages = receiver.feed(frame);
  const DecodeResult decoded = format().decode(frame);
  if (decoded.error != PacketError::kNone) {
    EXPECT_TRUE(messages.empty());
    EXPECT_EQ(receiver.refused(), 1u);
    const hermes_refusal cause = counterpart(decoded.error);
    ASSERT_LT(cause, HERMES_REFUSALS) << to_string(decoded.error);
    EXPECT_EQ(receiver.radio.refused[cause], 1u) << to_string(decoded.error);
    return;
  }
  if (decoded.values.message->direction == Direction::kFromRobot) {
    EXPECT_EQ(receiver.radio.refused[HERMES_DIRECTION], 1u);
  } else if (decoded.values.number("robot") != kRobot) {
    EXPECT_EQ(receiver.radio.refused[HERMES_ADDRESS], 1u);
  } else {
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_EQ(messages[0].type, decoded.values.message->type);
    expect_same_fields(messages[0], decoded.values);
  }
}

class Random {
 public:
  std::uint8_t byte() { return static_cast<std::uint8_t>(engine_() >> 24); }
  int below(int limit) { return static_cast<int>(engine_() % static_cast<unsigned>(limit)); }
  Bytes bytes(int count) {
    Bytes out;
    for (int i = 0; i < count; ++i) out.push_back(byte());
    return out;
  }

 private:
  std::mt19937 engine_{20240611};
};

constexpr int kPayloadOfType[] = {0, 0, 12, 2, 16, 0, 1, 0, 4, 14};

TEST(HermesCodec, AgreesOnRandomValidAndNearlyValidPackets) {
  Random random;
  for (int n = 0; n < 20000; ++n) {
    const int type = random.below(11);
    int payload = type < 10 ? kPayloadOfType[type] : random.below(16);
    if (n % 10 == 0) payload = random.below(20);  // wrong lengths
    const bool answer = type == kPingResponse || type == kBatteryResponse || type == kNumResponse;
    std::uint8_t source = answer ? kRobot : 0xFE, destination = answer ? 0 : kRobot;
    if (n % 7 == 0) destination = random.byte();
    if (n % 11 == 0) source = random.byte();
    Bytes bytes = packet(source, destination, static_cast<std::uint8_t>(type), random.bytes(payload));
    if (n % 13 == 0) bytes[static_cast<std::size_t>(random.below(static_cast<int>(bytes.size())))] ^= 0x10;
    expect_agreement(stuffed(bytes));
    if (HasFailure()) FAIL() << "frame " << n;
  }
}

TEST(HermesCodec, AgreesOnRandomBytes) {
  Random random;
  for (int n = 0; n < 50000; ++n) {
    Bytes frame = random.bytes(1 + random.below(40));
    for (std::uint8_t& byte : frame) {
      if (byte == 0) byte = 1;                                          // a zero would end the frame
      if (n % 2 == 0) byte = static_cast<std::uint8_t>(1 + byte % 24);  // codes that stay inside
    }
    frame.push_back(0);
    expect_agreement(frame);
    if (HasFailure()) FAIL() << "frame " << n;
  }
}

TEST(HermesCodec, EverySingleBitFlipInAPacketIsRefused) {
  const Bytes good = packet(0xFE, kRobot, kSpeedMoveAdvance, floats({1.5f, -0.25f, 3.0f}) + Bytes{0x83, 60});
  for (std::size_t bit = 0; bit < good.size() * 8; ++bit) {
    Bytes bad = good;
    bad[bit / 8] = static_cast<std::uint8_t>(bad[bit / 8] ^ (1u << (bit % 8)));
    Receiver receiver;
    EXPECT_TRUE(receiver.feed(stuffed(bad)).empty()) << bit;
    EXPECT_EQ(receiver.refused(), 1u) << bit;
  }
}

// On the wire a flip can also hit the stuffing: a code, or a byte that becomes the delimiter.
TEST(HermesCodec, EverySingleBitFlipOnTheWireIsRefused) {
  const Bytes frames[] = {to_robot(kRobot, kPing), to_robot(kRobot, kSetRegister, {0, 1}),
                          to_robot(kRobot, kSpeedMove, floats({0.0f, 1.0f, -2.0f})),
                          to_robot(kRobot, kSpeedMoveAdvance, floats({1.5f, -0.25f, 3.0f}) + Bytes{0x83, 60}),
                          to_robot(kRobot, kOpenLoop, floats({0.25f, -1.0f, 0.0f, 0.5f}))};
  for (const Bytes& good : frames) {
    for (std::size_t bit = 0; bit < good.size() * 8; ++bit) {
      Bytes bad = good;
      bad[bit / 8] = static_cast<std::uint8_t>(bad[bit / 8] ^ (1u << (bit % 8)));
      Receiver receiver;
      EXPECT_TRUE(receiver.feed(bad + Bytes{0}).empty()) << bit;  // a delimiter, in case it was the one hit
      EXPECT_GE(receiver.refused(), 1u) << bit;
    }
  }
}

TEST(HermesCodec, CutFramesAreRefusedAndTheNextOneIsRead) {
  const Bytes good = to_robot(kRobot, kSpeedMove, floats({1.0f, 2.0f, 3.0f}));
  for (std::size_t length = 1; length < good.size() - 1; ++length) {
    Receiver receiver;
    const Bytes cut(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(length));
    // without its delimiter the cut frame swallows the next; the one after that is read
    EXPECT_EQ(receiver.feed(cut + good + good).size(), 1u) << length;
    EXPECT_EQ(receiver.refused(), 1u) << length;
    Receiver delimited;
    EXPECT_EQ(delimited.feed(cut + Bytes{0} + good).size(), 1u) << length;
    EXPECT_EQ(delimited.refused(), 1u) << length;
  }
}

TEST(HermesCodec, GarbageBetweenFramesCostsNoFrameOnceDelimited) {
  Random random;
  const Bytes good = to_robot(kRobot, kSetRegister, {3, 2});
  Receiver receiver;
  for (int n = 0; n < 2000; ++n) {
    const Bytes garbage = random.bytes(random.below(200));
    const std::size_t before = receiver.feed(garbage + Bytes{0}).size();
    ASSERT_EQ(before, 0u);
    ASSERT_EQ(receiver.feed(good).size(), 1u) << n;
  }
}

TEST(HermesCodec, BytesMayComeOneByOneOrManyFramesAtOnce) {
  Bytes stream;
  for (std::uint8_t n = 0; n < 100; ++n) stream = stream + to_robot(kRobot, kSetRegister, {3, n});
  Receiver together, single;
  EXPECT_EQ(together.feed(stream).size(), 100u);
  std::size_t count = 0;
  for (std::uint8_t byte : stream) count += single.feed({byte}).size();
  EXPECT_EQ(count, 100u);
}

TEST(HermesCodec, EndlessLineWithoutDelimiterIsOneRefusal) {
  Receiver receiver;
  EXPECT_TRUE(receiver.feed(Bytes(100000, 0x55)).empty());
  EXPECT_EQ(receiver.refused(), 0u);
  EXPECT_TRUE(receiver.feed({0}).empty());
  EXPECT_EQ(receiver.radio.refused[HERMES_TOO_LONG], 1u);
  EXPECT_EQ(receiver.feed(to_robot(kRobot, kPing)).size(), 1u);
}

TEST(HermesCodec, RepeatedDelimitersAreNoFrame) {
  Receiver receiver;
  EXPECT_TRUE(receiver.feed(Bytes(50, 0)).empty());
  EXPECT_EQ(receiver.refused(), 0u);
}

std::filesystem::path shared_vectors() {
  const char* shared = std::getenv("OMNIHIL_SHARED");
  return shared == nullptr ? std::filesystem::path() : std::filesystem::path(shared) / "vectors";
}

// Packets by an encoder that is not ours: {"type", "in", "wire"}.
std::vector<nlohmann::json> team_rows() {
  std::ifstream file(shared_vectors() / "ulaval-hermes.json");
  if (!file) return {};
  return nlohmann::json::parse(file).at("vectors");
}
// Those of the golden packets, whose bytes are a second implementation's.
std::vector<nlohmann::json> golden_rows() {
  std::vector<nlohmann::json> rows;
  std::ifstream file(OMNIHIL_SOURCE_DIR "/tests/protocols/golden/packets.jsonl");
  for (std::string line; std::getline(file, line);) {
    const nlohmann::json row = nlohmann::json::parse(line);
    if (row.at("format") != "ulaval-hermes") continue;
    rows.push_back({{"type", row.at("packet")}, {"in", row.at("in")}, {"wire", row.at("hex")}});
  }
  return rows;
}

bool is_answer(const nlohmann::json& row) { return row.at("type").get<std::string>().ends_with("RESPONSE"); }

// A command to this robot with its values; a robot's answer is refused.
void expect_read(const nlohmann::json& row) {
  const auto& in = row.at("in");
  Receiver receiver(in.at("robot").get<std::uint8_t>());
  const auto messages = receiver.feed(from_hex(row.at("wire")));
  if (is_answer(row)) {
    EXPECT_EQ(receiver.radio.refused[HERMES_DIRECTION], 1u) << row;
    return;
  }
  ASSERT_EQ(messages.size(), 1u) << row;
  const hermes_message& m = messages[0];
  const auto same = [&](const char* name, double value) {
    if (in.contains(name)) {
      EXPECT_EQ(static_cast<float>(in.at(name).get<double>()), static_cast<float>(value)) << row;
    }
  };
  same("vx", m.vx_m_s);
  same("vy", m.vy_m_s);
  same("vtheta", m.vtheta_rad_s);
  same("kick_force", m.kick_force);
  same("dribbler", m.dribbler);
  same("register", m.register_id);
  same("value", m.value);
  if (in.contains("charge")) {
    EXPECT_EQ(in.at("charge").get<bool>(), m.charge != 0) << row;
  }
  for (int w = 0; in.contains("cmd") && w < 4; ++w) {
    EXPECT_EQ(in.at("cmd").at(static_cast<std::size_t>(w)).get<float>(), m.duty_ratio[w]) << row;
  }
}

// The firmware's own answer is the same bytes.
void expect_answered(const nlohmann::json& row) {
  const auto& in = row.at("in");
  const std::string type = row.at("type");
  Receiver robot(in.at("robot").get<std::uint8_t>());
  const std::uint32_t value = in.value("decivolts", in.value("value", 0u));
  const std::uint32_t code = type == "PING_RESPONSE"       ? kPingResponse
                             : type == "BATTERIE_RESPONSE" ? kBatteryResponse
                                                           : kNumResponse;
  hermes_radio_answer(&robot.radio, code, value);
  Bytes out(64);
  out.resize(hermes_radio_transmit(&robot.radio, out.data(), out.size()));
  EXPECT_EQ(out, from_hex(row.at("wire"))) << row;
}

void expect_read_and_answered(const std::vector<nlohmann::json>& rows, int commands, int answers) {
  int read = 0, answered = 0;
  for (const nlohmann::json& row : rows) {
    expect_read(row);
    ++read;
    if (!is_answer(row)) continue;
    expect_answered(row);
    ++answered;
  }
  EXPECT_EQ(read - answered, commands);
  EXPECT_EQ(answered, answers);
}

TEST(HermesCodec, GoldenPacketsAreReadAndAnswersAreTheirBytes) {
  expect_read_and_answered(golden_rows(), 11, 4);
}

TEST(HermesCodec, TeamsOwnVectorsAreReadAndAnswersAreTheirBytes) {
  const std::vector<nlohmann::json> rows = team_rows();
  if (rows.empty()) GTEST_SKIP() << "OMNIHIL_SHARED names no folder with vectors/ulaval-hermes.json";
  expect_read_and_answered(rows, 67, 26);
}

TEST(HermesCodec, RealHostStreamIsReadWithoutARefusal) {
  const std::filesystem::path path = shared_vectors() / "ulaval-strategyai-host-stream.json";
  if (!std::filesystem::exists(path)) {
    GTEST_SKIP() << "OMNIHIL_SHARED names no folder with vectors/ulaval-strategyai-host-stream.json";
  }
  std::ifstream file(path);
  const nlohmann::json root = nlohmann::json::parse(file);
  std::array<Receiver, 6> robots{Receiver(0), Receiver(1), Receiver(2),
                                 Receiver(3), Receiver(4), Receiver(5)};
  std::size_t frames = 0, read = 0;
  for (const auto& [name, session] : root.at("sessions").items()) {
    for (const auto& row : session) {
      const Bytes frame = from_hex(row.at(1));
      ++frames;
      for (Receiver& robot : robots) {
        for (const hermes_message& message : robot.feed(frame)) {
          ++read;
          EXPECT_EQ(message.type, std::uint32_t{kSpeedMoveAdvance});
          EXPECT_LT(std::abs(message.vx_m_s), 5.0f);
        }
      }
    }
  }
  EXPECT_EQ(frames, 1035u);
  EXPECT_EQ(read, frames) << "every frame is for exactly one of the six robots";
  for (const Receiver& robot : robots) {
    EXPECT_EQ(robot.refused(), robot.radio.refused[HERMES_ADDRESS]) << "nothing but other robots' frames";
  }
}

}  // namespace
}  // namespace omnihil::test

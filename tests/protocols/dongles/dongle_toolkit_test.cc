// The parts that dongles share: what waits for a robot, which robots there are, the sign of life.
#include <gtest/gtest.h>

#include <stdexcept>

#include "protocols/dongles/heartbeat.h"
#include "protocols/dongles/outbox.h"
#include "protocols/dongles/robot_table.h"
#include "protocols/dongles/sized_stream.h"

namespace omnihil {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr Message of_role(MessageRole role) {
  Message message{};
  message.role = role;
  return message;
}
constexpr Message kCommand = of_role(MessageRole::kCommand);
constexpr Message kKill = of_role(MessageRole::kKill);
constexpr Message kOther = of_role(MessageRole::kNone);

template <class Box>
Bytes next_of(Box& box, std::size_t room) {
  const auto packet = box.next(room);
  return packet ? Bytes(packet->span().begin(), packet->span().end()) : Bytes{};
}

TEST(Outbox, LatestCommandAndKillGoBeforeTheQueue) {
  Outbox<4, 2> box;
  EXPECT_TRUE(box.empty());
  EXPECT_TRUE(box.keep(kOther, Bytes{1, 2}));
  EXPECT_TRUE(box.keep(kKill, Bytes{3}));
  EXPECT_TRUE(box.keep(kCommand, Bytes{4}));
  EXPECT_TRUE(box.keep(kCommand, Bytes{5, 6}));
  EXPECT_TRUE(box.keep(kOther, Bytes{7}));
  EXPECT_FALSE(box.keep(kOther, Bytes{8}));  // two are all
  EXPECT_EQ(next_of(box, 1), Bytes{});       // the command's turn; it does not fit
  EXPECT_EQ(next_of(box, 4), (Bytes{5, 6}));
  EXPECT_EQ(next_of(box, 4), Bytes{3});
  EXPECT_EQ(next_of(box, 4), (Bytes{1, 2}));
  EXPECT_FALSE(box.empty());
  EXPECT_EQ(next_of(box, 4), Bytes{7});
  EXPECT_TRUE(box.empty());
  EXPECT_EQ(next_of(box, 4), Bytes{});
}

TEST(RobotTable, FindsTheRobotsOfTheListAndNoOthers) {
  RobotTable<int, 16> robots(std::array{0, 7, 15});
  *robots.find(7) = 42;
  EXPECT_EQ(std::vector<int>(robots.begin(), robots.end()), (std::vector<int>{0, 42, 0}));
  for (const int id : {-1, 1, 16, 1000}) EXPECT_EQ(robots.find(id), nullptr) << id;
  EXPECT_THROW((RobotTable<int, 16>(std::array{16})), std::out_of_range);
}

TEST(Heartbeat, BeatsAtMultiplesOfItsPeriodOnceHoweverManyWereMissed) {
  Heartbeat heartbeat(10);
  std::vector<int> beats;
  for (const int now : {0, 9, 10, 11, 19, 45, 49, 50}) {
    if (heartbeat.due(now)) beats.push_back(now);
  }
  EXPECT_EQ(beats, (std::vector<int>{10, 45, 50}));
}

// Frames: AA, length of all, content.
std::optional<std::size_t> frame_bytes(std::span<const std::uint8_t> front) {
  if (front[0] != 0xAA) return 0;
  if (front.size() < 2) return std::nullopt;
  return front[1] < 2 ? 0 : front[1];
}

TEST(SizedStream, FindsTheNextFrameBehindBytesThatBeginNone) {
  PacketCounts counts;
  SizedStream stream(frame_bytes, counts);
  std::vector<Bytes> frames;
  const auto feed = [&](const Bytes& bytes) {
    stream.feed(bytes, [&](std::span<const std::uint8_t> f) { frames.emplace_back(f.begin(), f.end()); });
  };
  feed({1, 2, 3, 0xAA, 3});
  feed({9});
  feed({0xAA, 1, 0xAA, 2, 0xAA, 4, 5, 6});  // AA 01 is no frame: the search goes on at its second byte
  EXPECT_EQ(frames, (std::vector<Bytes>{{0xAA, 3, 9}, {0xAA, 2}, {0xAA, 4, 5, 6}}));
  EXPECT_EQ(counts.bad[static_cast<std::size_t>(PacketError::kFraming)], 2u);  // two runs
  feed({0xAA});
  stream.close();
  feed({0xAA, 2});
  EXPECT_EQ(frames.back(), (Bytes{0xAA, 2}));
  EXPECT_EQ(counts.bad[static_cast<std::size_t>(PacketError::kTooShort)], 1u);
}

}  // namespace
}  // namespace omnihil

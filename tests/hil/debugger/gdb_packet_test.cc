// The remote serial protocol's frames, by the examples of GDB's manual and by what breaks them.
#include "hil/debugger/gdb_packet.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace omnihil {
namespace {

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

TEST(GdbPacket, EndsInTheSumOfWhatStandsBetween) {
  const std::vector<std::uint8_t> ok = gdb_packet("OK");
  EXPECT_EQ(std::string(ok.begin(), ok.end()), "$OK#9a");  // 0x4F + 0x4B
}

TEST(GdbPacket, SpecialBytesAreEscapedAndComeBack) {
  const std::string data = "a}b#c$d*e";
  const std::vector<std::uint8_t> framed = gdb_packet(data);
  GdbInput input;
  input.add(framed);
  const auto event = input.take();
  ASSERT_TRUE(event);
  EXPECT_EQ(event->data, data);
  EXPECT_EQ(std::count(framed.begin(), framed.end(), '#'), 1);
}

TEST(GdbPacket, AStreamIsCutWhereverItIsSplit) {
  const std::string stream = "+$g#67\x03$m8000000,4#25-";
  for (std::size_t cut = 0; cut <= stream.size(); ++cut) {
    GdbInput input;
    std::vector<GdbEventKind> kinds;
    std::vector<std::string> data;
    for (const std::string_view part :
         {std::string_view(stream).substr(0, cut), std::string_view(stream).substr(cut)}) {
      input.add(bytes_of(part));
      while (const auto event = input.take()) {
        kinds.push_back(event->kind);
        if (!event->data.empty()) data.push_back(event->data);
      }
    }
    EXPECT_EQ(kinds,
              (std::vector<GdbEventKind>{GdbEventKind::kAck, GdbEventKind::kPacket, GdbEventKind::kInterrupt,
                                         GdbEventKind::kPacket, GdbEventKind::kNack}))
        << cut;
    EXPECT_EQ(data, (std::vector<std::string>{"g", "m8000000,4"})) << cut;
  }
}

TEST(GdbPacket, AWrongSumIsRefusedAndTheNextPacketIsRead) {
  GdbInput input;
  input.add(bytes_of("$g#00$g#67"));
  EXPECT_EQ(input.take()->kind, GdbEventKind::kBroken);
  EXPECT_EQ(input.take()->kind, GdbEventKind::kPacket);
  EXPECT_FALSE(input.take());
}

TEST(GdbPacket, HexadecimalNumbersAreTakenOffTheText) {
  EXPECT_EQ(text_as_hex("\x01z"), "017a");
  std::string_view text = "20000010,4";
  EXPECT_EQ(take_hex(text), 0x20000010u);
  EXPECT_EQ(text, ",4");
  EXPECT_FALSE(take_hex(text));
}

}  // namespace
}  // namespace omnihil

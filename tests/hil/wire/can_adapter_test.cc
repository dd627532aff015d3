// Virtual USB-CAN sticks: their lines, byte by byte.
#include "hil/wire/can_adapter.h"

#include <gtest/gtest.h>

#include "tests/firmware_iface/motor_bus/bus_harness.h"

namespace omnihil::test {
namespace {

struct Stick {
  std::unique_ptr<CanAdapter> adapter;
  std::vector<BusFrame> frames;
  std::string say(std::string_view text) {
    std::string answer;
    adapter->receive(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()), frames,
                     answer);
    return answer;
  }
  std::string hear(const BusFrame& f) {
    std::string answer;
    EXPECT_TRUE(adapter->send(f, answer));
    return answer;
  }
};
Stick slcan() { return {make_slcan_adapter(), {}}; }
Stick fdcanusb() { return {make_fdcanusb_adapter(), {}}; }

TEST(SlcanTest, opens_and_takes_a_standard_frame) {
  Stick stick = slcan();
  EXPECT_EQ(stick.say("C\rS6\rO\r"), "\r\r\r");
  EXPECT_EQ(stick.say("t00780800000000000000\r"), "z\r");
  ASSERT_EQ(stick.frames.size(), 1U);
  EXPECT_EQ(stick.frames[0].id, 7U);
  EXPECT_EQ(data_of(stick.frames[0]), hex("08 00 00 00 00 00 00 00"));
  EXPECT_FALSE(stick.frames[0].extended || stick.frames[0].fd || stick.frames[0].remote);
}

TEST(SlcanTest, a_line_may_arrive_in_pieces) {
  Stick stick = slcan();
  stick.say("O\rt1");
  EXPECT_EQ(stick.say("232AB"), "");
  EXPECT_EQ(stick.say("CD\r"), "z\r");
  EXPECT_EQ(data_of(stick.frames.at(0)), hex("ABCD"));
}

TEST(SlcanTest, knows_extended_remote_and_fd_frames) {
  Stick stick = slcan();
  EXPECT_EQ(stick.say("O\rT0000800120A0B\r"), "\rZ\r");
  EXPECT_EQ(stick.say("r0178\r"), "z\r");
  EXPECT_EQ(stick.say("b1239000102030405060708090A0B\r"), "z\r");  // length code 9: 12 bytes
  ASSERT_EQ(stick.frames.size(), 3U);
  EXPECT_EQ(stick.frames[0].id, 0x8001U);
  EXPECT_TRUE(stick.frames[0].extended);
  EXPECT_TRUE(stick.frames[1].remote);
  EXPECT_EQ(stick.frames[1].size, 0);
  EXPECT_TRUE(stick.frames[2].fd && stick.frames[2].bitrate_switch);
  EXPECT_EQ(stick.frames[2].size, 12);
}

TEST(SlcanTest, says_frames_of_the_bus) {
  Stick stick = slcan();
  stick.say("O\r");
  EXPECT_EQ(stick.hear(frame(0x7F, "DE AD")), "t07F2DEAD\r");
  EXPECT_EQ(stick.hear(fd_frame(0x8001, "01 02 03 04 05 06 07 08 09")),
            "B000080019010203040506070809000000\r");
  BusFrame padded = fd_frame(0x8001, "01 02 03 04 05 06 07 08 09");
  padded.pad = 0x50;  // as its sender wants it
  EXPECT_EQ(stick.hear(padded), "B000080019010203040506070809505050\r");
}

TEST(SlcanTest, refuses_what_is_no_frame) {
  Stick stick = slcan();
  EXPECT_EQ(stick.say("t1230\r"), "\a") << "the channel is closed";
  stick.say("O\r");
  for (const char* line : {"t123\r", "t1239000000000000000000\r", "t1232AB\r", "t1231XY\r", "t8001AB\r",
                           "q\r", "T20000000100\r"}) {
    EXPECT_EQ(stick.say(line), "\a") << line;
  }
  EXPECT_TRUE(stick.frames.empty());
  EXPECT_EQ(stick.adapter->bad_lines(), 8U);
}

TEST(SlcanTest, an_endless_line_costs_no_memory_and_is_refused) {
  Stick stick = slcan();
  stick.say("O\r");
  EXPECT_EQ(stick.say(std::string(100'000, 't') + "\r"), "\a");
}

TEST(FdcanusbTest, takes_the_vendors_example) {
  Stick stick = fdcanusb();
  EXPECT_EQ(stick.say("can send 8001 01000a07206000200150ff140400130d\n"), "OK\r\n");
  ASSERT_EQ(stick.frames.size(), 1U);
  EXPECT_EQ(stick.frames[0].id, 0x8001U);
  EXPECT_TRUE(stick.frames[0].extended && stick.frames[0].fd && stick.frames[0].bitrate_switch);
  EXPECT_EQ(data_of(stick.frames[0]), hex("01000a07206000200150ff140400130d"));
}

TEST(FdcanusbTest, says_frames_of_the_bus_and_pads_them) {
  Stick stick = fdcanusb();
  BusFrame f = fd_frame(0x100, "2404000a005000000170");
  f.pad = 0x50;  // as its sender wants it
  EXPECT_EQ(stick.hear(f), "rcv 100 2404000a0050000001705050 e B F\r\n");
  f.id = 0x10001;
  f.extended = true;
  f.size = 2;
  EXPECT_EQ(stick.hear(f), "rcv 10001 2404 E B F\r\n");
}

// CRC-8, polynomial x^8+x^7+x^4+x^2+x+1 = 97h without its top bit, computed bit by bit on the message
// polynomial.
std::uint8_t crc8_by_division(std::string_view text) {
  unsigned remainder = 0;
  for (std::size_t bit = 0; bit < 8 * (text.size() + 1); ++bit) {
    const unsigned next =
        bit < 8 * text.size() ? static_cast<unsigned>(text[bit / 8]) >> (7 - bit % 8) & 1U : 0U;
    remainder = remainder << 1 | next;
    if ((remainder & 0x100U) != 0) remainder ^= 0x197U;
  }
  return static_cast<std::uint8_t>(remainder);
}

TEST(FdcanusbTest, answers_checksums_with_checksums) {
  Stick stick = fdcanusb();
  const std::string line = "can send 8001 0100 BF ";
  char sum[8];
  std::snprintf(sum, sizeof sum, "*%02X", crc8_by_division(line));
  char ok[16];
  std::snprintf(ok, sizeof ok, "OK *%02X\r\n", crc8_by_division("OK "));
  EXPECT_EQ(stick.say(line + sum + "\n"), ok);
  EXPECT_EQ(stick.say("can send 8001 0101 BF " + std::string(sum) + "\n").substr(0, 12), "ERR checksum");
  EXPECT_EQ(stick.frames.size(), 1U);
}

TEST(FdcanusbTest, refuses_what_is_no_command) {
  Stick stick = fdcanusb();
  for (const char* line : {"hello\n", "can fly\n", "can send\n", "can send xyz 00\n", "can send 1 0\n",
                           "can send 1 000102030405060708 f\n"}) {
    EXPECT_EQ(stick.say(line).substr(0, 3), "ERR") << line;
  }
  EXPECT_TRUE(stick.frames.empty());
}

TEST(CanFdLengthTest, codes_and_lengths_are_inverse_and_round_up) {
  for (int code = 0; code < 16; ++code)
    EXPECT_EQ(can_fd_code(static_cast<std::size_t>(can_fd_length(code))), code);
  EXPECT_EQ(can_fd_length(can_fd_code(9)), 12);
  EXPECT_EQ(can_fd_length(can_fd_code(49)), 64);
}

}  // namespace
}  // namespace omnihil::test

// Board files and images for AVR chips: what is read, and what is refused with every problem named.
#include "firmware_iface/mcu/avr/avr_board.h"

#include <gtest/gtest.h>

#include <string>

#include "firmware_iface/mcu/avr/avr_image.h"

namespace omnihil::mcu {
namespace {

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// ":LLAAAATT" + data + two's complement of the sum.
std::string record(unsigned address, unsigned type, const std::vector<unsigned>& data) {
  std::vector<unsigned> all{static_cast<unsigned>(data.size()), address >> 8, address & 255u, type};
  all.insert(all.end(), data.begin(), data.end());
  unsigned sum = 0;
  for (const unsigned byte : all) sum += byte;
  all.push_back((256u - sum % 256u) % 256u);
  std::string text = ":";
  for (const unsigned byte : all) {
    text += "0123456789ABCDEF"[byte >> 4];
    text += "0123456789ABCDEF"[byte & 15u];
  }
  return text + "\r\n";
}

TEST(AvrImage, HexRecordsAreLoadedWhereTheirAddressesSay) {
  const std::string text = record(0x10, 0, {1, 2}) + record(0, 2, {0x10, 0}) + record(4, 0, {3}) +
                           record(0, 4, {0, 1}) + record(8, 0, {4}) + record(0, 1, {});
  AvrImage image;
  std::vector<std::string> problems;
  ASSERT_TRUE(is_avr_image(bytes_of(text)));
  ASSERT_TRUE(read_avr_image(bytes_of(text), image, problems));
  ASSERT_EQ(image.flash.size(), 3u);
  EXPECT_EQ(image.flash[0].address, 0x10u);
  EXPECT_EQ(image.flash[0].bytes, (std::vector<std::uint8_t>{1, 2}));
  EXPECT_EQ(image.flash[1].address, 0x1000u * 16 + 4);
  EXPECT_EQ(image.flash[2].address, 0x10000u + 8);
}

TEST(AvrImage, DamagedHexIsRefusedWithItsLine) {
  std::string broken = record(0, 0, {1, 2}) + record(2, 0, {3, 4}) + record(0, 1, {});
  broken[broken.find('\n') + 10] ^= 1;  // a digit of the second record
  AvrImage image;
  std::vector<std::string> problems;
  EXPECT_FALSE(read_avr_image(bytes_of(broken), image, problems));
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].rfind("line 2: ", 0), 0u) << problems[0];
  problems.clear();
  EXPECT_FALSE(read_avr_image(bytes_of(record(0, 0, {1})), image, problems));  // no end
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].find("truncated"), std::string::npos) << problems[0];
}

TEST(AvrBoard, EveryProblemIsNamedWithItsLine) {
  const std::string text = R"(format = "omnihil-board/1"
name = "x"
chip = "atmega328p"
control_interrupt = "TIMER9"
[[motor]]
wheel = 0
pwm = "OC7A"
encoder = ["PD2"]
[[motor]]
wheel = 0
pwm = "OC1A"
enable = "PE1"
[[pin]]
pin = "PC0"
[radio]
format = "ulaval-hermes"
via = "USART1"
)";
  std::vector<BoardProblem> problems;
  EXPECT_FALSE(read_avr_board(text, "b.toml", problems).has_value());
  std::string all;
  for (const BoardProblem& problem : problems) all += problem.text() + "\n";
  for (const char* said : {"control_period_us", "b.toml:4: control_interrupt", "b.toml:7: motor[0].pwm",
                           "b.toml:8: motor[0].encoder", "b.toml:10: motor[1].wheel",
                           "b.toml:12: motor[1].enable", "b.toml:14: pin[0].pin", "b.toml:17: radio.via"}) {
    EXPECT_NE(all.find(said), std::string::npos) << said << " in\n" << all;
  }
  EXPECT_EQ(problems.size(), 8u) << all;
}

TEST(AvrBoard, ChannelsOfTheChipsHaveTheirPinsAndRegisters) {
  const AvrChip* chip = find_avr_chip("atmega32u4");
  ASSERT_NE(chip, nullptr);
  ASSERT_NE(chip->channel("OC1A"), nullptr);
  EXPECT_EQ(chip->channel("OC1A")->pin.port, 'B');
  EXPECT_EQ(chip->channel("OC1A")->pin.pin, 5u);
  EXPECT_EQ(chip->channel("OC1A")->ocr, 0x88u);
  EXPECT_EQ(chip->channel("OC9A"), nullptr);
  EXPECT_EQ(find_avr_chip("atmega4809"), nullptr);
}

}  // namespace
}  // namespace omnihil::mcu

// The CRC unit against the check values of named CRCs ("123456789", catalogue of parametrised CRC algorithms) and
// the values of the fixed unit for one word.
#include <gtest/gtest.h>

#include "tests/firmware_iface/mcu/chip_bench.h"

namespace omnihil::mcu {
namespace {

constexpr std::uint32_t kDr = 0x00, kCr = 0x08, kInit = 0x10, kPol = 0x14;

struct NamedCrc {
  const char* name;
  std::uint32_t polynomial, start, size_code;  // CR.POLYSIZE
  bool turned;                                 // input by bytes, and output
  std::uint32_t check;                         // before what is XORed at the end
};

TEST(CrcUnit, GivesTheCheckValuesOfNamedCrcs) {
  for (const char* chip : {"stm32f303", "stm32f767", "stm32g474"}) {
    for (const NamedCrc& c : {NamedCrc{"CRC-32/MPEG-2", 0x04C11DB7, 0xFFFFFFFF, 0, false, 0x0376E6E7},
                              NamedCrc{"CRC-32", 0x04C11DB7, 0xFFFFFFFF, 0, true, 0xCBF43926 ^ 0xFFFFFFFF},
                              NamedCrc{"CRC-16/IBM-3740", 0x1021, 0xFFFF, 1, false, 0x29B1},
                              NamedCrc{"CRC-16/MCRF4XX", 0x1021, 0xFFFF, 1, true, 0x6F91},
                              NamedCrc{"CRC-8/SMBUS", 0x07, 0x00, 2, false, 0xF4},
                              NamedCrc{"CRC-7/MMC", 0x09, 0x00, 3, false, 0x75}}) {
      ChipBench b(chip);
      b.set("CRC", kPol, c.polynomial);
      b.set("CRC", kInit, c.start);
      b.set("CRC", kCr, c.size_code << 3 | (c.turned ? 1u << 5 | 1u << 7 : 0u) | 1u);
      for (const char byte : std::string("123456789"))
        b.system.bus_write(b.base("CRC"), 1, static_cast<std::uint8_t>(byte));
      EXPECT_EQ(b.get("CRC", kDr), c.check) << chip << ", " << c.name;
    }
  }
}

TEST(CrcUnit, TheFixedUnitTakesWords) {
  for (const char* chip : {"stm32f405", "stm32f446", "stm32f303"}) {
    ChipBench b(chip);
    EXPECT_EQ(b.get("CRC", kDr), 0xFFFFFFFFu);
    b.set("CRC", kDr, 0);
    EXPECT_EQ(b.get("CRC", kDr), 0xC704DD7Bu) << chip;
    b.set("CRC", kCr, 1);
    EXPECT_EQ(b.get("CRC", kDr), 0xFFFFFFFFu) << "RESET";
    b.set("CRC", kDr, 0x12345678);
    EXPECT_EQ(b.get("CRC", kDr), 0xDF8A8A2Bu) << chip;
  }
}

TEST(CrcUnit, AWordIsItsBytesFromTheTop) {
  ChipBench words("stm32f767"), bytes("stm32f767"), halves("stm32f767");
  words.set("CRC", kDr, 0x31323334);
  for (const std::uint8_t byte : {0x31, 0x32, 0x33, 0x34}) bytes.system.bus_write(bytes.base("CRC"), 1, byte);
  for (const std::uint32_t half : {0x3132u, 0x3334u}) halves.system.bus_write(halves.base("CRC"), 2, half);
  EXPECT_EQ(words.get("CRC", kDr), bytes.get("CRC", kDr));
  EXPECT_EQ(words.get("CRC", kDr), halves.get("CRC", kDr));
}

TEST(CrcUnit, TheSmallOneOfF0HasItsPolynomialFixed) {
  ChipBench b("stm32f031");
  for (const char byte : std::string("123456789"))
    b.system.bus_write(b.base("CRC"), 1, static_cast<std::uint8_t>(byte));
  EXPECT_EQ(b.get("CRC", kDr), 0x0376E6E7u);
  EXPECT_TRUE(b.system.unmodelled.empty());
  b.set("CRC", kPol, 0x1021);
  EXPECT_FALSE(b.system.unmodelled.empty()) << "it has no such register";
}

}  // namespace
}  // namespace omnihil::mcu

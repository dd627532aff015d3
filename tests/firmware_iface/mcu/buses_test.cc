// SPI and I2C masters with the devices behind them, driven as drivers do.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <vector>

#include "firmware_iface/mcu/stm32/i2c.h"
#include "firmware_iface/mcu/stm32/spi.h"
#include "tests/firmware_iface/mcu/chip_bench.h"

namespace omnihil::mcu {
namespace {

struct SpiBench : ChipBench {
  SpiBench(const char* name, const char* kind, DeviceWorld world = {})
      : ChipBench(name), v2(std::string_view(name) != "stm32f407") {
    world.now_ns = [this] { return system.to_ns(system.now()); };
    device = find_device(kind)->make(world);
    spi = chip.find<Spi>("SPI1");
    spi->connect(*device->spi());
    set("SPI1", 0x00, 1u << 6 | 1u << 2);
    if (v2) set("SPI1", 0x04, 7u << 8 | 1u << 12);
  }
  std::uint8_t byte(std::uint8_t out) {
    system.bus_write(base("SPI1") + 0x0C, 1, out);
    for (int i = 0; i < 1000 && (get("SPI1", 0x08) & 1) == 0; ++i) system.run_for(1);
    return static_cast<std::uint8_t>(system.bus_read(base("SPI1") + 0x0C, 1));
  }
  std::vector<std::uint8_t> transfer(std::vector<std::uint8_t> bytes) {
    spi->select(*device->spi(), true);
    for (std::uint8_t& b : bytes) b = byte(b);
    spi->select(*device->spi(), false);
    return bytes;
  }
  bool v2;
  std::unique_ptr<Device> device;
  Spi* spi;
};

TEST(SpiMaster, NoDeviceSelectedReadsOnes) {
  for (const char* name : {"stm32f407", "stm32f303"}) {
    SpiBench b(name, "nrf24l01");
    EXPECT_EQ(b.byte(0xFF), 0xFF);
  }
}

TEST(SpiMaster, AByteTakesEightBitTimesOfThePrescaler) {
  ChipBench b("stm32f407");
  b.set("SPI1", 0x00, 1u << 6 | 1u << 2 | 3u << 3);
  b.set("SPI1", 0x0C, 0);
  b.system.run_for(8 * 16 - 1);
  EXPECT_EQ(b.get("SPI1", 0x08) & 0x81, 0x80u);
  b.system.run_for(1);
  EXPECT_EQ(b.get("SPI1", 0x08) & 0x81, 0x01u);
}

TEST(RadioChip, TakesAPacketFromTheAirAndPullsItsPinLowUntilCleared) {
  for (const char* name : {"stm32f407", "stm32f303"}) {
    SpiBench b(name, "nrf24l01");
    bool irq = true;
    b.device->on_output([&](std::string_view, bool level) { irq = level; });
    b.transfer({0x20, 0x0F});  // PWR_UP, PRIM_RX
    b.transfer({0x32, 4});     // width of pipe 1
    EXPECT_EQ(b.transfer({0x00, 0xFF})[1], 0x0F);
    b.device->air(std::vector<std::uint8_t>{9, 9, 9});
    EXPECT_TRUE(irq);  // CE is low: not listening
    b.device->input("ce", true);
    b.device->air(std::vector<std::uint8_t>{1, 2, 3});
    EXPECT_FALSE(irq);
    const auto read = b.transfer({0x61, 0, 0, 0, 0});
    EXPECT_EQ(read[0], 0x42);  // RX_DR, pipe 1
    EXPECT_EQ(read[1], 1);
    EXPECT_EQ(read[4], 0);  // padded to the pipe's width
    b.transfer({0x27, 0x40});
    EXPECT_TRUE(irq);
    EXPECT_EQ(b.transfer({0x17, 0})[1] & 1, 1);  // receive FIFO empty
  }
}

TEST(RadioChip, SendsWhatWasWrittenWhenEnabled) {
  SpiBench b("stm32f407", "nrf24l01");
  b.transfer({0x20, 0x0E});
  b.transfer({0xA0, 7, 8, 9});
  std::vector<std::uint8_t> sent;
  EXPECT_FALSE(b.device->take_sent(sent));
  b.device->input("ce", true);
  ASSERT_TRUE(b.device->take_sent(sent));
  EXPECT_EQ(sent, (std::vector<std::uint8_t>{7, 8, 9}));
  EXPECT_EQ(b.transfer({0xFF})[0] & 0x20, 0x20);
}

TEST(AngleSensor, GivesTheAngleOfTheInstantWithEvenParity) {
  DeviceWorld world;
  world.angle_rad = [](std::int64_t at_ns) { return 1.0 + 1e-5 * static_cast<double>(at_ns); };
  SpiBench b("stm32f303", "as5047p", world);
  b.transfer({0xFF, 0xFF});  // read ANGLECOM
  b.system.run_for(12345);
  const std::int64_t at = b.system.to_ns(b.system.now());
  const auto read = b.transfer({0xFF, 0xFF});
  const unsigned frame = static_cast<unsigned>(read[0]) << 8 | read[1];
  const double turns = (1.0 + 1e-5 * static_cast<double>(at)) / (2 * M_PI);
  EXPECT_EQ(frame & 0x3FFF, static_cast<unsigned>((turns - std::floor(turns)) * 16384));
  EXPECT_EQ(std::popcount(frame) % 2, 0);
  b.transfer({0x7F, 0xFF});  // wrong parity
  EXPECT_EQ(b.transfer({0xC0, 0x00})[0] & 0x40, 0x40);
}

TEST(InertialSensor, OverSpiReadsRateAndGravity) {
  DeviceWorld world;
  world.gyro_z_rad_s = [](std::int64_t) { return 2.0; };
  SpiBench b("stm32f303", "icm20689", world);
  EXPECT_EQ(b.transfer({0x80 | 0x75, 0})[1], 0x98);
  b.transfer({0x1B, 3u << 3});  // 2000 degrees per second
  const auto read = b.transfer({0x80 | 0x3F, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  const auto word = [&read](std::size_t i) { return static_cast<std::int16_t>(read[i] << 8 | read[i + 1]); };
  EXPECT_EQ(word(1), 16384);  // 1 g of 2 g
  EXPECT_EQ(word(9), static_cast<std::int16_t>(std::lround(2.0 * 180 / M_PI / 2000 * 32768)));
}

// As a polling driver of I2C v1 reads registers.
struct I2cBench : ChipBench {
  explicit I2cBench(const char* name) : ChipBench(name) {
    DeviceWorld world;
    world.now_ns = [this] { return system.to_ns(system.now()); };
    world.bus_voltage_V = [](std::int64_t) { return 16.0; };
    device = find_device("ina219")->make(world);
    chip.find<I2c>("I2C1")->connect(*device->i2c());
  }
  bool wait(std::uint32_t offset, std::uint32_t mask) {
    for (int i = 0; i < 5000; ++i) {
      if ((get("I2C1", offset) & mask) != 0) return true;
      system.run_for(1);
    }
    return false;
  }
  std::unique_ptr<Device> device;
};

TEST(I2cMaster, V1ReadsADeviceAndIsRefusedWhereThereIsNone) {
  I2cBench b("stm32f407");
  b.set("I2C1", 0x1C, 80);
  b.set("I2C1", 0x00, 1);
  constexpr std::uint32_t kCr1 = 0x00, kDr = 0x10, kSr1 = 0x14, kSr2 = 0x18;
  b.set("I2C1", kCr1, 1 | 1u << 8);
  ASSERT_TRUE(b.wait(kSr1, 1));
  b.set("I2C1", kDr, 0x40 << 1);
  ASSERT_TRUE(b.wait(kSr1, 2));
  b.get("I2C1", kSr2);
  ASSERT_TRUE(b.wait(kSr1, 0x80));
  b.set("I2C1", kDr, 2);
  ASSERT_TRUE(b.wait(kSr1, 4));  // BTF
  b.set("I2C1", kCr1, 1 | 1u << 8 | 1u << 10);
  ASSERT_TRUE(b.wait(kSr1, 1));
  b.set("I2C1", kDr, 0x40 << 1 | 1);
  ASSERT_TRUE(b.wait(kSr1, 2));
  b.set("I2C1", kCr1, 1 | 1u << 11);  // POS, no ACK: two bytes
  b.get("I2C1", kSr2);
  ASSERT_TRUE(b.wait(kSr1, 4));
  b.set("I2C1", kCr1, 1 | 1u << 9);
  const std::uint32_t high = b.get("I2C1", kDr), low = b.get("I2C1", kDr);
  EXPECT_EQ(high << 8 | low, 4000u << 3 | 2u);
  EXPECT_EQ(b.get("I2C1", kSr2) & 2, 0u);
  b.set("I2C1", kCr1, 1 | 1u << 8);
  ASSERT_TRUE(b.wait(kSr1, 1));
  b.set("I2C1", kDr, 0x41 << 1);
  ASSERT_TRUE(b.wait(kSr1, 1u << 10));  // AF
}

TEST(I2cMaster, V2ReadsADeviceAndIsRefusedWhereThereIsNone) {
  for (const char* name : {"stm32f303", "stm32f767", "stm32g474"}) {
    I2cBench b(name);
    constexpr std::uint32_t kCr2 = 0x04, kIsr = 0x18, kIcr = 0x1C, kRxdr = 0x24, kTxdr = 0x28;
    b.set("I2C1", 0x10, 0x10420F13);
    b.set("I2C1", 0x00, 1);
    b.set("I2C1", kCr2, 0x40 << 1 | 1u << 16 | 1u << 13);
    ASSERT_TRUE(b.wait(kIsr, 2)) << name;
    b.set("I2C1", kTxdr, 2);
    ASSERT_TRUE(b.wait(kIsr, 64));  // TC
    b.set("I2C1", kCr2, 0x40 << 1 | 1u << 10 | 2u << 16 | 1u << 25 | 1u << 13);
    ASSERT_TRUE(b.wait(kIsr, 4));
    const std::uint32_t high = b.get("I2C1", kRxdr);
    ASSERT_TRUE(b.wait(kIsr, 4));
    EXPECT_EQ(high << 8 | b.get("I2C1", kRxdr), 4000u << 3 | 2u);
    ASSERT_TRUE(b.wait(kIsr, 32));  // STOPF
    b.set("I2C1", kIcr, 32);
    b.set("I2C1", kCr2, 0x41 << 1 | 1u << 16 | 1u << 25 | 1u << 13);
    ASSERT_TRUE(b.wait(kIsr, 16));  // NACKF
    EXPECT_EQ(b.get("I2C1", kIsr) & (1u << 15), 0u);
  }
}

}  // namespace
}  // namespace omnihil::mcu

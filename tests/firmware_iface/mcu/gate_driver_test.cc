// DRV8323 (SLVSDJ3) and DRV8301 (SLOS719): registers, frames, faults, and the bridges that they let go or hold.
#include <gtest/gtest.h>

#include "tests/firmware_iface/mcu/device_bench.h"

namespace omnihil::mcu {
namespace {

constexpr unsigned kRead = 0x8000;
unsigned at(unsigned address, unsigned data = 0) { return address << 11 | data; }

struct Drv8323Bench : DeviceBench {
  Drv8323Bench() : DeviceBench("drv8323", {{"rds_on_ohm", 0.01}}) { run_for_ns(1'000'000); }
  bool drives() const { return device->drives_bridge(); }
};

TEST(Drv8323, HasTheDefaultsOfItsDataSheet) {
  Drv8323Bench b;
  const unsigned defaults[] = {0x000, 0x000, 0x000, 0x3FF, 0x7FF, 0x159, 0x283};
  for (unsigned address = 0; address < 7; ++address)
    EXPECT_EQ(b.word(kRead | at(address)), defaults[address]) << address;
}

TEST(Drv8323, AWriteAnswersWhatWasThereBefore) {
  Drv8323Bench b;
  EXPECT_EQ(b.word(at(6, 0x2C3)), 0x283u);
  EXPECT_EQ(b.word(at(6, 0x2C3)), 0x2C3u);
  EXPECT_EQ(b.word(kRead | at(6)), 0x2C3u);
}

TEST(Drv8323, FramesOfAnotherLengthAreIgnored) {
  Drv8323Bench b;
  b.transfer({0x30, 0x01, 0x02});
  b.transfer({0x30});
  EXPECT_EQ(b.word(kRead | at(6)), 0x283u);
}

TEST(Drv8323, LockedRegistersKeepTheirContents) {
  Drv8323Bench b;
  b.word(at(3, 6u << 8 | 0xFF));
  b.word(at(5, 0x000));
  b.word(at(2, 0x7FE));
  EXPECT_EQ(b.word(kRead | at(5)), 0x159u);
  EXPECT_EQ(b.word(kRead | at(2)), 0x006u) << "coast and brake stay free";
  b.word(at(3, 3u << 8 | 0xFF));
  b.word(at(5, 0x000));
  EXPECT_EQ(b.word(kRead | at(5)), 0x000u);
}

TEST(Drv8323, TheCoastBitLetsTheBridgeGo) {
  Drv8323Bench b;
  int told = 0;
  b.device->on_bridge([&] { ++told; });
  EXPECT_TRUE(b.drives());
  b.word(at(2, 1u << 2));
  EXPECT_FALSE(b.drives());
  b.word(at(2, 0));
  EXPECT_TRUE(b.drives());
  EXPECT_EQ(told, 2);
}

// 0.45 V (level 5) over 0.01 ohm: 45 A.
TEST(Drv8323, AnOvercurrentIsLatchedUntilItIsCleared) {
  Drv8323Bench b;
  b.word(at(5, 5));
  b.motor_current_A = 44.9;
  b.step();
  EXPECT_TRUE(b.drives());
  EXPECT_TRUE(b.pins["fault"]);
  b.motor_current_A = -45.1;
  b.step();
  EXPECT_FALSE(b.drives());
  EXPECT_FALSE(b.pins["fault"]);
  EXPECT_EQ(b.word(kRead | at(0)) & 0x600, 0x600u);
  b.motor_current_A = 0.0;
  b.step();
  b.run_for_ns(1'000'000'000);
  EXPECT_FALSE(b.drives());
  b.word(at(2, 1));
  EXPECT_TRUE(b.drives());
  EXPECT_TRUE(b.pins["fault"]);
  EXPECT_EQ(b.word(kRead | at(0)), 0u);
  EXPECT_EQ(b.word(kRead | at(2)), 0u) << "CLR_FLT clears itself";
}

TEST(Drv8323, AnOvercurrentIsTriedAgainAfterItsTime) {
  for (const auto& [bit, wait_ns] : {std::pair{0u, 4'000'000}, {1u, 50'000}}) {
    Drv8323Bench b;
    b.word(at(5, bit << 10 | 1u << 6 | 5));
    b.motor_current_A = 50.0;
    b.step();
    EXPECT_FALSE(b.drives());
    b.motor_current_A = 0.0;
    b.run_for_ns(wait_ns - 1);
    EXPECT_FALSE(b.drives());
    b.run_for_ns(1);
    EXPECT_TRUE(b.drives());
    EXPECT_TRUE(b.pins["fault"]);
  }
}

TEST(Drv8323, AnOvercurrentIsOnlyReportedOrNotSeenWhereTheRegisterSaysSo) {
  Drv8323Bench b;
  b.word(at(5, 2u << 6 | 5));
  b.motor_current_A = 50.0;
  b.step();
  EXPECT_TRUE(b.drives());
  EXPECT_FALSE(b.pins["fault"]);
  Drv8323Bench off;
  off.word(at(5, 3u << 6 | 5));
  off.motor_current_A = 500.0;
  off.step();
  EXPECT_TRUE(off.drives());
  EXPECT_TRUE(off.pins["fault"]);
}

TEST(Drv8323, ALowSupplySwitchesOffAndComesBackByItself) {
  Drv8323Bench b;
  b.bus_voltage_V = 5.7;
  b.step();
  EXPECT_FALSE(b.drives());
  EXPECT_EQ(b.word(kRead | at(0)), 0x480u);
  b.bus_voltage_V = 12.0;
  b.step();
  EXPECT_TRUE(b.drives());
  EXPECT_EQ(b.word(kRead | at(0)), 0x480u) << "until it is read and cleared";
}

TEST(Drv8323, SleepsWhileItsEnablePinIsLowAndForgets) {
  Drv8323Bench b;
  b.word(at(6, 0x2C3));
  b.device->input("enable", false);
  EXPECT_FALSE(b.drives());
  EXPECT_EQ(b.word(kRead | at(6)), 0xFFFFu) << "nobody drives the line";
  b.device->input("enable", true);
  b.run_for_ns(999'999);
  EXPECT_FALSE(b.drives());
  b.run_for_ns(1);
  EXPECT_TRUE(b.drives());
  EXPECT_EQ(b.word(kRead | at(6)), 0x283u);
}

struct Drv8301Bench : DeviceBench {
  Drv8301Bench() : DeviceBench("drv8301", {{"rds_on_ohm", 0.01}}) { run_for_ns(1'000'000); }
};

TEST(Drv8301, AnswersOneFrameLateWithAddressAndData) {
  Drv8301Bench b;
  b.word(kRead | at(1));
  EXPECT_EQ(b.word(kRead | at(2)), at(1, 0x001)) << "device id";
  b.word(at(3, 0x00C));
  EXPECT_EQ(b.word(kRead | at(3)), at(3, 0x00C));
  EXPECT_EQ(b.word(kRead | at(3)), at(3, 0x00C));
}

// OC_ADJ_SET 6: 0.123 V over 0.01 ohm.
TEST(Drv8301, ALatchedOvercurrentGoesByGateReset) {
  Drv8301Bench b;
  b.word(at(2, 6u << 6 | 1u << 4));
  b.motor_current_A = 12.2;
  b.step();
  EXPECT_TRUE(b.device->drives_bridge());
  b.motor_current_A = 12.4;
  b.step();
  EXPECT_FALSE(b.device->drives_bridge());
  EXPECT_FALSE(b.pins["fault"]);
  b.word(kRead | at(0));
  EXPECT_EQ(b.word(kRead | at(0)) & 0x400, 0x400u);
  b.motor_current_A = 0.0;
  b.word(at(2, 6u << 6 | 1u << 4 | 1u << 2));
  EXPECT_TRUE(b.device->drives_bridge());
  EXPECT_TRUE(b.pins["fault"]);
  b.word(kRead | at(2));
  EXPECT_EQ(b.word(kRead | at(2)), at(2, 6u << 6 | 1u << 4)) << "GATE_RESET clears itself";
}

}  // namespace
}  // namespace omnihil::mcu

// The SX1280's commands by their opcodes (data sheet DS.SX1280-1, table 12-1), and two of them on one air.
#include "firmware_iface/mcu/devices/sx1280.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "tests/firmware_iface/mcu/device_bench.h"

namespace omnihil::mcu {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr std::uint16_t kTxDone = 1, kRxDone = 2, kCrcError = 0x40, kTimeout = 0x4000;

struct Radio : DeviceBench {
  Radio() : DeviceBench("sx1280") {
    run_for_ns(2'000'000);  // boots
  }
  Sx1280& chip() const { return dynamic_cast<Sx1280&>(*device); }
  void say(const Bytes& bytes) {
    transfer(bytes);
    run_for_ns(100'000);
  }
  // As a firmware sets FLRC up: 1.3 Mb/s, code rate 3/4, 24 bits of preamble, two sync words, variable length, CRC.
  void set_up(double frequency_Hz, std::uint32_t own, std::uint32_t listens) {
    say({0x80, 0});
    say({0x8A, 3});
    frequency(frequency_Hz);
    say({0x8F, 0x80, 0x00});
    say({0x8B, 0x45, 0x02, 0x20});
    packet(127);
    sync_word(0x09CF, own);
    sync_word(0x09D4, listens);
    say({0x8D, 0x40, 0x43, 0x40, 0x43, 0, 0, 0, 0});
    say({0x9E, 1});
  }
  void packet(unsigned length, unsigned match = 0x20) {
    say({0x8C, 0x50, 0x04, static_cast<std::uint8_t>(match), 0x20, static_cast<std::uint8_t>(length), 0x20,
         0x08});
  }
  void frequency(double hz) {
    const auto steps = static_cast<std::uint32_t>(hz * 262144.0 / 52e6);
    say({0x86, static_cast<std::uint8_t>(steps >> 16), static_cast<std::uint8_t>(steps >> 8),
         static_cast<std::uint8_t>(steps)});
  }
  void sync_word(unsigned address, std::uint32_t word) {
    say({0x18, static_cast<std::uint8_t>(address >> 8), static_cast<std::uint8_t>(address),
         static_cast<std::uint8_t>(word >> 24), static_cast<std::uint8_t>(word >> 16),
         static_cast<std::uint8_t>(word >> 8), static_cast<std::uint8_t>(word)});
  }
  void listen(unsigned base = 1, unsigned count = 0) {  // no time-out
    say({0x82, static_cast<std::uint8_t>(base), static_cast<std::uint8_t>(count >> 8),
         static_cast<std::uint8_t>(count)});
  }
  void write(const Bytes& payload) {
    Bytes all{0x1A, 0x80};
    all.insert(all.end(), payload.begin(), payload.end());
    say(all);
    packet(static_cast<unsigned>(payload.size()));
  }
  unsigned irq() {
    const Bytes in = transfer({0x15, 0, 0, 0});
    return static_cast<unsigned>(in[2] << 8 | in[3]);
  }
  void clear_irq() { say({0x97, 0xFF, 0xFF}); }
  unsigned mode() { return transfer({0xC0})[0] >> 5; }
  Bytes received() {
    const Bytes where = transfer({0x17, 0, 0, 0});
    Bytes ask{0x1B, where[3], 0};
    ask.resize(3u + where[2]);
    const Bytes in = transfer(ask);
    return {in.begin() + 3, in.end()};
  }
};

TEST(Sx1280, ComesOutOfResetInStandbyAndIsBusyUntilThen) {
  DeviceBench b("sx1280");
  EXPECT_TRUE(b.pins["busy"]);
  b.run_for_ns(2'000'000);
  EXPECT_FALSE(b.pins["busy"]);
  EXPECT_EQ(b.transfer({0xC0})[0], 2u << 5 | 1u << 2) << "STDBY_RC, processed";
  b.device->input("reset", false);
  EXPECT_TRUE(b.pins["busy"]);
  EXPECT_EQ(b.transfer({0xC0})[0], 0u);
}

TEST(Sx1280, ReadsAndWritesRegistersAndTheBuffer) {
  Radio b;
  EXPECT_EQ(b.transfer({0x19, 0x01, 0x53, 0, 0, 0})[4], 0xB7) << "firmware version";
  b.say({0x18, 0x09, 0xC6, 0x10, 0x21});
  const Bytes in = b.transfer({0x19, 0x09, 0xC6, 0, 0, 0});
  EXPECT_EQ(in[4], 0x10);
  EXPECT_EQ(in[5], 0x21);
  b.say({0x1A, 0xFE, 1, 2, 3, 4});
  EXPECT_EQ(b.transfer({0x1B, 0xFE, 0, 0, 0, 0, 0}), (Bytes{0x44, 0x44, 0x44, 1, 2, 3, 4}))
      << "round its end";
}

TEST(Sx1280, GoesThroughItsModes) {
  Radio b;
  b.say({0x8A, 3});
  EXPECT_EQ(b.transfer({0x03, 0, 0})[2], 3);
  const std::pair<Bytes, unsigned> rows[] = {
      {{0x80, 1}, 3}, {{0xC1}, 4}, {{0x82, 0, 0, 0}, 5}, {{0x80, 0}, 2}};
  for (const auto& [command, mode] : rows) {
    b.transfer(command);
    EXPECT_TRUE(b.pins["busy"]);
    b.run_for_ns(100'000);
    EXPECT_FALSE(b.pins["busy"]);
    EXPECT_EQ(b.mode(), mode);
  }
  b.say({0x84, 1});
  EXPECT_TRUE(b.pins["busy"]) << "asleep";
}

TEST(Sx1280, RefusesWhatItDoesNotModel) {
  Radio b;
  for (const Bytes& command : {Bytes{0x8A, 1}, Bytes{0xC5}, Bytes{0xA3, 0}}) {
    b.say(command);
    EXPECT_EQ(b.transfer({0xC0})[0] >> 2 & 7, 5) << int{command[0]};
  }
}

// 24 + 32 bits plain, (8 n + 16 + 6) * 4 / 3 coded, at 1.3 Mb/s.
TEST(Sx1280, AFrameTakesItsTimeOnTheAir) {
  Radio b;
  b.set_up(2.4e9, 0x82108610, 0x00000400);
  b.write(Bytes(30, 0xA5));
  b.clear_irq();
  b.transfer({0x83, 1, 0, 24});
  const auto air_ns =
      static_cast<std::int64_t>((56 + std::ceil((8 * 30 + 22) * 4.0 / 3.0)) / 1.3e6 * 1e9 + 0.5);
  EXPECT_EQ(b.chip().air_time_ns(30), air_ns);
  b.run_for_ns(85'000 + air_ns - 1);
  EXPECT_FALSE(b.pins["dio1"]);
  b.run_for_ns(1);
  EXPECT_TRUE(b.pins["dio1"]);
  EXPECT_EQ(b.irq(), kTxDone);
  EXPECT_EQ(b.mode(), 4u) << "FS, by SetAutoFS";
  b.clear_irq();
  EXPECT_FALSE(b.pins["dio1"]);
  Bytes sent;
  ASSERT_TRUE(b.device->take_sent(sent));
  EXPECT_EQ(sent, Bytes(30, 0xA5));
  EXPECT_FALSE(b.device->take_sent(sent));
}

TEST(Sx1280, ReceivingEndsAfterItsTimeOut) {
  Radio b;
  b.set_up(2.4e9, 1, 0x400);
  b.transfer({0x82, 1, 0, 24});  // 24 of 62.5 us
  b.run_for_ns(85'000 + 1'500'000 - 1);
  EXPECT_EQ(b.irq(), 0u);
  b.run_for_ns(1);
  EXPECT_EQ(b.irq(), kTimeout);
  EXPECT_TRUE(b.pins["dio1"]);
  EXPECT_EQ(b.mode(), 4u);
  b.clear_irq();
  b.listen(1, 0xFFFF);
  b.run_for_ns(10'000'000'000);
  EXPECT_EQ(b.mode(), 5u) << "continuous";
}

TEST(Sx1280, MasksKeepInterruptsFromTheStatusAndThePins) {
  Radio b;
  b.set_up(2.4e9, 1, 0x400);
  b.say({0x8D, 0x00, 0x02, 0x00, 0x01, 0x00, 0x02, 0, 0});  // RxDone alone, on DIO2
  b.listen();
  b.device->air(Bytes(8, 1));
  EXPECT_EQ(b.irq(), kRxDone);
  EXPECT_FALSE(b.pins["dio1"]);
  EXPECT_TRUE(b.pins["dio2"]);
}

TEST(Sx1280, HearsNothingUnlessItReceives) {
  Radio b;
  b.set_up(2.4e9, 1, 0x400);
  b.device->air(Bytes(8, 1));
  EXPECT_EQ(b.irq(), 0u);
}

TEST(Sx1280, SaysLengthPlaceStrengthAndSyncWord) {
  Radio b;
  b.set_up(2.4e9, 1, 0x400);
  b.listen();
  b.device->air(Bytes{9, 8, 7, 6, 5, 4, 3});
  EXPECT_EQ(b.received(), (Bytes{9, 8, 7, 6, 5, 4, 3}));
  const Bytes status = b.transfer({0x1D, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(status[3], 80) << "-40 dBm";
  EXPECT_EQ(status[4] & 0x50, 0) << "no error";
  EXPECT_EQ(status[6], 2) << "sync word 2";
}

// --- two of them ---

struct Air {
  Radio a, b;
  explicit Air(std::uint32_t a_says = 0x400, std::uint32_t b_hears = 0x400, double b_Hz = 2.4e9) {
    a.set_up(2.4e9, a_says, 0x82108610);
    b.set_up(b_Hz, 0x82108610, b_hears);
  }
  // One frame from a to b, if `arrives`; whether b has it.
  bool send(const Bytes& payload, bool arrives = true, bool damaged = false) {
    a.write(payload);
    a.clear_irq();
    b.clear_irq();
    b.packet(127);
    b.listen(1, 32);  // 2 ms
    a.transfer({0x83, 1, 0, 0});
    for (int i = 0; i < 30; ++i) {
      a.run_for_ns(100'000);
      AirFrame frame;
      while (a.chip().take_frame(frame)) {
        frame.damaged = damaged;
        if (arrives) b.chip().receive(frame);
      }
      b.run_for_ns(100'000);
    }
    return (b.irq() & kRxDone) != 0;
  }
};

TEST(TwoSx1280, HearEachOtherAndAnswer) {
  Air air;
  const Bytes question{1, 2, 3, 4, 5, 6, 7, 8};
  ASSERT_TRUE(air.send(question));
  EXPECT_EQ(air.b.received(), question);
  EXPECT_EQ(air.a.irq(), kTxDone);
}

TEST(TwoSx1280, DoNotHearAnotherChannelOrSyncWord) {
  EXPECT_TRUE(Air(0x400, 0x400, 2.4003e9).send(Bytes(8, 1))) << "within half of 1.2 MHz";
  EXPECT_FALSE(Air(0x400, 0x400, 2.4010e9).send(Bytes(8, 1)));
  EXPECT_FALSE(Air(0x04210C21, 0x400).send(Bytes(8, 1)));
}

TEST(TwoSx1280, TolerateAsManyWrongBitsOfTheSyncWordAsTheRegisterSays) {
  for (const unsigned tolerated : {0u, 1u, 2u, 3u}) {
    Air air(0x00000400 ^ 0x80000001, 0x00000400);  // two bits differ
    air.b.say({0x18, 0x09, 0xCD, static_cast<std::uint8_t>(tolerated)});
    EXPECT_EQ(air.send(Bytes(8, 1)), tolerated >= 2) << tolerated;
  }
}

TEST(TwoSx1280, ADamagedFrameIsReceivedWithItsError) {
  Air air;
  EXPECT_TRUE(air.send(Bytes(8, 1), true, true));
  EXPECT_EQ(air.b.irq(), kRxDone | kCrcError);
}

TEST(TwoSx1280, LoseFramesAsTheAirDoesAndTimeOut) {
  Air air;
  std::mt19937 random(7);
  int heard = 0, carried = 0, timed_out = 0;
  constexpr int kFrames = 400;
  for (int i = 0; i < kFrames; ++i) {
    const bool arrives = random() % 10 >= 3;  // three of ten are lost
    const bool has = air.send(Bytes(20, static_cast<std::uint8_t>(i)), arrives);
    EXPECT_EQ(has, arrives) << i;
    carried += arrives ? 1 : 0;
    heard += has ? 1 : 0;
    timed_out += (air.b.irq() & kTimeout) != 0 ? 1 : 0;
  }
  EXPECT_EQ(heard, carried);
  EXPECT_EQ(timed_out, kFrames - carried);
  EXPECT_NEAR(carried, 0.7 * kFrames, 4.0 * std::sqrt(kFrames * 0.21));
}

TEST(TwoSx1280, AutoTxAnswersAfterItsDelay) {
  Air air;
  air.b.say({0x98, 0x00, 0x64});  // 100 us, and 33 of the chip's own
  air.b.write(Bytes(10, 0x55));
  air.b.clear_irq();
  air.b.listen();
  AirFrame frame{Bytes(10, 1), 2.4e9, 0x400, 0xFFFF, false};
  ASSERT_TRUE(air.b.chip().receive(frame));
  const std::int64_t answer_ns = 133'000 + air.b.chip().air_time_ns(10);
  air.b.run_for_ns(answer_ns - 1);
  EXPECT_FALSE(air.b.chip().take_frame(frame));
  air.b.run_for_ns(1);
  ASSERT_TRUE(air.b.chip().take_frame(frame));
  EXPECT_EQ(frame.payload, Bytes(10, 0x55));
}

}  // namespace
}  // namespace omnihil::mcu

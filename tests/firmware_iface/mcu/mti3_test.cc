// The MTi-3's transfers on SPI and its messages, as MT0512P and MT0101P have them.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/firmware_iface/mcu/device_bench.h"

namespace omnihil::mcu {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Mti : DeviceBench {
  Mti() : DeviceBench("mti3") {}
  Bytes read(std::uint8_t opcode, std::size_t n) {
    Bytes out{opcode, 0, 0, 0};
    out.resize(4 + n);
    const Bytes in = transfer(out);
    return {in.begin() + 4, in.end()};
  }
  std::size_t note_bytes() {
    const Bytes in = read(4, 4);
    return in[0] | static_cast<std::size_t>(in[1]) << 8;
  }
  std::size_t measured_bytes() {
    const Bytes in = read(4, 4);
    return in[2] | static_cast<std::size_t>(in[3]) << 8;
  }
  static bool sums(const Bytes& message) {
    unsigned sum = 0xFF;
    for (const std::uint8_t byte : message) sum += byte;
    return (sum & 0xFFu) == 0;
  }
  Bytes note() { return read(5, note_bytes()); }
  void say(std::uint8_t id, const Bytes& data = {}) {
    Bytes out{3, 0, 0, 0, id, static_cast<std::uint8_t>(data.size())};
    out.insert(out.end(), data.begin(), data.end());
    std::uint8_t sum = 0xFF;
    for (std::size_t i = 4; i < out.size(); ++i) sum = static_cast<std::uint8_t>(sum + out[i]);
    out.push_back(static_cast<std::uint8_t>(-sum));
    transfer(out);
    run_for_ns(1'000'000);
  }
  void wake() {
    run_for_ns(300'000'000);
    note();
    say(0x3F);
  }
};

double float_at(const Bytes& bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) word = word << 8 | bytes[at + i];
  return static_cast<double>(std::bit_cast<float>(word));
}

TEST(Mti3, WakesUpAndSaysSo) {
  Mti b;
  b.run_for_ns(299'999'999);
  EXPECT_FALSE(b.pins["drdy"]);
  b.run_for_ns(1);
  EXPECT_TRUE(b.pins["drdy"]);
  const Bytes message = b.note();
  EXPECT_EQ(message, (Bytes{0x3E, 0x00, 0xC3}));
  EXPECT_TRUE(Mti::sums(message));
  EXPECT_FALSE(b.pins["drdy"]);
  EXPECT_EQ(b.note_bytes(), 0u);
}

TEST(Mti3, MeasuresByItselfUnlessItsWakeUpIsAnswered) {
  Mti silent;
  silent.run_for_ns(300'000'000 + 520'000'000);
  EXPECT_GT(silent.measured_bytes(), 0u);
  Mti answered;
  answered.wake();
  answered.run_for_ns(1'000'000'000);
  EXPECT_EQ(answered.measured_bytes(), 0u);
}

TEST(Mti3, AcknowledgesWithTheNextMessageId) {
  Mti b;
  b.wake();
  b.say(0x30);
  EXPECT_EQ(b.note(), (Bytes{0x31, 0x00, 0xD0}));
  b.say(0x64, {0, 50});
  EXPECT_EQ(b.note()[0], 0x65);
  b.transfer({3, 0, 0, 0, 0x30, 0x00, 0x00});  // its checksum is wrong
  b.run_for_ns(2'000'000);
  EXPECT_EQ(b.note_bytes(), 0u);
}

TEST(Mti3, RefusesAnOutputThatItLacks) {
  Mti b;
  b.wake();
  b.say(0xC0, {0xC0, 0x20, 0, 100});  // magnetic field
  EXPECT_EQ(b.note()[0], 0x42);
}

TEST(Mti3, MeasuresEachOutputAtItsRate) {
  Mti b;
  b.wake();
  const Bytes outputs{0x10, 0x20, 0, 100, 0xE0, 0x20, 0, 10, 0x80, 0x20, 0, 100, 0x40, 0x20, 0, 50};
  b.say(0xC0, outputs);
  const Bytes acknowledge = b.note();
  EXPECT_EQ(acknowledge[0], 0xC1);
  EXPECT_EQ(Bytes(acknowledge.begin() + 2, acknowledge.begin() + 18), outputs);
  b.gyro_z_rad_s = -1.5;
  b.accel_x_m_s2 = 0.75;
  b.say(0x10);
  b.note();
  int messages = 0, status_words = 0, accelerations = 0;
  for (int ms = 0; ms < 1000; ++ms) {
    b.run_for_ns(1'000'000);
    const std::size_t n = b.measured_bytes();
    if (n == 0) continue;
    const Bytes message = b.read(6, n);
    EXPECT_TRUE(Mti::sums(message));
    EXPECT_EQ(message[0], 0x36);
    for (std::size_t at = 2; at + 3 < n - 1; at += 3u + message[at + 2]) {
      const unsigned id = static_cast<unsigned>(message[at] << 8 | message[at + 1]);
      if (id == 0xE020) ++status_words;
      if (id == 0x8020) {
        EXPECT_NEAR(float_at(message, at + 11), -1.5, 1e-6);
      }
      if (id != 0x4020) continue;
      ++accelerations;
      EXPECT_NEAR(float_at(message, at + 3), 0.75, 1e-6);
      EXPECT_NEAR(float_at(message, at + 11), 9.80665, 1e-5);
    }
    ++messages;
  }
  EXPECT_EQ(messages, 100);
  EXPECT_EQ(status_words, 10);
  EXPECT_EQ(accelerations, 50);
}

TEST(Mti3, YawIsTheSumOfTheRateOfTurn) {
  Mti b;
  b.wake();
  b.say(0xC0, {0x20, 0x30, 0, 100});
  b.note();
  b.gyro_z_rad_s = 2.0;
  b.say(0x10);
  b.run_for_ns(2'000'000'000);
  const Bytes message = b.read(6, b.measured_bytes());
  const double turned_deg = 2.0 * 2.0 * 180.0 / 3.14159265358979 - 360.0;  // 4 rad, wrapped
  EXPECT_NEAR(float_at(message, 2 + 3 + 8), turned_deg, 2.0);
}

TEST(Mti3, SaysWhileItIsKeptStill) {
  Mti b;
  b.wake();
  b.say(0xC0, {0xE0, 0x20, 0, 100});
  b.note();
  b.say(0x10);
  b.note();
  b.say(0x22, {0, 1});
  const auto status = [&b] { return b.read(6, b.measured_bytes())[2 + 3 + 3]; };
  b.run_for_ns(20'000'000);
  EXPECT_EQ(status() & 0x18, 0x18);
  b.run_for_ns(1'000'000'000);
  EXPECT_EQ(status() & 0x18, 0);
}

TEST(Mti3, EveryNewThingIsAnEdgeOfTheReadyPin) {
  Mti b;
  b.wake();
  b.say(0xC0, {0x10, 0x20, 0, 100});
  b.note();
  b.say(0x10);
  b.note();
  const int before = b.rises["drdy"];
  b.run_for_ns(1'000'000'000);  // nobody reads
  EXPECT_EQ(b.rises["drdy"] - before, 100);
  b.transfer({2, 0, 0, 0, 0x04});  // measurements no longer count
  EXPECT_FALSE(b.pins["drdy"]);
  EXPECT_EQ(b.read(1, 2), (Bytes{1, 0x04}));
}

TEST(Mti3, StartsAnewByItsResetPin) {
  Mti b;
  b.wake();
  b.device->input("reset", false);
  b.run_for_ns(1'000'000'000);
  EXPECT_EQ(b.note_bytes(), 0u);
  b.device->input("reset", true);
  b.run_for_ns(300'000'000);
  EXPECT_EQ(b.note()[0], 0x3E);
}

}  // namespace
}  // namespace omnihil::mcu

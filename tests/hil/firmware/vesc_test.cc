// A VESC, unmodified, told by its own packets over its serial port and its CAN: it measures the motor, takes its settings
// and turns it without a sensor.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>

#include "firmware_iface/mcu/stm32/can.h"
#include "firmware_iface/mcu/stm32/usart.h"
#include "tests/hil/firmware/esc_image.h"

namespace omnihil {
namespace {

using Bytes = std::vector<std::uint8_t>;

enum Packet : std::uint8_t {
  kVersion = 0,
  kValues = 4,
  kSpeed = 8,
  kSetSettings = 13,
  kSettings = 14,
  kMeasureResistance = 25,
  kMeasureFlux = 57
};
constexpr unsigned kCanSpeed = 3;

void put_big(Bytes& bytes, std::int32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

Bytes floats(std::initializer_list<float> values) {
  Bytes bytes;
  for (const float value : values) put_big(bytes, std::bit_cast<std::int32_t>(value));
  return bytes;
}

std::int32_t get_big(const Bytes& bytes, std::size_t at, std::size_t count = 4) {
  if (at + count > bytes.size()) return 0;
  std::uint32_t value = bytes[at] >= 0x80 ? ~0u : 0u;
  for (std::size_t i = 0; i < count; ++i) value = value << 8u | bytes[at + i];
  return static_cast<std::int32_t>(value);
}

// CRC-16/XMODEM.
unsigned crc(std::span<const std::uint8_t> bytes) {
  unsigned sum = 0;
  for (const unsigned byte : bytes) {
    sum ^= byte << 8u;
    for (int bit = 0; bit < 8; ++bit) sum = (sum << 1u ^ ((sum & 0x8000u) != 0 ? 0x1021u : 0u)) & 0xFFFFu;
  }
  return sum;
}

// 2 and a length of one byte, or 3 and of two; the payload; its sum; 3.
Bytes framed(const Bytes& payload) {
  const std::size_t size = payload.size();
  Bytes bytes = size < 255 ? Bytes{2} : Bytes{3, static_cast<std::uint8_t>(size >> 8u)};
  bytes.push_back(static_cast<std::uint8_t>(size));
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  const unsigned sum = crc(payload);
  for (const unsigned byte : {sum >> 8u, sum & 0xFFu, 3u}) bytes.push_back(static_cast<std::uint8_t>(byte));
  return bytes;
}

struct Vesc : EscImage {
  // Its own bridge is switched at 12.5 kHz, and at 5 kHz while it measures, where it takes off the voltage of 0.12 us of
  // dead time: the same voltage as of 48 ns at this frequency, which does not follow it.
  Vesc()
      : EscImage("vesc-410-f405.elf", "vesc_410_f405.toml",
                 {.pwm_frequency_Hz = 25e3,
                  .dead_time_s = 48e-9,
                  .switch_resistance_ohm = kSwitch_ohm,
                  .diode_forward_V = 0.8},
                 {.extra_inertia_kg_m2 = 1e-4}) {}
  void SetUp() override {
    EscImage::SetUp();
    if (!bench_) return;
    serial_ = board_->chip().find<mcu::Usart>("USART6");
    serial_->on_transmit([this](std::uint8_t byte, mcu::Cycles) { line_.push_back(byte); });
    // Its supply has to be still for two seconds before it takes its offsets, and its serial port opens then.
    for (int i = 0; i < 20 && ask({kVersion}, 0.5).empty(); ++i) continue;
  }
  void say(const Bytes& payload) { serial_->feed(framed(payload), board_->now_ns()); }
  // The payload of the next answer of this kind; what else comes is passed over. Empty: none in time.
  Bytes hear(std::uint8_t kind, double patience_s) {
    const std::int64_t end_ns = board_->now_ns() + std::llround(patience_s * 1e9);
    for (; board_->now_ns() < end_ns; bench_->period()) {
      Bytes payload = next_packet();
      if (!payload.empty() && payload[0] == kind) return payload;
    }
    return {};
  }
  Bytes next_packet() {
    const std::size_t head = line_.empty() ? 0 : line_[0];
    if (line_.size() < 6 || line_.size() < head) return {};
    EXPECT_TRUE(head == 2 || head == 3);
    const std::size_t size = head == 2 ? line_[1] : line_[1] * 256u + line_[2];
    if (line_.size() < head + size + 3) return {};
    const auto begin = line_.begin() + static_cast<std::ptrdiff_t>(head);
    Bytes payload(begin, begin + static_cast<std::ptrdiff_t>(size));
    EXPECT_EQ(line_[head + size] * 256u + line_[head + size + 1], crc(payload));
    line_.erase(line_.begin(), begin + static_cast<std::ptrdiff_t>(size + 3));
    return payload;
  }
  Bytes ask(const Bytes& payload, double patience_s = 1.0) {
    say(payload);
    return hear(payload[0], patience_s);
  }
  // In what it calls ERPM: electrical turns a minute.
  double erpm(double omega_rotor_rad_s) const {
    return omega_rotor_rad_s * windings_.pole_pairs * 60.0 / (2 * std::numbers::pi);
  }

  static constexpr double kSwitch_ohm = 0.002;
  mcu::Usart* serial_ = nullptr;
  Bytes line_;
};

// It stores the sum of its own flash the first time, and starts again.
TEST_F(Vesc, SaysWhoItIsAndNamesWhatIsNotModelled) {
  const Bytes said = ask({kVersion});
  ASSERT_GT(said.size(), 6u);
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(&said[3])), "410");
  const Bytes values = ask({kValues});
  EXPECT_NEAR(get_big(values, 27, 2) / 10.0, 24.0, 0.1);
  std::string all;
  for (const std::string& line : report(*board_)) all += line + "\n";
  for (const char* bad : {"fault", "reset by IWDG", "locked"})
    EXPECT_EQ(all.find(bad), std::string::npos) << all;
  EXPECT_NE(all.find("reset by software"), std::string::npos) << all;
  EXPECT_EQ(board_->machine().report().resets.size(), 2u) << all;
}

TEST_F(Vesc, SlowMeasuresTheMotorAsItIs) {
  const Bytes resistance = ask({kMeasureResistance}, 5.0);
  const double measured_ohm = 1e-6 * get_big(resistance, 1), ohm = windings_.resistance_ohm + kSwitch_ohm;
  Bytes question{kMeasureFlux};  // at 5 A, up to 30 % duty by 5000 ERPM/s, with what it has measured
  for (const int value : {5000, 5'000'000, 300}) put_big(question, value);
  put_big(question, get_big(resistance, 1));
  put_big(question, static_cast<std::int32_t>(std::lround(windings_.inductance_q_H * 1e8)));
  const double measured_Wb = 1e-7 * get_big(ask(question, 20.0), 1);
  std::printf("measured %.4f ohm (%.4f), %.4f mWb (%.4f)\n", measured_ohm, ohm, 1e3 * measured_Wb,
              1e3 * windings_.flux_linkage_Wb);
  EXPECT_NEAR(measured_ohm, ohm, 0.02 * ohm);
  EXPECT_NEAR(measured_Wb, windings_.flux_linkage_Wb, 0.01 * windings_.flux_linkage_Wb);
}

// Without a sensor, by the settings that fit the motor: its own, read and with these numbers sent back.
TEST_F(Vesc, SlowTurnsTheMotorAtTheSpeedThatItsPacketsSay) {
  Bytes settings = ask({kSettings});
  const auto change = [&settings](const Bytes& delivered, const Bytes& ours) {
    const auto at = std::search(settings.begin(), settings.end(), delivered.begin(), delivered.end());
    ASSERT_NE(at, settings.end()) << "another version: a setting is not as it was delivered";
    std::copy(ours.begin(), ours.end(), at);
  };
  const auto ohm = static_cast<float>(windings_.resistance_ohm),
             henry = static_cast<float>(windings_.inductance_q_H),
             weber = static_cast<float>(windings_.flux_linkage_Wb);
  change(floats({7e-6F, 0.0F, 0.015F, 0.00245F}), floats({henry, 0.0F, ohm, weber}));
  constexpr float kBandwidth_rad_s = 1000.0F;  // of the current loop: what its tool suggests
  change(floats({0.03F, 50.0F}), floats({kBandwidth_rad_s * henry, kBandwidth_rad_s * ohm}));
  change(floats({60.0F, -60.0F}), floats({8.0F, -8.0F}));  // A
  settings[0] = kSetSettings;
  ASSERT_FALSE(ask(settings, 5.0).empty());

  const auto id = static_cast<unsigned>(ask({kValues}).at(58));
  auto* can = board_->chip().find<mcu::CanPort>("CAN1");
  for (const double asked_rad_s : {200.0, -100.0, 300.0}) {
    const auto told = static_cast<std::int32_t>(std::lround(erpm(asked_rad_s)));
    Bytes number;
    put_big(number, told);
    mcu::CanFrame frame;
    frame.id = kCanSpeed << 8u | id;
    frame.extended = true;
    frame.bytes = 4;
    std::copy(number.begin(), number.end(), frame.data.begin());
    number.insert(number.begin(), kSpeed);
    double from_rad = 0.0;
    for (int tenth = 0; tenth < 40; ++tenth) {
      if (tenth == 30) from_rad = motor().theta_rad();
      if (asked_rad_s == 300.0) {
        can->receive(frame);
      } else {
        say(number);
      }
      wait(0.1);
    }
    const double reached_rad_s = motor().theta_rad() - from_rad;  // in the last second
    const double said_erpm = get_big(ask({kValues}), 23);
    std::printf("told %d ERPM by %s: reached %.0f, it says %.0f\n", told,
                asked_rad_s == 300.0 ? "CAN" : "UART", erpm(reached_rad_s), said_erpm);
    EXPECT_NEAR(erpm(reached_rad_s), told, 0.015 * std::abs(told));
    EXPECT_NEAR(said_erpm, told, 0.015 * std::abs(told));
  }
}

}  // namespace
}  // namespace omnihil

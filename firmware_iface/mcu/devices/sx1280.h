// SX1280 2.4 GHz transceiver in FLRC (data sheet DS.SX1280-1, rev. 3.2, chapters 7.3, 10, 11 and 14.3).
//
//   Sx1280 radio(world);
//   radio.select(true);  radio.exchange(0xC0);  radio.select(false);   // GetStatus
//   AirFrame frame;
//   while (radio.take_frame(frame)) other.receive(frame);              // what the antenna does
//
// Pins: in `reset` (low resets), out `busy`, `dio1`, `dio2`, `dio3`. Law: a frame is on the air for preamble, sync word
// and, at the code rate, payload, CRC and six tail bits; it leaves at the end of that, and is heard by whoever receives
// then, on the same frequency within half the bandwidth, for a sync word of at most so many wrong bits. Changes of mode
// take 40 to 85 us (guess, the size that the data sheet gives), other commands keep the chip busy for a microsecond.
// Cannot represent: other modems (their packet type is refused: command status 5), ranging, duty cycles, frames that
// begin before the receiver does or overlap, noise: what is lost or damaged says who carries the frames.
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <span>
#include <string_view>
#include <vector>

#include "firmware_iface/mcu/stm32/device.h"

namespace omnihil::mcu {

struct AirFrame {
  std::vector<std::uint8_t> payload;
  double frequency_Hz = 0.0;
  std::uint32_t sync_word = 0;
  std::uint32_t crc_seed = 0xFFFF;
  bool damaged = false;  // its CRC does not fit
};

class Sx1280 final : public Device, public SpiDevice {
 public:
  explicit Sx1280(const DeviceWorld& world);
  void reset() override;
  SpiDevice* spi() override { return this; }
  std::span<const std::string_view> inputs() const override;
  std::span<const std::string_view> outputs() const override;
  void input(std::string_view pin, bool level) override;
  void select(bool selected) override;
  std::uint8_t exchange(std::uint8_t from_master) override;
  void woken() override;

  // Whether it was listening for such a frame.
  bool receive(const AirFrame& frame);
  bool take_frame(AirFrame& frame);
  // Frames of the robot's link: on its own frequency, for the first sync word that it listens for.
  bool is_radio() const override { return true; }
  void air(std::span<const std::uint8_t> bytes) override;
  bool take_sent(std::vector<std::uint8_t>& bytes) override;

  std::int64_t air_time_ns(std::size_t payload_bytes) const;

 private:
  enum class Mode : std::uint8_t { kSleep, kStandbyRc = 2, kStandbyXosc = 3, kFs = 4, kRx = 5, kTx = 6 };
  struct Timing {
    std::int64_t busy_until_ns = 0, mode_ends_ns = kNoWake;  // of receiving and sending
  };
  void command();
  void configure(std::uint8_t opcode);
  bool radio_mode(std::uint8_t opcode);
  std::uint8_t answer(std::size_t at) const;
  std::uint8_t status() const;
  std::uint8_t arg(std::size_t i) const { return i < args_.size() ? args_[i] : std::uint8_t{0}; }
  std::uint16_t word_arg(std::size_t i) const { return static_cast<std::uint16_t>(arg(i) << 8 | arg(i + 1)); }
  std::int64_t timeout_ns(std::size_t at) const;
  std::uint32_t register_word(std::uint16_t address) const;
  unsigned sync_match(std::uint32_t word) const;
  void enter(Mode mode, std::int64_t busy_ns);
  void done(std::uint16_t irq);
  void raise(std::uint16_t irq);
  void show();
  void plan();

  DeviceWorld world_;
  std::array<std::uint8_t, 256> buffer_{};
  std::array<std::uint8_t, 0x1000> registers_{};
  std::array<std::uint8_t, 3> modulation_{};
  std::array<std::uint8_t, 7> packet_{};
  std::array<std::uint16_t, 4> irq_masks_{};  // of the status, of DIO1 to DIO3
  std::array<std::uint8_t, 5> packet_status_{};
  std::vector<std::uint8_t> args_;
  std::deque<AirFrame> sent_;
  Mode mode_ = Mode::kStandbyRc;
  Timing times_;
  bool resetting_ = false, selected_ = false, auto_fs_ = false, continuous_ = false, times_out_ = false;
  std::uint8_t packet_type_ = 0, tx_base_ = 0x80, rx_base_ = 0, rx_length_ = 0, rx_start_ = 0, opcode_ = 0;
  std::uint8_t command_status_ = 1;
  std::uint16_t irq_ = 0, auto_tx_us_ = 0;
  std::uint32_t frequency_steps_ = 0;
  std::size_t count_ = 0;
};

}  // namespace omnihil::mcu

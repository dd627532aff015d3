// nRF24L01+ radio: registers, three-deep FIFOs, IRQ pin, the air as packets in and out (product
// specification 1.0).
//
// Pins: in `ce`, out `irq` (low when RX_DR, TX_DS or MAX_RT is set and not masked). A packet from the air is
// taken while the chip listens (PWR_UP, PRIM_RX, CE) on the first enabled pipe (1 before 0), cut or padded to
// that pipe's width unless it is dynamic. Transmission takes no time and is always acknowledged: TX_DS
// follows CE at once. Not modelled: addresses and channels (the board's link has one robot behind each),
// retransmission, air time.
#include <algorithm>
#include <array>
#include <deque>
#include <memory>

#include "firmware_iface/mcu/stm32/device.h"

namespace omnihil::mcu {
namespace {
enum : std::uint8_t {
  kConfig = 0x00,
  kEnRxAddr = 0x02,
  kStatus = 0x07,
  kRxAddr0 = 0x0A,
  kRxAddr1 = 0x0B,
  kTxAddr = 0x10,
  kRxPw0 = 0x11,
  kFifoStatus = 0x17,
  kDynpd = 0x1C,
  kFeature = 0x1D
};
constexpr std::uint8_t kRxDr = 0x40, kTxDs = 0x20, kMaxRt = 0x10;
constexpr std::size_t kFifoDepth = 3, kMaxPayload = 32;

struct Packet {
  std::vector<std::uint8_t> bytes;
  unsigned pipe = 0;
};

class Nrf24 final : public Device, public SpiDevice {
 public:
  Nrf24() { Nrf24::reset(); }
  void reset() override {
    registers_ = {0x08, 0x3F, 0x03, 0x03, 0x03, 0x02, 0x0E, 0x0E};
    registers_[0x0C] = 0xC3;
    registers_[0x0D] = 0xC4;
    registers_[0x0E] = 0xC5;
    registers_[0x0F] = 0xC6;
    long_ = {std::array<std::uint8_t, 5>{0xE7, 0xE7, 0xE7, 0xE7, 0xE7},
             {0xC2, 0xC2, 0xC2, 0xC2, 0xC2},
             {0xE7, 0xE7, 0xE7, 0xE7, 0xE7}};
    receive_.clear();
    transmit_.clear();
    sent_.clear();
    count_ = 0;
    flags_ = 0;
    update_irq();
  }
  SpiDevice* spi() override { return this; }
  std::span<const std::string_view> inputs() const override {
    static constexpr std::string_view kPins[] = {"ce"};
    return kPins;
  }
  std::span<const std::string_view> outputs() const override {
    static constexpr std::string_view kPins[] = {"irq"};
    return kPins;
  }
  void input(std::string_view pin, bool level) override {
    if (pin != "ce") return;
    ce_ = level;
    transmit_all();
  }
  bool is_radio() const override { return true; }

  void air(std::span<const std::uint8_t> bytes) override {
    const bool listens = (registers_[kConfig] & 3) == 3 && ce_;
    if (!listens || receive_.size() >= kFifoDepth) return;
    const unsigned pipe = (registers_[kEnRxAddr] & 2) != 0 ? 1 : 0;
    Packet packet{{bytes.begin(), bytes.end()}, pipe};
    if (!dynamic(pipe)) packet.bytes.resize(registers_[kRxPw0 + pipe] & 0x3Fu);
    packet.bytes.resize(std::min(packet.bytes.size(), kMaxPayload));
    if (packet.bytes.empty()) return;  // a pipe of width 0 is not used
    receive_.push_back(std::move(packet));
    flags_ |= kRxDr;
    if (!transmit_.empty() && (registers_[kFeature] & 2) != 0) send_front();  // payload with the acknowledge
    update_irq();
  }
  bool take_sent(std::vector<std::uint8_t>& bytes) override {
    if (sent_.empty()) return false;
    bytes = std::move(sent_.front());
    sent_.pop_front();
    return true;
  }

  void select(bool selected) override {
    if (!selected) finish();
    count_ = 0;
  }
  std::uint8_t exchange(std::uint8_t from_master) override {
    const std::size_t at = count_++;
    if (at == 0) {
      command_ = from_master;
      payload_.clear();
      if (command_ == 0xE1) transmit_.clear();
      if (command_ == 0xE2) receive_.clear();
      return status();
    }
    if (command_ < 0x20) return read_register(command_, at - 1);
    if (command_ < 0x40) {
      write_register(command_ & 0x1F, at - 1, from_master);
      return 0;
    }
    if (command_ == 0x60)
      return receive_.empty() ? 0 : static_cast<std::uint8_t>(receive_.front().bytes.size());
    if (command_ == 0x61) {
      if (receive_.empty() || at - 1 >= receive_.front().bytes.size()) return 0;
      return receive_.front().bytes[at - 1];
    }
    if (payload_command() && payload_.size() < kMaxPayload) payload_.push_back(from_master);
    return 0;
  }

 private:
  bool payload_command() const { return command_ == 0xA0 || command_ == 0xB0 || (command_ & 0xF8) == 0xA8; }
  bool dynamic(unsigned pipe) const {
    return (registers_[kFeature] & 4) != 0 && (registers_[kDynpd] >> pipe & 1) != 0;
  }
  void finish() {  // chip select rises: the command acts
    if (count_ < 2) return;
    if (command_ == 0x61 && !receive_.empty()) receive_.pop_front();
    if (payload_command() && transmit_.size() < kFifoDepth && !payload_.empty()) {
      transmit_.push_back(payload_);
      if ((command_ & 0xF8) != 0xA8) transmit_all();
    }
    update_irq();
  }
  void send_front() {
    if (sent_.size() < 64) sent_.push_back(transmit_.front());
    transmit_.pop_front();
    flags_ |= kTxDs;
  }
  void transmit_all() {
    if (!ce_ || (registers_[kConfig] & 3) != 2) return;
    while (!transmit_.empty()) send_front();
    update_irq();
  }
  std::uint8_t status() const {
    const unsigned pipe = receive_.empty() ? 7 : receive_.front().pipe;
    return static_cast<std::uint8_t>(flags_ | pipe << 1 | (transmit_.size() >= kFifoDepth ? 1u : 0u));
  }
  std::uint8_t read_register(unsigned which, std::size_t at) const {
    if (const auto* address = long_register(which)) return at < 5 ? (*address)[at] : 0;
    if (which == kStatus) return status();
    if (which == kFifoStatus) {
      return static_cast<std::uint8_t>(
          (receive_.empty() ? 1u : 0u) | (receive_.size() >= kFifoDepth ? 2u : 0u) |
          (transmit_.empty() ? 0x10u : 0u) | (transmit_.size() >= kFifoDepth ? 0x20u : 0u));
    }
    return registers_[which];
  }
  void write_register(unsigned which, std::size_t at, std::uint8_t byte) {
    if (auto* address = const_cast<std::array<std::uint8_t, 5>*>(long_register(which))) {
      if (at < 5) (*address)[at] = byte;
      return;
    }
    if (at != 0) return;
    if (which == kStatus) {
      flags_ &= static_cast<std::uint8_t>(~(byte & (kRxDr | kTxDs | kMaxRt)));
    } else if (which != kFifoStatus && which != 0x08 && which != 0x09) {
      registers_[which] = byte;
    }
    update_irq();
  }
  const std::array<std::uint8_t, 5>* long_register(unsigned which) const {
    if (which == kRxAddr0) return &long_[0];
    if (which == kRxAddr1) return &long_[1];
    return which == kTxAddr ? &long_[2] : nullptr;
  }
  void update_irq() { output("irq", (flags_ & ~registers_[kConfig] & 0x70) == 0); }

  std::array<std::uint8_t, 32> registers_{};
  std::array<std::array<std::uint8_t, 5>, 3> long_{};
  std::deque<Packet> receive_;
  std::deque<std::vector<std::uint8_t>> transmit_, sent_;
  std::vector<std::uint8_t> payload_;
  std::uint8_t command_ = 0xFF, flags_ = 0;
  std::size_t count_ = 0;
  bool ce_ = false;
};
}  // namespace

const DeviceKind& device_nrf24l01() {
  static const DeviceKind kind{
      "nrf24l01",
      "nRF24L01+ radio on SPI, pins ce and irq",
      {},
      [](const DeviceWorld&) -> std::unique_ptr<Device> { return std::make_unique<Nrf24>(); }};
  return kind;
}

}  // namespace omnihil::mcu

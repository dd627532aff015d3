#include "firmware_iface/mcu/devices/sx1280.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <utility>

namespace omnihil::mcu {
namespace {
enum Opcode : std::uint8_t {
  kGetPacketType = 0x03,
  kGetIrqStatus = 0x15,
  kGetRxBufferStatus = 0x17,
  kWriteRegister = 0x18,
  kReadRegister = 0x19,
  kWriteBuffer = 0x1A,
  kReadBuffer = 0x1B,
  kGetPacketStatus = 0x1D,
  kGetRssiInst = 0x1F,
  kSetStandby = 0x80,
  kSetRx = 0x82,
  kSetTx = 0x83,
  kSetSleep = 0x84,
  kSetRfFrequency = 0x86,
  kSetPacketType = 0x8A,
  kSetModulation = 0x8B,
  kSetPacket = 0x8C,
  kSetDioIrq = 0x8D,
  kSetTxParams = 0x8E,
  kSetBufferBase = 0x8F,
  kSetRegulator = 0x96,
  kClearIrq = 0x97,
  kSetAutoTx = 0x98,
  kSetLongPreamble = 0x9B,
  kSetAutoFs = 0x9E,
  kGetStatus = 0xC0,
  kSetFs = 0xC1,
  kSetSaveContext = 0xD5
};
constexpr std::uint16_t kTxDone = 1u << 0, kRxDone = 1u << 1, kSyncValid = 1u << 2, kCrcError = 1u << 6,
                        kTimeout = 1u << 14;
// Command status of the status byte.
constexpr std::uint8_t kProcessed = 1, kDataThere = 2, kRefused = 5, kSent = 6;
constexpr std::uint8_t kFlrc = 3, kVariableLength = 0x20;
constexpr std::uint16_t kSyncWords[] = {0x09CF, 0x09D4, 0x09D9}, kCrcSeed = 0x09C8, kSyncTolerance = 0x09CD,
                        kFirmware = 0x0153;
constexpr double kStep_Hz = 52e6 / 262144.0;
// Typical times, between the data sheet's for the changes that a firmware makes; a command that changes nothing: 1 us.
constexpr std::int64_t kCommand_ns = 1'000, kBoot_ns = 1'200'000, kToXosc_ns = 40'000, kToFs_ns = 55'000,
                       kFromFs_ns = 40'000, kFromStandby_ns = 85'000;
constexpr std::int64_t kAutoTxOverhead_ns = 33'000;  // chapter 11.6.11
}  // namespace

Sx1280::Sx1280(const DeviceWorld& world) : world_(world) { Sx1280::reset(); }

void Sx1280::reset() {
  buffer_.fill(0);
  registers_.fill(0);
  registers_[kFirmware] = 0xB7;
  registers_[kFirmware + 1] = 0xA9;
  registers_[kCrcSeed] = registers_[kCrcSeed + 1] = 0xFF;
  modulation_ = {};
  packet_ = {};
  irq_masks_ = {};
  packet_status_ = {};
  sent_.clear();
  mode_ = Mode::kStandbyRc;
  times_ = {world_.now_ns() + kBoot_ns, kNoWake};
  auto_fs_ = continuous_ = times_out_ = false;
  packet_type_ = rx_base_ = rx_length_ = rx_start_ = 0;
  tx_base_ = 0x80;
  command_status_ = kProcessed;
  irq_ = auto_tx_us_ = 0;
  frequency_steps_ = 0;
  plan();
  show();
}

std::span<const std::string_view> Sx1280::inputs() const {
  static constexpr std::string_view kPins[] = {"reset"};
  return kPins;
}

std::span<const std::string_view> Sx1280::outputs() const {
  static constexpr std::string_view kPins[] = {"busy", "dio1", "dio2", "dio3"};
  return kPins;
}

void Sx1280::input(std::string_view, bool level) {
  if (std::exchange(resetting_, !level) && level) reset();
  show();
}

void Sx1280::select(bool selected) {
  if (selected_ && !selected && count_ > 0) command();
  selected_ = selected;
  count_ = 0;
  args_.clear();
}

std::uint8_t Sx1280::exchange(std::uint8_t from_master) {
  const std::size_t at = count_++;
  if (resetting_) return 0;
  if (at == 0) {
    opcode_ = from_master;
    if (mode_ == Mode::kSleep) enter(Mode::kStandbyRc, kBoot_ns);
    return status();
  }
  args_.push_back(from_master);
  return answer(at);
}

// Mode and what became of the last command; while a frame waits, that.
std::uint8_t Sx1280::status() const {
  return static_cast<std::uint8_t>(static_cast<unsigned>(mode_) << 5 | command_status_ << 2);
}

std::uint8_t Sx1280::answer(std::size_t at) const {
  const std::size_t i = at - 2;  // of commands with one byte of status before what was asked for
  switch (opcode_) {
    case kReadRegister:
      return at < 4 ? status() : registers_[(word_arg(0) + at - 4) % registers_.size()];
    case kReadBuffer:
      return at < 3 ? status() : buffer_[(arg(0) + at - 3) % buffer_.size()];
    case kGetPacketType:
      return at < 2 ? status() : packet_type_;
    case kGetRxBufferStatus:
      return at < 2 ? status() : i == 0 ? rx_length_ : rx_start_;
    case kGetPacketStatus:
      return at < 2 || i >= packet_status_.size() ? status() : packet_status_[i];
    case kGetRssiInst:
      return at < 2 ? status() : static_cast<std::uint8_t>(-2.0 * world_.setting("rssi_dBm", -40.0));
    case kGetIrqStatus:
      return at < 2 ? status() : static_cast<std::uint8_t>(i == 0 ? irq_ >> 8 : irq_);
    default:
      return status();
  }
}

// A command acts as the chip is deselected.
void Sx1280::command() {
  if (resetting_) return;
  if (opcode_ != kGetStatus) command_status_ = kProcessed;
  times_.busy_until_ns = std::max(times_.busy_until_ns, world_.now_ns() + kCommand_ns);
  if (!radio_mode(opcode_)) configure(opcode_);
  plan();
  show();
}

bool Sx1280::radio_mode(std::uint8_t opcode) {
  const bool synthesised = mode_ == Mode::kFs || mode_ == Mode::kRx || mode_ == Mode::kTx;
  const std::int64_t to_radio_ns = synthesised ? kFromFs_ns : kFromStandby_ns;
  switch (opcode) {
    case kSetSleep:
      enter(Mode::kSleep, kCommand_ns);
      return true;
    case kSetStandby:
      enter(arg(0) == 0 ? Mode::kStandbyRc : Mode::kStandbyXosc, arg(0) == 0 ? kCommand_ns : kToXosc_ns);
      return true;
    case kSetFs:
      enter(Mode::kFs, kToFs_ns);
      return true;
    case kSetRx:
    case kSetTx:
      break;
    default:
      return false;
  }
  if (packet_type_ != kFlrc) {
    command_status_ = kRefused;
    return true;
  }
  const std::int64_t until_ns = timeout_ns(0);
  enter(opcode == kSetRx ? Mode::kRx : Mode::kTx, to_radio_ns);
  const std::int64_t begins_ns = times_.busy_until_ns;
  continuous_ = opcode == kSetRx && word_arg(1) == 0xFFFF;
  times_out_ = !continuous_ && until_ns > 0;
  times_.mode_ends_ns = times_out_ ? begins_ns + until_ns : kNoWake;
  if (opcode == kSetTx) {
    const std::int64_t sent_ns = begins_ns + air_time_ns(packet_[4]);
    times_out_ = times_out_ && times_.mode_ends_ns < sent_ns;
    if (!times_out_) times_.mode_ends_ns = sent_ns;
  }
  return true;
}

void Sx1280::configure(std::uint8_t opcode) {
  switch (opcode) {
    case kWriteRegister:
      for (std::size_t i = 2; i < args_.size(); ++i)
        registers_[(word_arg(0) + i - 2) % registers_.size()] = args_[i];
      break;
    case kWriteBuffer:
      for (std::size_t i = 1; i < args_.size(); ++i) buffer_[(arg(0) + i - 1) % buffer_.size()] = args_[i];
      break;
    case kSetPacketType:
      packet_type_ = arg(0);
      if (packet_type_ != kFlrc) command_status_ = kRefused;
      break;
    case kSetRfFrequency:
      frequency_steps_ = static_cast<std::uint32_t>(arg(0)) << 16 | word_arg(1);
      break;
    case kSetModulation:
      for (std::size_t i = 0; i < modulation_.size(); ++i) modulation_[i] = arg(i);
      break;
    case kSetPacket:
      for (std::size_t i = 0; i < packet_.size(); ++i) packet_[i] = arg(i);
      break;
    case kSetBufferBase:
      tx_base_ = arg(0);
      rx_base_ = arg(1);
      break;
    case kSetDioIrq:
      for (std::size_t i = 0; i < irq_masks_.size(); ++i) irq_masks_[i] = word_arg(2 * i);
      break;
    case kClearIrq:
      irq_ &= static_cast<std::uint16_t>(~word_arg(0));
      break;
    case kSetAutoTx:
      auto_tx_us_ = word_arg(0);
      break;
    case kSetAutoFs:
      auto_fs_ = arg(0) != 0;
      break;
    case kSetTxParams:
    case kSetRegulator:
    case kSetLongPreamble:
    case kSetSaveContext:
    case kReadRegister:
    case kReadBuffer:
    case kGetPacketType:
    case kGetIrqStatus:
    case kGetRxBufferStatus:
    case kGetPacketStatus:
    case kGetRssiInst:
    case kGetStatus:
      break;
    default:
      command_status_ = kRefused;
  }
}

std::int64_t Sx1280::timeout_ns(std::size_t at) const {
  constexpr std::int64_t kBases_ns[] = {15'625, 62'500, 1'000'000, 4'000'000};
  return kBases_ns[arg(at) & 3u] * word_arg(at + 1);
}

std::uint32_t Sx1280::register_word(std::uint16_t address) const {
  std::uint32_t word = 0;
  for (unsigned i = 0; i < 4; ++i) word = word << 8 | registers_[address + i];
  return word;
}

// A bit per sync word that is looked for and that this one is, all but some of its bits; at most one.
unsigned Sx1280::sync_match(std::uint32_t word) const {
  const int tolerance = registers_[kSyncTolerance] & 0xF;
  for (unsigned i = 0; i < 3; ++i) {
    const bool wanted = (packet_[2] >> (4 + i) & 1u) != 0;
    if (wanted && std::popcount(word ^ register_word(kSyncWords[i])) <= tolerance) return 1u << i;
  }
  return 0;
}

// Table 7-3 and chapter 14.3: bits on the air over the bit rate.
std::int64_t Sx1280::air_time_ns(std::size_t payload_bytes) const {
  struct Rate {
    std::uint8_t code;
    double bits_per_s;
  };
  constexpr Rate kRates[] = {{0x45, 1.3e6},  {0x69, 1.04e6},  {0x86, 0.65e6},
                             {0xAA, 0.52e6}, {0xC7, 0.325e6}, {0xEB, 0.26e6}};
  double rate = 1.3e6;
  for (const Rate& row : kRates) {
    if (row.code == modulation_[0]) rate = row.bits_per_s;
  }
  const double code_rate = modulation_[1] == 0 ? 0.5 : modulation_[1] == 2 ? 0.75 : 1.0;
  const double preamble = 4.0 * ((packet_[0] >> 4) + 1), sync = packet_[1] == 0 ? 0.0 : 32.0;
  const double crc = 8.0 * (packet_[5] >> 4);
  const double coded = std::ceil((8.0 * static_cast<double>(payload_bytes) + crc + 6.0) / code_rate);
  return std::llround((preamble + sync + coded) / rate * 1e9);
}

void Sx1280::enter(Mode mode, std::int64_t busy_ns) {
  mode_ = mode;
  times_ = {std::max(times_.busy_until_ns, world_.now_ns() + busy_ns), kNoWake};
  continuous_ = times_out_ = false;
}

// Back from receiving or sending.
void Sx1280::done(std::uint16_t irq) {
  mode_ = auto_fs_ ? Mode::kFs : Mode::kStandbyRc;
  times_.mode_ends_ns = kNoWake;
  raise(irq);
}

void Sx1280::raise(std::uint16_t irq) { irq_ |= static_cast<std::uint16_t>(irq & irq_masks_[0]); }

void Sx1280::woken() {
  const std::int64_t now_ns = world_.now_ns();
  if (times_.mode_ends_ns != kNoWake && times_.mode_ends_ns <= now_ns) {
    if (mode_ == Mode::kTx && !times_out_) {
      AirFrame frame{{}, frequency_steps_ * kStep_Hz, register_word(kSyncWords[0]), 0, false};
      for (std::size_t i = 0; i < packet_[4]; ++i)
        frame.payload.push_back(buffer_[(tx_base_ + i) % buffer_.size()]);
      frame.crc_seed = register_word(kCrcSeed) >> 16;
      if (sent_.size() < 64) sent_.push_back(std::move(frame));
      command_status_ = kSent;
      done(kTxDone);
    } else {
      done(kTimeout);
    }
  }
  plan();
  show();
}

bool Sx1280::receive(const AirFrame& frame) {
  constexpr double kHalfBand_Hz = 0.6e6;
  if (mode_ != Mode::kRx || world_.now_ns() < times_.busy_until_ns) return false;
  if (std::abs(frame.frequency_Hz - frequency_steps_ * kStep_Hz) > kHalfBand_Hz) return false;
  const unsigned match = packet_[1] == 0 ? 0 : sync_match(frame.sync_word);
  if (packet_[1] != 0 && packet_[2] != 0 && match == 0) return false;
  const bool bad_crc = packet_[5] != 0 && (frame.damaged || frame.crc_seed != register_word(kCrcSeed) >> 16);
  std::size_t length = frame.payload.size();
  const bool too_long = length > packet_[4];
  length = packet_[3] == kVariableLength ? std::min<std::size_t>(length, packet_[4]) : packet_[4];
  for (std::size_t i = 0; i < length; ++i) {
    buffer_[(rx_base_ + i) % buffer_.size()] = i < frame.payload.size() ? frame.payload[i] : std::uint8_t{0};
  }
  rx_length_ = static_cast<std::uint8_t>(length);
  rx_start_ = rx_base_;
  const auto errors = static_cast<std::uint8_t>(0x02 | (bad_crc ? 0x10 : 0) | (too_long ? 0x20 : 0));
  packet_status_ = {0, static_cast<std::uint8_t>(-2.0 * world_.setting("rssi_dBm", -40.0)), errors, 0,
                    static_cast<std::uint8_t>(match)};
  command_status_ = kDataThere;
  const auto irq = static_cast<std::uint16_t>(kRxDone | kSyncValid | (bad_crc ? kCrcError : 0));
  if (continuous_) {
    raise(irq);
  } else {
    done(irq);
    if (auto_tx_us_ != 0 && !bad_crc) {
      enter(Mode::kTx, 1'000 * std::int64_t{auto_tx_us_} + kAutoTxOverhead_ns);
      times_.mode_ends_ns = times_.busy_until_ns + air_time_ns(packet_[4]);
      times_.busy_until_ns = world_.now_ns();
    }
  }
  plan();
  show();
  return true;
}

bool Sx1280::take_frame(AirFrame& frame) {
  if (sent_.empty()) return false;
  frame = std::move(sent_.front());
  sent_.pop_front();
  return true;
}

void Sx1280::air(std::span<const std::uint8_t> bytes) {
  std::uint32_t word = register_word(kSyncWords[0]);
  for (unsigned i = 3; i-- > 0;) {
    if ((packet_[2] >> (4 + i) & 1u) != 0) word = register_word(kSyncWords[i]);
  }
  receive({{bytes.begin(), bytes.end()},
           frequency_steps_ * kStep_Hz,
           word,
           register_word(kCrcSeed) >> 16,
           false});
}

bool Sx1280::take_sent(std::vector<std::uint8_t>& bytes) {
  AirFrame frame;
  if (!take_frame(frame)) return false;
  bytes = std::move(frame.payload);
  return true;
}

void Sx1280::show() {
  output("busy", resetting_ || mode_ == Mode::kSleep || world_.now_ns() < times_.busy_until_ns);
  static constexpr std::string_view kDio[] = {"dio1", "dio2", "dio3"};
  for (std::size_t i = 0; i < 3; ++i) output(kDio[i], !resetting_ && (irq_ & irq_masks_[i + 1]) != 0);
}

// The next instant at which a pin or the mode changes by itself.
void Sx1280::plan() {
  std::int64_t next_ns = times_.mode_ends_ns;
  const bool busy = world_.now_ns() < times_.busy_until_ns;
  if (busy && (next_ns == kNoWake || times_.busy_until_ns < next_ns)) next_ns = times_.busy_until_ns;
  world_.wake_at(next_ns);
}

const DeviceKind& device_sx1280() {
  static const DeviceKind kind{
      "sx1280",
      "SX1280 radio on SPI in FLRC, pins reset, busy and dio1 to dio3",
      {"rssi_dBm"},
      [](const DeviceWorld& world) -> std::unique_ptr<Device> { return std::make_unique<Sx1280>(world); }};
  return kind;
}

}  // namespace omnihil::mcu

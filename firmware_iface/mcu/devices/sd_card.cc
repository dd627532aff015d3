// SD memory card of high capacity on an SDMMC host (SD Association, Physical Layer Simplified Specification 3.01): identified,
// selected, read and written in blocks of 512 bytes that are numbered.
//
// What it holds at first is its image; what is written stays beside it, block by block, each only when it has come whole.
// A block is ready 100 us after its command and kept 500 us after it has come (guess; cards take 0.1 to 1 ms and more).
// Modelled: CMD0, 2, 3, 6 to 10, 12, 13, 15 to 18, 23 to 25, 32, 33, 38, 55, ACMD6, 13, 22, 23, 41, 42, 51. Not modelled: SPI mode,
// passwords, lower voltages, standard capacity, write protection, speeds above what the host asks.
#include <algorithm>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/stm32/device.h"

namespace omnihil::mcu {
namespace {
constexpr std::int64_t kAccess_ns = 100'000, kProgram_ns = 500'000;
// Card status (table 4-42)
constexpr std::uint32_t kOutOfRange = 1u << 31, kBlockLength = 1u << 29, kIllegal = 1u << 22,
                        kReadyForData = 1u << 8, kAppCommand = 1u << 5;
constexpr std::uint32_t kEraseParameter = 1u << 27;
constexpr std::uint32_t kRca = 0x0001;
constexpr std::uint32_t kMostErased = 65536;  // blocks by one command; ours, for they are kept one by one

class SdCard final : public Device, public SdDevice {
 public:
  explicit SdCard(const DeviceWorld& world)
      : image_(world.card), blocks_(static_cast<std::uint32_t>(image_.bytes.size() / kCardBlockBytes)) {}
  SdDevice* sd() override { return this; }
  const CardBlocks* changed_blocks() const override { return &changed_; }
  void reset() override {  // of its power; what is written stays
    state_ = State::kIdle;
    status_ = 0;
    application_ = false;
    sending_.clear();
    sent_ = 0;
    block_count_ = 0;
  }

  SdAnswer command(unsigned index, std::uint32_t argument, std::int64_t now_ns) override;
  bool sends() const override { return state_ == State::kData && sent_ < sending_.size(); }
  std::int64_t ready_ns() const override { return ready_ns_; }
  void send(std::span<std::uint8_t> bytes) override;
  bool takes() const override { return state_ == State::kReceive; }
  void take(std::span<const std::uint8_t> block, std::int64_t now_ns) override;
  std::int64_t busy_until_ns() const override { return busy_until_ns_; }

 private:
  enum class State : std::uint8_t {
    kIdle,
    kReady,
    kIdentify,
    kStandby,
    kTransfer,
    kData,
    kReceive,
    kProgram,
    kGone = 15
  };
  using Kind = SdAnswer::Kind;

  SdAnswer plain(unsigned index, std::int64_t now_ns);  // R1
  SdAnswer application_command(unsigned index, std::uint32_t argument, std::int64_t now_ns);
  SdAnswer refuse() {
    status_ |= kIllegal;
    return {};
  }
  static SdAnswer number(std::array<std::uint32_t, 4> words) { return {Kind::kLong, 0x3F, words}; }
  // Not in this state: it does not answer.
  bool in(State state, std::int64_t now_ns) {
    settle(now_ns);
    return state_ == state;
  }
  void settle(std::int64_t now_ns) {
    if (state_ == State::kProgram && now_ns >= busy_until_ns_) state_ = State::kTransfer;
  }
  void give(std::vector<std::uint8_t> bytes, std::int64_t now_ns) {
    sending_ = std::move(bytes);
    sent_ = 0;
    many_ = false;
    ready_ns_ = now_ns + kAccess_ns;
    state_ = State::kData;
  }
  std::vector<std::uint8_t> block(std::uint32_t number) const;
  bool begin_blocks(std::uint32_t from, bool many);
  std::array<std::uint32_t, 4> identification() const;
  std::array<std::uint32_t, 4> specific_data() const;
  std::vector<std::uint8_t> switch_status(std::uint32_t argument);

  CardImage image_;
  std::uint32_t blocks_;
  CardBlocks changed_;
  State state_ = State::kIdle;
  std::uint32_t status_ = 0;  // errors, until they are told
  bool application_ = false;
  std::vector<std::uint8_t> sending_;
  std::size_t sent_ = 0;
  std::uint32_t next_block_ = 0, block_count_ = 0, blocks_left_ = 0, written_ = 0;
  std::uint32_t erase_from_ = 0, erase_to_ = 0;
  bool many_ = false, counted_ = false, wide_ = false, high_speed_ = false;
  std::int64_t ready_ns_ = 0, busy_until_ns_ = 0;
};

SdAnswer SdCard::plain(unsigned index, std::int64_t now_ns) {
  settle(now_ns);
  const bool programs = state_ == State::kProgram;
  const std::uint32_t status = status_ | static_cast<std::uint32_t>(state_) << 9 |
                               (programs ? 0u : kReadyForData) | (application_ ? kAppCommand : 0u);
  status_ = 0;
  return {Kind::kShort, index, {status}};
}

std::vector<std::uint8_t> SdCard::block(std::uint32_t number) const {
  const auto at = changed_.find(number);
  if (at != changed_.end()) return {at->second.begin(), at->second.end()};
  const auto bytes = image_.bytes.subspan(std::size_t{number} * kCardBlockBytes, kCardBlockBytes);
  return {bytes.begin(), bytes.end()};
}

bool SdCard::begin_blocks(std::uint32_t from, bool many) {
  if (from >= blocks_) {
    status_ |= kOutOfRange;
    return false;
  }
  next_block_ = from;
  many_ = many;
  counted_ = many && block_count_ > 0;
  blocks_left_ = many ? block_count_ : 1;
  block_count_ = 0;
  return true;
}

std::array<std::uint32_t, 4> SdCard::identification() const {  // CID: no maker's; OMHIL, of January 2024
  return {0x004F4D4Fu, 0x4D48494Cu, 0x10000000u, 0x01018101u};
}

// CSD version 2: C_SIZE counts units of 512 KiB, from 1; all command classes of a memory card; 25 MHz.
std::array<std::uint32_t, 4> SdCard::specific_data() const {
  const std::uint32_t size = blocks_ / 1024 - 1;
  return {0x400E0032u, 0x5B590000u | (size >> 16 & 0x3Fu), size << 16 | 0x7F80u, 0x0A400001u};
}

// Function group 1: default and high speed; no others (4.3.10).
std::vector<std::uint8_t> SdCard::switch_status(std::uint32_t argument) {
  std::vector<std::uint8_t> all(64, 0);
  const std::uint32_t asked = argument & 0xFu;
  const bool known = asked <= 1 || asked == 0xF;
  if (argument >> 31 != 0 && asked <= 1) high_speed_ = asked == 1;
  all[1] = 100;                                      // mA
  for (std::size_t group = 0; group < 6; ++group) {  // 6 first
    all[2 + 2 * group] = 0x80;
    all[3 + 2 * group] = group == 5 ? 0x03 : 0x01;
  }
  all[16] = static_cast<std::uint8_t>(!known ? 0xF : asked == 0xF ? (high_speed_ ? 1 : 0) : asked);
  return all;
}

SdAnswer SdCard::application_command(unsigned index, std::uint32_t argument, std::int64_t now_ns) {
  application_ = true;  // told by its answer
  const auto told = [&] {
    const SdAnswer answer = plain(index, now_ns);
    application_ = false;
    return answer;
  };
  constexpr std::uint32_t kVoltages = 0x00FF8000, kHighCapacity = 1u << 30, kPoweredUp = 1u << 31;
  switch (index) {
    case 6:
      if (!in(State::kTransfer, now_ns)) break;
      wide_ = (argument & 3u) == 2;
      return told();
    case 13: {
      if (!in(State::kTransfer, now_ns)) break;
      const SdAnswer answer = told();
      std::vector<std::uint8_t> all(64, 0);
      all[0] = wide_ ? 0x80 : 0;
      give(std::move(all), now_ns);
      return answer;
    }
    case 22: {
      if (!in(State::kTransfer, now_ns)) break;
      const SdAnswer answer = told();
      give({static_cast<std::uint8_t>(written_ >> 24), static_cast<std::uint8_t>(written_ >> 16),
            static_cast<std::uint8_t>(written_ >> 8), static_cast<std::uint8_t>(written_)},
           now_ns);
      return answer;
    }
    case 23:  // blocks to erase ahead: a hint
    case 42:  // the pull-up of DAT3
      if (!in(State::kTransfer, now_ns)) break;
      return told();
    case 41: {
      application_ = false;
      if (state_ != State::kIdle && state_ != State::kReady) break;
      const bool inquiry = (argument & kVoltages) == 0, high = (argument & kHighCapacity) != 0;
      // A host that does not know of high capacity waits for ever.
      if (inquiry || !high) return {Kind::kShortUnchecked, 0x3F, {kVoltages}};
      state_ = State::kReady;
      return {Kind::kShortUnchecked, 0x3F, {kPoweredUp | kHighCapacity | kVoltages}};
    }
    case 51: {
      if (!in(State::kTransfer, now_ns)) break;
      const SdAnswer answer = told();
      give({0x02, 0x35, 0x80, 0x02, 0, 0, 0, 0}, now_ns);  // SCR: version 3, 1 and 4 bits, CMD23
      return answer;
    }
    default:
      break;
  }
  application_ = false;
  return refuse();
}

SdAnswer SdCard::command(unsigned index, std::uint32_t argument, std::int64_t now_ns) {
  if (state_ == State::kGone) return {};
  // An application command that there is not is the plain one of its number (4.3.9.1).
  constexpr unsigned kApplication[] = {6, 13, 22, 23, 41, 42, 51};
  const bool known =
      std::find(std::begin(kApplication), std::end(kApplication), index) != std::end(kApplication);
  if (std::exchange(application_, false) && known) return application_command(index, argument, now_ns);
  const bool mine = argument >> 16 == kRca;
  settle(now_ns);
  switch (index) {
    case 0:
      reset();
      return {};
    case 2:
      if (state_ != State::kReady) return refuse();
      state_ = State::kIdentify;
      return number(identification());
    case 3: {
      if (state_ != State::kIdentify && state_ != State::kStandby) return refuse();
      const SdAnswer was = plain(3, now_ns);
      state_ = State::kStandby;
      return {Kind::kShort, 3, {kRca << 16 | (was.words[0] & 0x1FFFu)}};
    }
    case 6: {
      if (state_ != State::kTransfer) return refuse();
      const SdAnswer answer = plain(6, now_ns);
      give(switch_status(argument), now_ns);
      return answer;
    }
    case 7: {
      if (!mine) {
        if (state_ == State::kTransfer || state_ == State::kData) state_ = State::kStandby;
        return {};
      }
      if (state_ != State::kStandby) return refuse();
      const SdAnswer answer = plain(7, now_ns);
      state_ = State::kTransfer;
      return answer;
    }
    case 8:
      if (state_ != State::kIdle || (argument >> 8 & 0xFu) != 1) return {};  // 2.7 to 3.6 V
      return {Kind::kShort, 8, {argument & 0xFFFu}};
    case 9:
    case 10:
      if (!mine || state_ != State::kStandby) return refuse();
      return number(index == 9 ? specific_data() : identification());
    case 12: {
      if (state_ != State::kData && state_ != State::kReceive && state_ != State::kTransfer) return refuse();
      const SdAnswer answer = plain(12, now_ns);
      state_ = busy_until_ns_ > now_ns ? State::kProgram : State::kTransfer;
      return answer;
    }
    case 13:
      return mine ? plain(13, now_ns) : SdAnswer{};
    case 15:
      if (mine) state_ = State::kGone;
      return {};
    case 16:
      if (state_ != State::kTransfer) return refuse();
      if (argument != kCardBlockBytes) status_ |= kBlockLength;  // of high capacity: 512 always
      return plain(16, now_ns);
    case 17:
    case 18: {
      if (state_ != State::kTransfer) return refuse();
      const bool there = begin_blocks(argument, index == 18);
      const SdAnswer answer = plain(index, now_ns);
      if (there) {
        give(block(next_block_), now_ns);
        many_ = index == 18;
      }
      return answer;
    }
    case 23:
      if (state_ != State::kTransfer) return refuse();
      block_count_ = argument;
      return plain(23, now_ns);
    case 24:
    case 25: {
      if (state_ != State::kTransfer) return refuse();
      const bool there = begin_blocks(argument, index == 25);
      const SdAnswer answer = plain(index, now_ns);
      written_ = 0;
      if (there) state_ = State::kReceive;
      return answer;
    }
    case 32:
    case 33:
      if (state_ != State::kTransfer) return refuse();
      if (argument >= blocks_) status_ |= kOutOfRange;
      (index == 32 ? erase_from_ : erase_to_) = argument;
      return plain(index, now_ns);
    case 38: {
      if (state_ != State::kTransfer) return refuse();
      if (erase_to_ < erase_from_ || erase_to_ - erase_from_ >= kMostErased) status_ |= kEraseParameter;
      const bool erases = (status_ & kEraseParameter) == 0;
      const SdAnswer answer = plain(38, now_ns);
      if (!erases) return answer;
      for (std::uint32_t b = erase_from_; b <= erase_to_ && b < blocks_; ++b) changed_[b].fill(0);
      busy_until_ns_ = now_ns + kProgram_ns;
      state_ = State::kProgram;
      return answer;
    }
    case 55:
      if (state_ >= State::kStandby && !mine) return {};
      application_ = true;
      return plain(55, now_ns);
    default:
      return refuse();
  }
}

void SdCard::send(std::span<std::uint8_t> bytes) {
  for (std::uint8_t& byte : bytes) byte = sent_ < sending_.size() ? sending_[sent_++] : 0xFF;
  if (sent_ < sending_.size()) return;
  const bool more = many_ && !(counted_ && --blocks_left_ == 0);
  if (more && ++next_block_ < blocks_) {
    sending_ = block(next_block_);
    sent_ = 0;
    return;
  }
  if (more) status_ |= kOutOfRange;
  many_ = false;
  state_ = State::kTransfer;
}

void SdCard::take(std::span<const std::uint8_t> bytes, std::int64_t now_ns) {
  if (bytes.size() != kCardBlockBytes || next_block_ >= blocks_) {
    status_ |= bytes.size() != kCardBlockBytes ? kBlockLength : kOutOfRange;
    state_ = State::kTransfer;
    return;
  }
  std::memcpy(changed_[next_block_].data(), bytes.data(), kCardBlockBytes);
  ++next_block_;
  ++written_;
  busy_until_ns_ = now_ns + kProgram_ns;
  const bool last = !many_ || (counted_ && --blocks_left_ == 0);
  if (last) state_ = State::kProgram;
}
}  // namespace

const DeviceKind& device_sd_card() {
  static const DeviceKind kind{
      "sd_card",
      "SD memory card of high capacity on SDMMC, its contents a file",
      {},
      [](const DeviceWorld& world) { return std::unique_ptr<Device>(std::make_unique<SdCard>(world)); }};
  return kind;
}

}  // namespace omnihil::mcu

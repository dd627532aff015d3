#include "firmware_iface/mcu/stm32/sdmmc.h"

#include <algorithm>
#include <utility>

#include "firmware_iface/mcu/stm32/register_table.h"

namespace omnihil::mcu {
namespace {
enum : std::uint16_t {
  kPower = 0x00,
  kClkcr = 0x04,
  kArg = 0x08,
  kCmd = 0x0C,
  kRespcmd = 0x10,
  kResp1 = 0x14,
  kDtimer = 0x24,
  kDlen = 0x28,
  kDctrl = 0x2C,
  kDcount = 0x30,
  kSta = 0x34,
  kIcr = 0x38,
  kMask = 0x3C,
  kFifoCount = 0x48,  // v1
  kIdmaCtrl = 0x50,
  kIdmaSize = 0x54,
  kIdmaBase0 = 0x58,
  kIdmaBase1 = 0x5C,
  kFifo = 0x80
};
// STA: the places that both versions have
constexpr std::uint32_t kCcrcfail = 1u << 0, kCtimeout = 1u << 2, kDtimeout = 1u << 3, kTxunderr = 1u << 4,
                        kRxoverr = 1u << 5, kCmdrend = 1u << 6, kCmdsent = 1u << 7, kDataend = 1u << 8,
                        kDbckend = 1u << 10;
constexpr std::uint32_t kHalfEmpty = 1u << 14, kHalfFull = 1u << 15, kTxFull = 1u << 16, kRxFull = 1u << 17,
                        kTxEmpty = 1u << 18, kRxEmpty = 1u << 19;
// v1 only, v2 only
constexpr std::uint32_t kCmdact1 = 1u << 11, kTxact = 1u << 12, kRxact = 1u << 13, kTxdavl = 1u << 20,
                        kRxdavl = 1u << 21;
constexpr std::uint32_t kDabort = 1u << 11, kDpsmact = 1u << 12, kCpsmact = 1u << 13, kBusyd0 = 1u << 20,
                        kBusyd0end = 1u << 21, kIdmate = 1u << 27, kIdmaBtc = 1u << 28;
constexpr std::uint32_t kDten = 1u << 0, kDtdir = 1u << 1, kDmaen1 = 1u << 3, kFiforst = 1u << 13;
constexpr std::uint32_t kPieceBytes = 32, kAnswerGap = 5, kBlockRest = 18;  // CRC of 16 bits, start, stop

std::span<const RegisterInfo> table(bool v2) {
  static const auto made = [](bool second) {
    RegisterTable t;
    t.add(kPower, "POWER", 0, second ? 0x1F : 3, second ? 0x1C : 0);
    t.add(kClkcr, "CLKCR", 0, second ? 0x3FD3FF : 0x7FFF, second ? 0x3C0000 : 0);
    t.add(kArg, "ARG");
    t.add(kCmd, "CMD", 0, second ? 0x1FFFF : 0xFFF, second ? 0x1EC00 : 0xB00);
    t.add(kRespcmd, "RESPCMD", 0, 0);
    for (unsigned i = 0; i < 4; ++i) t.add(kResp1 + 4 * i, "RESP" + std::to_string(i + 1), 0, 0);
    t.add(kDtimer, "DTIMER");
    t.add(kDlen, "DLEN", 0, 0x1FFFFFF);
    t.add(kDctrl, "DCTRL", 0, second ? 0x1FFF : 0xFFF, second ? 0x1F08 : 0xF00);
    t.add(kDcount, "DCOUNT", 0, 0);
    t.add(kSta, "STA", 0, 0);
    t.add(kIcr, "ICR", 0, 0);
    t.add(kMask, "MASK", 0, second ? 0x1FFFFFFF : 0x7FFFFF);
    if (second) {
      t.add(0x40, "ACKTIMER", 0, 0x1FFFFFF);
      t.add(kIdmaCtrl, "IDMACTRL", 0, 7);
      t.add(kIdmaSize, "IDMABSIZE", 0, 0x1FE0);
      t.add(kIdmaBase0, "IDMABASE0", 0, 0xFFFFFFFC);
      t.add(kIdmaBase1, "IDMABASE1", 0, 0xFFFFFFFC);
    } else {
      t.add(kFifoCount, "FIFOCNT", 0, 0);
    }
    for (unsigned i = 0; i < 32; ++i) t.add(kFifo + 4 * i, "FIFO" + std::to_string(i), 0, 0);
    return t;
  };
  static const RegisterTable first = made(false), second = made(true);
  return v2 ? second.rows() : first.rows();
}
}  // namespace

Sdmmc::Sdmmc(SdmmcSpec spec, ChipContext& context)
    : RegisterBlock(spec.name, context.system, table(spec.v2)),
      spec_(std::move(spec)),
      context_(context),
      irq_(context.irqs, spec_.irq),
      dma_(context.dma.line(spec_.name)) {
  next_event_is(next_);
}

void Sdmmc::reset() {
  RegisterBlock::reset();
  flags_ = 0;
  fifo_.clear();
  block_.clear();
  data_ = Data::kIdle;
  left_ = block_left_ = to_feed_ = 0;
  command_end_ = data_at_ = timeout_at_ = busy_end_ = kNever;
  schedule();
  update();
}

// SDMMC_CK: v1 the kernel clock by CLKDIV + 2 or, bypassed, itself; v2 by twice CLKDIV.
Cycles Sdmmc::clocks(std::uint64_t count) const {
  const std::uint32_t clkcr = value(kClkcr);
  const std::uint64_t divider = spec_.v2         ? std::max(1u, 2 * field(clkcr, 0, 10))
                                : bit(clkcr, 10) ? 1
                                                 : field(clkcr, 0, 8) + 2;
  const ClockRatio kernel = context_.clocks.bus(Bus::kSdmmc);
  return std::max<Cycles>(1, count * divider * kernel.div / kernel.mul);
}

unsigned Sdmmc::bus_width() const {
  return 1u << std::min(2 * field(value(kClkcr), spec_.v2 ? 14 : 11, 2), 3u);
}

std::uint32_t Sdmmc::piece_bytes() const { return std::min({kPieceBytes, block_left_, left_}); }

Cycles Sdmmc::piece_cycles() const {
  const std::uint32_t bytes = piece_bytes();
  return clocks(8u * bytes / bus_width() + (bytes == block_left_ ? kBlockRest : 0));
}

void Sdmmc::schedule() { next_ = std::min({command_end_, data_at_, timeout_at_, busy_end_}); }

void Sdmmc::control_command(std::uint32_t written) {
  if (!bit(written, spec_.v2 ? 12 : 10)) return;  // CPSMEN
  const unsigned wait = field(written, spec_.v2 ? 8 : 6, 2);
  // v1: 1 short, 3 long, else none; v2: 1 short, 2 short without a CRC, 3 long
  const unsigned answer = wait == 3 ? 136 : wait == 1 || (spec_.v2 && wait == 2) ? 48 : 0;
  command_end_ = now() + clocks(48 + (answer > 0 ? kAnswerGap + answer : 0));
  schedule();
}

void Sdmmc::finish_command() {
  command_end_ = kNever;
  const std::uint32_t cmd = value(kCmd);
  const unsigned index = cmd & 0x3Fu, wait = field(cmd, spec_.v2 ? 8 : 6, 2);
  const bool powered = (value(kPower) & 3u) == 3;
  SdAnswer answer;
  if (card_ != nullptr && powered) {
    answer = card_->command(index, value(kArg), now_ns());
  } else {
    ledger_.lost("command", powered ? "sent, no card is there" : "sent without power for the card", now());
  }
  if (wait == 0 || (!spec_.v2 && wait == 2)) {
    flags_ |= kCmdsent;
  } else if (answer.kind == SdAnswer::Kind::kNone) {
    flags_ |= kCtimeout;
  } else {
    value(kRespcmd) = answer.index;
    for (unsigned i = 0; i < 4; ++i) value(kResp1 + 4 * i) = i == 3 ? answer.words[i] & ~1u : answer.words[i];
    const bool unchecked = answer.kind == SdAnswer::Kind::kShortUnchecked;
    flags_ |= unchecked && wait == 1 ? kCcrcfail : kCmdrend;
  }
  if (spec_.v2 && bit(cmd, 6) && !moving()) arm();                     // CMDTRANS
  if (spec_.v2 && bit(cmd, 7) && data_ != Data::kIdle && left_ > 0) {  // CMDSTOP
    data_ = Data::kIdle;
    data_at_ = timeout_at_ = kNever;
    flags_ |= kDabort;
  }
  if (card_ != nullptr && card_->busy_until_ns() > now_ns()) busy_end_ = at_ns(card_->busy_until_ns());
  look_for_data();
}

// A transfer of DLEN bytes is expected from now on.
void Sdmmc::arm() {
  const std::uint32_t dctrl = value(kDctrl);
  left_ = value(kDlen);
  block_left_ = block_bytes();
  data_ = left_ == 0 ? Data::kIdle : (dctrl & kDtdir) != 0 ? Data::kReceive : Data::kTransmit;
  to_feed_ = data_ == Data::kTransmit ? (left_ + 3) / 4 : 0;
  block_.clear();
  fifo_.clear();
  moved_ = false;
  memory_at_ = bit(value(kIdmaCtrl), 2) ? value(kIdmaBase1) : value(kIdmaBase0);
  memory_left_ = bit(value(kIdmaCtrl), 1) ? value(kIdmaSize) : ~0u;
  if (own_dma() && data_ != Data::kIdle && !context_.reaches(memory_at_, name())) {
    data_ = Data::kIdle;
    flags_ |= kIdmate;
  }
  timeout_at_ = data_ == Data::kReceive ? now() + clocks(std::max(1u, value(kDtimer))) : kNever;
  look_for_data();
}

// Begins the next piece as soon as card and FIFO are ready for it.
void Sdmmc::look_for_data() {
  if (data_at_ == kNever && card_ != nullptr && data_ == Data::kReceive && card_->sends()) {
    timeout_at_ = kNever;
    data_at_ = at_ns(card_->ready_ns()) + piece_cycles();
  }
  if (data_at_ == kNever && card_ != nullptr && data_ == Data::kTransmit && card_->takes() &&
      (!fifo_.empty() || own_dma())) {
    data_at_ = at_ns(card_->busy_until_ns()) + piece_cycles();
  }
  schedule();
}

void Sdmmc::run_events() {
  if (command_end_ <= now()) finish_command();
  if (data_at_ <= now()) piece_done();
  if (timeout_at_ <= now()) {
    timeout_at_ = kNever;
    data_ = Data::kIdle;
    flags_ |= kDtimeout;
  }
  if (busy_end_ <= now()) {
    busy_end_ = kNever;
    if (spec_.v2) flags_ |= kBusyd0end;
  }
  schedule();
  update();
}

void Sdmmc::piece_done() {
  data_at_ = kNever;
  moved_ = true;
  if (data_ == Data::kReceive) {
    receive_piece();
  } else if (data_ == Data::kTransmit) {
    transmit_piece();
  }
  look_for_data();
}

void Sdmmc::memory_moved() {
  memory_at_ += 4;
  if (!bit(value(kIdmaCtrl), 1)) return;  // one buffer
  memory_left_ -= 4;
  if (memory_left_ != 0) return;
  value(kIdmaCtrl) ^= 4u;
  flags_ |= kIdmaBtc;
  memory_at_ = bit(value(kIdmaCtrl), 2) ? value(kIdmaBase1) : value(kIdmaBase0);
  memory_left_ = value(kIdmaSize);
}

void Sdmmc::receive_piece() {
  const std::uint32_t bytes = piece_bytes(), words = (bytes + 3) / 4;
  if (!own_dma() && fifo_.size() + words > fifo_words()) {
    if (flow_control()) return;  // the clock stands until the FIFO has been read: load() looks again
    flags_ |= kRxoverr;
    data_ = Data::kIdle;
    return;
  }
  std::uint8_t piece[kPieceBytes] = {};
  card_->send(std::span(piece).first(bytes));
  for (std::uint32_t i = 0; i < words; ++i) {
    const std::uint32_t word = piece[4 * i] | piece[4 * i + 1] << 8 | piece[4 * i + 2] << 16 |
                               static_cast<std::uint32_t>(piece[4 * i + 3]) << 24;
    if (own_dma()) {
      system().bus_write(memory_at_, 4, word);
      memory_moved();
    } else {
      fifo_.push_back(word);
    }
  }
  left_ -= bytes;
  block_left_ -= bytes;
  if (block_left_ == 0 || left_ == 0) end_block();
}

void Sdmmc::transmit_piece() {
  const std::uint32_t bytes = piece_bytes(), words = (bytes + 3) / 4;
  if (!own_dma() && fifo_.size() < words) {
    if (flow_control()) return;  // store() looks again
    flags_ |= kTxunderr;
    data_ = Data::kIdle;
    fifo_.clear();
    return;
  }
  for (std::uint32_t i = 0; i < words; ++i) {
    std::uint32_t word = 0;
    if (own_dma()) {
      word = system().bus_read(memory_at_, 4);
      memory_moved();
    } else {
      word = fifo_.front();
      fifo_.pop_front();
    }
    for (unsigned b = 0; b < 4; ++b) block_.push_back(static_cast<std::uint8_t>(word >> (8 * b)));
  }
  left_ -= bytes;
  block_left_ -= bytes;
  if (block_left_ != 0 && left_ != 0) return;
  card_->take(block_, now_ns());
  block_.clear();
  if (card_->busy_until_ns() > now_ns()) busy_end_ = at_ns(card_->busy_until_ns());
  end_block();
}

void Sdmmc::end_block() {
  if (!stream()) flags_ |= kDbckend;
  block_left_ = block_bytes();
  if (left_ != 0) return;
  flags_ |= kDataend;
  data_ = Data::kIdle;
  if (spec_.v2) value(kDctrl) &= ~kDten;
}

std::uint32_t Sdmmc::status() const {
  const std::size_t half = fifo_words() / 2, in = fifo_.size();
  const bool transmits = data_ == Data::kTransmit, full = in >= fifo_words();
  std::uint32_t sta = flags_;
  if (transmits) {
    sta |= (in + half <= fifo_words() ? kHalfEmpty : 0u) | (in == 0 ? kTxEmpty : 0u) | (full ? kTxFull : 0u);
  } else {
    sta |= (in >= half ? kHalfFull : 0u) | (in == 0 ? kRxEmpty : 0u) | (full ? kRxFull : 0u);
  }
  const bool commands = command_end_ != kNever;
  if (spec_.v2) {
    const bool busy = card_ != nullptr && card_->busy_until_ns() > now_ns();
    return sta | (data_ != Data::kIdle ? kDpsmact : 0u) | (commands ? kCpsmact : 0u) | (busy ? kBusyd0 : 0u);
  }
  if (in > 0) sta |= transmits ? kTxdavl : kRxdavl;
  return sta | (commands ? kCmdact1 : 0u) | (transmits ? kTxact : 0u) |
         (data_ == Data::kReceive ? kRxact : 0u);
}

// The request last: a controller reads and writes the FIFO at once.
void Sdmmc::update() {
  irq_.set((status() & value(kMask)) != 0);
  if (spec_.v2) return;
  const bool fed = data_ == Data::kTransmit && to_feed_ > 0 && fifo_.size() < fifo_words();
  const bool drained = data_ != Data::kTransmit && !fifo_.empty();
  context_.dma.set(dma_, (value(kDctrl) & kDmaen1) != 0 && (fed || drained));
}

std::uint32_t Sdmmc::load(std::uint32_t offset) {
  if (offset < kFifo) return shown(offset);
  if (fifo_.empty() || data_ == Data::kTransmit) return 0;
  const std::uint32_t word = fifo_.front();
  fifo_.pop_front();
  look_for_data();
  update();
  return word;
}

std::uint32_t Sdmmc::shown(std::uint32_t offset) {
  switch (offset) {
    case kSta:
      return status();
    case kDcount:
      return left_;
    case kFifoCount:
      return spec_.v2                   ? 0
             : data_ == Data::kTransmit ? to_feed_
                                        : static_cast<std::uint32_t>((left_ + 3) / 4 + fifo_.size());
    default:
      return offset < kFifo ? value(offset) : fifo_.empty() ? 0 : fifo_.front();
  }
}

void Sdmmc::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  if (offset >= kFifo) {
    if (data_ == Data::kTransmit && to_feed_ > 0 && fifo_.size() < fifo_words()) {
      fifo_.push_back(written);
      --to_feed_;
    }
  } else if (offset == kIcr) {
    flags_ &= ~written;
  } else if (offset == kDctrl) {
    const bool was = (value(kDctrl) & kDten) != 0;
    keep(offset, written, lanes);
    if (spec_.v2 && (written & kFiforst) != 0) fifo_.clear();
    const bool is = (value(kDctrl) & kDten) != 0;
    // Written again it begins the next transfer (RM0410 39.8.9), and one that nothing has moved of anew.
    if (is && !moving()) arm();
    if (!is && was) {
      data_ = Data::kIdle;
      data_at_ = timeout_at_ = kNever;
    }
  } else {
    keep(offset, written, lanes);
    if (offset == kCmd) control_command(value(kCmd));
    if (offset == kClkcr) context_.clocks.need(Bus::kSdmmc, name());
  }
  look_for_data();
  update();
}

}  // namespace omnihil::mcu

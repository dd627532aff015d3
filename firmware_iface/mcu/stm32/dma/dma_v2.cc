#include "firmware_iface/mcu/stm32/dma/dma_v2.h"

#include <algorithm>

#include "firmware_iface/mcu/stm32/register_table.h"

namespace omnihil::mcu {
namespace {
constexpr unsigned kStreams = 8;
constexpr unsigned kPlace[] = {0, 6, 16, 22};  // of a stream's flags in LISR, HISR
enum : unsigned { kCr, kNdtr, kPar, kM0ar, kM1ar, kFcr };
constexpr std::uint32_t kEn = 1, kCirc = 1u << 8, kPinc = 1u << 9, kMinc = 1u << 10, kDbm = 1u << 18,
                        kCt = 1u << 19;
constexpr std::uint32_t kHalf = 1u << 4, kComplete = 1u << 5, kError = 1u << 3;
constexpr int kMaxItemsAtOnce = 256;

std::span<const RegisterInfo> table() {
  static const RegisterTable all = [] {
    RegisterTable t;
    t.add(0x00, "LISR", 0, 0);
    t.add(0x04, "HISR", 0, 0);
    t.add(0x08, "LIFCR", 0, 0);
    t.add(0x0C, "HIFCR", 0, 0);
    for (unsigned s = 0; s < kStreams; ++s) {
      const std::string n = std::to_string(s);
      t.add(0x10 + 24 * s, "S" + n + "CR", 0, 0x1FEFFFFF, 0x00008020);
      t.add(0x14 + 24 * s, "S" + n + "NDTR", 0, 0xFFFF);
      t.add(0x18 + 24 * s, "S" + n + "PAR");
      t.add(0x1C + 24 * s, "S" + n + "M0AR");
      t.add(0x20 + 24 * s, "S" + n + "M1AR");
      t.add(0x24 + 24 * s, "S" + n + "FCR", 0x21, 0x87);
    }
    return t;
  }();
  return all.rows();
}
}  // namespace

DmaV2::DmaV2(int number, std::vector<int> irqs, ChipContext& context)
    : RegisterBlock("DMA" + std::to_string(number), context.system, table()),
      context_(context),
      streams_(kStreams) {
  for (const int irq : irqs) irqs_.emplace_back(context.irqs, irq);
  context.dma.add(*this);
}

void DmaV2::connect(std::string_view request, unsigned stream, unsigned channel) {
  rows_.push_back({context_.dma.line(request), stream, channel});
}

void DmaV2::use_mux(const DmaMux& mux, unsigned first) {
  mux_ = &mux;
  mux_first_ = first;
}

void DmaV2::announce_ends() {
  for (unsigned s = 0; s < kStreams; ++s)
    ends_.push_back(context_.dma.line(name() + "_TC" + std::to_string(s)));
}

void DmaV2::reset() {
  RegisterBlock::reset();
  update_irqs();
  update_ends();
}

std::uint32_t DmaV2::flags(unsigned s) const { return value(s < 4 ? 0x00 : 0x04) >> kPlace[s % 4] & 0x3Du; }

void DmaV2::flag(unsigned s, std::uint32_t flags) {
  value(s < 4 ? 0x00 : 0x04) |= flags << kPlace[s % 4];
  update_irqs();
  update_ends();
}

void DmaV2::update_ends() {
  for (unsigned s = 0; s < ends_.size(); ++s) context_.dma.set(ends_[s], (flags(s) & kComplete) != 0);
}

void DmaV2::update_irqs() {
  for (unsigned s = 0; s < irqs_.size(); ++s) {
    const std::uint32_t cr = reg(s, kCr), f = flags(s);
    irqs_[s].set(((f & kComplete) != 0 && bit(cr, 4)) || ((f & kHalf) != 0 && bit(cr, 3)) ||
                 ((f & kError) != 0 && bit(cr, 2)));
  }
}

void DmaV2::requested(int line) {
  for (unsigned s = 0; mux_ != nullptr && s < kStreams; ++s) {
    if (mux_->line(mux_first_ + s) == line) serve(s, line);
  }
  for (const Row& row : rows_) {
    if (row.line == line && field(reg(row.stream, kCr), 25, 3) == row.channel) serve(row.stream, line);
  }
}

void DmaV2::serve(unsigned s, int line) {
  for (int n = 0; context_.dma.high(line) && (reg(s, kCr) & kEn) != 0 && field(reg(s, kCr), 6, 2) < 2; ++n) {
    if (streams_[s].left == 0) return;
    if (n == kMaxItemsAtOnce) {
      system().report_unmodelled(name(), "a request that its transfers do not take away");
      return;
    }
    context_.dma.taken(line);
    item(s);
  }
}

void DmaV2::start(unsigned s) {
  const std::uint32_t cr = reg(s, kCr), direction = field(cr, 6, 2);
  Stream& stream = streams_[s];
  stream.left = stream.all = reg(s, kNdtr);
  // NDTR counts items of the peripheral's size; packing by the FIFO puts the same bytes to memory.
  const unsigned bytes = 1u << std::min(field(cr, 11, 2), 2u);
  stream.transfer = {.peripheral = reg(s, kPar),
                     .memory = reg(s, (cr & (kDbm | kCt)) == (kDbm | kCt) ? kM1ar : kM0ar),
                     .peripheral_bytes = bytes,
                     .memory_bytes = bytes,
                     .peripheral_steps = (cr & kPinc) != 0,
                     .memory_steps = (cr & kMinc) != 0,
                     .to_peripheral = direction == 1};
  if (!context_.reaches(stream.transfer.peripheral, name()) ||
      !context_.reaches(stream.transfer.memory, name())) {
    fail(s);
    return;
  }
  if (direction == 2) {  // memory to memory: from PAR to M0AR
    while (stream.left > 0 && (reg(s, kCr) & kEn) != 0) item(s);
    return;
  }
  if (mux_ != nullptr) {
    const int line = mux_->line(mux_first_ + s);
    if (line >= 0 && context_.dma.high(line)) serve(s, line);
  }
  for (const Row& row : rows_) {
    if (row.stream == s && row.channel == field(cr, 25, 3) && context_.dma.high(row.line)) serve(s, row.line);
  }
}

void DmaV2::item(unsigned s) {
  Stream& stream = streams_[s];
  std::uint32_t& cr = reg(s, kCr);
  --stream.left;
  const bool last = stream.left == 0, half = !last && stream.left == stream.all / 2;
  const DmaTransfer transfer = stream.transfer;
  if (transfer.peripheral_steps) stream.transfer.peripheral += transfer.peripheral_bytes;
  if (transfer.memory_steps) stream.transfer.memory += transfer.memory_bytes;
  if (last && (cr & (kCirc | kDbm)) != 0) {
    if ((cr & kDbm) != 0) cr ^= kCt;
    stream.left = stream.all;
    stream.transfer.peripheral = reg(s, kPar);
    stream.transfer.memory = reg(s, (cr & (kDbm | kCt)) == (kDbm | kCt) ? kM1ar : kM0ar);
  } else if (last) {
    cr &= ~kEn;
    reg(s, kNdtr) = 0;
  }
  DmaTransfer now_moved = transfer;
  move_item(system(), now_moved);
  if (last) flag(s, kComplete);
  if (half) flag(s, kHalf);
}

bool DmaV2::fail_transfer() {
  for (unsigned s = 0; s < kStreams; ++s) {
    if ((reg(s, kCr) & kEn) == 0 || streams_[s].left == 0) continue;
    fail(s);
    return true;
  }
  return false;
}

void DmaV2::fail(unsigned s) {
  reg(s, kCr) &= ~kEn;
  reg(s, kNdtr) = streams_[s].left;
  flag(s, kError);
}

std::uint32_t DmaV2::load(std::uint32_t offset) {
  if (offset >= 0x10 && (offset - 0x10) % 24 == 4) {
    const unsigned s = (offset - 0x10) / 24;
    return (reg(s, kCr) & kEn) != 0 ? streams_[s].left : value(offset);
  }
  return value(offset);
}

void DmaV2::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  if (offset < 0x08) return;
  if (offset < 0x10) {
    value(offset - 8) &= ~written;
    update_ends();
    return update_irqs();
  }
  const unsigned s = (offset - 0x10) / 24, which = (offset - 0x10) % 24 / 4;
  const bool was = (reg(s, kCr) & kEn) != 0;
  if (was && (which == kNdtr || which == kPar)) return;
  keep(offset, written, lanes);
  if (which != kCr) return;
  const bool is = (reg(s, kCr) & kEn) != 0;
  if (was && !is) {  // stopped on the way: as RM0090 §10.3.17 says, TCIF is set
    reg(s, kNdtr) = streams_[s].left;
    flag(s, kComplete);
  }
  update_irqs();
  if (is && !was) start(s);
}

}  // namespace omnihil::mcu

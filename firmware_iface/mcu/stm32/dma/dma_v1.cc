#include "firmware_iface/mcu/stm32/dma/dma_v1.h"

#include <algorithm>
#include <utility>

#include "firmware_iface/mcu/stm32/register_table.h"

namespace omnihil::mcu {
namespace {
constexpr unsigned kChannels = 8;
enum : std::uint32_t { kIsr = 0x00, kIfcr = 0x04 };
enum : unsigned { kCcr, kCndtr, kCpar, kCmar };  // of a channel
constexpr std::uint32_t kEn = 1, kDir = 1u << 4, kCirc = 1u << 5, kPinc = 1u << 6, kMinc = 1u << 7,
                        kMem2Mem = 1u << 14;
constexpr std::uint32_t kGlobal = 1, kComplete = 2, kHalf = 4, kError = 8;
constexpr int kMaxItemsAtOnce = 256;  // a peripheral that never lowers its request must not stop time

std::span<const RegisterInfo> table() {
  static const RegisterTable all = [] {
    RegisterTable t;
    t.add(kIsr, "ISR", 0, 0);
    t.add(kIfcr, "IFCR", 0, 0);
    for (unsigned c = 0; c < kChannels; ++c) {
      const std::string n = std::to_string(c + 1);
      t.add(0x08 + 20 * c, "CCR" + n, 0, 0x7FFF);
      t.add(0x0C + 20 * c, "CNDTR" + n, 0, 0xFFFF);
      t.add(0x10 + 20 * c, "CPAR" + n);
      t.add(0x14 + 20 * c, "CMAR" + n);
    }
    t.add(0xA8, "CSELR", 0, 0x0FFFFFFF);
    return t;
  }();
  return all.rows();
}

std::span<const RegisterInfo> mux_table() {
  static const RegisterTable all = [] {
    RegisterTable t;
    for (unsigned c = 0; c < 16; ++c) t.add(4 * c, "C" + std::to_string(c) + "CR", 0, 0x1F1F03FF, 0x00010000);
    t.add(0x80, "CSR", 0, 0);
    t.add(0x84, "CFR", 0, 0);
    for (unsigned c = 0; c < 8; ++c)
      t.add(0x100 + 4 * c, "RG" + std::to_string(c) + "CR", 0, 0xFFFFFFFF, 0x00010000);
    t.add(0x140, "RGSR", 0, 0);
    t.add(0x144, "RGCFR", 0, 0);
    return t;
  }();
  return all.rows();
}
}  // namespace

DmaMux::DmaMux(const char* name, const std::vector<std::pair<unsigned, std::string>>& requests,
               ChipContext& context)
    : RegisterBlock(name, context.system, mux_table()) {
  for (const auto& [number, request] : requests) {
    if (lines_.size() <= number) lines_.resize(number + 1, -1);
    lines_[number] = context.dma.line(request);
  }
}

int DmaMux::line(unsigned channel) const {
  const std::uint32_t request = value(4 * channel) & 0x7Fu;
  return request < lines_.size() ? lines_[request] : -1;
}

DmaV1::DmaV1(const std::string& name, std::vector<int> irqs, ChipContext& context)
    : RegisterBlock(name, context.system, table()), context_(context), channels_(kChannels) {
  for (const int irq : irqs) irqs_.emplace_back(context.irqs, irq);
  context.dma.add(*this);
}

void DmaV1::connect(std::string_view request, unsigned channel, int code) {
  const int line = context_.dma.line(request);
  channels_[channel - 1].wires.push_back({line, code});
  const auto at = static_cast<std::size_t>(line);
  if (wired_to_.size() <= at) wired_to_.resize(at + 1);
  wired_to_[at] |= static_cast<std::uint8_t>(1u << (channel - 1));
}

void DmaV1::use_mux(const DmaMux& mux, unsigned first) {
  mux_ = &mux;
  mux_first_ = first;
}

void DmaV1::reset() {
  RegisterBlock::reset();
  update_irqs();
}

bool DmaV1::serves(unsigned channel, int line) const {
  if (mux_ != nullptr) return mux_->line(mux_first_ + channel) == line;
  const auto& wires = channels_[channel].wires;
  return std::any_of(wires.begin(), wires.end(),
                     [&](const Wire& wire) { return wire.line == line && chosen(channel, wire.code); });
}

// A bit for each channel that this line may request: it serves() those that are set so.
std::uint32_t DmaV1::wired_to(int line) const {
  if (mux_ != nullptr) return (1u << irqs_.size()) - 1u;
  const auto at = static_cast<std::size_t>(line);
  return at < wired_to_.size() ? wired_to_[at] : 0u;
}

void DmaV1::update_irqs() {
  for (unsigned c = 0; c < irqs_.size(); ++c) update_irq(c);
}

void DmaV1::update_irq(unsigned c) {
  const std::uint32_t flags = value(kIsr) >> (4 * c) & 0xEu;
  if (c < irqs_.size()) irqs_[c].set((flags & reg(c, kCcr) & 0xEu) != 0);
}

void DmaV1::requested(int line) {
  const std::uint32_t channels = wired_to(line);
  for (unsigned c = 0; channels >> c != 0; ++c) {
    if ((channels >> c & 1u) == 0 || !serves(c, line)) continue;
    for (int n = 0; context_.dma.high(line) && (reg(c, kCcr) & (kEn | kMem2Mem)) == kEn; ++n) {
      if (channels_[c].left == 0) break;
      if (n == kMaxItemsAtOnce) {
        system().report_unmodelled(name(), "a request that its transfers do not take away");
        break;
      }
      context_.dma.taken(line);
      item(c);
    }
  }
}

void DmaV1::start(unsigned c) {
  const std::uint32_t ccr = reg(c, kCcr);
  Channel& channel = channels_[c];
  channel.left = channel.all = reg(c, kCndtr);
  channel.transfer = {.peripheral = reg(c, kCpar),
                      .memory = reg(c, kCmar),
                      .peripheral_bytes = 1u << std::min(field(ccr, 8, 2), 2u),
                      .memory_bytes = 1u << std::min(field(ccr, 10, 2), 2u),
                      .peripheral_steps = (ccr & kPinc) != 0,
                      .memory_steps = (ccr & kMinc) != 0,
                      .to_peripheral = (ccr & kDir) != 0};
  if (!context_.reaches(channel.transfer.peripheral, name()) ||
      !context_.reaches(channel.transfer.memory, name())) {
    fail(c);
    return;
  }
  if ((ccr & kMem2Mem) != 0) {
    while (channel.left > 0 && (reg(c, kCcr) & kEn) != 0) item(c);
    return;
  }
  if (mux_ != nullptr) {
    const int line = mux_->line(mux_first_ + c);
    if (line >= 0 && context_.dma.high(line)) requested(line);
    return;
  }
  for (const Wire& wire : channel.wires) {
    if (context_.dma.high(wire.line)) requested(wire.line);
  }
}

void DmaV1::item(unsigned c) {
  Channel& channel = channels_[c];
  --channel.left;
  const bool last = channel.left == 0, half = channel.left == channel.all / 2;
  const bool again = last && (reg(c, kCcr) & kCirc) != 0 && (reg(c, kCcr) & kMem2Mem) == 0;
  DmaTransfer transfer = channel.transfer;
  if (again) {
    channel.left = channel.all;
    channel.transfer.peripheral = reg(c, kCpar);
    channel.transfer.memory = reg(c, kCmar);
  } else {
    if (transfer.peripheral_steps) channel.transfer.peripheral += transfer.peripheral_bytes;
    if (transfer.memory_steps) channel.transfer.memory += transfer.memory_bytes;
  }
  move_item(system(), transfer);
  if (last) value(kIsr) |= (kGlobal | kComplete) << (4 * c);
  if (half && !last) value(kIsr) |= (kGlobal | kHalf) << (4 * c);
  if (last || half) update_irq(c);
}

bool DmaV1::fail_transfer() {
  for (unsigned c = 0; c < irqs_.size(); ++c) {
    if ((reg(c, kCcr) & kEn) == 0 || channels_[c].left == 0) continue;
    fail(c);
    return true;
  }
  return false;
}

void DmaV1::fail(unsigned c) {
  reg(c, kCcr) &= ~kEn;
  reg(c, kCndtr) = channels_[c].left;
  value(kIsr) |= (kGlobal | kError) << (4 * c);
  update_irqs();
}

std::uint32_t DmaV1::load(std::uint32_t offset) {
  if (offset >= 0x08 && offset < 0xA8 && (offset - 0x08) % 20 == 4) {
    const unsigned c = (offset - 0x08) / 20;
    return (reg(c, kCcr) & kEn) != 0 ? channels_[c].left : value(offset);
  }
  return value(offset);
}

void DmaV1::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  if (offset == kIfcr) {
    for (unsigned c = 0; c < kChannels; ++c) {
      const std::uint32_t flags = written >> (4 * c) & 0xFu;
      value(kIsr) &= ~(((flags & kGlobal) != 0 ? 0xFu : flags) << (4 * c));
    }
    return update_irqs();
  }
  if (offset < 0x08 || offset >= 0xA8) return keep(offset, written, lanes);
  const unsigned c = (offset - 0x08) / 20, which = (offset - 0x08) % 20 / 4;
  const bool was = (reg(c, kCcr) & kEn) != 0;
  if (was && which != kCcr) return;  // write-protected while enabled
  keep(offset, written, lanes);
  if (which != kCcr) return;
  const bool is = (reg(c, kCcr) & kEn) != 0;
  if (was && !is) reg(c, kCndtr) = channels_[c].left;
  update_irqs();
  if (is && !was) start(c);
}

}  // namespace omnihil::mcu

#include "firmware_iface/mcu/stm32/dma/mdma.h"

#include <fmt/format.h>

#include <algorithm>

#include "firmware_iface/mcu/stm32/register_table.h"

namespace omnihil::mcu {
namespace {
constexpr unsigned kChannels = 16;
// of a channel, from its first register
enum : std::uint32_t {
  kIsr = 0x00,
  kIfcr = 0x04,
  kEsr = 0x08,
  kCr = 0x0C,
  kTcr = 0x10,
  kBndtr = 0x14,
  kSar = 0x18,
  kDar = 0x1C,
  kBrur = 0x20,
  kLar = 0x24,
  kTbr = 0x28,
  kMar = 0x30,
  kMdr = 0x34,
  kBytes = 0x40
};
constexpr std::uint32_t kEn = 1, kSoftwareRequest = 1u << 16;  // CR
// ISR and IFCR; the interrupts' enables stand one place above in CR
constexpr std::uint32_t kError = 1, kChannelDone = 2, kBlocksDone = 4, kBlockDone = 8, kBufferDone = 16,
                        kAllFlags = 0x1F;
constexpr std::uint32_t kWriteFailed = 1u << 7, kBlockSizeError = 1u << 11;                      // ESR
constexpr std::uint32_t kPacked = 1u << 25, kSoftwareMode = 1u << 30;                            // TCR
constexpr std::uint32_t kBndt = 0x1FFFF, kSourceMinus = 1u << 18, kDestinationMinus = 1u << 19;  // BNDTR
constexpr unsigned kSourceBus = 16, kDestinationBus = 17;                                        // TBR
constexpr int kMostAtOnce =
    1 << 20;  // buffers of one request: a list that leads to itself must not stop time

std::span<const RegisterInfo> table() {
  static const RegisterTable all = [] {
    RegisterTable t;
    t.add(0x00, "GISR0", 0, 0);
    for (unsigned c = 0; c < kChannels; ++c) {
      const std::uint32_t at = 0x40 + kBytes * c;
      const std::string n = "C" + std::to_string(c);
      t.add(at + kIsr, n + "ISR", 0, 0);
      t.add(at + kIfcr, n + "IFCR", 0, 0);
      t.add(at + kEsr, n + "ESR", 0, 0);
      t.add(at + kCr, n + "CR", 0, 0x000070FF, 0x00007000);
      t.add(at + kTcr, n + "TCR");
      t.add(at + kBndtr, n + "BNDTR", 0, 0xFFFDFFFF);
      t.add(at + kSar, n + "SAR");
      t.add(at + kDar, n + "DAR");
      t.add(at + kBrur, n + "BRUR");
      t.add(at + kLar, n + "LAR", 0, 0xFFFFFFF8);
      t.add(at + kTbr, n + "TBR", 0, 0x0003003F);
      t.add(at + kMar, n + "MAR");
      t.add(at + kMdr, n + "MDR");
    }
    return t;
  }();
  return all.rows();
}

// SINC and SINCOS, or DINC and DINCOS: the address stays, goes up or down.
std::uint32_t step_of(std::uint32_t mode, std::uint32_t size) {
  const std::uint32_t bytes = 1u << size;
  return mode == 2 ? bytes : mode == 3 ? 0u - bytes : 0u;
}
}  // namespace

Mdma::Mdma(int irq, const std::vector<std::string>& requests, ChipContext& context)
    : RegisterBlock("MDMA", context.system, table()),
      context_(context),
      irq_(context.irqs, irq),
      block_bytes_(kChannels) {
  for (const std::string& name : requests) lines_.push_back(name.empty() ? -1 : context.dma.line(name));
  context.dma.add(*this);
}

void Mdma::reset() {
  RegisterBlock::reset();
  update_irq();
}

bool Mdma::active(unsigned c) { return (reg(c, kCr) & kEn) != 0; }

void Mdma::update_irq() {
  bool asks = false;
  for (unsigned c = 0; c < kChannels; ++c) asks = asks || (reg(c, kIsr) & reg(c, kCr) >> 1 & kAllFlags) != 0;
  irq_.set(asks);
}

int Mdma::line_of(unsigned c) {
  const std::uint32_t selected = reg(c, kTbr) & 0x3Fu;
  if ((reg(c, kTcr) & kSoftwareMode) != 0 || selected >= lines_.size()) return -1;
  return lines_[selected];
}

// The line stays high until what MDR writes to MAR, or a handler, takes its reason away.
void Mdma::requested(int line) {
  for (unsigned c = 0; c < kChannels; ++c) {
    for (int n = 0; active(c) && line_of(c) == line && context_.dma.high(line); ++n) {
      if (n == kMostAtOnce) {
        system().report_unmodelled(name(), "a request that its transfers do not take away");
        break;
      }
      context_.dma.taken(line);
      serve(c);
    }
  }
}

// One request: as much as TRGM said when it came.
void Mdma::serve(unsigned c) {
  const auto until = static_cast<Over>(field(reg(c, kTcr), 28, 2));
  for (int n = 0; n < kMostAtOnce; ++n) {
    const Over over = move_buffer(c);
    if (over >= until || over == Over::kChannel) return update_irq();
  }
  system().report_unmodelled(name(), "a list that leads to itself, moved by one request");
  fail(c, 0);
}

Mdma::Over Mdma::move_buffer(unsigned c) {
  const std::uint32_t left = reg(c, kBndtr) & kBndt, bytes = std::min(left, field(reg(c, kTcr), 18, 7) + 1);
  if (!move_bytes(c, bytes)) return Over::kChannel;
  reg(c, kBndtr) -= bytes;
  reg(c, kIsr) |= kBufferDone;
  if (reg(c, kMar) != 0) system().bus_write(reg(c, kMar), 4, reg(c, kMdr));
  return left > bytes ? Over::kBuffer : end_block(c);
}

Mdma::Over Mdma::end_block(unsigned c) {
  reg(c, kIsr) |= kBlockDone;
  std::uint32_t& bndtr = reg(c, kBndtr);
  if (bndtr >> 20 > 0) {  // BRC
    const std::uint32_t by_source = reg(c, kBrur) & 0xFFFFu, by_destination = reg(c, kBrur) >> 16;
    reg(c, kSar) += (bndtr & kSourceMinus) != 0 ? 0u - by_source : by_source;
    reg(c, kDar) += (bndtr & kDestinationMinus) != 0 ? 0u - by_destination : by_destination;
    bndtr = (bndtr - (1u << 20)) | block_bytes_[c];
    return Over::kBlock;
  }
  reg(c, kIsr) |= kBlocksDone;
  const std::uint32_t next = reg(c, kLar);
  if (next == 0) {
    reg(c, kCr) &= ~kEn;
    reg(c, kIsr) |= kChannelDone;
    return Over::kChannel;
  }
  for (const std::uint32_t at : {kTcr, kBndtr, kSar, kDar, kBrur, kLar, kTbr, kMar, kMdr})
    reg(c, at) = system().bus_read(next + at - kTcr, 4);
  start(c);
  return active(c) ? Over::kBlocks : Over::kChannel;
}

void Mdma::start(unsigned c) {
  block_bytes_[c] = reg(c, kBndtr) & kBndt;
  if (block_bytes_[c] == 0) return fail(c, kBlockSizeError);
  if ((reg(c, kTcr) & kSoftwareMode) != 0 || line_of(c) >= 0) return;
  system().report_unmodelled(name(), fmt::format("request {} of TSEL", reg(c, kTbr) & 0x3Fu));
}

// SBUS, DBUS: the core's bus for its memories; else all the others.
bool Mdma::reaches(unsigned c, std::uint32_t address, bool is_write) {
  bool reached = true;
  if (bit(reg(c, kTbr), is_write ? kDestinationBus : kSourceBus)) {
    reached = std::any_of(context_.core_only.begin(), context_.core_only.end(),
                          [&](const ChipContext::Range& r) { return address - r.base < r.bytes; });
  } else {
    reached = context_.reaches(address, name());
  }
  if (!reached) fail(c, (address & 0x7Fu) | (is_write ? kWriteFailed : 0u));
  return reached;
}

std::uint64_t Mdma::read_item(std::uint32_t address, unsigned size) {
  if (size < 3) return system().bus_read(address, 1u << size);
  const std::uint64_t low = system().bus_read(address, 4);
  return std::uint64_t{system().bus_read(address + 4, 4)} << 32 | low;
}

void Mdma::write_item(std::uint32_t address, unsigned size, std::uint64_t item) {
  system().bus_write(address, 1u << std::min(size, 2u), static_cast<std::uint32_t>(item));
  if (size == 3) system().bus_write(address + 4, 4, static_cast<std::uint32_t>(item >> 32));
}

bool Mdma::move_bytes(unsigned c, std::uint32_t bytes) {
  const std::uint32_t tcr = reg(c, kTcr), from = field(tcr, 4, 2), to = field(tcr, 6, 2);
  const bool packed = (tcr & kPacked) != 0 || from == to;
  if (bytes % (1u << from) != 0 || (packed && bytes % (1u << to) != 0)) {
    fail(c, kBlockSizeError);
    return false;
  }
  if (!packed && field(tcr, 26, 2) != 0) system().report_unmodelled(name(), "alignment by PAM");
  if (!reaches(c, reg(c, kSar), false) || !reaches(c, reg(c, kDar), true)) return false;
  const std::uint32_t source_step = step_of(field(tcr, 0, 2), field(tcr, 8, 2));
  const std::uint32_t destination_step = step_of(field(tcr, 2, 2), field(tcr, 10, 2));
  std::vector<std::uint8_t> held;  // what has been read and not written
  for (std::uint32_t done = 0; done < bytes; done += 1u << from) {
    const std::uint64_t item = read_item(reg(c, kSar), from);
    reg(c, kSar) += source_step;
    if (!packed) {
      write_item(reg(c, kDar), to, item);
      reg(c, kDar) += destination_step;
      continue;
    }
    for (unsigned i = 0; i < 1u << from; ++i) held.push_back(static_cast<std::uint8_t>(item >> (8 * i)));
    while (held.size() >= 1u << to) {
      std::uint64_t out = 0;
      for (unsigned i = 0; i < 1u << to; ++i) out |= std::uint64_t{held[i]} << (8 * i);
      held.erase(held.begin(), held.begin() + (1 << to));
      write_item(reg(c, kDar), to, out);
      reg(c, kDar) += destination_step;
    }
  }
  return true;
}

bool Mdma::fail_transfer() {
  for (unsigned c = 0; c < kChannels; ++c) {
    if (!active(c)) continue;
    fail(c, reg(c, kSar) & 0x7Fu);
    return true;
  }
  return false;
}

void Mdma::fail(unsigned c, std::uint32_t error) {
  reg(c, kCr) &= ~kEn;
  reg(c, kEsr) = error;
  reg(c, kIsr) |= kError;
  update_irq();
}

std::uint32_t Mdma::load(std::uint32_t offset) {
  if (offset != 0) return value(offset);
  std::uint32_t asking = 0;
  for (unsigned c = 0; c < kChannels; ++c)
    asking |= (reg(c, kIsr) & reg(c, kCr) >> 1 & kAllFlags) != 0 ? 1u << c : 0u;
  return asking;
}

void Mdma::control(unsigned c, std::uint32_t written, std::uint32_t lanes) {
  const bool was = active(c);
  keep(0x40 + kBytes * c + kCr, written, lanes);
  if (was && !active(c)) reg(c, kIsr) |= kChannelDone;  // stopped on the way
  if (!was && active(c)) {
    start(c);
    if (const int line = line_of(c); active(c) && line >= 0 && context_.dma.high(line)) requested(line);
  }
  const bool by_software = (reg(c, kTcr) & kSoftwareMode) != 0;
  if ((written & lanes & kSoftwareRequest) != 0 && active(c) && by_software) serve(c);
  update_irq();
}

void Mdma::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  if (offset < 0x40) return;
  const unsigned c = (offset - 0x40) / kBytes;
  const std::uint32_t which = (offset - 0x40) % kBytes;
  if (which == kCr) return control(c, written, lanes);
  if (which == kIfcr) {
    reg(c, kIsr) &= ~(written & kAllFlags);
    if ((written & kError) != 0) reg(c, kEsr) = 0;
    return update_irq();
  }
  if (active(c)) return;  // protected while it is on
  keep(offset, written, lanes);
}

}  // namespace omnihil::mcu

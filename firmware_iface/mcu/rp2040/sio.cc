#include "firmware_iface/mcu/rp2040/sio.h"

#include <fmt/format.h>

#include <string>

namespace omnihil::mcu::rp2040 {
namespace {
enum : std::uint32_t {
  kIn = 0x04,
  kHiIn = 0x08,
  kOut = 0x10,
  kOe = 0x20,
  kHi = 0x30,
  kFifoStatus = 0x50,
  kFifoWrite = 0x54,
  kFifoRead = 0x58,
  kLocks = 0x5C,
  kUDividend = 0x60,
  kUDivisor = 0x64,
  kSDividend = 0x68,
  kSDivisor = 0x6C,
  kQuotient = 0x70,
  kRemainder = 0x74,
  kDividerStatus = 0x78,
  kInterpolators = 0x80,
  kLock0 = 0x100
};
constexpr std::uint32_t kPinMask = (1u << kPins) - 1;
constexpr int kIrqCore0 = 15;
constexpr std::size_t kFifoWords = 8;

const RegisterTable& table() {
  static const RegisterTable rows = [] {
    RegisterTable t;
    t.add(0x00, "CPUID", 0, 0);
    t.add(kIn, "GPIO_IN", 0, 0);
    t.add(kHiIn, "GPIO_HI_IN", 0, 0);
    std::uint32_t at = kOut;
    for (const char* word : {"GPIO_OUT", "GPIO_OE", "GPIO_HI_OUT", "GPIO_HI_OE"}) {
      for (const char* way : {"", "_SET", "_CLR", "_XOR"}) {
        t.add(at, word + std::string(way), 0, at < kHi ? kPinMask : 0x3Fu);
        at += 4;
      }
    }
    t.add(kFifoStatus, "FIFO_ST", 2, 0);
    t.add(kFifoWrite, "FIFO_WR", 0, 0);
    t.add(kFifoRead, "FIFO_RD", 0, 0);
    t.add(kLocks, "SPINLOCK_ST", 0, 0);
    at = kUDividend;
    for (const char* name : {"DIV_UDIVIDEND", "DIV_UDIVISOR", "DIV_SDIVIDEND", "DIV_SDIVISOR", "DIV_QUOTIENT",
                             "DIV_REMAINDER", "DIV_CSR"}) {
      t.add(at, name, at == kDividerStatus ? 1 : 0, at == kDividerStatus ? 0u : 0xFFFFFFFFu);
      at += 4;
    }
    at = kInterpolators;
    for (const char* one : {"INTERP0_", "INTERP1_"}) {
      for (const char* name : {"ACCUM0", "ACCUM1", "BASE0", "BASE1", "BASE2", "POP_LANE0", "POP_LANE1",
                               "POP_FULL", "PEEK_LANE0", "PEEK_LANE1", "PEEK_FULL", "CTRL_LANE0",
                               "CTRL_LANE1", "ACCUM0_ADD", "ACCUM1_ADD", "BASE_1AND0"}) {
        t.add(at, one + std::string(name));
        at += 4;
      }
    }
    for (std::uint32_t i = 0; i < 32; ++i) t.add(kLock0 + 4 * i, "SPINLOCK" + std::to_string(i), 0, 0);
    return t;
  }();
  return rows;
}
}  // namespace

Division divide(std::uint32_t dividend, std::uint32_t divisor, bool with_sign) {
  if (divisor == 0) {
    const bool negative = with_sign && static_cast<std::int32_t>(dividend) < 0;
    return {negative ? 1u : 0xFFFFFFFFu, dividend};
  }
  if (!with_sign) return {dividend / divisor, dividend % divisor};
  const std::int64_t a = static_cast<std::int32_t>(dividend), b = static_cast<std::int32_t>(divisor);
  return {static_cast<std::uint32_t>(a / b), static_cast<std::uint32_t>(a % b)};
}

Sio::Sio(IoBank& io, ChipContext& context)
    : RegisterBlock("SIO", context.system, table().rows()), io_(io), line_(context.irqs, kIrqCore0) {
  next_event_is(kNever);
}

void Sio::reset() {
  RegisterBlock::reset();
  out_ = enable_ = locks_ = dividend_ = divisor_ = fifo_errors_ = 0;
  signed_ = dirty_ = false;
  result_ = {};
  from_1_.clear();
  to_1_.clear();
  launch_step_ = 0;
  interpolators_ = {Interpolator(0), Interpolator(1)};
  io_.drive_from(IoBank::kSio, 0, 0);
  update();
}

Cycles Sio::stable_until(std::uint32_t offset) const {
  const std::uint32_t at = offset & ~3u;
  const bool pops = at == kFifoRead || at == kQuotient || at >= kInterpolators;
  return pops ? 0 : kNever;
}

std::uint32_t Sio::fifo_status() const {
  return (from_1_.empty() ? 0u : 1u) | (to_1_.size() < kFifoWords ? 2u : 0u) | fifo_errors_;
}

void Sio::update() { line_.set((fifo_status() & 0xDu) != 0); }

// The boot ROM's answer, word by word: 0, 0, 1, vectors, stack, entry.
void Sio::to_core_1(std::uint32_t word) {
  constexpr unsigned kWords = 6;
  if (launch_step_ == kWords) {  // nobody reads any more
    if (to_1_.size() < kFifoWords)
      to_1_.push_back(word);
    else
      fifo_errors_ |= 1u << 2;
    return;
  }
  constexpr std::uint32_t kFirst[] = {0, 0, 1};
  const bool fits = launch_step_ >= std::size(kFirst) || word == kFirst[launch_step_];
  launch_step_ = fits ? launch_step_ + 1 : word == 0 ? 1 : 0;
  if (from_1_.size() < kFifoWords) from_1_.push_back(word);
  if (launch_step_ == kWords)
    system().report_unmodelled(
        name(), fmt::format("core 1 was launched at 0x{:08x}: it is not emulated", word & ~1u));
}

std::uint32_t Sio::load(std::uint32_t offset) {
  if (offset >= kLock0) {
    const std::uint32_t lock = 1u << ((offset - kLock0) / 4);
    const bool free = (locks_ & lock) == 0;
    locks_ |= lock;
    return free ? lock : 0u;
  }
  if (offset >= kInterpolators)
    return interpolators_[(offset - kInterpolators) / 0x40].read(offset & 0x3Fu, true);
  const std::uint32_t is = shown(offset);
  if (offset == kQuotient) dirty_ = false;
  if (offset == kFifoRead) {
    if (from_1_.empty())
      fifo_errors_ |= 1u << 3;
    else
      from_1_.pop_front();
    update();
  }
  return is;
}

std::uint32_t Sio::shown(std::uint32_t offset) {
  if (offset >= kLock0) return locks_ >> ((offset - kLock0) / 4) & 1u;
  if (offset >= kInterpolators)
    return interpolators_[(offset - kInterpolators) / 0x40].read(offset & 0x3Fu, false);
  switch (offset) {
    case kIn:
      return io_.inputs();
    case kHiIn:
      return 0x3Eu;  // flash pins: chip select and data idle high
    case kFifoStatus:
      return fifo_status();
    case kFifoRead:
      return from_1_.empty() ? 0u : from_1_.front();
    case kLocks:
      return locks_;
    case kUDividend:
    case kSDividend:
      return dividend_;
    case kUDivisor:
    case kSDivisor:
      return divisor_;
    case kQuotient:
      return result_.quotient;
    case kRemainder:
      return result_.remainder;
    case kDividerStatus:
      return 1u | (dirty_ ? 2u : 0u);
    default:
      break;
  }
  if (offset >= kOut && offset < kOe) return out_;
  if (offset >= kOe && offset < kHi) return enable_;
  return offset >= kHi && offset < kFifoStatus ? value(offset & ~0xFu) : 0u;
}

void Sio::store_divider(std::uint32_t offset, std::uint32_t written) {
  dirty_ = true;
  if (offset == kQuotient) {
    result_.quotient = written;
  } else if (offset == kRemainder) {
    result_.remainder = written;
  } else {
    const bool is_divisor = offset == kUDivisor || offset == kSDivisor;
    (is_divisor ? divisor_ : dividend_) = written;
    signed_ = offset >= kSDividend;
    result_ = divide(dividend_, divisor_, signed_);
  }
}

void Sio::store(std::uint32_t offset, std::uint32_t written, std::uint32_t) {
  const auto change = [written, way = offset >> 2 & 3u](std::uint32_t old) {
    return way == 0 ? written : way == 1 ? old | written : way == 2 ? old & ~written : old ^ written;
  };
  if (offset >= kOut && offset < kHi) {
    std::uint32_t& word = offset < kOe ? out_ : enable_;
    word = change(word) & kPinMask;
    io_.drive_from(IoBank::kSio, out_, enable_);
  } else if (offset >= kHi && offset < kFifoStatus) {
    std::uint32_t& word = value(offset & ~0xFu);
    word = change(word) & 0x3Fu;
  } else if (offset >= kUDividend && offset <= kRemainder) {
    store_divider(offset, written);
  } else if (offset >= kLock0) {
    locks_ &= ~(1u << ((offset - kLock0) / 4));
  } else if (offset >= kInterpolators) {
    interpolators_[(offset - kInterpolators) / 0x40].write(offset & 0x3Fu, written);
  } else if (offset == kFifoWrite) {
    to_core_1(written);
    update();
  } else if (offset == kFifoStatus) {
    fifo_errors_ = 0;
    update();
  }
}

}  // namespace omnihil::mcu::rp2040

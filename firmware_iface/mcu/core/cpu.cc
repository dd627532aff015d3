#include "firmware_iface/mcu/core/cpu.h"

#include <algorithm>
#include <cfenv>
#include <cmath>

#include "firmware_iface/mcu/core/plus_cycles.h"

namespace omnihil::mcu {
namespace {

constexpr std::uint32_t kDevices = 0x40000000, kDevicesSize = 0x20000000;  // peripherals (B3.1)
constexpr std::uint32_t kPrivate = 0xE0000000, kPrivateSize = 0x100000;    // where no memory is
constexpr std::uint32_t kFpscrWritable = 0xF7C0009F, kRoundingMode = 3u << 22;

// In bytes of code: a guess. What is longer, or calls functions, is found by looking now and then.
constexpr std::uint32_t kLongestWait = 64;

int host_rounding(std::uint32_t fpscr) {
  constexpr int kModes[] = {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};
  return kModes[fpscr >> 22 & 3];
}

}  // namespace

Cpu::Cpu(const Variant& variant, Memory& memory, CpuBus& bus, double cpi_scale)
    : variant_(variant), memory_(memory), bus_(bus), scale_(std::lround(cpi_scale * kSubcycles)) {
  trap_unaligned = variant.arch == Arch::kV6M;
  memory_changed();
}

void Cpu::memory_changed() {
  code_ = nullptr;
  ram_ = flash_ = ccm_ = Window{};
  shared_begin_ = kDevices + kDevicesSize;
  shared_end_ = kDevices;
  for (const auto& region : memory_.regions()) {
    Window window{region->base, region->size, region->data(), region->block};
    if (region->base + region->size > kDevices && region->base < kDevices + kDevicesSize) {
      shared_begin_ = std::min(shared_begin_, region->base);
      shared_end_ = std::max(shared_end_, region->base + region->size);
    }
    if (!region->writable()) {
      if (!flash_.data) flash_ = window;
    } else if (!ram_.data) {
      ram_ = window;
    } else if (!ccm_.data) {
      ccm_ = window;
    }
  }
  if (!watches_.empty()) {  // every access then goes the far way, where they are looked at
    ram_ = flash_ = ccm_ = Window{};
    shared_begin_ = 0;
    shared_end_ = ~0u;
  }
  leave_code_out();
}

void Cpu::leave_code_out() {
  store_ = ram_;
  if (ram_.block == nullptr || ram_.block->code_size == 0) return;
  const std::uint32_t begin = ram_.block->code_begin, end = (begin + ram_.block->code_size + 3) & ~3u;
  if (ram_.size - end < begin) {
    store_.size = begin;
  } else {
    store_.base += end;
    store_.data += end;
    store_.size -= end;
  }
}

Stop Cpu::run(std::int64_t now, std::int64_t deadline) {
  fp_changed();
  watching_ = false;
  watch_.rest = watch_.rest < 2 ? 2 : watch_.rest;
  const bool waits = watch_.idle_pc - reg.r[15] < kLongestWait;
  if (waits) watch_.rest = 1;  // back in the loop that it waited in
  if (waits && may_pass() && (reg.fpscr & kRoundingMode) == 0) {
    std::int64_t then = pass_wait(now, deadline);
    if (then == now) {
      Stop stop = Stop::kDeadline;
      if (!learn_wait(then, deadline, stop)) return stop;
      then = pass_wait(then, deadline);
    }
    now_ = now = then;
    if (now >= deadline) return Stop::kDeadline;
  }
  wait_.steady_until = 0;
  if ((reg.fpscr & kRoundingMode) != 0) [[unlikely]]
    return run_rounded(now, deadline);
  const Stop stop = observer_ == nullptr ? execute(now, deadline) : execute_observed(now, deadline);
  if ((reg.fpscr & kRoundingMode) != 0) std::fesetround(FE_TONEAREST);
  return stop;
}

Stop Cpu::run_rounded(std::int64_t now, std::int64_t deadline) {
  const int host = std::fegetround();
  std::fesetround(host_rounding(reg.fpscr));
  const Stop stop = observer_ == nullptr ? execute(now, deadline) : execute_observed(now, deadline);
  std::fesetround(host);
  return stop;
}

void Cpu::set_fpscr(std::uint32_t value) {
  const std::uint32_t old = reg.fpscr;
  reg.fpscr = value & kFpscrWritable;
  if ((old ^ value) & kRoundingMode) std::fesetround(host_rounding(reg.fpscr));
  fp_plain_ = fp_ready_ && !(reg.fpscr & kFlushToZero);
}

bool Cpu::fp_begin() {
  if (!fp_enabled) return false;
  fp_ready_ = true;
  if (fp_automatic) {
    reg.control |= kFpContextActive;
    set_fpscr((reg.fpscr & ~0x07C00000u) | fpdscr);
  }
  fp_plain_ = !(reg.fpscr & kFlushToZero);
  return true;
}

std::uint32_t Cpu::access_pc() const {
  if (!code_ || !access_op_) return reg.r[15];
  return code_->base + static_cast<std::uint32_t>(access_op_ - code_->ops.data()) * 2;
}

bool Cpu::holds(unsigned condition) const {
  const bool n = reg.n >> 31, z = reg.z == 0, c = reg.c, v = reg.v;
  bool result = true;
  switch (condition >> 1) {
    case 0:
      result = z;
      break;
    case 1:
      result = c;
      break;
    case 2:
      result = n;
      break;
    case 3:
      result = v;
      break;
    case 4:
      result = c && !z;
      break;
    case 5:
      result = n == v;
      break;
    case 6:
      result = n == v && !z;
      break;
    default:
      return true;
  }
  return result != static_cast<bool>(condition & 1);
}

// ---- decoding into slots

std::uint16_t Cpu::halfword(std::uint32_t pc) const {
  const MemoryRegion* region = memory_.find(pc);
  if (!region) return 0;
  std::uint16_t value;
  std::memcpy(&value, region->data() + (pc - region->base), 2);
  return value;
}

namespace {
// Of a branch to where its constant says, of a load from there.
int near_entry(const Op& op) {
  switch (op.code) {
    case kB:
      return kNearB;
    case kBl:
      return kNearBl;
    case kCbz:
      return kNearCbz;
    case kCbnz:
      return kNearCbnz;
    case kBcond:
      return kBranchEq + op.a;
    default:
      return kUndecoded;
  }
}
// It may jump, or end the run.
bool ends_row(const Op& op) {
  switch (op.code) {
    case kUndefined:
    case kNoCoprocessor:
    case kB:
    case kBcond:
    case kBl:
    case kBx:
    case kBlx:
    case kCbz:
    case kCbnz:
    case kTbb:
    case kTbh:
    case kSvc:
    case kBkpt:
    case kWfi:
    case kWfe:
    case kLdrPc:
    case kPopPc:
    case kMovToPc:
      return true;
    case kLdm:
      return (op.imm & 0x8000) != 0;
    case kAddHigh:
      return op.d == 15;
    default:
      return false;
  }
}
}  // namespace

Op Cpu::make(std::uint32_t pc, std::uint8_t it) const {
  const std::uint16_t first = halfword(pc);
  Op op = decode({pc, variant_, it}, first, is_wide(first) ? halfword(pc + 2) : std::uint16_t{0});
  int cycles = op_cycles(op.code) + (variant_.plus ? more_on_plus(op.code) : 0);
  if (op.code == kLdm || op.code == kStm || op.code == kPush || op.code == kPopPc) {
    op.m = static_cast<std::uint8_t>(std::popcount(op.imm & 0xFFFF));
    cycles += op.m;
  } else if (op.code == kVldm || op.code == kVstm) {
    cycles += op.m;
  }
  op.cost = static_cast<std::uint16_t>(cycles * scale_);
  op.entry = static_cast<std::uint16_t>(op.condition < kAlways ? kIfEq + op.condition : int{op.code});
  op.last = ends_row(op);
  return op;
}

// Instead of its own code's entry a shorter one, where there is one.
void Cpu::shorten(Op& op, std::uint32_t pc) const {
  if (op.condition < kAlways || op.it != 0) return;
  const bool compares = op.code == kVcmpF32 || op.code == kVcmpZeroF32;
  const Op& next = (&op)[2];
  if (compares && next.code == kVmrs && next.d == 15 && next.entry == kVmrs) {
    op.entry = op.code == kVcmpF32 ? kVcmpFlags : kVcmpZeroFlags;
  }
  if (op.imm - code_->base >= code_->size) return;
  const int near = near_entry(op);
  if (near != kUndecoded) {
    op.entry = static_cast<std::uint16_t>(near);
    op.imm = static_cast<std::uint32_t>(static_cast<std::int32_t>(op.imm - pc) / 2 *
                                        static_cast<std::int32_t>(sizeof(Op)));
  } else if ((op.code == kLdrLit || (op.code == kVldrS && op.n == 15)) && is_near_constant(op.imm)) {
    op.entry = op.code == kLdrLit ? kNearLdr : kNearVldr;
    op.imm -= code_->base;
  }
}

// A word of the memory that code runs from, where load() would find it too.
bool Cpu::is_near_constant(std::uint32_t address) const {
  const bool seen = code_->base == ram_.base || code_->base == flash_.base || code_->base == ccm_.base;
  return seen && address % 4 == 0 && address - code_->base <= code_->size - 4;
}

// From pc on to the end of its row, or to what is decoded already, and to the end of its IT block.
void Cpu::fill(std::uint32_t pc, std::uint8_t it) {
  MemoryRegion& region = *code_;
  row_.clear();
  while (pc - region.base < region.size) {
    Op& op = region.ops[(pc - region.base) / 2];
    if (!row_.empty() && it == 0 && op.entry != kUndecoded && op.it == 0) break;
    const Op before = op;
    op = make(pc, it);
    op.known = before.known;
    op.charged = before.charged;
    op.charged_count = before.charged_count;
    note_code(*region.block, pc - region.base);
    row_.push_back(&op);
    const std::uint16_t first = halfword(pc);
    it = is_it(first) && op.code == kNop ? static_cast<std::uint8_t>(first & 0xFF) : it_next(it);
    pc += 2u * op.halfwords;
    if (op.last && it == 0) break;
  }
  add_up_row();
  if (region.block == ram_.block) leave_code_out();
}

// In whole words, and twice as far as the longest one reaches (two may be one entry): a store of any size
// that touches them is then noticed.
void Cpu::note_code(MemoryBlock& block, std::uint32_t at) {
  const std::uint32_t begin = at & ~3u, end = at + 8, code_end = block.code_begin + block.code_size;
  block.code_begin = block.code_size == 0 ? begin : std::min(block.code_begin, begin);
  block.code_size = (block.code_size == 0 ? end : std::max(end, code_end)) - block.code_begin;
}

// What each operation of the row is charged with, from the last one back.
void Cpu::add_up_row() {
  constexpr unsigned kMost = 128, kLongest = 0x8000;  // of one row; longer ones are cut
  for (std::size_t i = row_.size(); i-- > 0;) {
    Op& op = *row_[i];
    Op& next = (&op)[op.halfwords];
    const bool whole = next.charged_count < kMost && next.charged < kLongest;
    if (!op.last && !whole && i + 1 < row_.size() && !next.known) {
      next.charged = next.charged_count = 0;
      next.entry = kResync;
    }
    op.rest = static_cast<std::uint16_t>(op.cost + (op.last ? 0 : next.charged));
    op.count = static_cast<std::uint8_t>(1 + (op.last ? 0 : next.charged_count));
    if (op.known && (op.charged != op.rest || op.charged_count != op.count)) op.entry = kResync;
    if (!op.known) {
      op.charged = op.rest;
      op.charged_count = op.count;
    }
  }
  for (Op* op : row_) {
    op->known = 1;
    if (!halts_.empty() && std::ranges::binary_search(halts_, address_of(op))) op->entry = kHalt;
  }
  for (Op* op : row_) {
    if (op->entry != kResync && op->entry != kHalt) shorten(*op, address_of(op));
  }
}

std::uint32_t Cpu::address_of(const Op* op) const {
  return code_->base + static_cast<std::uint32_t>(op - code_->ops.data()) * 2;
}

bool Cpu::go_to(std::uint32_t pc) {
  if (!code_ || pc - code_->base >= code_->size) {
    code_ = memory_.find(pc);
    if (!code_ || !code_->executable()) {
      code_ = nullptr;
      const bool never = (pc >= 0x40000000u && pc < 0x60000000u) || pc >= 0xA0000000u;
      fault = {never ? kInstructionAccess : kInstructionBus, 0};
      return false;
    }
  }
  if (code_->ops.empty()) {
    code_->ops.make(code_->size / 2 + 2);
    for (std::size_t i = code_->size / 2; i < code_->ops.size(); ++i) {
      code_->ops[i].code = kOffEnd;
      code_->ops[i].entry = kOffEnd;
    }
  }
  return true;
}

void Cpu::resume_it(std::uint32_t pc, std::uint8_t it) {
  if (!go_to(pc)) return;
  const Op& op = code_->ops[(pc - code_->base) / 2];
  if (op.entry == kUndecoded ? it != 0 : op.it != it) fill(pc, it);
}

std::uint8_t Cpu::it_at(std::uint32_t pc) {
  const MemoryRegion* region = memory_.find(pc);
  return region && !region->ops.empty() ? region->ops[(pc - region->base) / 2].it : std::uint8_t{0};
}

// ---- memory off the fast path

bool Cpu::invalid_access(std::uint32_t address, unsigned bytes, bool must_align) {
  if (address % bytes == 0) return false;
  if (must_align || trap_unaligned) {
    fault = {kUnaligned, address};
    return true;
  }
  if (learning_) changed_ = true;
  bus_.note_unaligned(address);
  return false;
}

// Certainly no memory, and aligned.
inline bool Cpu::is_device(std::uint32_t address, unsigned bytes) const {
  const bool shared = address >= shared_begin_ && address < shared_end_;
  return address - kDevices < kDevicesSize && !shared && (address & (bytes - 1)) == 0;
}

bool Cpu::bus_fault(std::uint32_t address) {
  fault = {kPreciseBus | kBusAddressValid, address};
  return false;
}

bool Cpu::slow_load(std::uint32_t address, unsigned bytes, std::uint32_t& value, bool must_align) {
  if (!is_device(address, bytes)) {
    const bool own = address - kPrivate < kPrivateSize && (address & (bytes - 1)) == 0;  // of the core
    if (!own || !watches_.empty()) return far_load(address, bytes, value, must_align);
  }
  if (!bus_.read(address, bytes, value)) return bus_fault(address);
  if (learning_) note_of_wait(address, bytes, value, nullptr);
  return true;
}

bool Cpu::slow_store(std::uint32_t address, unsigned bytes, std::uint32_t value, bool must_align) {
  if (!is_device(address, bytes)) return far_store(address, bytes, value, must_align);
  changed_ = true;
  return bus_.write(address, bytes, value) || bus_fault(address);
}

bool Cpu::far_load(std::uint32_t address, unsigned bytes, std::uint32_t& value, bool must_align) {
  if (invalid_access(address, bytes, must_align)) return false;
  if (!watches_.empty()) note_watched(address, bytes, kReads);
  const MemoryRegion* region = memory_.find(address);
  if (region && address - region->base <= region->size - bytes) {
    value = 0;
    std::memcpy(&value, region->data() + (address - region->base), bytes);
    if (address < 4096) bus_.note_null(address, false);
    if (learning_) note_of_wait(address, bytes, value, region->data() + (address - region->base));
    return true;
  }
  if (address % bytes == 0) {
    if (learning_) changed_ = true;  // of a device: what it does is not known here
    return bus_.read(address, bytes, value) || bus_fault(address);
  }
  if (!region) {  // device memory takes no unaligned access
    fault = {kUnaligned, address};
    return false;
  }
  value = 0;
  for (unsigned i = 0; i < bytes; ++i) {
    std::uint32_t byte = 0;
    if (!slow_load(address + i, 1, byte, false)) return false;
    value |= byte << (8 * i);
  }
  return true;
}

bool Cpu::far_store(std::uint32_t address, unsigned bytes, std::uint32_t value, bool must_align) {
  if (invalid_access(address, bytes, must_align)) return false;
  if (!watches_.empty()) note_watched(address, bytes, kWrites);
  const MemoryRegion* region = memory_.find(address);
  if (region && region->writable() && address - region->base <= region->size - bytes) {
    const std::uint32_t at = address - region->base;
    if (watching_ && std::memcmp(region->data() + at, &value, bytes) != 0) changed_ = true;
    std::memcpy(region->data() + at, &value, bytes);
    memory_.invalidate(*region->block, at, bytes);
    if (address < 4096) bus_.note_null(address, true);
    if (learning_) note_of_wait(address, bytes, value, region->data() + (address - region->base));
    return true;
  }
  changed_ = true;
  if (region && address < 4096) bus_.note_null(address, true);
  if (address % bytes == 0 || !region) {
    if (address % bytes != 0) {
      fault = {kUnaligned, address};
      return false;
    }
    return bus_.write(address, bytes, value) || bus_fault(address);
  }
  for (unsigned i = 0; i < bytes; ++i) {
    if (!slow_store(address + i, 1, value >> (8 * i) & 255, false)) return false;
  }
  return true;
}

// ---- busy waiting

// A loop that comes round to the same registers without having changed anything will do so until something
// outside changes: whole turns of it are skipped, which leaves every result as it would be.
Cpu::Pace Cpu::watch_loop(const Op* at, Pace pace, std::int64_t end) {
  if (!watching_) {
    watching_ = true;
    changed_ = false;
    watch_.at = at;
    watch_.registers = reg;
    watch_.pace = pace;
    watch_.limit = INT64_MAX;
    watch_.patience = 64;
    watch_.rest = 1;
    return pace;
  }
  watch_.rest = 1;
  const bool again = at == watch_.at;
  if (!changed_ && !again && --watch_.patience > 0) return pace;
  watching_ = false;
  if (changed_ || !again || !(watch_.registers == reg)) {
    watch_.pause = watch_.pause < 4096 ? watch_.pause * 2 : 4096;
    watch_.rest = watch_.pause;
    return pace;
  }
  watch_.rest = watch_.pause = 64;
  watch_.idle_pc = address_of(at);
  const std::int64_t turn = watch_.pace.left - pace.left, now = end - pace.left;
  std::int64_t room = pace.left - 1;
  if (watch_.limit - now < room) room = watch_.limit - now;
  const std::int64_t turns = room > 0 ? room / turn : 0;
  pace.left -= turns * turn;
  pace.count += static_cast<std::uint64_t>(turns) * (pace.count - watch_.pace.count);
  statistics.skipped_subcycles += static_cast<std::uint64_t>(turns * turn);
  return pace;
}

}  // namespace omnihil::mcu

// The loop that runs decoded instructions: each jumps to the next one's case itself, by the table kEntries (a
// GNU extension; measured: two thirds of the host's instructions of a switch in a loop). The cases are in
// execute_*.inc, by group.
//
// Inside of the cases: R are the registers, `cur` the operation, `left` the subcycles from the end of its row
// (op.h) to the deadline, less one: below zero the row does not fit, and each of its operations is looked at
// before it runs (kSteps). `count` are the operations to the end of the row. A case ends with NEXT, with a
// jump (BRANCH, INTERWORK), with NEXT_ROW if it might have jumped, or by leaving (LEAVE, FAULT).
#include <cmath>

#include "firmware_iface/mcu/core/cpu.h"
#include "firmware_iface/mcu/core/fp.h"
#include "firmware_iface/mcu/core/shifter.h"

// Labels as values.
#pragma GCC diagnostic ignored "-Wpedantic"

namespace omnihil::mcu {

using std::bit_cast;
using std::rotr;

template <class T>
inline bool Cpu::load(std::uint32_t address, T& value) const {
  if (address & (sizeof(T) - 1)) [[unlikely]]
    return false;
  std::uint32_t at = address - ram_.base;
  const std::uint8_t* data = ram_.data;
  if (at >= ram_.size) {
    at = address - flash_.base;
    data = flash_.data;
    if (at >= flash_.size) {
      at = address - ccm_.base;
      data = ccm_.data;
      if (at >= ccm_.size) return false;
    }
  }
  std::memcpy(&value, data + at, sizeof(T));
  return true;
}

template <class T>
inline bool Cpu::store(std::uint32_t address, T value) {
  const std::uint32_t at = address - store_.base;
  if (at >= store_.size || (address & (sizeof(T) - 1))) return false;
  if (watching_ && std::memcmp(store_.data + at, &value, sizeof(T)) != 0) changed_ = true;
  std::memcpy(store_.data + at, &value, sizeof(T));
  return true;
}

// Of a list of words that lie in a window, all of them; else null.
inline std::uint8_t* Cpu::words_in(const Window& window, std::uint32_t address, std::uint32_t bytes) {
  const std::uint32_t at = address - window.base;
  return at < window.size && bytes <= window.size - at && address % 4 == 0 ? window.data + at : nullptr;
}

// Of the condition as it is encoded (DDI 0403E.e A7.3).
template <unsigned kCondition>
inline bool Cpu::meets() const {
  const bool n = reg.n >> 31, z = reg.z == 0, c = reg.c, v = reg.v;
  constexpr unsigned kKind = kCondition >> 1;
  bool result = true;
  if constexpr (kKind == 0) result = z;
  if constexpr (kKind == 1) result = c;
  if constexpr (kKind == 2) result = n;
  if constexpr (kKind == 3) result = v;
  if constexpr (kKind == 4) result = c && !z;
  if constexpr (kKind == 5) result = n == v;
  if constexpr (kKind == 6) result = n == v && !z;
  return result != static_cast<bool>(kCondition & 1);
}

namespace {

std::int32_t s32(std::uint32_t value) { return static_cast<std::int32_t>(value); }
std::uint32_t u32(std::int64_t value) { return static_cast<std::uint32_t>(value); }
std::int32_t low_half(std::uint32_t value) { return static_cast<std::int16_t>(value); }
std::int32_t high_half(std::uint32_t value) { return static_cast<std::int16_t>(value >> 16); }
std::int32_t half(std::uint32_t value, unsigned top) { return top ? high_half(value) : low_half(value); }
std::int64_t product(std::uint32_t a, std::uint32_t b) { return std::int64_t{s32(a)} * s32(b); }
std::uint64_t unsigned_product(std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} * b; }
std::uint64_t pair(std::uint32_t high, std::uint32_t low) { return std::uint64_t{high} << 32 | low; }
std::uint32_t mask_of(std::uint32_t width) { return width >= 32 ? ~0u : (1u << width) - 1; }

// x + y z, rounded once; without a call where the host can.
#if defined(__x86_64__)
const bool kHostFuses = __builtin_cpu_supports("fma");
float fuse(float x, float y, float z) {
  if (!kHostFuses) return std::fma(y, z, x);
  asm("vfmadd231ss %2, %1, %0" : "+x"(x) : "x"(y), "x"(z));
  return x;
}
double fuse(double x, double y, double z) {
  if (!kHostFuses) return std::fma(y, z, x);
  asm("vfmadd231sd %2, %1, %0" : "+x"(x) : "x"(y), "x"(z));
  return x;
}
#else
template <class F>
F fuse(F x, F y, F z) {
  return std::fma(y, z, x);
}
#endif

}  // namespace

#define CASE(code) entry_##code:
#define CAREFUL_CASE(code) careful_##code:
#define GO_TO(slot)            \
  do {                         \
    cur = (slot);              \
    goto* entries[cur->entry]; \
  } while (0)
// By a branch, not by a sum: the host then need not wait for this slot to know the next one.
#define NEXT                                       \
  do {                                             \
    if ((cur->halfwords & 2) != 0) GO_TO(cur + 2); \
    GO_TO(cur + 1);                                \
  } while (0)
#define NEXT_WIDE GO_TO(cur + 2)  // where no encoding of the operation is narrow
// A row begins here.
#define ENTER_ROW(slot)             \
  do {                              \
    cur = (slot);                   \
    left -= cur->charged;           \
    count += cur->charged_count;    \
    if (left < 0) entries = kSteps; \
    goto* entries[cur->entry];      \
  } while (0)
#define NEXT_ROW ENTER_ROW(cur + cur->halfwords)
#define LEAVE(reason) \
  do {                \
    stop = reason;    \
    goto leave;       \
  } while (0)
#define FAULT(bits)    \
  do {                 \
    fault = {bits, 0}; \
    goto faulted;      \
  } while (0)
#define BRANCH(address) \
  do {                  \
    target = (address); \
    goto branch;        \
  } while (0)
#define NEAR_TARGET() reinterpret_cast<const Op*>(reinterpret_cast<const std::uint8_t*>(cur) + s32(cur->imm))
#define NEAR_BRANCH()                           \
  do {                                          \
    left -= taken;                              \
    if (s32(cur->imm) <= 0) goto near_backward; \
    ENTER_ROW(NEAR_TARGET());                   \
  } while (0)
// Before a jump backwards, which closes a loop. Who observes sees every turn of it.
#ifdef OMNIHIL_OBSERVED
#define MAY_SKIP false
#else
#define MAY_SKIP fast_forward
#endif
#define WATCH()                                                  \
  do {                                                           \
    if (MAY_SKIP && --watch_.rest <= 0) {                        \
      const Pace pace = watch_loop(cur, {left + 1, count}, end); \
      left = pace.left - 1;                                      \
      count = pace.count;                                        \
    }                                                            \
  } while (0)
#define INTERWORK(address) \
  do {                     \
    target = (address);    \
    goto interwork;        \
  } while (0)
#define PC_OF(slot) (code_base + static_cast<std::uint32_t>((slot)-slots) * 2)
// After whatever may have changed what the FPU may be used for, or the time that is left. Observed, each instruction is
// looked at before it runs; what is not decoded yet comes round again.
#ifdef OMNIHIL_OBSERVED
#define EXECUTE execute_observed
#define CHOOSE_ENTRIES()                            \
  do {                                              \
    codes = fp_plain_ ? kEntries : kCarefulEntries; \
    entries = kSteps;                               \
  } while (0)
#define OBSERVE()                                                                                  \
  do {                                                                                             \
    if (cur->entry > kOffEnd)                                                                      \
      observer_->instruction(PC_OF(cur), *cur, cur->condition >= kAlways || holds(cur->condition), \
                             end - left - cur->charged - 1);                                       \
  } while (0)
#else
#define EXECUTE execute
#define CHOOSE_ENTRIES()                            \
  do {                                              \
    codes = fp_plain_ ? kEntries : kCarefulEntries; \
    entries = left < 0 ? kSteps : codes;            \
  } while (0)
#define OBSERVE()
#endif
// What a bus access may want to know, and what it may ask for: that this instruction is the last one.
#define REQUEST_CHECK()                                           \
  do {                                                            \
    if (stop_requested_ && left + cur->rest >= cur->cost) {       \
      const std::int64_t over = left + cur->rest + 1 - cur->cost; \
      end -= over;                                                \
      left -= over;                                               \
      CHOOSE_ENTRIES();                                           \
    }                                                             \
  } while (0)
#define BUS(call)                      \
  do {                                 \
    now_ = end - left - cur->rest - 1; \
    access_op_ = cur;                  \
    if (!(call)) goto faulted;         \
    REQUEST_CHECK();                   \
  } while (0)
// NOLINTBEGIN(bugprone-macro-parentheses): a type takes none
#define LOAD_ALIGNED(type, value, address, must_align)         \
  type value;                                                  \
  do {                                                         \
    if (!load<type>(address, value)) [[unlikely]] {            \
      std::uint32_t word = 0;                                  \
      BUS(slow_load(address, sizeof(type), word, must_align)); \
      value = static_cast<type>(word);                         \
    }                                                          \
  } while (0)
// NOLINTEND(bugprone-macro-parentheses)
#define LOAD(type, value, address) LOAD_ALIGNED(type, value, address, false)
#define STORE_ALIGNED(type, address, value, must_align)                             \
  do {                                                                              \
    if (!store<type>(address, static_cast<type>(value))) [[unlikely]] {             \
      BUS(slow_store(address, sizeof(type), static_cast<type>(value), must_align)); \
    }                                                                               \
  } while (0)
#define STORE(type, address, value) STORE_ALIGNED(type, address, value, false)
#define RD R.r[cur->d]
#define RN R.r[cur->n]
#define RM R.r[cur->m]
#define RA R.r[cur->a]
#define FLAGS_NZ(x) (R.n = R.z = (x))

Stop Cpu::EXECUTE(std::int64_t now, std::int64_t deadline) {
  static const void* const kEntries[] = {
#define OP(name, cycles) &&entry_k##name,
#include "firmware_iface/mcu/core/op_codes.inc"
#undef OP
  };
  // The same while the FPU may not be used yet, or flushes denormal numbers.
  static const void* const kCarefulEntries[] = {
#define OP(name, cycles) &&entry_k##name,
#define FP_OP(name, cycles) &&fp_first,
#define FLUSHING_OP(name, cycles) &&careful_k##name,
#include "firmware_iface/mcu/core/op_codes.inc"
#undef OP
  };
  // Near the deadline: whether there is time for this operation.
  static const void* const kSteps[] = {
#define OP(name, cycles) &&step,
#include "firmware_iface/mcu/core/op_codes.inc"
#undef OP
  };
  Registers& R = reg;
  Stop stop = Stop::kDeadline;
  std::int64_t end = deadline, left = deadline - now - 1;
  std::uint64_t count = 0;
  const void *const *codes = nullptr, *const *entries = nullptr;
  std::uint32_t target = R.r[15];
  const std::int64_t taken = scale_ * variant_.taken_branch_cycles();
  stop_requested_ = false;
  now_ = now;
  access_op_ = nullptr;
  if (!go_to(target)) return Stop::kFault;
  Op* slots = code_->ops.data();
  std::uint32_t code_base = code_->base, code_size = code_->size;
  const std::uint8_t* code_data = code_->data();
  const Op* cur = slots + (target - code_base) / 2;

  CHOOSE_ENTRIES();
  ENTER_ROW(cur);
step:
  if (left + cur->charged < 0) goto out_of_time;
  OBSERVE();
  goto* codes[cur->entry >= kVcmpFlags ? int{cur->code} : int{cur->entry}];  // two in one are taken apart
  CASE(kUndecoded) {
    const Op before = *cur;
    fill(PC_OF(cur), 0);
    left += before.charged - cur->charged;
    count += static_cast<std::uint64_t>(cur->charged_count) - before.charged_count;
    CHOOSE_ENTRIES();
    GO_TO(cur);
  }
  CASE(kResync)
  left += cur->charged - cur->rest;
  count += static_cast<std::uint64_t>(cur->count) - cur->charged_count;
  CHOOSE_ENTRIES();
  goto* codes[cur->condition < kAlways ? kIfEq + cur->condition : int{cur->code}];
  CASE(kHalt)  // a debugger's: nothing of it has been done
  stop = Stop::kHalted;
  goto out_of_time;
  CASE(kOffEnd)  // memory may go on behind it
  target = PC_OF(cur);
  goto relocate;
  CASE(kUndefined)
  FAULT(kUndefinedInstruction);
  CASE(kNoCoprocessor)
  FAULT(kNoCp);
  CASE(kNop)
  NEXT;
#include "firmware_iface/mcu/core/execute_access.inc"
#include "firmware_iface/mcu/core/execute_control.inc"
#include "firmware_iface/mcu/core/execute_data.inc"
#include "firmware_iface/mcu/core/execute_dsp.inc"
#include "firmware_iface/mcu/core/execute_fp.inc"

interwork:
  if (target >= 0xF0000000u && R.ipsr != 0) {
    exception_return = target;
    LEAVE(Stop::kExceptionReturn);
  }
  if (!(target & 1)) {
    fault = {kInvalidState, 0};
    goto lost;
  }
branch:
  target &= ~1u;
  left -= taken;
  if (target - code_base < code_size) [[likely]] {
    const Op* to = slots + (target - code_base) / 2;
    if (to <= cur) WATCH();
    ENTER_ROW(to);
  }
relocate:
  if (!go_to(target)) goto lost;
  slots = code_->ops.data();
  code_base = code_->base;
  code_size = code_->size;
  code_data = code_->data();
  ENTER_ROW(slots + (target - code_base) / 2);

near_backward:
  WATCH();
  ENTER_ROW(NEAR_TARGET());

lost:
  R.r[15] = target;
  stop = Stop::kFault;
  goto stopped;
faulted:
  stop = Stop::kFault;
  left += cur->rest - cur->cost;
  count -= cur->count - 1u;
stay:
  R.r[15] = PC_OF(cur);
  goto stopped;
leave:
  R.r[15] = PC_OF(cur + cur->halfwords);
  goto stopped;
out_of_time:
  left += cur->charged;
  count -= cur->charged_count;
  R.r[15] = PC_OF(cur);
stopped:
  statistics.instructions += count;
  now_ = end - left - 1;
  return stop;
}

}  // namespace omnihil::mcu

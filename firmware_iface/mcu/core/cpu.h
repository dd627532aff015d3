// One Cortex-M core without its exceptions: runs pre-decoded instructions until a deadline or until something
// happens that the machine around it must act on.
//
//   Cpu cpu(kCortexM4F, memory, bus);
//   cpu.reg.r[15] = entry;
//   const Stop stop = cpu.run(now, deadline);   // both in 16ths of a cycle
//
// Instructions are whole: the core stops before the first one that would start at or after the deadline.
// Memory beyond the Memory goes to the CpuBus, stamped with the time at which its instruction started. A
// faulting instruction has changed no register and is what r[15] then names (stores of a list may have been
// made). Approximate: cycles (a table, see op_codes.inc, times `cpi_scale`). Not there: FPSCR's cumulative
// exception flags, flush-to-zero, alternative half precision.
#pragma once
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/core/decode.h"
#include "firmware_iface/mcu/core/fp.h"
#include "firmware_iface/mcu/core/known_wait.h"
#include "firmware_iface/mcu/core/memory.h"
#include "firmware_iface/mcu/core/registers.h"
#include "firmware_iface/mcu/core/variant.h"

namespace omnihil::mcu {

enum class Stop : std::uint8_t {
  kDeadline,
  kWfi,
  kWfe,
  kSvc,
  kExceptionReturn,
  kBreakpoint,
  kFault,
  kHalted
};

// Bits of the configurable fault status register (DDI 0403E.e B3.2.15).
enum FaultStatus : std::uint32_t {
  kInstructionAccess = 1u << 0,
  kDataAccess = 1u << 1,
  kInstructionBus = 1u << 8,
  kPreciseBus = 1u << 9,
  kUnstackingBus = 1u << 11,
  kStackingBus = 1u << 12,
  kBusAddressValid = 1u << 15,
  kUndefinedInstruction = 1u << 16,
  kInvalidState = 1u << 17,
  kInvalidReturn = 1u << 18,
  kNoCp = 1u << 19,
  kUnaligned = 1u << 24,
  kDivideByZero = 1u << 25,
};

struct Fault {
  std::uint32_t status = 0;
  std::uint32_t address = 0;
};

// Accesses that a debugger wants to hear of.
enum AccessKinds : std::uint8_t { kReads = 1, kWrites = 2 };
struct AccessWatch {
  std::uint32_t address = 0, bytes = 0;
  std::uint8_t kinds = 0;
  bool operator==(const AccessWatch&) const = default;
};
struct AccessHit {
  AccessWatch watch;
  bool is_write = false;
};

// What is not plain memory. `false`: a bus fault. Peripherals may ask the core to stop by Cpu::stop_soon().
class CpuBus {
 public:
  virtual ~CpuBus() = default;
  virtual bool read(std::uint32_t address, unsigned bytes, std::uint32_t& value) = 0;
  virtual bool write(std::uint32_t address, unsigned bytes, std::uint32_t value) = 0;
  // A null pointer, or an address that is no multiple of its size: allowed, and worth telling.
  virtual void note_null(std::uint32_t address, bool is_write) = 0;
  virtual void note_unaligned(std::uint32_t address) = 0;
  // What read() would give, without doing anything, and until when it would (in 16ths of a cycle) if nothing from
  // outside comes; 0: not said.
  virtual std::int64_t steady_until(std::uint32_t /*address*/, unsigned /*bytes*/, std::uint32_t& /*value*/) {
    return 0;
  }
};

// Sees every instruction before it runs. While there is one, the core runs by a loop of its own (execute_observed.cc)
// with the same results at the same instants; without, nothing asks for it.
class CpuObserver {
 public:
  virtual ~CpuObserver() = default;
  // `met` false: its IT block's condition does not hold, and it does nothing. `at` in 16ths of a cycle.
  virtual void instruction(std::uint32_t pc, const Op& op, bool met, std::int64_t at) = 0;
};

struct CpuStatistics {
  std::uint64_t instructions = 0;
  std::uint64_t skipped_subcycles = 0;  // of them spent in busy-waiting loops that were fast-forwarded
};

class Cpu {
 public:
  Cpu(const Variant& variant, Memory& memory, CpuBus& bus, double cpi_scale = 1.0);

  Stop run(std::int64_t now, std::int64_t deadline);
  std::int64_t now() const { return now_; }  // of the last access while running, of the stop afterwards

  // From inside a bus access: end run() after this instruction.
  void stop_soon() { stop_requested_ = true; }
  // Something is pending: writes to PRIMASK, BASEPRI and the like end run().
  void set_attention(bool on) { attention_ = on; }
  // The memory or a peripheral read by the loop that is being watched would change from `at` on.
  void limit_fast_forward(std::int64_t at) { watch_.limit = at < watch_.limit ? at : watch_.limit; }
  bool watching() const { return watching_; }
  void spoil_fast_forward() { changed_ = true; }
  // A register of the core's own peripherals was changed by somebody else than its code.
  void own_register_changed() { wait_.steady_until = 0; }

  std::uint32_t access_pc() const;                    // of the instruction whose bus access is going on
  void memory_changed();                              // regions were added: fetch their addresses anew
  void resume_it(std::uint32_t pc, std::uint8_t it);  // code at pc is entered in the middle of an IT block
  std::uint8_t it_at(std::uint32_t pc);               // ITSTATE of the instruction at pc
  std::uint32_t special(std::uint32_t sysm) const;    // MRS
  std::uint32_t xpsr() { return reg.apsr() | reg.ipsr | 0x01000000u | it_to_xpsr(it_at(reg.r[15])); }
  // After a change of fp_enabled, fp_automatic or CONTROL.FPCA.
  void fp_changed() {
    fp_ready_ = fp_enabled && ((reg.control & kFpContextActive) || !fp_automatic);
    fp_plain_ = fp_ready_ && !(reg.fpscr & kFlushToZero);
  }
  const Variant& variant() const { return variant_; }
  // For a debugger, between two runs. Before an instruction at one of these addresses run() ends with
  // Stop::kHalted; after one that has touched what is watched, with kDeadline and a hit. Loads of constants from
  // the code's own memory are not seen.
  void set_halts(std::vector<std::uint32_t> addresses);
  void set_watches(std::vector<AccessWatch> watches);
  std::optional<AccessHit> take_hit() { return std::exchange(hit_, std::nullopt); }
  void observe(CpuObserver* observer) { observer_ = observer; }  // not owned; null: nobody
  std::int64_t subcycles(int cycles) const { return cycles * scale_; }

  Registers reg;
  Fault fault;                         // after Stop::kFault
  std::uint32_t exception_return = 0;  // after Stop::kExceptionReturn
  std::uint32_t breakpoint = 0;        // after Stop::kBreakpoint
  bool trap_unaligned = false, trap_divide_by_zero = false, fp_enabled = false;
  bool fp_automatic = true;  // FPCCR.ASPEN: FP instructions make a context to be stacked
  std::uint32_t fpdscr = 0;  // what FPSCR's modes are in a new context
  bool fast_forward = true;
  std::uint32_t lowest_sp[2] = {~0u, ~0u};  // of main and process stack
  CpuStatistics statistics;

 private:
  struct Window {  // a region as the fast paths see it
    std::uint32_t base = 0, size = 0;
    std::uint8_t* data = nullptr;
    const MemoryBlock* block = nullptr;
  };
  struct Pace {  // of the loop: subcycles to the deadline, instructions done
    std::int64_t left = 0;
    std::uint64_t count = 0;
  };
  struct Watch {
    const Op* at = nullptr;
    Registers registers;
    Pace pace;
    std::int64_t limit = 0;
    int patience = 0, rest = 64, pause = 64;
    std::uint32_t idle_pc = 1;  // of the jump that closes the loop that was skipped last; 1: none
  };

  Stop execute(std::int64_t now, std::int64_t deadline);
  Stop execute_observed(std::int64_t now, std::int64_t deadline);  // the same, telling the observer
  Stop run_rounded(std::int64_t now, std::int64_t deadline);       // in another mode than to nearest
  bool go_to(std::uint32_t pc);                                    // sets code_; false: a fault
  void fill(std::uint32_t pc, std::uint8_t it);
  Op make(std::uint32_t pc, std::uint8_t it) const;
  void shorten(Op& op, std::uint32_t pc) const;
  void add_up_row();
  static void note_code(MemoryBlock& block, std::uint32_t at);
  std::uint16_t halfword(std::uint32_t pc) const;
  bool holds(unsigned condition) const;
  template <unsigned kCondition>
  bool meets() const;  // holds(), known at compile time
  bool fp_begin();
  void write_special(std::uint32_t sysm, unsigned mask, std::uint32_t value);
  void change_masks(std::uint32_t imm);
  void set_fpscr(std::uint32_t value);
  void track_stack() {
    const int which = reg.uses_psp() ? 1 : 0;
    if (reg.r[13] < lowest_sp[which]) lowest_sp[which] = reg.r[13];
  }
  bool invalid_access(std::uint32_t address, unsigned bytes, bool must_align);
  bool is_device(std::uint32_t address, unsigned bytes) const;
  bool bus_fault(std::uint32_t address);
  bool slow_load(std::uint32_t address, unsigned bytes, std::uint32_t& value, bool must_align);
  bool slow_store(std::uint32_t address, unsigned bytes, std::uint32_t value, bool must_align);
  bool far_load(std::uint32_t address, unsigned bytes, std::uint32_t& value, bool must_align);
  bool far_store(std::uint32_t address, unsigned bytes, std::uint32_t value, bool must_align);
  Pace watch_loop(const Op* at, Pace pace, std::int64_t end);
  bool may_pass() const;
  std::int64_t pass_wait(std::int64_t now, std::int64_t deadline);
  std::int64_t steady_wait();
  bool wait_reads_the_same();
  bool learn_wait(std::int64_t& now, std::int64_t deadline, Stop& stop);
  void keep_learnt(std::int64_t turn);
  void note_of_wait(std::uint32_t address, unsigned bytes, std::uint32_t value, const std::uint8_t* memory);
  void leave_code_out();  // of store_
  bool is_near_constant(std::uint32_t address) const;
  std::uint32_t address_of(const Op* op) const;
  void forget_decoded(std::uint32_t pc);
  void note_watched(std::uint32_t address, unsigned bytes, AccessKinds kind);
  static std::uint8_t* words_in(const Window& window, std::uint32_t address, std::uint32_t bytes);
  template <class T>
  bool load(std::uint32_t address, T& value) const;
  template <class T>
  bool store(std::uint32_t address, T value);

  const Variant& variant_;
  Memory& memory_;
  CpuBus& bus_;
  std::int64_t scale_;  // 16ths of a cycle for one cycle of the table
  std::int64_t now_ = 0;
  bool stop_requested_ = false, attention_ = false;
  bool fp_ready_ = false, fp_plain_ = false;  // may be used; and needs no look at denormal numbers
  bool watching_ = false, changed_ = false;
  Window ram_, flash_, ccm_;
  Window store_;                                       // of ram_, the larger part without code
  std::uint32_t shared_begin_ = 0, shared_end_ = ~0u;  // where memory lies among the peripherals
  MemoryRegion* code_ = nullptr;
  std::vector<Op*> row_;  // that is being decoded
  const Op* access_op_ = nullptr;
  Watch watch_;
  KnownWait wait_, learnt_;
  bool learning_ = false;
  int learning_rest_ = 0, learning_pause_ = 1;  // in runs
  std::vector<std::uint32_t> halts_;            // in order
  std::vector<AccessWatch> watches_;
  std::optional<AccessHit> hit_;
  CpuObserver* observer_ = nullptr;
};

// Parallel additions and subtractions; `ge` is set by the plain ones.
std::uint32_t parallel_add(std::uint32_t x, std::uint32_t y, unsigned which, unsigned kind,
                           std::uint32_t& ge);

}  // namespace omnihil::mcu

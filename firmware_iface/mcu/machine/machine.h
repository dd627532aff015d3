// A microcontroller: core, memory, exceptions, and whatever peripherals are attached to its bus.
//
//   Machine machine({.variant = kCortexM4F, .flash_bytes = 1 << 20, .ram_bytes = 128 << 10, .reset_hz = 16'000'000});
//   machine.attach(0x40003000, 0x400, watchdog);
//   machine.load(image, problems);
//   machine.power_on();
//   machine.run_until_ns(1'000'000);
//
// The same image with the same inputs at the same instants gives the same bytes, however the time is cut into
// calls of run_until and whether busy-waiting loops are fast-forwarded or executed. An exception is taken
// between two instructions, at the first boundary at or after its cause; stacking takes the cycles of the
// core's manual. Approximate: cycles of instructions, no contention on buses, no caches, no flash wait states
// but `cpi_scale`. FP context is stacked at once (the lazy way shows in cycles alone). Not there: MPU, debug,
// trace.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "firmware_iface/mcu/core/cpu.h"
#include "firmware_iface/mcu/machine/core_clock.h"
#include "firmware_iface/mcu/machine/debug_unit.h"
#include "firmware_iface/mcu/machine/elf_image.h"
#include "firmware_iface/mcu/machine/nvic.h"
#include "firmware_iface/mcu/machine/report.h"
#include "firmware_iface/mcu/machine/systick.h"
#include "firmware_iface/mcu/peripheral.h"

namespace omnihil::mcu {

struct ExtraMemory {
  std::string name;
  std::uint32_t base, bytes;
  MemoryKind kind;
};

struct MachineConfig {
  Variant variant = kCortexM4F;
  std::uint32_t flash_base = 0x08000000, flash_bytes = 1 << 20;
  std::uint32_t ram_base = 0x20000000, ram_bytes = 128 << 10;
  std::vector<ExtraMemory> memories = {};  // core-coupled RAM, instruction RAM, system memory, further banks
  std::vector<std::pair<std::string, std::uint32_t>> aliases =
      {};  // of "flash", "ram" or one of those, at another base
  // Name and base of the chip's block at an address, for what is not modelled; an empty name: none is known.
  std::function<std::pair<std::string_view, std::uint32_t>(std::uint32_t)> block_name = {};
  bool flash_at_zero = true;
  // Below 4096: what a program may read without it being a null pointer's.
  std::vector<ElfRange> used_low = {};
  std::uint32_t boot_address = 0x08000000;  // where the vectors are at reset: in flash or an alias of it
  double reset_hz = 16e6;                   // the clock the chip comes out of reset with
  double cpi_scale = 1.0;  // cycles of the table are multiplied by this: fit it to one measured duration
  bool fast_forward = true;
};

// Sees what the core does: every instruction, and every change of what it handles.
class MachineObserver : public CpuObserver {
 public:
  void instruction(std::uint32_t, const Op&, bool, std::int64_t) override {}
  virtual void exception_begins(int /*exception*/, Cycles /*at*/) {
  }  // after stacking, before its first instruction
  virtual void exception_ends(int /*exception*/, Cycles /*at*/) {}  // at its last one
  virtual void was_reset(Cycles /*at*/) {}
};

class Machine final : public System, private CpuBus {
 public:
  explicit Machine(const MachineConfig& config);

  // `peripheral` answers for [base, base + size); it must outlive the machine. Attach before power_on().
  void attach(std::uint32_t base, std::uint32_t size, Peripheral& peripheral);
  void set_flash_writes(FlashWrites* controller) { flash_writes_ = controller; }
  // BKPT asks here first; true: go on behind it. Without a hook, or refused, it is a fault as without a
  // debugger.
  void set_breakpoint_hook(std::function<bool(std::uint32_t)> hook) { breakpoint_hook_ = std::move(hook); }

  // A boot ROM whose functions are the host's: BKPT n within these addresses calls it, which says where the program
  // goes on; false: there is no such function. What it takes it spends.
  void set_rom_calls(std::uint32_t base, std::uint32_t bytes, std::function<bool(unsigned)> calls) {
    rom_base_ = base;
    rom_bytes_ = bytes;
    rom_calls_ = std::move(calls);
  }
  void spend(Cycles cycles) { now_ += static_cast<std::int64_t>(cycles) * kSubcycles; }

  // Does `work` when the program first comes to this address, before the instruction there runs; once. Until then a
  // BKPT stands in its place. False: no code is there.
  bool when_at(std::uint32_t address, std::function<void()> work);
  bool awaits_visit() const { return !visits_.empty(); }  // work of when_at() that has not been done yet
  bool debugged() const { return debug_ != nullptr; }
  // Whom a debugger halts it by; made when it is first asked for. The listener must outlive the machine.
  DebugUnit& debug(DebugListener& listener);
  // Memory and registers as they are, without what reading them would do; false: nothing is there.
  bool peek(std::uint32_t address, std::span<std::uint8_t> bytes);
  // As the core would write them, but flash as it lies. False: nothing is there.
  bool poke(std::uint32_t address, std::span<const std::uint8_t> bytes);

  // Text that the program says: through semihosting (BKPT 0xAB), through the stimulus ports of ITM, of which all are on.
  void set_semihosting(std::function<void(std::string_view)> listener);
  void set_trace_listener(std::function<void(std::string_view)> listener) { trace_ = std::move(listener); }

  // Copies the image into flash and RAM. False, with every problem named, if it does not fit; then nothing is
  // copied.
  bool load(const ElfImage& image, std::vector<std::string>& problems);
  void power_on();  // RAM is cleared, time starts at 0
  void reset(std::string_view cause);

  // Runs to the first instruction boundary at or after `end`. Waiting inputs must be given to peripherals
  // before.
  void run_until(Cycles end);
  void run_until_ns(std::int64_t end_ns);
  // Until one of them holds: `end` is reached, or the program has stopped for good (lock-up).
  bool stopped() const { return locked_up_; }
  // How many resets in a row, up to the last one, came after a fault.
  int resets_after_faults() const { return resets_after_faults_; }
  // Since when its handler of a fault has not been left; kNever: it is in none.
  Cycles in_fault_handler_since() const {
    return faulted_at_ != kNever && fault_handler_active() ? faulted_at_ : kNever;
  }

  // Not owned; null: nobody. Slower while somebody looks at instructions, with the same results; without them it hears
  // of exceptions and resets alone, at no cost.
  void observe(MachineObserver* observer, bool instructions = true) {
    observer_ = observer;
    cpu_.observe(instructions ? observer : nullptr);
  }
  // The oscillators run at this part of their rate from now on, and with them all that counts core cycles.
  void set_clock_error(double ratio);

  MachineReport report() const;
  Cpu& cpu() { return cpu_; }
  Memory& memory() { return memory_; }
  const Nvic& nvic() const { return nvic_; }
  const CoreClock& clock() const { return clock_; }
  bool sleeping() const { return sleeping_ != Sleep::kNo; }

  Cycles now() const override {
    if (event_at_ != kNever) return event_at_;
    return static_cast<Cycles>(running_ ? cpu_.now() : now_) / kSubcycles;
  }
  std::int64_t to_ns(Cycles at) const override { return clock_.to_ns(at); }
  Cycles from_ns(std::int64_t at_ns) const override { return clock_.from_ns(at_ns); }
  double core_hz() const override { return static_cast<double>(clock_.hz()); }
  void set_core_hz(double hz) override;
  void set_irq(int irq, bool high) override;
  void reschedule() override;
  void event_moved(const Cycles* field, Cycles before) override;
  void request_reset(std::string_view cause) override;
  std::string_view reset_cause() const override { return reset_cause_; }
  std::uint32_t bus_read(std::uint32_t address, unsigned bytes) override;
  void bus_write(std::uint32_t address, unsigned bytes, std::uint32_t value) override;
  void map_at_zero(std::uint32_t base) override;
  void program_flash(std::uint32_t address, std::span<const std::uint8_t> bytes) override;
  void report_unmodelled(std::string_view peripheral, std::string_view what) override;
  void set_nmi() { pend(kNmi); }

 private:
  enum class Sleep : std::uint8_t { kNo, kForInterrupt, kForEvent };
  struct Slot {
    std::uint32_t base, size;
    Peripheral* peripheral;
  };
  struct Eventful {
    Peripheral* peripheral;
    const Cycles* field;  // where its next event stands; null: it has to be asked
    bool armed;
    Cycles next() const { return field != nullptr ? *field : peripheral->next_event(); }
  };
  struct Frame {  // of an exception being handled: for the load statistics
    int exception;
    Cycles entered;
    InterruptLoad* load;  // in the report
  };

  // CpuBus
  bool read(std::uint32_t address, unsigned bytes, std::uint32_t& value) override;
  bool write(std::uint32_t address, unsigned bytes, std::uint32_t value) override;
  void note_null(std::uint32_t address, bool is_write) override;
  void note_unaligned(std::uint32_t address) override;
  std::int64_t steady_until(std::uint32_t address, unsigned bytes, std::uint32_t& value) override;

  bool peek_word(std::uint32_t address, std::uint32_t& word);
  const Slot* slot_at(std::uint32_t address);
  const Slot* find_slot(std::uint32_t address);
  void was_polled(Cycles steady_until);
  bool read_elsewhere(std::uint32_t address, unsigned bytes, std::uint32_t& value);
  bool write_elsewhere(std::uint32_t address, unsigned bytes, std::uint32_t value);
  // True where the chip has registers, or may have; what is done with them is reported.
  bool report_unknown(std::uint32_t address, const char* done);
  bool read_unknown(std::uint32_t address, unsigned bytes, std::uint32_t& value);
  bool write_unknown(std::uint32_t address, unsigned bytes, std::uint32_t value);
  bool bit_band(std::uint32_t address, std::uint32_t& target, unsigned& bit) const;
  bool read_word(std::uint32_t address, std::uint32_t& value);  // stack frames, vectors
  // Up to the first word that no RAM takes; false if there is one.
  bool write_words(std::uint32_t address, std::span<const std::uint32_t> words);

  // system_control.cc
  std::uint32_t read_system(std::uint32_t offset);
  bool write_system(std::uint32_t offset, unsigned bytes, std::uint32_t value);
  std::uint32_t read_faults(std::uint32_t offset) const;
  void write_faults(std::uint32_t offset, std::uint32_t value);
  std::uint32_t read_fpu(std::uint32_t offset) const;
  void write_fpu(std::uint32_t offset, std::uint32_t value);
  std::uint32_t interrupt_state() const;
  void write_reset_control(std::uint32_t value);
  std::uint32_t handler_state() const;
  void write_interrupt_control(std::uint32_t value);
  void write_handler_control(std::uint32_t value);
  std::uint32_t read_debug(std::uint32_t address);
  void write_debug(std::uint32_t address, std::uint32_t value);
  // program_text.cc
  bool read_trace(std::uint32_t address, std::uint32_t& value) const;
  bool write_trace(std::uint32_t address, unsigned bytes, std::uint32_t value);
  void apply_control();

  // interrupt_registers.cc
  static bool is_interrupt_register(std::uint32_t offset);
  std::uint32_t read_interrupts(std::uint32_t offset) const;
  void write_interrupts(std::uint32_t offset, unsigned bytes, std::uint32_t value);
  std::uint32_t read_bits(std::uint32_t offset) const;
  void write_bits(std::uint32_t offset, std::uint32_t value);

  // exceptions.cc
  void pend(int e);
  int execution_priority() const;
  void take_exception();  // the most urgent one
  void return_from(std::uint32_t exception_return);
  void enter_handler(std::uint32_t exception_return);
  bool push_frame();
  bool pop_frame(std::uint32_t exception_return);
  void raise(const Fault& fault);
  bool fault_handler_active() const {
    return nvic_.active(kHardFault) || nvic_.active(kMemManage) || nvic_.active(kBusFault) ||
           nvic_.active(kUsageFault);
  }
  void note_fault(int exception, const Fault& fault);
  void lock_up();
  void account();

  // machine.cc
  void run_to(Cycles end, bool until_clock_changes);
  void run_due_events() {
    if (!next_event_known_ || next_event_ <= static_cast<Cycles>(now_) / kSubcycles) run_events_due();
  }
  void run_events_due();
  Cycles next_event();
  void look_who_is_armed();
  bool rom_call();
  void handle(Stop stop);
  bool wakes() const;
  void sleep_until(Cycles end);
  void do_reset();
  void note_reset();
  void show_at_zero(std::uint32_t base);

  const MachineConfig config_;
  Memory memory_;
  Cpu cpu_;
  Nvic nvic_;
  SysTick systick_;
  CoreClock clock_;
  std::vector<Slot> slots_;
  std::vector<Eventful> eventful_;  // of them, those that may ever have an event; in the same order
  std::vector<Eventful> armed_;     // of them, those that have had one: the others need not be looked at
  std::array<const Slot*, 256> recent_slots_{};     // by address; of those that share a place, the last one
  std::map<std::uint32_t, std::uint32_t> unknown_;  // words written to where no model is
  std::map<std::pair<std::string, std::string>, std::size_t> unmodelled_index_;
  FlashWrites* flash_writes_ = nullptr;
  std::function<bool(std::uint32_t)> breakpoint_hook_;
  std::uint32_t rom_base_ = 0, rom_bytes_ = 0;
  std::function<bool(unsigned)> rom_calls_;
  std::unique_ptr<DebugUnit> debug_;
  std::function<void(std::string_view)> trace_;
  struct Visit {
    std::uint8_t original[2];
    std::vector<std::function<void()>> work;
  };
  bool visit();
  std::map<std::uint32_t, Visit> visits_;  // by address, those that have not been yet

  MachineObserver* observer_ = nullptr;
  double clock_error_ = 1.0;  // real rate over nominal one
  double nominal_hz_ = 0.0;

  std::int64_t now_ = 0;      // in subcycles
  Cycles event_at_ = kNever;  // the instant of the events that are being run
  Cycles next_event_ = 0;
  std::uint64_t announced_ = 0;  // how often an event has been said to have moved
  bool running_ = false, next_event_known_ = false, armed_known_ = false, locked_up_ = false;
  bool rare_ =
      false;  // a reset or another memory at 0 is wanted, the core is locked up, or there is a debugger
  Sleep sleeping_ = Sleep::kNo;
  std::string reset_cause_ = "power-on";
  std::string reset_wanted_;
  std::optional<std::uint32_t> zero_wanted_;  // what address 0 is to show
  std::uint32_t initial_sp_ = 0;
  Cycles faulted_at_ = kNever;  // the last time since the last reset
  int resets_after_faults_ = 0;
  std::vector<ElfRange> occupied_low_;  // by the image, among the addresses of null pointers

  std::uint32_t vtor_ = 0, ccr_ = 0x200, cfsr_ = 0, hfsr_ = 0, mmfar_ = 0, bfar_ = 0, scr_ = 0, shcsr_ = 0;
  std::uint32_t cpacr_ = 0, fpccr_ = 0xC0000000u, fpcar_ = 0, demcr_ = 0, dwt_control_ = 0x40000000u;
  Cycles cycle_count_base_ = 0;

  MachineReport report_;
  std::vector<Frame> frames_;
  Cycles accounted_ = 0;
};

}  // namespace omnihil::mcu

// What a chip is built of: blocks of registers that live in the time of the core clock.
//
//   class Watchdog : public Peripheral { … };
//   machine.attach(0x40003000, 0x400, watchdog);    // the bus then calls read() and write()
//
// Time is counted in cycles of the core clock since reset; nothing here knows seconds but CoreClock, which
// keeps both over changes of the clock tree. A peripheral never pushes state: what a register shows is worked
// out from now() when it is read, and only instants at which something happens by itself (an interrupt, a
// byte on a wire) are announced by next_event().
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace omnihil::mcu {

using Cycles = std::uint64_t;
inline constexpr Cycles kNever = ~Cycles{0};

// The machine as a peripheral sees it.
class System {
 public:
  virtual ~System() = default;
  // The instant of the access that is going on, or of the event that is being run.
  virtual Cycles now() const = 0;
  // What now() is in time since power-on; exact over changes of the core clock.
  virtual std::int64_t to_ns(Cycles at) const = 0;
  virtual Cycles from_ns(std::int64_t at_ns) const = 0;  // the first cycle not before at_ns
  virtual double core_hz() const = 0;
  // From now on the core runs at `hz`: called by the clock tree (RCC) alone. Peripherals hear of it.
  virtual void set_core_hz(double hz) = 0;
  // A peripheral's interrupt line. A rising edge makes it pending, a line still high on return does so again.
  virtual void set_irq(int irq, bool high) = 0;
  // next_event() of some peripheral has changed, or an exception may be due: look again after this access.
  virtual void reschedule() = 0;
  // The same of that of one peripheral alone, which stands in `field` and was `before`.
  virtual void event_moved(const Cycles* /*field*/, Cycles /*before*/) { reschedule(); }
  // Reset of the whole chip at the end of this access or event, by the named cause.
  virtual void request_reset(std::string_view cause) = 0;
  // By what the chip was reset last: "power-on" or what request_reset() was given. For the reset flags.
  virtual std::string_view reset_cause() const = 0;
  // Bus master access (DMA): as the core would, without its permission. `bytes` is 1, 2 or 4.
  virtual std::uint32_t bus_read(std::uint32_t address, unsigned bytes) = 0;
  virtual void bus_write(std::uint32_t address, unsigned bytes, std::uint32_t value) = 0;
  // What address 0 shows from the next instruction on: flash, system memory or RAM by its base (the boot mode
  // of SYSCFG). On a core without VTOR the vectors move with it.
  virtual void map_at_zero(std::uint32_t base) = 0;
  // Changes the contents of the flash as they lie there, for the flash controller alone; no erased bits are
  // looked at.
  virtual void program_flash(std::uint32_t address, std::span<const std::uint8_t> bytes) = 0;
  // A register, a bit or a use of it that is not modelled: reported once each with the program counter.
  virtual void report_unmodelled(std::string_view peripheral, std::string_view what) = 0;
};

class Peripheral {
 public:
  explicit Peripheral(std::string name) : name_(std::move(name)) {}
  virtual ~Peripheral() = default;
  Peripheral(const Peripheral&) = delete;
  Peripheral& operator=(const Peripheral&) = delete;

  const std::string& name() const { return name_; }
  virtual void reset() = 0;
  // `offset` from the block's base; `bytes` 1, 2 or 4, `offset` a multiple of it.
  virtual std::uint32_t read(std::uint32_t offset, unsigned bytes) = 0;
  virtual void write(std::uint32_t offset, unsigned bytes, std::uint32_t value) = 0;
  // The word at `offset`, a multiple of 4, as a debugger sees it: what read() would give, and nothing else happens.
  virtual std::uint32_t peek(std::uint32_t /*offset*/) { return 0; }
  // The next instant at which it acts by itself; run_events() is then called with now() at that instant.
  virtual Cycles next_event() const {
    if (next_event_field_ != nullptr) return *next_event_field_;
    ever_acts_ = false;  // a block that acts at all answers this itself
    return kNever;
  }
  // Where it always stands; null: next_event() has to be asked.
  const Cycles* next_event_field() const { return next_event_field_; }
  // next_event(), without a call where it stands in a field.
  Cycles upcoming() const { return next_event_field_ != nullptr ? *next_event_field_ : next_event(); }
  virtual void run_events() {}
  // False: of a kind that has no events at all, and need not be asked for the next one.
  bool ever_acts() const {
    static_cast<void>(next_event());
    return ever_acts_;
  }
  // The core clock changes at now(); what is counted in core cycles ahead must be counted anew.
  virtual void clock_changed() {}
  // Until when a read of `offset` gives what it would give now and changes nothing; a loop that polls it can
  // then be skipped up to there (or to the next event, whichever is first). 0: not known.
  virtual Cycles stable_until(std::uint32_t /*offset*/) const { return 0; }

 protected:
  // This member of the block is its next_event(), always.
  void next_event_is(const Cycles& field) { next_event_field_ = &field; }

 private:
  std::string name_;
  const Cycles* next_event_field_ = nullptr;
  mutable bool ever_acts_ = true;
};

// Who is told of stores to the flash's addresses (the flash controller); without one they are reported and
// lost.
class FlashWrites {
 public:
  virtual ~FlashWrites() = default;
  virtual void flash_write(std::uint32_t address, unsigned bytes, std::uint32_t value) = 0;
};

}  // namespace omnihil::mcu

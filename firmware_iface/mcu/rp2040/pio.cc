#include "firmware_iface/mcu/rp2040/pio.h"

#include <algorithm>
#include <string>

namespace omnihil::mcu::rp2040 {
namespace {
enum : std::uint32_t {
  kCtrl = 0x00,
  kFstat = 0x04,
  kFdebug = 0x08,
  kFlevel = 0x0C,
  kTx = 0x10,
  kRx = 0x20,
  kIrq = 0x30,
  kIrqForce = 0x34,
  kPadOut = 0x3C,
  kPadOe = 0x40,
  kConfiguration = 0x44,
  kMemory = 0x48,
  kMachine = 0xC8,
  kIntr = 0x128,
  kInte0 = 0x12C,
  kIntf0 = 0x130,
  kInts0 = 0x134,
  kInte1 = 0x138,
  kIntf1 = 0x13C,
  kInts1 = 0x140
};
// Of one machine, 24 bytes apart.
enum Own : std::uint32_t {
  kClkdiv = 0,
  kExecctrl = 4,
  kShiftctrl = 8,
  kAddr = 12,
  kInstr = 16,
  kPinctrl = 20
};
constexpr std::uint32_t kMachineBytes = 24;
constexpr unsigned kLooks = 16;  // a choice: longer loops than this many back jumps are not found

const RegisterTable& table() {
  static const RegisterTable rows = [] {
    RegisterTable t;
    t.add(kCtrl, "CTRL", 0, 0xF);
    t.add(kFstat, "FSTAT", 0x0F000F00, 0);
    t.add(kFdebug, "FDEBUG", 0, 0);
    t.add(kFlevel, "FLEVEL", 0, 0);
    for (std::uint32_t i = 0; i < 4; ++i) t.add(kTx + 4 * i, "TXF" + std::to_string(i), 0, 0);
    for (std::uint32_t i = 0; i < 4; ++i) t.add(kRx + 4 * i, "RXF" + std::to_string(i), 0, 0);
    t.add(kIrq, "IRQ", 0, 0);
    t.add(kIrqForce, "IRQ_FORCE", 0, 0);
    t.add(0x38, "INPUT_SYNC_BYPASS");
    t.add(kPadOut, "DBG_PADOUT", 0, 0);
    t.add(kPadOe, "DBG_PADOE", 0, 0);
    t.add(kConfiguration, "DBG_CFGINFO", 32u << 16 | 4u << 8 | 4u, 0);
    for (std::uint32_t i = 0; i < 32; ++i) t.add(kMemory + 4 * i, "INSTR_MEM" + std::to_string(i), 0, 0xFFFF);
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::string name = "SM" + std::to_string(i);
      const std::uint32_t at = kMachine + kMachineBytes * i;
      t.add(at + kClkdiv, name + "_CLKDIV", 0x00010000, 0xFFFFFF00);
      t.add(at + kExecctrl, name + "_EXECCTRL", 0x0001F000, 0x7FFFFF9F, 0x00060000);
      t.add(at + kShiftctrl, name + "_SHIFTCTRL", 0x000C0000, 0xFFFF0000);
      t.add(at + kAddr, name + "_ADDR", 0, 0);
      t.add(at + kInstr, name + "_INSTR", 0, 0xFFFF);
      t.add(at + kPinctrl, name + "_PINCTRL", 0x14000000);
    }
    t.add(kIntr, "INTR", 0, 0);
    t.add(kInte0, "IRQ0_INTE", 0, 0xFFF);
    t.add(kIntf0, "IRQ0_INTF", 0, 0xFFF);
    t.add(kInts0, "IRQ0_INTS", 0, 0);
    t.add(kInte1, "IRQ1_INTE", 0, 0xFFF);
    t.add(kIntf1, "IRQ1_INTF", 0, 0xFFF);
    t.add(kInts1, "IRQ1_INTS", 0, 0);
    return t;
  }();
  return rows;
}
}  // namespace

Pio::Pio(unsigned number, IoBank& io, ChipContext& context)
    : Rp2040Block("PIO" + std::to_string(number), context.system, table().rows()),
      number_(number),
      io_(io),
      context_(context),
      first_(context.irqs, 7 + 2 * static_cast<int>(number)),
      second_(context.irqs, 8 + 2 * static_cast<int>(number)) {
  next_event_is(next_);
  for (unsigned i = 0; i < kMachines; ++i) {
    requests_[i] = context.dma.line(name() + "_TX" + std::to_string(i));
    requests_[kMachines + i] = context.dma.line(name() + "_RX" + std::to_string(i));
  }
  io.on_input([this](unsigned, bool) { input_changed(); });
}

void Pio::reset() {
  Rp2040Block::reset();
  program_ = {};
  port_ = {};
  port_.inputs = io_.inputs();
  debug_ = wanted_ = 0;
  for (unsigned i = 0; i < kMachines; ++i) {
    runners_[i] = {};
    runners_[i].sm.program = &program_;
    runners_[i].sm.number = i;
  }
  drive();
  settle();
}

void Pio::drive() { io_.drive_from(number_ == 0 ? IoBank::kPio0 : IoBank::kPio1, port_.out, port_.enable); }

// Everything up to this instant; machines in the order of their instants.
void Pio::advance() {
  if (advancing_) return;
  advancing_ = true;
  const Time now_there = Time{now()} << 8;
  for (;;) {
    Runner* first = nullptr;
    for (Runner& runner : runners_) {
      if (!runner.sm.enabled || runner.asleep || runner.at > now_there) continue;
      if (first == nullptr || runner.at < first->at) first = &runner;
    }
    if (first == nullptr) break;
    run(*first);
  }
  advancing_ = false;
}

void Pio::run(Runner& runner) {
  StateMachine& sm = runner.sm;
  const PioPort before = port_;
  const std::size_t sent = sm.tx.size(), received = sm.rx.size();
  const unsigned pc = sm.state.pc;
  unsigned cycles = 1;
  const bool stalled = sm.step(port_, cycles) == StateMachine::kStalled;
  runner.at += Time{cycles} * sm.period();
  const bool pins = port_.out != before.out || port_.enable != before.enable;
  if (pins || port_.flags != before.flags || sm.tx.size() != sent || sm.rx.size() != received) {
    runner.seen.left = 0;
    wake();
    if (pins) drive();
    update();
    return;
  }
  look_round(runner, pc, stalled);
}

// Back at a place where it has been with nothing changed since: it comes round for ever, in that time.
void Pio::look_round(Runner& runner, unsigned pc_before, bool stalled) {
  const StateMachine::State& state = runner.sm.state;
  if (!stalled && state.pc > pc_before) return;
  if (runner.seen.left > 0 && runner.seen.state == state) {
    runner.asleep = true;
    runner.turn = runner.at - runner.seen.at;
    return;
  }
  if (runner.seen.left > 0) {
    --runner.seen.left;
  } else {
    runner.seen = {state, runner.at, kLooks};
  }
}

// Something that a machine may see has changed: at this instant, or while they are brought to it.
void Pio::wake() {
  const Time now_there = Time{now()} << 8;
  for (Runner& runner : runners_) {
    runner.seen.left = 0;
    if (!runner.asleep) continue;
    runner.asleep = false;
    if (now_there > runner.at) runner.at += (now_there - runner.at) / runner.turn * runner.turn;
  }
}

void Pio::input_changed() {
  if (advancing_) {
    port_.inputs = io_.inputs();
    return wake();
  }
  const Cycles before = next_;
  advance();
  port_.inputs = io_.inputs();
  wake();
  plan();
  if (next_ != before) system().event_moved(&next_, before);
}

// Who must be run at its own instants, and the first of those.
void Pio::plan() {
  next_ = kNever;
  for (const Runner& runner : runners_) {
    if (!runner.sm.enabled || runner.asleep || !runner.outside) continue;
    next_ = std::min<Cycles>(next_, std::max<Cycles>((runner.at + 255) >> 8, now()));
  }
}

// Settings may have changed.
void Pio::settle() {
  const std::uint32_t listened = value(kInte0) | value(kInte1);
  bool any = false;
  for (const Runner& runner : runners_) any = any || (runner.sm.enabled && runner.sm.acts_outside());
  for (unsigned i = 0; i < kMachines; ++i) {
    const std::uint32_t fifos = 1u << i | 1u << (kMachines + i);
    runners_[i].outside = any || ((listened | wanted_) & fifos) != 0;
  }
  wake();
  plan();
  update();
}

void Pio::want(unsigned machine, bool receives, bool wanted) {
  const std::uint32_t mask = 1u << (machine + (receives ? 0 : kMachines));
  const Cycles before = next_;
  advance();
  wanted_ = (wanted_ & ~mask) | (wanted ? mask : 0u);
  settle();
  if (next_ != before) system().event_moved(&next_, before);
}

void Pio::run_events() {
  if (next_ > now()) return;
  advance();
  plan();
  if (next_ <= now()) next_ = now() + 1;
}

std::uint32_t Pio::raw() const {
  std::uint32_t is = (port_.flags & 15u) << 8;
  for (unsigned i = 0; i < kMachines; ++i) {
    const StateMachine& sm = runners_[i].sm;
    is |= (sm.rx.empty() ? 0u : 1u << i) | (sm.tx.size() < sm.tx_depth() ? 1u << (4 + i) : 0u);
  }
  return is;
}

void Pio::update() {
  const std::uint32_t is = raw();
  first_.set(((is & value(kInte0)) | value(kIntf0)) != 0);
  second_.set(((is & value(kInte1)) | value(kIntf1)) != 0);
  for (unsigned i = 0; i < kMachines; ++i) {
    const bool on = (wanted_ >> i & 0x11u) != 0;
    context_.dma.set(requests_[i], on && bit(is, 4 + i));
    context_.dma.set(requests_[kMachines + i], on && bit(is, i));
  }
}

std::uint32_t Pio::fifo_status() const {
  std::uint32_t is = 0;
  for (unsigned i = 0; i < kMachines; ++i) {
    const StateMachine& sm = runners_[i].sm;
    is |= (sm.rx.size() >= sm.rx_depth() ? 1u << i : 0u) | (sm.rx.empty() ? 1u << (8 + i) : 0u) |
          (sm.tx.size() >= sm.tx_depth() ? 1u << (16 + i) : 0u) | (sm.tx.empty() ? 1u << (24 + i) : 0u);
  }
  return is;
}

std::uint32_t Pio::load(std::uint32_t offset) {
  advance();
  const std::uint32_t is = shown(offset);
  if (offset >= kRx && offset < kIrq) {
    StateMachine& sm = runners_[(offset - kRx) / 4].sm;
    if (sm.rx.empty())
      debug_ |= 1u << (8 + (offset - kRx) / 4);
    else
      sm.rx.pop_front();
    wake();
    update();
  }
  plan();
  return is;
}

std::uint32_t Pio::shown(std::uint32_t offset) {
  if (offset >= kRx && offset < kIrq) {
    const StateMachine& sm = runners_[(offset - kRx) / 4].sm;
    return sm.rx.empty() ? 0u : sm.rx.front();
  }
  if (offset >= kMachine && offset < kIntr) {
    const StateMachine& sm = runners_[(offset - kMachine) / kMachineBytes].sm;
    const std::uint32_t own = (offset - kMachine) % kMachineBytes;
    if (own == kAddr) return sm.state.pc;
    if (own == kInstr)
      return sm.forced() ? static_cast<std::uint32_t>(sm.state.forced) : program_[sm.state.pc];
    return value(offset) | (own == kExecctrl && sm.forced() ? 1u << 31 : 0u);
  }
  switch (offset) {
    case kFstat:
      return fifo_status();
    case kFdebug: {
      std::uint32_t is = debug_;
      for (unsigned i = 0; i < kMachines; ++i)
        is |= (runners_[i].sm.rx_stall ? 1u << i : 0u) | (runners_[i].sm.tx_stall ? 1u << (24 + i) : 0u);
      return is;
    }
    case kFlevel: {
      std::uint32_t is = 0;
      for (unsigned i = 0; i < kMachines; ++i)
        is |= static_cast<std::uint32_t>(runners_[i].sm.tx.size() | runners_[i].sm.rx.size() << 4) << (8 * i);
      return is;
    }
    case kIrq:
      return port_.flags;
    case kPadOut:
      return port_.out;
    case kPadOe:
      return port_.enable;
    case kIntr:
      return raw();
    case kInts0:
      return (raw() & value(kInte0)) | value(kIntf0);
    case kInts1:
      return (raw() & value(kInte1)) | value(kIntf1);
    default:
      return value(offset);
  }
}

// SM_ENABLE, SM_RESTART, CLKDIV_RESTART.
void Pio::control(std::uint32_t written) {
  for (unsigned i = 0; i < kMachines; ++i) {
    Runner& runner = runners_[i];
    const bool on = bit(written, i);
    if (bit(written, 4 + i)) {
      runner.sm.restart();
      // Its delay is over; its divider goes on.
      const Time now_there = Time{now()} << 8;
      if (runner.at > now_there) runner.at = now_there + (runner.at - now_there - 1) % runner.sm.period() + 1;
    }
    if (bit(written, 8 + i) || (on && !runner.sm.enabled)) runner.at = (Time{now()} + 1) << 8;
    runner.sm.enabled = on;
  }
}

void Pio::store_machine(unsigned machine, std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  Runner& runner = runners_[machine];
  StateMachine& sm = runner.sm;
  const std::uint32_t at = kMachine + kMachineBytes * machine + offset, joined = sm.shiftctrl >> 30;
  keep(at, written, lanes);
  switch (offset) {
    case kClkdiv:
      sm.clkdiv = value(at);
      break;
    case kExecctrl:
      sm.execctrl = value(at);
      break;
    case kShiftctrl:
      sm.shiftctrl = value(at);
      if (sm.shiftctrl >> 30 != joined) sm.tx.clear(), sm.rx.clear();
      break;
    case kPinctrl:
      sm.pinctrl = value(at);
      break;
    case kInstr: {  // at once, whatever the clock divider is at; with the machine off too
      sm.force(static_cast<std::uint16_t>(written));
      const PioPort before = port_;
      unsigned cycles = 1;
      sm.step(port_, cycles);
      if (port_.out != before.out || port_.enable != before.enable) drive();
      break;
    }
    default:
      break;
  }
}

void Pio::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  advance();
  if (offset >= kTx && offset < kRx) {
    StateMachine& sm = runners_[(offset - kTx) / 4].sm;
    if (sm.tx.size() >= sm.tx_depth())
      debug_ |= 1u << (16 + (offset - kTx) / 4);
    else
      sm.tx.push_back(written);
    wake();
    plan();
    return update();
  }
  if (offset == kFdebug) {
    debug_ &= ~written;
    for (unsigned i = 0; i < kMachines; ++i) {
      if (bit(written, i)) runners_[i].sm.rx_stall = false;
      if (bit(written, 24 + i)) runners_[i].sm.tx_stall = false;
    }
  } else if (offset == kIrq) {
    port_.flags &= ~written;
  } else if (offset == kIrqForce) {
    port_.flags |= written & 0xFFu;
  } else if (offset >= kMemory && offset < kMachine) {
    keep(offset, written, lanes);
    program_[(offset - kMemory) / 4] = static_cast<std::uint16_t>(written);
  } else if (offset >= kMachine && offset < kIntr) {
    store_machine((offset - kMachine) / kMachineBytes, (offset - kMachine) % kMachineBytes, written, lanes);
  } else {
    keep(offset, written, lanes);
    if (offset == kCtrl) control(written);
  }
  settle();
}

}  // namespace omnihil::mcu::rp2040

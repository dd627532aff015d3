#include "firmware_iface/mcu/rp2040/watchdog.h"

namespace omnihil::mcu::rp2040 {
namespace {
enum : std::uint32_t { kCtrl = 0x00, kLoad = 0x04, kReason = 0x08, kScratch = 0x0C, kTick = 0x2C };
constexpr unsigned kEnable = 30, kTrigger = 31, kTickEnable = 9;
constexpr const char *kTimer = "watchdog", *kForced = "watchdog (CTRL.TRIGGER)";
constexpr RegisterInfo kRegisters[] = {{kCtrl, "CTRL", 0x07000000, 0x47000000},
                                       {kLoad, "LOAD", 0, 0},
                                       {kReason, "REASON", 0, 0},
                                       {0x0C, "SCRATCH0"},
                                       {0x10, "SCRATCH1"},
                                       {0x14, "SCRATCH2"},
                                       {0x18, "SCRATCH3"},
                                       {0x1C, "SCRATCH4"},
                                       {0x20, "SCRATCH5"},
                                       {0x24, "SCRATCH6"},
                                       {0x28, "SCRATCH7"},
                                       {kTick, "TICK", 0x00000200, 0x000003FF}};
bool is_scratch(std::uint32_t offset) { return offset >= kScratch && offset < kTick; }
}  // namespace

Watchdog::Watchdog(ChipContext& context)
    : Rp2040Block("WATCHDOG", context.system, kRegisters), context_(context) {
  next_event_is(next_);
  context.clocks.listen(*this);
}

void Watchdog::reset() {
  Rp2040Block::reset();
  if (system().reset_cause() == "power-on") scratch_ = {};
  count_ = {};
  end_ = 0;
  clock_changed();
}

ClockRatio Watchdog::tick() const {
  const std::uint32_t cycles = field(value(kTick), 0, 9);
  if (!bit(value(kTick), kTickEnable) || cycles == 0) return {0, 1};
  const ClockRatio reference = context_.clocks.bus(Bus::kReference);
  return {reference.mul, reference.div * cycles};
}

void Watchdog::clock_changed() {
  run_or_pause();
  for (const auto& listener : listeners_) listener();
  plan();
}

// Without ENABLE the count stands.
void Watchdog::run_or_pause() { count_.rate(bit(value(kCtrl), kEnable) ? tick() : ClockRatio{0, 1}, now()); }

void Watchdog::plan() { next_ = bit(value(kCtrl), kEnable) ? count_.when(end_, now()) : kNever; }

void Watchdog::run_events() {
  if (next_ > now()) return;
  next_ = kNever;
  system().request_reset(kTimer);
}

std::uint32_t Watchdog::left() const {
  const std::uint64_t at = count_.at(now());
  return at < end_ ? static_cast<std::uint32_t>(2 * (end_ - at)) & 0xFFFFFFu : 0u;
}

std::uint32_t Watchdog::load(std::uint32_t offset) {
  if (is_scratch(offset)) return scratch_[(offset - kScratch) / 4];
  if (offset == kCtrl) return value(kCtrl) | left();
  if (offset == kReason)
    return system().reset_cause() == kTimer ? 1u : system().reset_cause() == kForced ? 2u : 0u;
  if (offset == kTick) return value(kTick) | (tick().mul != 0 ? 1u << 10 : 0u);  // RUNNING
  return value(offset);
}

void Watchdog::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  if (is_scratch(offset)) {
    scratch_[(offset - kScratch) / 4] = written;
  } else if (offset == kLoad) {
    end_ = count_.at(now()) + (written & 0xFFFFFFu) / 2;
    plan();
  } else {
    keep(offset, written, lanes);
    if (offset == kTick) clock_changed();
    if (offset == kCtrl) run_or_pause();
    plan();
    if (offset == kCtrl && bit(written, kTrigger)) system().request_reset(kForced);
  }
}

}  // namespace omnihil::mcu::rp2040

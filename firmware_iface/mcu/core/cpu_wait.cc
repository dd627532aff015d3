// Waiting without executing: a wait that was learnt is passed by arithmetic.
#include <algorithm>
#include <cstring>

#include "firmware_iface/mcu/core/cpu.h"

namespace omnihil::mcu {
namespace {

constexpr std::uint32_t kNullPointers = 4096;  // CpuBus::note_null
constexpr int kLongestPause = 4096;            // runs between two tries to learn what cannot be learnt

}  // namespace

bool Cpu::may_pass() const {
  return fast_forward && observer_ == nullptr && halts_.empty() && watches_.empty() && !attention_;
}

// Until when the registers that the wait reads stay as they are; 0: they are not. Asked once, until the core runs again.
// Once that instant is reached the answer is 0, asked or not: what the wait reads is another then.
std::int64_t Cpu::steady_wait() {
  if (wait_.steady_until > now_) return wait_.steady_until;
  std::int64_t until = INT64_MAX;
  for (const KnownWait::Value& value : wait_.values) {
    if (value.memory != nullptr) continue;
    std::uint32_t now_there = 0;
    const std::int64_t steady = bus_.steady_until(value.address, value.bytes, now_there);
    if (steady <= now_ || now_there != value.value) return 0;
    until = std::min(until, steady);
  }
  wait_.steady_until = until;
  return until;
}

bool Cpu::wait_reads_the_same() {
  if (wait_.code_changes != memory_.code_changes()) {
    wait_.moments.clear();
    return false;
  }
  return std::ranges::all_of(wait_.values, [](const KnownWait::Value& value) {
    return value.memory == nullptr || std::memcmp(value.memory, &value.value, value.bytes) == 0;
  });
}

// The instant of the first instruction at or after the deadline, or of the first that may read something new.
std::int64_t Cpu::pass_wait(std::int64_t now, std::int64_t deadline) {
  const auto& moments = wait_.moments;
  if (moments.empty() || reg.r[15] - wait_.first_pc > wait_.last_pc - wait_.first_pc) return now;
  std::size_t here = wait_.here;  // mostly where it was left
  // What a core without FPU has of registers is a third of them.
  const auto core_bytes = reinterpret_cast<const char*>(&reg.fpscr) - reinterpret_cast<const char*>(&reg);
  const auto used_bytes = variant_.fpu != Fpu::kNone ? sizeof reg : static_cast<std::size_t>(core_bytes);
  const auto is_at = [&](std::size_t i) {
    return moments[i].registers.r[15] == reg.r[15] &&
           std::memcmp(&moments[i].registers, &reg, used_bytes) == 0;
  };
  if (!is_at(here)) {
    here = 0;
    while (here < moments.size() && !is_at(here)) ++here;
    if (here == moments.size()) return now;
  }
  if (!wait_reads_the_same()) return now;
  now_ = now;
  const std::int64_t until = std::min(deadline, steady_wait());
  if (until <= now) return now;
  learning_pause_ = 1;  // it was worth learning
  const std::int64_t left = until - now + moments[here].at;
  std::int64_t turns = left < wait_.turn ? 0 : left / wait_.turn;
  const std::int64_t rest = left - turns * wait_.turn;
  std::size_t there = 0;
  while (there < moments.size() && moments[there].at < rest) ++there;
  if (there == moments.size()) {
    there = 0;
    ++turns;
  }
  const std::int64_t then = now - moments[here].at + turns * wait_.turn + moments[there].at;
  statistics.instructions += static_cast<std::uint64_t>(turns) * moments.size() + there - here;
  statistics.skipped_subcycles += static_cast<std::uint64_t>(then - now);
  if (there != here) std::memcpy(static_cast<void*>(&reg), &moments[there].registers, used_bytes);
  wait_.here = there;
  return then;
}

// Of an access that goes the far way because a turn is being learnt. `memory`: where it lies; null: of the core's own.
void Cpu::note_of_wait(std::uint32_t address, unsigned bytes, std::uint32_t value,
                       const std::uint8_t* memory) {
  if (address < kNullPointers) changed_ = true;  // each turn is told of
  if (bytes < 4) value &= (1u << 8 * bytes) - 1;
  learnt_.values.push_back({address, value, bytes, memory});
}

// Executes one turn from here on, or as far as it is one: false where the run has to end. What it learns from is
// code in flash that changes nothing and reads memory and the core's own peripherals alone.
bool Cpu::learn_wait(std::int64_t& now, std::int64_t deadline, Stop& stop) {
  if (--learning_rest_ > 0 || !go_to(reg.r[15]) || code_->writable()) return true;
  const Window windows[] = {ram_, flash_, ccm_, store_};
  const std::uint32_t shared[] = {shared_begin_, shared_end_};
  const int rest = watch_.rest;
  ram_ = flash_ = ccm_ = store_ = Window{};  // every access goes the far way, where it is noted
  shared_begin_ = 0;
  shared_end_ = ~0u;
  learnt_.moments.clear();
  learnt_.values.clear();
  learning_ = watching_ = true;
  changed_ = false;
  watch_.rest = INT32_MAX;
  const std::int64_t start = now;
  bool again = false;
  do {
    learnt_.moments.push_back({now - start, reg});
    stop = execute(now, now + 1);
    now = now_;
    again = reg == learnt_.moments.front().registers;
  } while (stop == Stop::kDeadline && !again && !stop_requested_ && !changed_ && now < deadline &&
           learnt_.moments.size() < KnownWait::kLongest);
  learning_ = watching_ = false;
  ram_ = windows[0], flash_ = windows[1], ccm_ = windows[2], store_ = windows[3];
  shared_begin_ = shared[0], shared_end_ = shared[1];
  watch_.rest = rest;
  const bool ends = stop != Stop::kDeadline || stop_requested_ || now >= deadline;
  learning_pause_ = std::min(2 * learning_pause_, kLongestPause);  // until it is passed
  learning_rest_ = learning_pause_;
  if (stop == Stop::kDeadline && again && !changed_ && !stop_requested_) keep_learnt(now - start);
  return !ends;
}

void Cpu::keep_learnt(std::int64_t turn) {
  std::swap(wait_, learnt_);
  wait_.turn = turn;
  wait_.here = 0;
  wait_.steady_until = 0;
  wait_.code_changes = memory_.code_changes();
  const auto pc = [](const KnownWait::Moment& moment) { return moment.registers.r[15]; };
  wait_.first_pc = pc(std::ranges::min(wait_.moments, {}, pc));
  wait_.last_pc = pc(std::ranges::max(wait_.moments, {}, pc));
}

}  // namespace omnihil::mcu

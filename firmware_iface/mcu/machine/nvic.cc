#include "firmware_iface/mcu/machine/nvic.h"

#include <algorithm>
#include <bit>

namespace omnihil::mcu {

void Nvic::reset() {
  pending_.fill(0);
  enabled_.fill(0);
  active_.fill(0);
  line_.fill(0);
  priority_.fill(0);
  pended_at_.fill(0);
  active_list_.clear();
  enabled_[0] = 0xFFFF & ~(1u << kMemManage | 1u << kBusFault | 1u << kUsageFault);
  pending_words_ = 0;
  prigroup_ = 0;
}

void Nvic::set_line(int irq, bool high, Cycles now) {
  const int e = kFirstIrq + irq;
  if (irq < 0 || e >= kExceptions) return;
  std::uint32_t& line = line_[word(e)];
  const std::uint32_t mask = 1u << (e & 31);
  if (high && !(line & mask)) set_pending(e, now);
  line = high ? line | mask : line & ~mask;
}

void Nvic::set_pending(int e, Cycles now) {
  if (pending(e)) return;
  pending_[word(e)] |= 1u << (e & 31);
  pending_words_ |= 1u << word(e);
  pended_at_[index(e)] = now;
}

void Nvic::clear_pending(int e) {
  if (!pending(e)) return;
  pending_[word(e)] &= ~(1u << (e & 31));
  if (pending_[word(e)] == 0) pending_words_ &= ~(1u << word(e));
}

void Nvic::set_enabled(int e, bool on) {
  const std::uint32_t mask = 1u << (e & 31);
  enabled_[word(e)] = on ? enabled_[word(e)] | mask : enabled_[word(e)] & ~mask;
}

void Nvic::set_priority(int e, std::uint8_t value) {
  priority_[index(e)] = static_cast<std::uint8_t>(value & (0xFF00u >> variant_.priority_bits));
}

int Nvic::group_priority(int e) const {
  if (e == kNmi) return -2;
  if (e == kHardFault) return -1;
  return grouped(priority_[index(e)]);
}

int Nvic::best(int execution_priority) const {
  int found = 0, found_priority = execution_priority, found_full = kLowest;
  for (std::uint32_t words = pending_words_; words; words &= words - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(words));
    for (std::uint32_t rest = pending_[i] & enabled_[i]; rest; rest &= rest - 1) {
      const int e = static_cast<int>(i) * 32 + std::countr_zero(rest);
      const int priority = group_priority(e), full = e <= kHardFault ? priority : priority_[index(e)];
      if (priority < found_priority || (found != 0 && priority == found_priority && full < found_full)) {
        found = e;
        found_priority = priority;
        found_full = full;
      }
    }
  }
  return found;
}

int Nvic::execution_priority(bool primask, bool faultmask, std::uint32_t basepri) const {
  int priority = kLowest;
  for (const int e : active_list_) priority = std::min(priority, group_priority(e));
  if (basepri != 0) priority = std::min(priority, grouped(static_cast<int>(basepri)));
  if (primask) priority = std::min(priority, 0);
  if (faultmask) priority = std::min(priority, -1);
  return priority;
}

void Nvic::activate(int e) {
  clear_pending(e);
  active_[word(e)] |= 1u << (e & 31);
  active_list_.push_back(e);
}

void Nvic::deactivate(int e, Cycles now) {
  active_[word(e)] &= ~(1u << (e & 31));
  std::erase(active_list_, e);
  if (e >= kFirstIrq && line_[word(e)] >> (e & 31) & 1) set_pending(e, now);
}

}  // namespace omnihil::mcu

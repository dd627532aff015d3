// Exceptions and their priorities: what is pending, active, enabled (DDI 0403E.e B1.5, B3.4).
//
//   nvic.set_line(37, true, now);                  // an interrupt's level
//   const int e = nvic.best(execution_priority);   // what would be taken now, 0: nothing
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "firmware_iface/mcu/core/variant.h"
#include "firmware_iface/mcu/peripheral.h"

namespace omnihil::mcu {

enum Exception : int {
  kNmi = 2,
  kHardFault = 3,
  kMemManage = 4,
  kBusFault = 5,
  kUsageFault = 6,
  kSvCall = 11,
  kPendSv = 14,
  kSysTick = 15,
  kFirstIrq = 16,
};

class Nvic {
 public:
  static constexpr int kExceptions = kFirstIrq + 240;
  static constexpr int kLowest = 256;  // the priority of thread mode

  explicit Nvic(const Variant& variant) : variant_(variant) { reset(); }
  void reset();

  void set_line(int irq, bool high, Cycles now);  // a rising edge pends
  void set_pending(int e, Cycles now);
  void clear_pending(int e);
  void set_enabled(int e, bool on);
  void set_priority(int e, std::uint8_t value);
  void set_group(unsigned prigroup) { prigroup_ = prigroup; }

  bool pending(int e) const { return pending_[word(e)] >> (e & 31) & 1; }
  bool enabled(int e) const { return enabled_[word(e)] >> (e & 31) & 1; }
  bool active(int e) const { return active_[word(e)] >> (e & 31) & 1; }
  std::uint8_t priority(int e) const { return priority_[index(e)]; }
  unsigned group() const { return prigroup_; }
  Cycles pended_at(int e) const { return pended_at_[index(e)]; }
  bool any_pending() const { return pending_words_ != 0; }
  int active_count() const { return static_cast<int>(active_list_.size()); }
  std::uint32_t pending_word(int i) const { return pending_[static_cast<std::size_t>(i)]; }

  // The exception that preempts what runs at `execution_priority`; 0: none.
  int best(int execution_priority) const;
  // Of the active exceptions and the masks.
  int execution_priority(bool primask, bool faultmask, std::uint32_t basepri) const;
  int group_priority(int e) const;
  void activate(int e);                // no longer pending
  void deactivate(int e, Cycles now);  // pending again if its line is still high

 private:
  static std::size_t index(int e) { return static_cast<std::size_t>(e); }
  static std::size_t word(int e) { return static_cast<std::size_t>(e >> 5); }
  int grouped(int value) const { return value >> (prigroup_ + 1) << (prigroup_ + 1); }

  const Variant& variant_;
  std::array<std::uint32_t, 8> pending_{}, enabled_{}, active_{}, line_{};
  std::array<std::uint8_t, kExceptions> priority_{};
  std::array<Cycles, kExceptions> pended_at_{};
  std::vector<int> active_list_;
  std::uint32_t pending_words_ = 0;  // a bit for each of pending_ that is not 0
  unsigned prigroup_ = 0;
};

}  // namespace omnihil::mcu

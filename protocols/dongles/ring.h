// A queue of fixed size: bounded by construction, no allocation.
//
//   Ring<int, 40> queue;
//   if (!queue.push(7)) ++lost;   // full: the newcomer is refused
#pragma once
#include <array>
#include <cassert>
#include <cstddef>

namespace omnihil {

template <class T, std::size_t kCapacity>
class Ring {
 public:
  bool empty() const { return count_ == 0; }
  bool full() const { return count_ == kCapacity; }
  std::size_t size() const { return count_; }
  bool push(const T& item) {
    if (full()) return false;
    items_[(first_ + count_) % kCapacity] = item;
    ++count_;
    return true;
  }
  const T& front() const {
    assert(!empty());
    return items_[first_];
  }
  void pop() {
    assert(!empty());
    first_ = (first_ + 1) % kCapacity;
    --count_;
  }
  void clear() { first_ = count_ = 0; }

 private:
  std::array<T, kCapacity> items_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace omnihil

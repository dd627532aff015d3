// Packets under way, each with the time of its arrival: they come out by time, of one time in the order they went in.
//
//   AirQueue<int> queue(64);
//   int crowded_out = 0;
//   if (!queue.push(7, 2'000'000)) ++crowded_out;   // full: the newcomer is refused
//   while (const int* packet = queue.due(now_ns)) { …; queue.pop(); }
//
// No allocation after start.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace omnihil {

template <class T>
class AirQueue {
 public:
  explicit AirQueue(std::size_t capacity) : items_(capacity) {
    order_.reserve(capacity);
    free_.reserve(capacity);
    for (std::size_t i = capacity; i-- > 0;) free_.push_back(i);
  }

  bool push(const T& item, std::int64_t at_ns) {
    if (free_.empty()) return false;
    const std::size_t place = free_.back();
    free_.pop_back();
    items_[place] = item;
    order_.push_back({at_ns, pushed_++, place});
    std::push_heap(order_.begin(), order_.end(), Later{});
    return true;
  }
  // The first one, when it has arrived by now.
  T* due(std::int64_t now_ns) {
    return order_.empty() || order_.front().at_ns > now_ns ? nullptr : &items_[order_.front().place];
  }
  std::int64_t at_ns() const { return order_.front().at_ns; }  // of the first one
  void pop() {
    free_.push_back(order_.front().place);
    std::pop_heap(order_.begin(), order_.end(), Later{});
    order_.pop_back();
  }
  std::size_t size() const { return order_.size(); }

 private:
  struct Entry {
    std::int64_t at_ns = 0;
    std::uint64_t number = 0;
    std::size_t place = 0;
  };
  struct Later {
    bool operator()(const Entry& a, const Entry& b) const {
      return a.at_ns != b.at_ns ? a.at_ns > b.at_ns : a.number > b.number;
    }
  };

  std::vector<T> items_;
  std::vector<Entry> order_;  // a heap, the next to arrive in front
  std::vector<std::size_t> free_;
  std::uint64_t pushed_ = 0;
};

}  // namespace omnihil

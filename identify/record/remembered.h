// What was made lately and is asked for again: a prediction of a fit's best point with other weights, of where the last fit
// ended, of a comparison for the same once more.
//
//   Remembered<double, double> made(8);                                    // the last eight
//   const std::shared_ptr<const double> y = made.of(x, [&] { return simulate(x); });
//
// Exact: what is given again was made of the same key. Several threads may ask at once; two that ask for the same at the same
// time both make it.
#pragma once
#include <algorithm>
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <utility>

namespace omnihil {

template <typename Key, typename Made>
class Remembered {
 public:
  explicit Remembered(std::size_t most) : most_(most) {}

  template <typename Make>
  std::shared_ptr<const Made> of(Key key, const Make& make) {
    {
      const std::scoped_lock lock(mutex_);
      const auto same = [&](const Entry& e) { return e.key == key; };
      if (const auto found = std::ranges::find_if(kept_, same); found != kept_.end()) {
        std::rotate(kept_.begin(), found, found + 1);
        return kept_.front().made;
      }
    }
    auto made = std::make_shared<const Made>(make());
    const std::scoped_lock lock(mutex_);
    kept_.push_front({std::move(key), made});
    if (kept_.size() > most_) kept_.pop_back();
    return made;
  }

 private:
  struct Entry {
    Key key;
    std::shared_ptr<const Made> made;
  };
  std::size_t most_;
  std::mutex mutex_;
  std::deque<Entry> kept_;  // the one asked for last in front
};

}  // namespace omnihil

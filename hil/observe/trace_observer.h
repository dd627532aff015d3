// A trace of what images do, whatever its form: kept while they run, written as text afterwards.
//
//   std::shared_ptr<TraceObserver> trace = std::make_shared<WaveTrace>(TraceOptions{.last_s = 0.5});
//   FirmwareChoice choice{.file = "fw.elf", .board = "mine.toml", .observer = trace};
//   …
//   write(trace->text());
//
// With last_s only that much is kept, up to the end.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "hil/firmware/image_observer.h"

namespace omnihil {

struct TraceOptions {
  double last_s = 0.0;           // 0: all
  std::string filter = {};       // names that have one of these, separated by commas, in them; empty: all
  bool levels_only = false;      // of signals: those of one bit
  std::size_t most = 5'000'000;  // events; older ones go first
};

// Whether a name has one of the filter's texts in it.
bool passes_filter(const std::string& filter, std::string_view name);

class TraceObserver : public ImageObserver {
 public:
  virtual std::string text() const = 0;
  virtual std::size_t events() const = 0;
  virtual bool dropped() const = 0;  // older events have gone because there were too many
  virtual void clear() = 0;          // what is over; before the next run
};

}  // namespace omnihil

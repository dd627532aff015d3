// Signals over time, as a trace keeps them: levels, words and numbers, all of them or the last stretch.
//
//   WaveLog log({.last_s = 0.5});
//   const int tx = log.add("robot0", "USART2_TX", WaveKind::kLevel, 1, {1, false});      // below 0: filtered out
//   log.put(tx, at_ns, 0);
//   log.put_none(tx, at_ns);                                                   // nobody drives it
//
// Of one signal the instants never go back; those of several may come in any order. A value that is the one before is not
// kept twice. What leaves the kept stretch lives on as the value with which it begins.
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "hil/observe/trace_observer.h"

namespace omnihil {

enum class WaveKind : std::uint8_t { kLevel, kWord, kInteger, kReal };

struct WaveValue {
  std::uint64_t raw = 0;  // of a real its bits, of an integer two's complement
  bool none = true;       // nobody drives it, nothing is there
  bool operator==(const WaveValue&) const = default;
};

struct WaveSignal {
  std::string scope, name;
  WaveKind kind = WaveKind::kLevel;
  unsigned bits = 1;
  WaveValue first, last;  // where the kept stretch begins; of the newest event
  bool shown = false;     // it has had an event, or is worth a line without one
};

struct WaveEvent {
  std::int64_t at_ns = 0;
  int signal = 0;
  WaveValue value;
};

class WaveLog {
 public:
  explicit WaveLog(TraceOptions options) : options_(std::move(options)) {}

  // `shown`: even if nothing ever happens there.
  int add(const std::string& scope, const std::string& name, WaveKind kind, unsigned bits = 1,
          WaveValue first = {}, bool shown = false);
  void put(int signal, std::int64_t at_ns, std::uint64_t raw) { put(signal, at_ns, WaveValue{raw, false}); }
  void put_real(int signal, std::int64_t at_ns, double value) {
    put(signal, at_ns, std::bit_cast<std::uint64_t>(value));
  }
  void put_none(int signal, std::int64_t at_ns) { put(signal, at_ns, WaveValue{}); }

  void reaches(std::int64_t at_ns);  // nothing has happened up to then

  const std::vector<WaveSignal>& signals() const { return signals_; }
  const std::deque<WaveEvent>& events() const { return events_; }
  std::int64_t from_ns() const;  // where the kept stretch begins
  std::int64_t to_ns() const { return newest_ns_; }
  bool dropped() const { return dropped_; }
  void clear();

 private:
  void put(int signal, std::int64_t at_ns, WaveValue value);
  void forget();

  TraceOptions options_;
  std::vector<WaveSignal> signals_;
  std::deque<WaveEvent> events_;
  std::int64_t newest_ns_ = 0, gone_ns_ = 0;
  bool dropped_ = false;
};

}  // namespace omnihil

// Another computer's clock against ours, from messages that carry the time they were sent: offset and drift.
//
//   ClockLine line;
//   line.add(sent_s, arrived_s);                   // of each message, in the order of sending
//   const ClockFit fit = line.fit();
//   const double ours_s = fit.ours(captured_s);    // the other clock's time on ours, by the quickest messages
//
// A message arrives at arrived = ours(sent) + delay, delay >= 0. The line below all points (sent, arrived - sent) that
// has the least sum of distances to them is an edge of their lower convex hull, the one over the mean of `sent`. Source: Moon,
// Skelly and Towsley 1999, "Estimation and removal of clock skew from network delay measurements". Its constant part contains
// the least delay of the way, which nobody can see from one end. Under kLeastSpan_s the drift is taken as 0.
// A clock that was set anew begins a new line: a jump of more than kJump_s.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace omnihil {

struct ClockFit {
  double at_s = 0.0;         // of the other clock, in the middle of what was seen
  double offset_s = 0.0;     // ours less theirs, there
  double drift_ratio = 0.0;  // by which ours gains on theirs; 1e-6 is a microsecond a second
  double delay_p50_s = 0.0;  // of the messages beyond the quickest
  std::uint64_t messages = 0;
  std::uint64_t set_anew = 0;  // times the clock jumped; what was before is forgotten

  bool known() const { return messages > 0; }
  double ours(double theirs_s) const { return theirs_s + offset_s + drift_ratio * (theirs_s - at_s); }
};

class ClockLine {
 public:
  static constexpr double kLeastSpan_s = 10.0;  // the scatter of the quickest, 0.1 ms, is then 10 ppm
  static constexpr double kJump_s = 1.0;        // no network is that late between two messages

  void add(double sent_s, double arrived_s);
  ClockFit fit() const;
  std::uint64_t messages() const { return static_cast<std::uint64_t>(points_.size()); }

 private:
  struct Point {
    double sent_s, late_s;  // arrived - sent
  };
  std::vector<Point> points_, hull_;  // the hull is kept as points come
  double sum_sent_s_ = 0.0;           // of sent less the first's
  std::uint64_t set_anew_ = 0;
};

// For people, a line per camera: frames, offset from this computer's clock, drift, delay. `unix_start_s`: Unix time by this
// computer's clock at 0 of the lines' own.
std::string clock_words(const std::map<unsigned, ClockLine>& cameras, double unix_start_s);

}  // namespace omnihil

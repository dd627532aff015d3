// Watches a robot beside its model: learns what healthy is, then raises an alarm with a named suspect.
//
//   TwinWatch watch(bank, {.learn_s = 60.0, .false_alarms_per_hour = 0.01});
//   for (const TwinWindow& w : windows) if (const std::optional<TwinAlarm> alarm = watch.take(w); alarm) tell(alarm->sentence);
//
// A statistic per hypothesis, the cumulative sum of E. S. Page (Biometrika 41, 1954) over windows:
//   S = max(0, S + l),  l = ln mean_j exp((size - bias) s_j - s_j^2 / 2) / var),  s_j = 1, 2, 4 times the least size of a fault
// with bias and var of twin_promise.h, l at most h / kLeastWindows, so that nothing shorter than that many windows (a blow, a
// skid, a hand) can do it. An alarm is S > h.
//   h = ln(hypotheses windows_per_hour / false_alarms_per_hour)
// The mean time to a false alarm of one sum of log-likelihood ratios is
// at least e^h windows (G. Lorden, Ann. Math. Stat. 42, 1971), which cutting l from above does not change. A difference of less than
// half a fault's least size never adds up, however long it lasts.
// Beside the bank of faults there is one hypothesis per signal that its differences are three times what they were, for what no
// fault explains, and one per wheel that its encoder's line tells nothing but zeros.
// The suspect is the fault that explains most of the differences' energy since its sum left zero. It is named when that is
// kExplained or more (less where the differences as such have not grown) and is worth an alarm, else the alarm says that no fault it
// knows explains it; suspects that explain nearly as much are named with it.
// Where the first windows do not name one, it waits kPatience windows for more of them.
// Cannot: see what a standing robot has; name two faults at once.
#pragma once
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "identify/twin/twin_promise.h"

namespace omnihil {

struct TwinOptions {
  double learn_s = 60.0;  // of driving
  double settle_s = 3.0;  // at the start, in which the model forgets that it began from elsewhere
  double window_s = 0.5;
  double false_alarms_per_hour = 0.01;
};

struct TwinAlarm {
  double time_s = 0.0, since_s = 0.0;  // when it is raised; where its evidence begins
  std::string suspect;                 // "torque of wheel 2"; "unknown"
  std::string fault;                   // "wheel_torque_2"; "encoder_line_2"; "unknown"
  std::vector<std::string> or_else;    // suspects that explain nearly as much
  double size = 0.0, sigma = 0.0;      // of a fault of the bank
  double explained_ratio = 0.0;        // share of the differences' energy
  std::string worst_signal;            // whose differences grew most
  double worst_times = 0.0;            // rms over what it was while learning
  std::string sentence;
};

class TwinWatch {
 public:
  TwinWatch(const TwinBank& bank, const TwinOptions& options);
  std::optional<TwinAlarm> take(const TwinWindow& window);
  // The robot was not driven, or another stretch begins: the model settles again.
  void pause() { began_s_.reset(); }

  bool learning() const { return !promise_; }
  double learned_s() const { return options_.window_s * static_cast<double>(healthy_.size()); }
  const TwinPromise* promise() const { return promise_ ? &*promise_ : nullptr; }
  double threshold() const { return threshold_; }
  double worst() const;  // the largest sum over the threshold
  const std::string& suspected() const {
    return suspected_;
  }  // of the last alarm while it lasts; empty: all is well

 private:
  struct Sum {
    double value = 0.0;
    double since_s = 0.0;  // when it last left zero
    void add(double l, double most, const TwinScore& score);
  };
  void add(const TwinScore& score);
  TwinAlarm judged(double since_s, double now_s) const;
  std::optional<TwinAlarm> dead_line(double now_s) const;
  void say(TwinAlarm& alarm) const;

  TwinBank bank_;
  TwinOptions options_;
  double threshold_ = 0.0;
  std::optional<double> began_s_;
  std::vector<TwinWindow> healthy_;
  std::optional<TwinPromise> promise_;
  std::vector<Sum> faults_;
  std::map<std::string, Sum, std::less<>> signals_, lines_;
  std::deque<TwinScore> recent_;
  std::optional<double> crossed_since_s_;
  int patience_ = 0, calm_ = 0;
  std::string suspected_;
};

}  // namespace omnihil

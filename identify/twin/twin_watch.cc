#include "identify/twin/twin_watch.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/model/rolling_model.h"
#include "sim/robot/geometry.h"

namespace omnihil {
namespace {

constexpr double kLeastWindows =
    6.0;  // that an alarm takes: a blow, a skid, a hand last less than three seconds; a choice
// Share of the differences' energy that names a suspect: where the differences as such have grown, and where only the direction of
// one fault stands out of what healthy differences are. Choices; wrong names and no names were weighed on hidden robots.
constexpr double kExplained = 0.6, kExplainedOfLittle = 0.3;  // choices, as above
constexpr double kWorthIt = 0.75;  // of its least size: a suspect that is smaller is none; a choice
constexpr double kNearly = 0.8;    // of what the suspect explains: a rival that is named with it; a choice
constexpr int kPatience = 2;       // windows that an alarm waits for a name: a second; a choice
constexpr int kCalm =
    20;  // windows without a crossing after which a fault counts as gone: ten seconds; a choice
constexpr double kMoving_rad_s = 1.0;  // rms of the wheels: 3 cm/s of rim; a choice
constexpr double kTimes2 = 9.0;  // squared growth of differences that is looked for: three times; a choice
constexpr double kIndependent =
    5.0;  // values of a window of half a second that tell anything new: 0.1 s apart; a choice
constexpr double kDeadShare = 0.25;  // of the threshold: an alarm is there already, this says which; a choice
constexpr std::size_t kStandingWindows = 4;  // two seconds; a choice
constexpr double kStandsStill =
    4.0;  // mean square in sigmas of a line that tells nothing: two sigmas; a choice
constexpr std::size_t kRecent =
    24;  // windows kept: 12 s, longer than the evidence of any alarm of the tests (8.6 s); a choice

}  // namespace

TwinWatch::TwinWatch(const TwinBank& bank, const TwinOptions& options) : bank_(bank), options_(options) {
  faults_.resize(bank_.faults.size());
}

void TwinWatch::Sum::add(double l, double most, const TwinScore& score) {
  if (value <= 0.0) since_s = score.from_s;
  value = std::max(0.0, value + std::min(l, most));
}

double TwinWatch::worst() const {
  double most = 0.0;
  for (const Sum& s : faults_) most = std::max(most, s.value);
  for (const auto* sums : {&signals_, &lines_}) {
    for (const auto& [name, s] : *sums) most = std::max(most, s.value);
  }
  return threshold_ > 0.0 ? most / threshold_ : 0.0;
}

void TwinWatch::add(const TwinScore& score) {
  const double most = 1.001 * threshold_ / kLeastWindows;
  for (std::size_t f = 0; f < faults_.size(); ++f) {
    const FaultScore& s = score.faults[f];
    if (!(s.information > 0.0)) continue;
    const FaultPromise& p = promise_->faults[f];
    const double variance = p.variance(s.information), off = s.size - p.bias;
    double sum = 0.0;
    // Times the least: a fault of any size lies within an octave of one, or far beyond the threshold. A choice.
    constexpr std::array<double, 3> kSizes = {1.0, 2.0, 4.0};
    for (const double times : kSizes) {
      const double size = times * bank_.faults[f].least;
      sum += std::exp(std::min(50.0, (off * size - 0.5 * size * size) / variance));  // 50: far beyond the cut
    }
    faults_[f].add(std::log(sum / kSizes.size()), most, score);
  }
  for (const SignalScore& s : score.signals) {
    const SignalPromise& p = promise_->signals.at(s.name);
    const double shift = std::log(kTimes2), off = std::log(std::max(s.typical, 1e-12)) - p.log_mean;
    signals_[s.name].add((off - 0.5 * shift) * shift / (p.log_sigma * p.log_sigma), most, score);
    if (s.wheel_speed) lines_[s.name].add(0.5 * kIndependent * (s.excess - s.standing), most, score);
  }
}

std::optional<TwinAlarm> TwinWatch::take(const TwinWindow& window) {
  if (!window.finite) return std::nullopt;
  if (!began_s_) began_s_ = window.from_s;
  if (window.from_s < *began_s_ + options_.settle_s) return std::nullopt;
  if (!promise_) {
    if (window.moved_rad_s > kMoving_rad_s) healthy_.push_back(window);
    if (learned_s() < options_.learn_s) return std::nullopt;
    promise_ = learned_promise(healthy_, bank_);
    const auto hypotheses = static_cast<double>(bank_.faults.size() + promise_->signals.size() +
                                                wheel_count(bank_.model.file.parameters));
    threshold_ = std::log(hypotheses * 3600.0 / options_.window_s / options_.false_alarms_per_hour);
    healthy_.clear();
    return std::nullopt;
  }
  recent_.push_back(twin_score(window, *promise_, bank_.faults.size()));
  if (recent_.size() > kRecent) recent_.pop_front();
  add(recent_.back());
  if (worst() < 1.0) {
    if (++calm_ >= kCalm) suspected_.clear();
    if (!crossed_since_s_) return std::nullopt;
  }
  if (!crossed_since_s_) {
    const Sum* first = nullptr;
    const auto look = [&](const Sum& s) {
      if (first == nullptr || s.value > first->value) first = &s;
    };
    for (const Sum& s : faults_) look(s);
    for (const auto& [name, s] : signals_) look(s);
    for (const auto& [name, s] : lines_) look(s);
    crossed_since_s_ = first->since_s;
    patience_ = kPatience;
  }
  calm_ = 0;
  TwinAlarm alarm = judged(*crossed_since_s_, window.to_s);
  if ((alarm.fault == "unknown" || !alarm.or_else.empty()) && patience_-- > 0) return std::nullopt;
  crossed_since_s_.reset();
  for (Sum& s : faults_) s = {};
  signals_.clear();
  lines_.clear();
  if (alarm.suspect == suspected_ || (!suspected_.empty() && alarm.fault == "unknown")) return std::nullopt;
  suspected_ = alarm.suspect;
  return alarm;
}

// Lines that tell zeros while more is expected of them. A fault that slows a wheel lets it move in some window; this one does not.
std::optional<TwinAlarm> TwinWatch::dead_line(double now_s) const {
  std::vector<std::string> dead;
  double since_s = now_s;
  const auto stands = [](const TwinScore& w, const std::string& name) {
    return std::none_of(w.signals.begin(), w.signals.end(),
                        [&](const SignalScore& s) { return s.name == name && s.standing > kStandsStill; });
  };
  for (const auto& [name, sum] : lines_) {
    if (sum.value < kDeadShare * threshold_ || recent_.size() < kStandingWindows) continue;
    const auto from = recent_.end() - static_cast<std::ptrdiff_t>(kStandingWindows);
    if (!std::all_of(from, recent_.end(), [&, n = &name](const TwinScore& w) { return stands(w, *n); }))
      continue;
    dead.push_back(name);
    since_s = std::min(since_s, sum.since_s);
  }
  if (dead.empty()) return std::nullopt;
  TwinAlarm a;
  a.time_s = now_s;
  a.since_s = since_s;
  a.explained_ratio = 1.0;
  if (dead.size() == wheel_count(bank_.model.file.parameters)) {
    a.fault = a.suspect = "robot stands";
    return a;
  }
  const std::string wheel = dead.front().substr(dead.front().rfind('_') + 1);
  a.fault = "encoder_line_" + wheel;
  a.suspect = "encoder line of wheel " + wheel;
  return a;
}

TwinAlarm TwinWatch::judged(double since_s, double now_s) const {
  TwinAlarm a;
  std::vector<double> gained(bank_.faults.size(), 0.0), information(bank_.faults.size(), 0.0);
  std::map<std::string, std::array<double, 2>> excess;  // [sum, samples] by signal
  double all = 0.0;
  for (const TwinScore& w : recent_) {
    if (w.from_s < since_s - 1e-9) continue;
    for (std::size_t f = 0; f < bank_.faults.size(); ++f) {
      gained[f] += w.faults[f].gained - promise_->faults[f].bias * w.faults[f].information;
      information[f] += w.faults[f].information;
    }
    for (const SignalScore& s : w.signals) {
      all += s.samples * (s.excess - promise_->signals.at(s.name).excess);
      excess[s.name][0] += s.samples * s.excess;
      excess[s.name][1] += s.samples;
    }
  }
  for (const auto& [name, e] : excess) {
    const double times = std::sqrt(e[0] / e[1] / promise_->signals.at(name).excess);
    if (times > a.worst_times) a.worst_times = times, a.worst_signal = name;
  }
  if (std::optional<TwinAlarm> dead = dead_line(now_s)) {
    dead->worst_signal = a.worst_signal;
    dead->worst_times = a.worst_times;
    say(*dead);
    return *dead;
  }
  a.time_s = now_s;
  a.since_s = since_s;
  a.suspect = a.fault = "unknown";
  const auto explained = [&](std::size_t f) {
    if (!(information[f] > 0.0) || !(all > 0.0)) return 0.0;
    if (gained[f] / information[f] / bank_.faults[f].least < kWorthIt) return 0.0;
    return std::min(1.0, gained[f] * gained[f] / information[f] / all);
  };
  std::size_t best = 0;
  for (std::size_t f = 1; f < bank_.faults.size(); ++f) {
    if (explained(f) > explained(best)) best = f;
  }
  a.explained_ratio = explained(best);
  const bool grown = std::any_of(signals_.begin(), signals_.end(),
                                 [&](const auto& s) { return s.second.value > 0.5 * threshold_; });
  if (a.explained_ratio >= (grown ? kExplained : kExplainedOfLittle)) {
    const TwinFault& fault = bank_.faults[best];
    a.fault = fault.id;
    a.suspect = fault.suspect;
    a.size = gained[best] / information[best];
    const FaultPromise& p = promise_->faults[best];
    a.sigma = std::sqrt(p.serial * (p.lambda2 / information[best] + p.tau2));
    for (std::size_t f = 0; f < bank_.faults.size(); ++f) {
      const std::string& other = bank_.faults[f].suspect;
      if (other == a.suspect || explained(f) < kNearly * a.explained_ratio) continue;
      if (std::find(a.or_else.begin(), a.or_else.end(), other) == a.or_else.end()) a.or_else.push_back(other);
    }
  }
  say(a);
  return a;
}

void TwinWatch::say(TwinAlarm& a) const {
  const std::string seen =
      fmt::format("{} is off by {:.1f} times what it was while healthy", a.worst_signal, a.worst_times);
  const auto fault = std::find_if(bank_.faults.begin(), bank_.faults.end(),
                                  [&](const TwinFault& f) { return f.id == a.fault; });
  if (fault != bank_.faults.end()) {
    a.sentence = fmt::format("{}{}{}: {}, explains {:.0f} % of what differs; {}", a.suspect,
                             a.or_else.empty() ? "" : ", or ", fmt::join(a.or_else, ", or "),
                             fault->size_text(a.size, a.sigma), 100.0 * a.explained_ratio, seen);
  } else if (a.fault == "robot stands") {
    a.sentence =
        "robot stands though it is asked to move: not enabled, without power, or out of the radio's reach";
  } else if (a.fault == "unknown") {
    a.sentence =
        fmt::format("unknown: no fault that is known here explains what differs (the best {:.0f} %); {}",
                    100.0 * a.explained_ratio, seen);
  } else {
    a.sentence = fmt::format(
        "{} tells nothing but zeros while the wheel should turn (or the wheel is blocked)", a.suspect);
  }
}

}  // namespace omnihil

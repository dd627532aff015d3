#include "hil/twin/twin_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "hil/card/card_gallery.h"
#include "hil/text/hashed_file.h"
#include "hil/text/json_text.h"
#include "hil/text/text_file.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

// Driving, not noise, decides how far a model is off: a drive of another kind may well be twice as far off; a choice.
constexpr double kTimesCard = 2.0;

void read_errors(const fs::path& json_file, std::map<std::string, double>& rmse) {
  std::string error;
  const nlohmann::ordered_json card = json_of(read_text_file(json_file.string(), error));
  if (!error.empty() || !card.is_object() || !card.contains("data")) return;
  for (const auto& data : card["data"]) {
    for (const char* use : {"holdout", "extrapolation"}) {
      if (!data.contains("errors") || !data["errors"].contains(use)) continue;
      for (const auto& [signal, e] : data["errors"][use].items()) {
        if (e.contains("rmse") && e["rmse"].is_number())
          rmse[signal] = std::max(rmse[signal], e["rmse"].get<double>());
      }
    }
  }
}

}  // namespace

std::map<std::string, double> card_errors(const fs::path& model_file) {
  std::map<std::string, double> rmse;
  if (!fs::exists(model_file)) return rmse;
  const std::string sha = hash_file(model_file.string()).sha256;
  const fs::path folder = model_file.parent_path().empty() ? fs::path(".") : model_file.parent_path();
  for (const StoredCard& card : read_cards(folder).cards) {
    const bool same = std::any_of(card.files.begin(), card.files.end(),
                                  [&](const HashedFile& f) { return f.sha256 == sha; });
    if (same) read_errors(card.json, rmse);
  }
  return rmse;
}

TwinRunner::TwinRunner(const Candidate& model, std::map<std::string, double> card_rmse,
                       const TwinOptions& options, TwinTell tell)
    : card_rmse_(std::move(card_rmse)),
      options_(options),
      tell_(std::move(tell)),
      model_([&] {
        if (const std::string why = twin_refusal(model); !why.empty())
          throw std::invalid_argument("the model " + why);
        return twin_bank(model);
      }()),
      watch_(model_.bank(), options) {}

void TwinRunner::pause() {
  model_.restart();
  watch_.pause();
}

void TwinRunner::take(const Run& piece) {
  last_ = model_.advance(piece);
  const bool learning = watch_.learning();
  const std::optional<TwinAlarm> alarm = watch_.take(last_);
  if (!learning) watched_s_ += last_.to_s - last_.from_s;
  if (learning && !watch_.learning()) {
    std::string said = fmt::format("learned from {:.0f} s of driving:", options_.learn_s);
    for (const auto& [name, p] : watch_.promise()->signals) said += fmt::format(" {} {:.3g}", name, p.rms);
    tell_(
        {.kind = TwinEvent::Kind::kLearned, .time_s = last_.to_s, .sentence = std::move(said), .alarm = {}});
    for (std::string& line : outside_card(*watch_.promise(), card_rmse_, kTimesCard)) {
      tell_({.kind = TwinEvent::Kind::kOutsideCard,
             .time_s = last_.to_s,
             .sentence = std::move(line),
             .alarm = {}});
    }
  }
  if (!alarm) return;
  ++alarms_;
  tell_({.kind = TwinEvent::Kind::kAlarm,
         .time_s = alarm->time_s,
         .sentence = alarm->sentence,
         .alarm = *alarm});
}

std::string TwinRunner::status_line() const {
  std::string line = fmt::format("{:8.1f} s ", last_.to_s);
  for (const TwinSignal& s : last_.signals) {
    if (s.measured.empty()) continue;
    line +=
        fmt::format(" {} {:.3g}/{:.3g}", s.wheel_speed ? "w" + s.name.substr(s.name.rfind('_') + 1) : s.name,
                    s.measured.back(), s.expected.back());
  }
  if (watch_.learning())
    return line + fmt::format("  learning {:.0f} of {:.0f} s", watch_.learned_s(), options_.learn_s);
  if (!watch_.suspected().empty()) return line + "  ALARM " + watch_.suspected();
  return line + fmt::format("  as expected (suspicion {:.0f} %)", 100.0 * watch_.worst());
}

std::string twin_text(const TwinEvent& e) {
  const char* what = e.kind == TwinEvent::Kind::kAlarm     ? "ALARM"
                     : e.kind == TwinEvent::Kind::kLearned ? "twin"
                                                           : "outside its card";
  return fmt::format("{:.1f} s {}: {}", e.time_s, what, e.sentence);
}

std::string twin_json(const TwinEvent& e) {
  nlohmann::ordered_json out;
  out["time_s"] = e.time_s;
  out["event"] = e.kind == TwinEvent::Kind::kAlarm     ? "alarm"
                 : e.kind == TwinEvent::Kind::kLearned ? "learned"
                                                       : "outside_card";
  if (e.kind == TwinEvent::Kind::kAlarm) {
    const TwinAlarm& a = e.alarm;
    out["since_s"] = a.since_s;
    out["suspect"] = a.suspect;
    out["fault"] = a.fault;
    out["or"] = a.or_else;
    if (a.sigma > 0.0) {
      out["size"] = a.size;
      out["interval_95_percent"] = {a.size - 1.96 * a.sigma, a.size + 1.96 * a.sigma};
    }
    out["explained_ratio"] = a.explained_ratio;
    out["worst_signal"] = a.worst_signal;
    out["worst_times"] = a.worst_times;
  }
  out["sentence"] = e.sentence;
  return json_text(out);
}

}  // namespace omnihil

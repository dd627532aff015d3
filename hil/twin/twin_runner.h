// The twin beside a stream of pieces: model, watch, and what is said of them, whoever brings the pieces.
//
//   TwinRunner runner(model, card_errors("bench/model.toml"), {.learn_s = 60.0}, tell);
//   runner.take(piece);                       // tell(event) for what is new: "learned", "outside card", "alarm"
//   runner.status_line();                     // one line: told against expected, and how suspicious
//   twin_json(event);                         // one line of JSON
//
// `card_errors`: rms errors of unseen runs by signal, from the cards (*.card.json) that lie beside a model or in cards/ there and name
// this very file; none: there is no card, or it is stale, and nothing is held against it.
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "identify/twin/twin_watch.h"

namespace omnihil {

struct TwinEvent {
  enum class Kind : std::uint8_t { kLearned, kOutsideCard, kAlarm } kind = Kind::kAlarm;
  double time_s = 0.0;
  std::string sentence;
  TwinAlarm alarm;  // kAlarm
};

using TwinTell = std::function<void(const TwinEvent&)>;

std::map<std::string, double> card_errors(const std::filesystem::path& model_file);

class TwinRunner {
 public:
  // Throws std::invalid_argument where the model cannot be a twin.
  TwinRunner(const Candidate& model, std::map<std::string, double> card_rmse, const TwinOptions& options,
             TwinTell tell);
  void take(const Run& piece);
  // Another stretch: the model starts from telemetry again, what was learned stays.
  void pause();

  std::string status_line() const;
  const TwinWatch& watch() const { return watch_; }
  std::uint64_t alarms() const { return alarms_; }
  double watched_s() const { return watched_s_; }

 private:
  std::map<std::string, double> card_rmse_;
  TwinOptions options_;
  TwinTell tell_;
  TwinModel model_;
  TwinWatch watch_;
  TwinWindow last_;
  std::uint64_t alarms_ = 0;
  double watched_s_ = 0.0;
};

std::string twin_text(const TwinEvent& event);
std::string twin_json(const TwinEvent& event);

}  // namespace omnihil

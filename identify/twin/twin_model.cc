#include "identify/twin/twin_model.h"

#include <algorithm>
#include <cmath>

#include "identify/record/rig.h"
#include "sim/model/rolling_model.h"

namespace omnihil {
namespace {

constexpr double kLevel_s = 10.0;  // a battery's charge moves in minutes, its sag with every start: a choice

Dataset told_by(const Run& piece) {
  Dataset d;
  d.rig = &rig_robot();
  for (const auto& [name, values] : piece.signals) {
    const SignalRow* row = find_signal(rig_robot(), name);
    if (row == nullptr || name.starts_with("vision") || name.starts_with("encoder")) continue;
    // sigma: any; the twin finds the noise itself. Of a bus voltage none, so that it is taken as it is.
    d.channels.push_back({.signal = name,
                          .column = name,
                          .unit = std::string(row->unit),
                          .sigma = name == "bus_voltage" ? 0.0 : 1.0});
  }
  return d;
}

}  // namespace

std::string twin_refusal(const Candidate& model) {
  if (model.file.rig != "robot") return "is no robot's model";
  if (!rolling_params(model.file.parameters).has_controller)
    return "has no [controller]: what makes duties of radio commands (docs/radio-driven.md)";
  return "";
}

TwinModel::TwinModel(TwinBank bank) : bank_(std::move(bank)), unknowns_(bank_.unknowns()) {
  for (std::size_t first = 0; first < unknowns_.size(); first += kJetWidth)
    models_.push_back(rolling_values<Jet>({bank_.model, unknowns_, first}));
  restart();
}

void TwinModel::restart() {
  carries_.assign(models_.size(), {});
  levels_.clear();
}

TwinWindow TwinModel::advance(const Run& piece) {
  const Dataset dataset = told_by(piece);
  const RobotRun run = robot_run(dataset, piece, rolling_params(bank_.model.file.parameters));
  const RobotRecord& record = run.record;
  TwinWindow out{.from_s = piece.time_s.front(), .to_s = piece.time_s.back(), .signals = {}};
  const bool goes_on = carries_.front().begun;
  const RobotMotionOptions options{.slave_angle = false, .follow_camera = false, .noise_seed = {}};
  std::vector<std::vector<Jet>> expected;  // [pass * signals + signal]
  for (std::size_t m = 0; m < models_.size(); ++m) {
    const RobotMotion<Jet> motion = run_robot(models_[m], record, options, &carries_[m]);
    out.finite = out.finite && motion.finite;
    for (std::vector<Jet>& y : robot_outputs(run, motion)) expected.push_back(std::move(y));
  }
  if (!out.finite) {
    restart();
    return out;
  }
  const auto faults = static_cast<Eigen::Index>(unknowns_.size());
  double square = 0.0, count = 0.0;
  for (std::size_t s = 0; s < run.seen.size(); ++s) {
    TwinSignal told;
    told.name = run.compared[s].name;
    told.unit = run.compared[s].unit;
    told.wheel_speed = run.seen[s].quantity == Quantity::kWheelSpeed;
    std::vector<double> plain;
    for (const Jet& y : expected[s]) plain.push_back(y.a);
    const std::vector<double>& measured = run.compared[s].measured;
    std::vector<std::size_t> rows;
    for (std::size_t k = goes_on ? 1 : 0; k < plain.size(); ++k) {
      if (std::isfinite(measured[k])) rows.push_back(k);
    }
    told.gains.resize(static_cast<Eigen::Index>(rows.size()), faults);
    for (std::size_t n = 0; n < rows.size(); ++n) {
      const std::size_t k = rows[n];
      told.time_s.push_back(record.time_s[k]);
      told.measured.push_back(measured[k]);
      told.expected.push_back(plain[k]);
      told.slope.push_back(rate_at(record.time_s, plain, k));
      for (Eigen::Index f = 0; f < faults; ++f) {
        const Jet& y = expected[static_cast<std::size_t>(f / kJetWidth) * run.seen.size() + s][k];
        told.gains(static_cast<Eigen::Index>(n), f) = y.v[f % kJetWidth];
      }
      if (told.wheel_speed) square += plain[k] * plain[k], count += 1.0;
    }
    if (run.seen[s].quantity == Quantity::kBusVoltage) take_level(told);
    out.signals.push_back(std::move(told));
  }
  out.moved_rad_s = count > 0.0 ? std::sqrt(square / count) : 0.0;
  return out;
}

// Each stage takes off the mean over the last kLevel_s, at first over all so far.
void TwinModel::take_level(TwinSignal& bus) {
  constexpr std::size_t kStages = 2;  // derived: a level that falls evenly leaves nothing behind the second
  for (std::size_t n = 0; n < bus.time_s.size(); ++n) {
    const auto row = static_cast<Eigen::Index>(n);
    Level now{bus.measured[n] - bus.expected[n], bus.gains.row(row).transpose()};
    if (levels_.empty()) {
      levels_.assign(kStages, {0.0, Eigen::VectorXd::Zero(now.gains.size())});
      levels_[0] = now;
      level_from_s_ = level_last_s_ = bus.time_s[n];
    }
    const double age_s = std::max(bus.time_s[n] - level_from_s_, 1e-3);
    const double share = -std::expm1(-(bus.time_s[n] - level_last_s_) / std::min(kLevel_s, age_s));
    for (Level& level : levels_) {
      const Level before = now;
      now.gap -= level.gap;
      now.gains -= level.gains;
      level.gap += share * (before.gap - level.gap);
      level.gains += share * (before.gains - level.gains);
    }
    bus.expected[n] = bus.measured[n] - now.gap;
    bus.gains.row(row) = now.gains.transpose();
    level_last_s_ = bus.time_s[n];
  }
}

}  // namespace omnihil

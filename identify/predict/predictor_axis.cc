#include "identify/predict/predictor_axis.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <ranges>
#include <string>
#include <utility>

#include "identify/predict/axis_outputs.h"
#include "identify/predict/axis_substep.h"
#include "identify/predict/counted_setups.h"
#include "identify/predict/input_wander.h"
#include "identify/predict/predictor_rig.h"
#include "sim/law/random.h"

namespace omnihil {
namespace {

// A delay whose derivative a limit behind it hides (predictor_axis.h).
bool is_hidden_delay(const Candidate& c, const Unknown& u) {
  if (u.effect < 0 || !acts(c, kHidesDelays)) return false;
  const EffectInfo& info = *c.effects[static_cast<std::size_t>(u.effect)].entry->info;
  return (info.numerics & kDelays) != 0 && static_cast<std::size_t>(u.row) == first_strength(info);
}

class AxisRig : public RigRuns<AxisSetup> {
 public:
  AxisRig(std::shared_ptr<const Dataset> dataset, std::shared_ptr<const Candidate> nominal,
          const PredictOptions& options)
      : RigRuns(std::move(dataset), std::move(nominal), options) {
    for (const Run& run : dataset_->runs) {
      runs_.push_back(make_axis_setup(*dataset_, *nominal_, run));
      if (!options_.slave_angle) runs_.back().input.measured_position_rad.clear();
    }
    counter_ = find_counted_speed(runs_, drive_of(*nominal_));
    std::vector<RigRun*> series;
    for (AxisSetup& s : runs_) {
      if (!s.steady) series.push_back(&s);
    }
    share_noise(series);
    choose_averaging(*dataset_, all_runs());
    choose_step();
    choose_whitening();
  }

  Method method() const { return axis_method(*dataset_); }
  bool shows_signature_of(const EffectEntry& effect) const { return counter_ == &effect; }
  Capabilities capabilities() const { return axis_capabilities(*dataset_, *nominal_); }
  double step_s(const Candidate& own, std::size_t n) const { return substep_.of(own, static_cast<int>(n)); }
  // Between parts that meet and leave exact derivatives hold for no finite step.
  bool is_exact(const Candidate& own, std::size_t) const { return !acts(own, kImpacts); }
  std::vector<RegimeTrack> regimes(const Candidate& own, std::size_t n) const {
    return axis_regimes(runs_[n], own, step_s(own, n));
  }

  template <typename T>
  RigOutputs<T> outputs(const RigModel& model, std::size_t n, double step_s) const {
    const AxisSetup& s = runs_[n];
    if (s.input.time_s.empty()) return {.values = std::vector<std::vector<T>>(s.seen.size())};
    const auto m = axis_values<T>(model);
    return {.values = axis_outputs<T>(s, m.params, EffectSet<T>(m.uses, m.values), step_s)};
  }

  Secant secant(const Candidate& own, const Unknown& unknown, Eigen::Index u, std::size_t n,
                const Prediction& p) const {
    constexpr double kStep_s = 4e-3;  // two of the longest sub-steps; a choice
    constexpr double kWidth = 0.1;    // of Unknown::scale (DECISIONS 29): a choice; sensitivity not measured
    if (runs_[n].input.time_s.empty()) return {};
    if (is_hidden_delay(own, unknown)) return {.width = kStep_s};
    const double width = kWidth * unknown.scale;
    if (is_exact(own, n)) return {.width = explodes(runs_[n], unknown, u, p) ? width : 0.0};
    const bool of_the_play =
        unknown.effect >= 0 &&
        (own.effects[static_cast<std::size_t>(unknown.effect)].entry->info->numerics & kImpacts) != 0;
    if (of_the_play) return {.width = width};
    return {.width = 0.5 * width, .forward = true};
  }

  // Rotor and load turn as one: J = J_rotor + J_load / N^2, unless something gives between them.
  std::optional<MultipleOf> multiple_of(const Candidate& own, std::span<const Unknown> unknowns,
                                        std::size_t u) const {
    if (unknowns[u].path != "load.inertia_kg_m2") return std::nullopt;
    const bool is_rigid = std::ranges::none_of(
        own.effects, [](const EffectUse& use) { return use.entry->info->place == Place::kShaft; });
    const auto rotor = std::ranges::find(unknowns, "motor.rotor_inertia_kg_m2", &Unknown::path);
    const double ratio = drive_of(own).gear_ratio;
    if (!is_rigid || rotor == unknowns.end()) return std::nullopt;
    return MultipleOf{.unknown = static_cast<std::size_t>(rotor - unknowns.begin()),
                      .factor = 1.0 / (ratio * ratio)};
  }

  void measure(const Candidate& truth, std::uint64_t seed) {
    for (std::size_t n = 0; n < runs_.size(); ++n) {
      AxisSetup& s = runs_[n];
      Prediction p = ground_truth_prediction(with_known(truth, dataset_->runs[n].known), n, seed);
      for (std::size_t c = 0; c < s.compared.size(); ++c) {
        add_sensor_noise(s, c, seed, stream_of(s.compared[c].name) + std::uint64_t{n} * 1000003, p.values[c]);
        s.compared[c].measured = p.values[c];
      }
    }
  }

 private:
  // Would a step of Unknown::scale change a signal, to first order, by several times its rms? Then the
  // derivative has grown from impact to impact (play, sticking) while the motion stays bounded: it holds for
  // no finite step.
  static bool explodes(const AxisSetup& s, const Unknown& unknown, Eigen::Index u, const Prediction& p) {
    constexpr double kMost = 3.0;  // times the signal's rms, where a bounded change is below 2; a choice
    for (std::size_t c = 0; c < p.derivatives.size(); ++c) {
      double moved = 0.0, signal = 0.0;
      for (Eigen::Index k = 0; k < p.derivatives[c].rows(); ++k) {
        const double value = s.compared[c].measured[static_cast<std::size_t>(k)];
        if (!std::isfinite(value)) continue;
        moved += p.derivatives[c](k, u) * p.derivatives[c](k, u);
        signal += value * value;
      }
      if (!(moved * unknown.scale * unknown.scale <= kMost * kMost * signal)) return true;
    }
    return false;
  }

  void choose_step() {
    const auto trial = std::make_shared<AxisRig>(shortened());
    substep_ =
        AxisSubstep(*nominal_, runs_, options_.step_s, [trial](const Candidate& model, int run, double h) {
          const auto n = static_cast<std::size_t>(run);
          const AxisSetup& s = trial->runs_[n];
          const Run& of = trial->dataset_->runs[n];
          if (of.split != Split::kTraining || s.steady || s.input.time_s.size() < 2) return kMissing;
          const Candidate own = with_known(model, of.known);
          return distance(s, predicted(*trial, own, n, h), predicted(*trial, own, n, 0.25 * h));
        });
  }

  // Of counts and positions whose drive's bus is measured: that input's noise integrates into speed and position.
  void choose_whitening() {
    std::map<std::string, std::vector<Wander>> wanders;
    std::optional<AxisRig> shorter;
    for (std::size_t n = 0; n < runs_.size(); ++n) {
      const AxisSetup& s = runs_[n];
      const bool compares = std::ranges::any_of(s.compared, is_difference);
      if (!compares || dataset_->runs[n].split != Split::kTraining || !has_bus_input(s)) continue;
      AxisRig& trial = shorter ? *shorter : shorter.emplace(shortened());
      const Candidate own = with_known(*nominal_, dataset_->runs[n].known);
      const Prediction moved = trial.ground_truth_prediction(own, n, kNoiseSeed),
                       still = predicted(trial, own, n, step_s(own, n));
      for (std::size_t c = 0; c < s.compared.size(); ++c) {
        if (!is_difference(s.compared[c])) continue;
        Wander& w = wanders[s.compared[c].name].emplace_back(Wander{&s.compared[c], moved.values[c]});
        for (std::size_t k = 0; k < w.change.size(); ++k) w.change[k] -= still.values[c][k];
      }
    }
    for (const auto& [name, of_runs] : wanders) {
      const Whitening best = whitening_beside(of_runs, kWhitening_s, kShortestWhitening_s);
      for (AxisSetup& s : runs_) {
        for (ComparedSignal& c : s.compared) {
          if (c.name != name || !is_difference(c)) continue;
          c.whitening_s = best.time_constant_s;
          c.whitened_sigma = best.sigma;
        }
      }
    }
  }
  static bool is_difference(const ComparedSignal& c) {
    return c.whitening_s > 0.0 && c.counted.window_s <= 0.0;
  }
  static bool has_bus_input(const AxisSetup& s) {
    return s.method == Method::kForward && !s.steady && s.input.time_s.size() > 1 &&
           std::ranges::any_of(s.compared, [](const ComparedSignal& c) { return c.name == "bus_voltage"; });
  }
  // Any: the draw is used for the rms of the noise alone.
  static constexpr std::uint64_t kNoiseSeed = 1;  // as above
  static constexpr double kTrial_s = 10.0;        // of a run: bounds the cost; a choice

  AxisRig shortened() const {
    AxisRig out(*this);
    for (AxisSetup& s : out.runs_) shorten(s, kTrial_s);
    return out;
  }
  static void shorten(AxisSetup& s, double span_s) {
    const auto& t = s.input.time_s;
    if (t.empty() || s.steady) return;
    const auto n =
        static_cast<std::size_t>(std::lower_bound(t.begin(), t.end(), t.front() + span_s) - t.begin());
    const auto cut = [&](auto& v) {
      if (v.size() > n) v.resize(n);
    };
    AxisInput& in = s.input;
    cut(in.command), cut(in.enable), cut(in.bus_voltage_V), cut(in.imposed_velocity_rad_s);
    cut(in.load_torque_Nm), cut(in.measured_position_rad), cut(in.restart_velocity_rad_s), cut(s.given);
    for (ComparedSignal& c : s.compared) cut(c.measured);
    cut(in.time_s);
  }

  // The model's bus voltage is a measurement smoothed over kBusWindow samples (axis_record.h). The true one
  // differs from it by the mean of the sensor's noise over that window, which integrates into speed and
  // position.
  Prediction ground_truth_prediction(const Candidate& truth, std::size_t n, std::uint64_t seed) {
    AxisSetup& s = runs_[n];
    const auto bus = std::find_if(s.compared.begin(), s.compared.end(),
                                  [](const ComparedSignal& c) { return c.name == "bus_voltage"; });
    s.input.noise_seed = random_bits(seed, stream_of("effects"), std::uint64_t{n});
    if (s.method != Method::kForward || bus == s.compared.end()) return as_drawn(truth, n);
    const std::vector<double> given = s.input.bus_voltage_V;
    const std::uint64_t stream = stream_of("bus_voltage input") + std::uint64_t{n} * 1000003;
    double sum = 0.0;
    for (std::size_t k = 0; k < given.size(); ++k) {
      sum += gaussian(seed, stream, k) - (k >= kBusWindow ? gaussian(seed, stream, k - kBusWindow) : 0.0);
      s.input.bus_voltage_V[k] += bus->noise_sigma * sum / static_cast<double>(kBusWindow);
    }
    Prediction p = as_drawn(truth, n);
    s.input.bus_voltage_V = given;
    return p;
  }

  // Prediction with the random draws of its effects; the seed is cleared afterwards. The noise of a counted
  // speed is added by add_counting_noise(): that of the effect behind it is left out here, its delay is kept.
  Prediction as_drawn(const Candidate& truth, std::size_t n) {
    AxisSetup& s = runs_[n];
    const auto predict = [&](const Candidate& own) { return predicted(*this, own, n, step_s(own, n)); };
    Candidate others = truth;
    const bool counts =
        std::erase_if(others.effects, [&](const EffectUse& u) { return u.entry == counter_; }) > 0;
    Prediction p = predict(truth);
    const Prediction drawn = counts ? predict(others) : Prediction{};
    s.input.noise_seed.reset();
    if (!counts) return p;
    // the expected value with the window's delay, plus the other effects' random part
    const Prediction lagging = predict(truth), still = predict(others);
    for (std::size_t c = 0; c < s.compared.size(); ++c) {
      if (s.compared[c].counted.window_s <= 0.0) continue;
      for (std::size_t k = 0; k < p.values[c].size(); ++k)
        p.values[c][k] = lagging.values[c][k] + drawn.values[c][k] - still.values[c][k];
    }
    return p;
  }

  AxisSubstep substep_;
  const EffectEntry* counter_ = nullptr;  // the effect that made a counted speed; null: none did
};

}  // namespace

std::unique_ptr<Predictor> make_axis_predictor(const Dataset& dataset, const Candidate& nominal,
                                               const PredictOptions& options) {
  return make_rig_predictor<AxisRig>(dataset, nominal, options);
}

}  // namespace omnihil

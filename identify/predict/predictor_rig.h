// What predictors of all rigs share: runs, passes of dual numbers, secants where a motion has no derivative that holds
// for a finite step, numbers that a run states as known.
//
// What a rig is: PredictedRig below. All of its functions but the first are given candidates that hold what the run knows.
#pragma once
#include <algorithm>
#include <concepts>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "identify/predict/observation.h"
#include "identify/predict/rig_values.h"
#include "identify/predict/settled_points.h"
#include "identify/record/remembered.h"

namespace omnihil {

template <typename T>
struct RigOutputs {
  std::vector<std::vector<T>> values;  // [signal][sample], as Prediction's
  bool finite = true;
};

// In place of a derivative: the difference over `width`, half of it to either side, or forward: half the simulations.
struct Secant {
  double width = 0.0;  // unit of the unknown; 0: none
  bool forward = false;
};

// The derivative by an unknown is that by another one (an index among the unknowns), times a factor, whatever the motion: what has
// no derivative of its own to simulate.
struct MultipleOf {
  std::size_t unknown = 0;
  double factor = 1.0;
};

// kCostly: a simulation takes a large part of a second, and what was made last is kept. step_s(): of the simulation, at most.
// is_exact(): dual numbers pass through it. is_rough(): with them it takes longer steps; values are of a run without them.
// secant(): where the exact derivative is not to be used. measure(): puts what `truth` shows these sensors, with their noise, in
// place of the measurement.
template <class R>
concept PredictedRig = requires(R& made, const R& rig, const Candidate& own, const Unknown& unknown,
                                std::size_t run, Eigen::Index u, Prediction& p) {
  { rig.dataset() } -> std::same_as<const Dataset&>;
  { rig.method() } -> std::same_as<Method>;
  { rig.run(run) } -> std::same_as<const RigRun&>;
  { rig.template outputs<double>(RigModel{own}, run, 1e-3) } -> std::same_as<RigOutputs<double>>;
  { rig.template outputs<Jet>(RigModel{own}, run, 1e-3) } -> std::same_as<RigOutputs<Jet>>;
  { rig.step_s(own, run) } -> std::same_as<double>;
  { R::kCostly } -> std::convertible_to<bool>;
  { rig.is_exact(own, run) } -> std::same_as<bool>;
  { rig.is_rough(own, run) } -> std::same_as<bool>;
  { rig.secant(own, unknown, u, run, p) } -> std::same_as<Secant>;
  { rig.multiple_of(own, std::span<const Unknown>(), run) } -> std::same_as<std::optional<MultipleOf>>;
  { rig.regimes(own, run) } -> std::same_as<std::vector<RegimeTrack>>;
  { rig.capabilities() } -> std::same_as<Capabilities>;
  { rig.shows_signature_of(std::declval<const EffectEntry&>()) } -> std::same_as<bool>;
  made.measure(own, std::uint64_t{1});
};

// What a rig has of its dataset, run by run. If it does not say otherwise, it is run forward with exact derivatives.
template <std::derived_from<RigRun> Kept>
class RigRuns {
 public:
  static constexpr bool kCostly = false;
  RigRuns(std::shared_ptr<const Dataset> dataset, std::shared_ptr<const Candidate> nominal,
          const PredictOptions& options)
      : dataset_(std::move(dataset)), nominal_(std::move(nominal)), options_(options) {}

  const Dataset& dataset() const { return *dataset_; }
  const RigRun& run(std::size_t n) const { return runs_[n]; }
  Method method() const { return Method::kForward; }
  double step_s(const Candidate&, std::size_t) const { return options_.step_s; }
  bool is_exact(const Candidate&, std::size_t) const { return true; }
  bool is_rough(const Candidate&, std::size_t) const { return false; }
  Secant secant(const Candidate&, const Unknown&, Eigen::Index, std::size_t, const Prediction&) const {
    return {};
  }
  std::optional<MultipleOf> multiple_of(const Candidate&, std::span<const Unknown>, std::size_t) const {
    return std::nullopt;
  }
  bool shows_signature_of(const EffectEntry&) const { return false; }

 protected:
  std::vector<RigRun*> all_runs() {
    std::vector<RigRun*> all;
    for (Kept& run : runs_) all.push_back(&run);
    return all;
  }
  // The same rig on what its sensors recorded of another motion.
  template <class Rig>
  Rig on(std::shared_ptr<const Dataset> made) const {
    Rig rig(std::move(made), nominal_, options_);
    for (std::size_t n = 0; n < runs_.size(); ++n) keep_sensors(runs_[n], rig.runs_[n]);
    return rig;
  }

  std::shared_ptr<const Dataset> dataset_;
  std::shared_ptr<const Candidate> nominal_;
  PredictOptions options_;
  std::vector<Kept> runs_;
};

template <class Rig>
Prediction predicted(const Rig& rig, std::size_t run, RigOutputs<double> y) {
  Prediction p{.values = std::move(y.values), .derivatives = {}, .finite = y.finite};
  complete(rig.run(run), p);
  return p;
}
template <class Rig>
Prediction predicted(const Rig& rig, const Candidate& own, std::size_t run, double step_s) {
  return predicted(rig, run, rig.template outputs<double>({own}, run, step_s));
}

template <PredictedRig Rig>
class RigPredictor final : public Predictor {
 public:
  RigPredictor(const Dataset& dataset, const Candidate& nominal, const PredictOptions& options)
      : rig_(std::make_shared<const Dataset>(dataset), std::make_shared<const Candidate>(nominal), options) {}

  Method method() const override { return rig_.method(); }
  int run_count() const override { return static_cast<int>(rig_.dataset().runs.size()); }
  const Run& run(int n) const override { return rig_.dataset().runs[at(n)]; }
  const std::vector<ComparedSignal>& compared(int n) const override { return rig_.run(at(n)).compared; }
  Capabilities capabilities() const override { return rig_.capabilities(); }
  bool is_costly() const override { return Rig::kCostly; }
  bool shows_signature_of(const EffectEntry& effect) const override {
    return rig_.shows_signature_of(effect);
  }
  std::vector<RegimeTrack> regimes(const Candidate& candidate, int n) const override {
    const Candidate own = with_known(candidate, run(n).known);
    const auto made = [&] {
      std::vector<RegimeTrack> tracks = rig_.regimes(own, at(n));
      if (run(n).steady) no_time(tracks);
      return tracks;
    };
    return Rig::kCostly ? *kept_->regimes.of(simulated_numbers(own, at(n)), made) : made();
  }

  Prediction predict(const Candidate& candidate, int n) const override {
    const Candidate own = with_known(candidate, run(n).known);
    return predicted(rig_, at(n), values_of(own, at(n)));
  }

  Prediction predict_with_derivatives(const Candidate& candidate, std::span<const Unknown> unknowns,
                                      int n) const override {
    const Candidate own = with_known(candidate, run(n).known);
    const std::vector<Unknown> open = open_unknowns(unknowns, run(n));
    if (!Rig::kCostly || open.empty()) return derived(own, open, at(n));
    Prediction all;
    for (std::size_t first = 0; first < open.size(); first += kJetWidth) {
      const auto pass = std::span(open).subspan(first, std::min<std::size_t>(kJetWidth, open.size() - first));
      const std::shared_ptr<const Prediction> made = kept_->derivatives.of(
          simulated_numbers(own, at(n), pass), [&] { return derived(own, pass, at(n)); });
      if (pass.size() == open.size()) return *made;
      append(*made, static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(open.size()), all);
    }
    return all;
  }

  std::unique_ptr<Predictor> simulated(const Candidate& truth, std::uint64_t seed) const override {
    auto copy = std::make_unique<RigPredictor>(*this);
    copy->rig_.measure(truth, seed);
    copy->kept_ = std::make_shared<Kept>(copy->rig_);
    return copy;
  }

 private:
  // What fit() asks for again of each run: its start, the best point so far, the end of the last step, a trial; of two fits at
  // a time. Derivatives: of where each of them is, in two passes, as far as memory lets it.
  struct Kept {
    static constexpr std::size_t kValues = 8, kPasses = 4;            // derived
    static constexpr std::size_t kMost_bytes = std::size_t{1} << 28;  // of derivatives; a choice
    explicit Kept(const Rig& rig)
        : values(kValues * rig.dataset().runs.size()),
          derivatives(passes_kept(rig)),
          regimes(rig.dataset().runs.size()) {}
    static std::size_t passes_kept(const Rig& rig) {
      std::size_t numbers = 1;  // of the longest run
      for (std::size_t n = 0; n < rig.dataset().runs.size(); ++n) {
        std::size_t of_run = 0;
        for (const ComparedSignal& c : rig.run(n).compared) of_run += kJetWidth * c.measured.size();
        numbers = std::max(numbers, of_run);
      }
      const std::size_t asked = kPasses * rig.dataset().runs.size();
      return std::clamp<std::size_t>(kMost_bytes / (numbers * sizeof(double)), 1,
                                     std::max<std::size_t>(1, asked));
    }
    Remembered<SimulatedNumbers, RigOutputs<double>> values;
    Remembered<SimulatedNumbers, Prediction> derivatives;
    Remembered<SimulatedNumbers, std::vector<RegimeTrack>> regimes;
  };
  static std::size_t at(int n) { return static_cast<std::size_t>(n); }

  RigOutputs<double> values_of(const Candidate& own, std::size_t n) const {
    const auto simulate = [&] { return rig_.template outputs<double>({own}, n, rig_.step_s(own, n)); };
    if constexpr (!Rig::kCostly) return simulate();
    return *kept_->values.of(simulated_numbers(own, n), simulate);
  }

  // One pass's columns to their places.
  static void append(const Prediction& pass, Eigen::Index first, Eigen::Index count, Prediction& all) {
    if (first == 0) {
      all.values = pass.values;
      for (const Eigen::MatrixXd& d : pass.derivatives) all.derivatives.emplace_back(d.rows(), count);
    }
    all.finite = all.finite && pass.finite;
    for (std::size_t s = 0; s < pass.derivatives.size(); ++s)
      all.derivatives[s].middleCols(first, pass.derivatives[s].cols()) = pass.derivatives[s];
  }

  Prediction derived(const Candidate& own, std::span<const Unknown> open, std::size_t n) const {
    const double step_s = rig_.step_s(own, n);
    const bool exact = rig_.is_exact(own, n);
    const bool passes = exact && !open.empty();  // of no unknowns there are no columns
    Prediction p = passes ? by_passes(own, open, n, step_s) : by_values(own, open, n);
    if (passes && rig_.is_rough(own, n)) {
      RigOutputs<double> y = values_of(own, n);
      p.values = std::move(y.values);
      p.finite = p.finite && y.finite;
    }
    for (std::size_t u = 0; u < open.size() && p.finite; ++u) {
      if (open[u].path.empty()) continue;
      const Secant secant = rig_.secant(own, open[u], static_cast<Eigen::Index>(u), n, p);
      if (secant.width > 0.0) difference(own, open.subspan(u, 1), u, n, secant, step_s, p);
    }
    complete(rig_.run(n), p);
    return p;
  }

  // Unknowns that the run states as known keep their index, but have no path: their derivatives are zero.
  static std::vector<Unknown> open_unknowns(std::span<const Unknown> unknowns, const Run& run) {
    std::vector<Unknown> open(unknowns.begin(), unknowns.end());
    for (Unknown& u : open) {
      const bool known = std::any_of(run.known.begin(), run.known.end(), [&](const auto& k) {
        return k.first == u.path || k.first == "effects." + u.path;
      });
      if (known) u.path.clear();
    }
    return open;
  }

  Prediction by_values(const Candidate& own, std::span<const Unknown> open, std::size_t n) const {
    RigOutputs<double> y = values_of(own, n);
    Prediction p{.values = std::move(y.values), .derivatives = {}, .finite = y.finite};
    for (const auto& v : p.values)
      p.derivatives.emplace_back(
          Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(v.size()), static_cast<Eigen::Index>(open.size())));
    return p;
  }

  // Which unknowns are simulated with a derivative of their own: not those that the run knows, nor those whose derivative is a
  // multiple of another's.
  struct Lanes {
    std::vector<Unknown> unknowns;
    std::vector<Eigen::Index> columns;                           // of each of them
    std::vector<std::pair<Eigen::Index, MultipleOf>> multiples;  // column, and what it is a multiple of
  };
  Lanes lanes_of(const Candidate& own, std::span<const Unknown> open) const {
    Lanes out;
    for (std::size_t u = 0; u < open.size(); ++u) {
      if (open[u].path.empty()) continue;
      if (const std::optional<MultipleOf> m = rig_.multiple_of(own, open, u)) {
        out.multiples.emplace_back(static_cast<Eigen::Index>(u), *m);
        continue;
      }
      out.unknowns.push_back(open[u]);
      out.columns.push_back(static_cast<Eigen::Index>(u));
    }
    return out;
  }

  Prediction by_passes(const Candidate& own, std::span<const Unknown> open, std::size_t n,
                       double step_s) const {
    const Lanes lanes = lanes_of(own, open);
    if (lanes.unknowns.empty()) return by_values(own, open, n);
    Prediction p;
    for (std::size_t first = 0; first < lanes.unknowns.size(); first += kJetWidth) {
      const RigOutputs<Jet> y = rig_.template outputs<Jet>({own, lanes.unknowns, first}, n, step_s);
      p.finite = p.finite && y.finite;
      const std::size_t count = std::min<std::size_t>(kJetWidth, lanes.unknowns.size() - first);
      for (std::size_t s = 0; s < y.values.size(); ++s) {
        const auto rows = static_cast<Eigen::Index>(y.values[s].size());
        if (first == 0) {
          p.derivatives.emplace_back(Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(open.size())));
          p.values.emplace_back();
          for (const Jet& v : y.values[s]) p.values[s].push_back(v.a);
        }
        for (std::size_t lane = 0; lane < count; ++lane) {
          const Eigen::Index column = lanes.columns[first + lane];
          for (Eigen::Index k = 0; k < rows; ++k)
            p.derivatives[s](k, column) =
                y.values[s][static_cast<std::size_t>(k)].v[static_cast<Eigen::Index>(lane)];
        }
      }
    }
    for (const auto& [column, of] : lanes.multiples) {
      for (Eigen::MatrixXd& d : p.derivatives)
        d.col(column) = of.factor * d.col(static_cast<Eigen::Index>(of.unknown));
    }
    return p;
  }

  // As wide as the bounds and a finite motion let it.
  void difference(const Candidate& own, std::span<const Unknown> unknown, std::size_t u, std::size_t n,
                  const Secant& secant, double step_s, Prediction& p) const {
    const double at = value_at(own, unknown[0].path).value_or(unknown[0].start);
    const auto beside = [&](double value) {
      value = std::clamp(value, unknown[0].lower, unknown[0].upper);
      if (value == at) return std::pair(at, p.values);
      const Candidate moved = with_values(own, unknown, std::span(&value, 1));
      RigOutputs<double> y = rig_.template outputs<double>({moved}, n, step_s);
      return y.finite ? std::pair(value, std::move(y.values)) : std::pair(at, p.values);
    };
    const auto above = beside(at + (secant.forward ? 1.0 : 0.5) * secant.width);
    const auto below = beside(secant.forward && above.first > at ? at : at - 0.5 * secant.width);
    const double apart = above.first - below.first;
    if (!(apart > 0.0)) return;
    for (std::size_t s = 0; s < p.values.size(); ++s) {
      for (std::size_t k = 0; k < p.values[s].size(); ++k) {
        p.derivatives[s](static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(u)) =
            (above.second[s][k] - below.second[s][k]) / apart;
      }
    }
  }

  Rig rig_;
  std::shared_ptr<Kept> kept_ = std::make_shared<Kept>(rig_);
};

// Of a rig's table (identify/record/rig.h).
template <PredictedRig Rig>
std::unique_ptr<Predictor> make_rig_predictor(const Dataset& dataset, const Candidate& nominal,
                                              const PredictOptions& options) {
  return std::make_unique<RigPredictor<Rig>>(dataset, nominal, options);
}

}  // namespace omnihil

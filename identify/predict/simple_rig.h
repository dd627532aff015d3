// A rig as short as can be: forward in time from rest, exact derivatives, sensors with white noise. A kind says the rest.
//
//   struct Spindle {
//     static constexpr SeenSignal kSeen[] = {{"velocity", Quantity::kSpeed, View::kPoint}};
//     template <typename T>
//     static std::vector<AxisSample<T>> motion(const RigModel& model, const Run& run, double step_s);
//     template <typename T>
//     static T quantity(const AxisSample<T>& now, Quantity what);
//     static Capabilities capabilities(const Dataset& dataset);
//   };
//   static_assert(SimpleKind<Spindle>);              // Rig::make_predictor: make_rig_predictor<SimpleRig<Spindle>>
//
// Cannot: views other than a point and a mean (observation.h), inputs whose sensors' noise matters, loops that a measured
// state has to hold in place: what axis and robot have of their own.
#pragma once
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "identify/predict/predictor_rig.h"
#include "sim/law/random.h"

namespace omnihil {

struct SeenSignal {
  std::string_view signal;
  Quantity quantity = Quantity::kSpeed;
  View view = View::kPoint;  // or kMean
};

// motion(): n samples, on the run's clock.
template <class K>
concept SimpleKind = requires(const RigModel& model, const Run& run, const Dataset& dataset) {
  K::quantity(K::template motion<double>(model, run, 1e-3).front(), Quantity::kSpeed);
  K::quantity(K::template motion<Jet>(model, run, 1e-3).front(), Quantity::kSpeed);
  { K::capabilities(dataset) } -> std::same_as<Capabilities>;
  {SeenSignal(K::kSeen[0])};
};

template <SimpleKind Kind>
class SimpleRig : public RigRuns<RigRun> {
 public:
  SimpleRig(std::shared_ptr<const Dataset> dataset, std::shared_ptr<const Candidate> nominal,
            const PredictOptions& options)
      : RigRuns(std::move(dataset), std::move(nominal), options) {
    for (const Run& run : dataset_->runs) add_run(run);
    share_noise(all_runs());
  }

  Capabilities capabilities() const { return Kind::capabilities(*dataset_); }

  template <typename T>
  RigOutputs<T> outputs(const RigModel& model, std::size_t n, double step_s) const {
    const auto motion = Kind::template motion<T>(model, dataset_->runs[n], step_s);
    return {.values =
                observed<T>(runs_[n], dataset_->runs[n].time_s, [&](const Observation& how, std::size_t k) {
                  return Kind::quantity(motion[k], how.quantity);
                })};
  }

  // Along time, and where a speed is seen along that, as the model has it.
  std::vector<RegimeTrack> regimes(const Candidate& own, std::size_t n) const {
    const RigRun& run = runs_[n];
    std::vector<RegimeTrack> out{{"time", "s", dataset_->runs[n].time_s}};
    const RigOutputs<double> y = outputs<double>({own}, n, step_s(own, n));
    for (std::size_t s = 0; s < run.seen.size(); ++s) {
      if (run.seen[s].quantity != Quantity::kSpeed) continue;
      std::vector<double> speed = y.values[s];
      for (double& v : speed) v = std::abs(v);
      out.push_back({"velocity", run.compared[s].unit, y.values[s]});
      out.push_back({"speed", run.compared[s].unit, std::move(speed)});
    }
    return out;
  }

  void measure(const Candidate& truth, std::uint64_t seed) {
    auto made = std::make_shared<Dataset>(*dataset_);
    for (std::size_t n = 0; n < made->runs.size(); ++n) {
      Run& run = made->runs[n];
      const Candidate own = with_known(truth, run.known);
      Prediction p = predicted(*this, own, n, step_s(own, n));
      for (std::size_t s = 0; s < p.values.size(); ++s) {
        const std::string& channel = runs_[n].seen[s].channel;
        add_sensor_noise(runs_[n], s, seed, stream_of(channel) + mix_bits(n), p.values[s]);
        run.signals[channel] = std::move(p.values[s]);
      }
    }
    *this = on<SimpleRig>(std::move(made));
  }

 private:
  void add_run(const Run& run) {
    RigRun& made = runs_.emplace_back();
    for (const SeenSignal& seen : Kind::kSeen) {
      const std::vector<double>* values = run.signal(seen.signal);
      if (values == nullptr) continue;
      add_channel(made, {.quantity = seen.quantity, .view = seen.view}, *dataset_->channel(seen.signal),
                  run.time_s, *values);
    }
  }
};

}  // namespace omnihil

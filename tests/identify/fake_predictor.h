// A predictor whose measurements and predictions the test writes itself.
//
//   FakePredictor fake;
//   fake.add(Split::kTraining, measured, model).track("speed", "rad/s", speed);
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "identify/predict/predictor.h"

namespace omnihil {

class FakePredictor : public Predictor {
 public:
  struct FakeRun {
    Run run;
    std::vector<ComparedSignal> compared;
    std::vector<RegimeTrack> tracks;
    Prediction prediction;

    FakeRun& track(std::string name, std::string unit, std::vector<double> value) {
      tracks.push_back({std::move(name), std::move(unit), std::move(value)});
      return *this;
    }
  };

  // One run with one signal, sampled at 1 kHz.
  FakeRun& add(Split split, std::vector<double> measured, std::vector<double> model, double noise_sigma = 1.0,
               const std::string& signal = "velocity") {
    FakeRun made;
    made.run.file = "run_" + std::to_string(runs_.size()) + ".csv";
    made.run.split = split;
    for (std::size_t i = 0; i < measured.size(); ++i)
      made.run.time_s.push_back(static_cast<double>(i) * 1e-3);
    ComparedSignal compared;
    compared.name = signal;
    compared.unit = "rad/s";
    compared.time_s = made.run.time_s;
    compared.measured = std::move(measured);
    compared.noise_sigma = noise_sigma;
    made.compared.push_back(std::move(compared));
    made.prediction.values.push_back(std::move(model));
    runs_.push_back(std::move(made));
    return runs_.back();
  }
  FakeRun& last() { return runs_.back(); }

  Method method() const override { return method_; }
  int run_count() const override { return static_cast<int>(runs_.size()); }
  const Run& run(int r) const override { return at(r).run; }
  const std::vector<ComparedSignal>& compared(int r) const override { return at(r).compared; }
  std::vector<RegimeTrack> regimes(const Candidate&, int r) const override { return at(r).tracks; }
  Prediction predict(const Candidate&, int r) const override { return at(r).prediction; }
  Prediction predict_with_derivatives(const Candidate&, std::span<const Unknown>, int r) const override {
    return at(r).prediction;
  }
  std::unique_ptr<Predictor> simulated(const Candidate&, std::uint64_t) const override { return nullptr; }
  Capabilities capabilities() const override {
    return {.rig = kOnBoth, .list = {{~0U, true, ""}}, .free_base = {}, .present_base = {}};
  }

  Method method_ = Method::kForward;

 private:
  const FakeRun& at(int r) const { return runs_[static_cast<std::size_t>(r)]; }
  std::vector<FakeRun> runs_;
};

}  // namespace omnihil

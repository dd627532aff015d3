// Recordings that others published, as far as they are at hand: skipped by name where $OMNIHIL_SHARED is not
// set.
//
//   const RealSet set("emps");                        // inside a RealTest
//   const FitResult r = set.fitted({"coulomb_friction"});
//   EXPECT_NEAR(set.rmse(r.model, Split::kTraining, "velocity"), 9.80, 0.05 * 9.80);
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "hil/dataset/dataset_reader.h"
#include "identify/estimate/fit.h"
#include "sim/law/effect_registry.h"

namespace omnihil {

class RealTest : public testing::Test {
 protected:
  void SetUp() override {
    const char* shared = std::getenv("OMNIHIL_SHARED");
    if (shared == nullptr) GTEST_SKIP() << "OMNIHIL_SHARED is not set: no recordings";
  }
};

class RealSet {
 public:
  explicit RealSet(const std::string& folder) : RealSet(folder, {}) {}
  // Without these channels, as where a published figure was fitted on fewer.
  RealSet(const std::string& folder, const std::vector<std::string>& without) {
    DatasetReading reading = read_dataset(std::string(std::getenv("OMNIHIL_SHARED")) + "/data/" + folder);
    for (const ModelProblem& p : reading.problems) ADD_FAILURE() << p.text();
    if (!reading.dataset) return;
    dataset = std::move(*reading.dataset);
    nominal = std::move(*reading.nominal);
    for (const std::string& name : without) {
      std::erase_if(dataset.channels, [&](const Channel& c) { return c.signal == name; });
      for (Run& run : dataset.runs) run.signals.erase(name);
    }
    predictor = make_predictor(dataset, nominal, {});
  }

  // The nominal model with these effects ("id" or "id.parameter=value", in this order), fitted.
  FitResult fitted(const std::vector<std::string>& effects, int iterations = 30) const {
    Candidate c = nominal;
    for (const std::string& word : effects) {
      const std::size_t equals = word.find('=');
      if (equals == std::string::npos) {
        c = with_effect(c, *find_effect(word));
      } else {
        EXPECT_EQ(set_value(c, word.substr(0, equals), std::stod(word.substr(equals + 1))), "");
      }
    }
    FitOptions options;
    options.jobs = 2;
    options.max_iterations = iterations;
    return fit(*predictor, c, unknowns_of(c), options);
  }

  // Root mean square over all samples of a split; `steady`: points, or series.
  double rmse(const Candidate& c, Split split, const std::string& signal, bool steady = false) const {
    double square = 0.0, n = 0.0;
    each(c, split, signal, steady, [&](int, double r) { square += r * r, n += 1.0; });
    return std::sqrt(square / n);
  }
  // Mean of |error| per run, averaged over the runs.
  double mean_absolute(const Candidate& c, Split split, const std::string& signal) const {
    std::map<int, std::pair<double, double>> runs;
    each(c, split, signal, false, [&](int run, double r) {
      runs[run].first += std::abs(r);
      runs[run].second += 1.0;
    });
    double sum = 0.0;
    for (const auto& [run, s] : runs) sum += s.first / s.second;
    return sum / static_cast<double>(runs.size());
  }

  Dataset dataset;
  Candidate nominal;
  std::unique_ptr<Predictor> predictor;

 private:
  template <typename Visit>
  void each(const Candidate& c, Split split, const std::string& signal, bool steady, Visit visit) const {
    for (int run = 0; run < predictor->run_count(); ++run) {
      if (predictor->run(run).split != split || predictor->run(run).steady != steady) continue;
      const Prediction p = predictor->predict(c, run);
      EXPECT_TRUE(p.finite) << predictor->run(run).file;
      const std::vector<ComparedSignal>& compared = predictor->compared(run);
      for (std::size_t s = 0; s < compared.size(); ++s) {
        if (compared[s].name != signal) continue;
        for (std::size_t k = 0; k < compared[s].measured.size(); ++k) {
          const double r = compared[s].measured[k] - p.values[s][k];
          if (std::isfinite(compared[s].measured[k])) visit(run, r);
        }
      }
    }
  }
};

// The program's own figure stays within `share` of the published one, or below it.
inline void expect_at_most(double value, double published, double share = 0.05) {
  EXPECT_LE(value, published * (1.0 + share));
}
// On both sides: the same model on the same data.
inline void expect_same(double value, double published, double share = 0.05) {
  EXPECT_NEAR(value, published, share * published);
}

}  // namespace omnihil

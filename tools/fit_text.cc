#include "tools/fit_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace omnihil {
namespace {

constexpr Split kFitSplits[] = {Split::kTraining, Split::kValidation, Split::kExtrapolation};

std::string uncertain(const ParameterEstimate& p) {
  constexpr double kNinety = 1.645;  // 90 % of a normal
  return fmt::format("{:.4g} .. {:.4g}", p.value - kNinety * p.sigma, p.value + kNinety * p.sigma);
}

std::string prior(const ParameterEstimate& p) {
  return p.prior_sigma > 0.0 ? fmt::format("{:.4g} ± {:.2g}", p.prior_mean, p.prior_sigma) : "-";
}

std::string deviation(const ParameterEstimate& p) {
  return p.prior_sigma > 0.0 ? fmt::format("{:+.1f}", p.prior_deviation_sigmas) : "-";
}

std::string parameter_table(const FitResult& fit) {
  std::size_t wide = 9;
  for (const ParameterEstimate& p : fit.parameters) wide = std::max(wide, p.path.size());
  std::string out = fmt::format("{:<{}}  {:>11} {:<10} {:>24}  {:>20}  {:>6}\n", "parameter", wide, "value",
                                "unit", "90 % interval", "prior", "dev.");
  for (const ParameterEstimate& p : fit.parameters) {
    out += fmt::format("{:<{}}  {:>11.5g} {:<10} {:>24}  {:>20}  {:>6}{}\n", p.path, wide, p.value, p.unit,
                       uncertain(p), prior(p), deviation(p), p.sentence.empty() ? "" : "  !");
  }
  return out +
         "prior: what the model file believes, value and tolerance (for an effect: zero and its typical "
         "size); dev.: "
         "deviation from it, in "
         "tolerances\n";
}

std::string fit_error_table(const FitReport& r) {
  std::string out = fmt::format("{:<22} {:<14} {:>12} {:>12}  {:<7} {:>9} {:>9}\n", "signal", "runs",
                                "error before", "after", "unit", "% of std", "noise");
  for (const Split split : kFitSplits) {
    for (const SignalError& e : r.after.errors) {
      if (e.split != split) continue;
      const SignalError* old = r.before.error(split, e.signal);
      out += fmt::format("{:<22} {:<14} {:>12.5g} {:>12.5g}  {:<7} {:>9.3g} {:>9.3g}\n", e.signal,
                         split_name(split), old != nullptr ? old->rmse : NAN, e.rmse, e.unit, e.nrmse_percent,
                         e.noise_sigma);
    }
  }
  return out;
}

nlohmann::json number_or_null(double v) {
  return std::isfinite(v) ? nlohmann::json(v) : nlohmann::json(nullptr);
}

nlohmann::json fit_errors_json(const Comparison& c, Split split) {
  nlohmann::json out = nlohmann::json::object();
  for (const SignalError& e : c.errors) {
    if (e.split != split) continue;
    out[e.signal] = {{"rmse", number_or_null(e.rmse)},
                     {"nrmse_percent", number_or_null(e.nrmse_percent)},
                     {"unit", e.unit}};
  }
  return out;
}

}  // namespace

std::string fit_text(const FitReport& r) {
  std::string out = fmt::format("{}\n\n{}\n{}", r.dataset, parameter_table(r.fit), fit_error_table(r));
  if (!r.fit.findings.empty()) out += "\n";
  for (const std::string& finding : r.fit.findings) out += "! " + finding + "\n";
  if (r.fit.stopped) out += "stopped early: the values are the best so far\n";
  if (!r.fit.converged && !r.fit.stopped)
    out += "not converged: more iterations might still move the values\n";
  return out;
}

std::string fit_json(const FitReport& r) {
  nlohmann::json parameters = nlohmann::json::object();
  for (const ParameterEstimate& p : r.fit.parameters) {
    parameters[p.path] = {
        {"value", p.value},
        {"sigma", number_or_null(p.sigma)},
        {"unit", p.unit},
        {"at_bound", p.at_bound},
        {"identifiable", p.identifiable},
        {"unphysical", p.unphysical},
        {"prior_deviation_sigmas",
         p.prior_sigma > 0.0 ? number_or_null(p.prior_deviation_sigmas) : nlohmann::json(nullptr)},
        {"correlated_with", p.correlated_with},
        {"sentence", p.sentence}};
  }
  nlohmann::json out = {{"format", "omnihil-fit/1"},  {"dataset", r.dataset},
                        {"elapsed_s", r.elapsed_s},   {"converged", r.fit.converged},
                        {"parameters", parameters},   {"findings", r.fit.findings},
                        {"before", nlohmann::json{}}, {"after", nlohmann::json{}}};
  for (const Split split : kFitSplits) {
    out["before"][std::string(split_name(split))] = fit_errors_json(r.before, split);
    out["after"][std::string(split_name(split))] = fit_errors_json(r.after, split);
  }
  return out.dump(2) + "\n";
}

}  // namespace omnihil

#include "hil/report/diagnosis_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "hil/text/json_text.h"

namespace omnihil {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json parameter_json(const ParameterEstimate& p) {
  Json out = {{"value", number(p.value)},
              {"sigma", number(p.sigma)},
              {"unit", p.unit},
              {"at_bound", p.at_bound},
              {"identifiable", p.identifiable}};
  if (p.unphysical) out["unphysical"] = true;
  if (p.prior_sigma > 0.0) out["prior_deviation_sigmas"] = number(p.prior_deviation_sigmas);
  if (!p.correlated_with.empty()) out["correlated_with"] = p.correlated_with;
  if (!p.sentence.empty()) out["sentence"] = p.sentence;
  return out;
}

Json parameters_json(const std::vector<ParameterEstimate>& parameters) {
  Json out = Json::object();
  for (const ParameterEstimate& p : parameters) out[p.path] = parameter_json(p);
  return out;
}

Json errors_json(const Comparison& comparison, Split split) {
  Json out = Json::object();
  for (const SignalError& e : comparison.errors) {
    if (e.split == split)
      out[e.signal] = {{"rmse", number(e.rmse)}, {"nrmse_percent", number(e.nrmse_percent)}};
  }
  return out;
}

// The three uses, as far as there are runs of them.
void add_errors(const Comparison& comparison, Json& out) {
  for (const Split split : {Split::kTraining, Split::kValidation, Split::kExtrapolation}) {
    Json errors = errors_json(comparison, split);
    if (split == Split::kExtrapolation && errors.empty()) continue;
    out[std::string(split_name(split))] = std::move(errors);
  }
}

Json signals_json(const Comparison& comparison) {
  Json out = Json::object();
  for (const SignalError& e : comparison.errors) {
    if (!out.contains(e.signal))
      out[e.signal] = {
          {"noise_sigma", number(e.noise_sigma)}, {"unit", e.unit}, {"averaging_s", number(e.averaging_s)}};
  }
  return out;
}

Json ranking_json(const std::vector<RankedEffect>& ranking) {
  Json out = Json::array();
  for (const RankedEffect& r : ranking) {
    out.push_back({{"effect", r.effect},
                   {"selection_frequency", number(r.selection_frequency)},
                   {"accepted_by", accepted_by_name(r.accepted_by)},
                   {"noise_share", number(r.noise_share)},
                   {"holdout_error_ratio", number(r.holdout_error_ratio)},
                   {"parameters", parameters_json(r.parameters)},
                   {"fit_error_ratio", number(r.fit_error_ratio)},
                   {"extrapolation_error_ratio", number(r.extrapolation_error_ratio)},
                   {"score", number(r.score)},
                   {"refitted", r.refitted},
                   {"plausible", r.plausible},
                   {"signal_to_null", number(r.signal_to_null)},
                   {"share_of_base", number(r.share_of_base)},
                   {"delta_bic", number(r.evidence.delta_bic)},
                   {"delta_elpd", number(r.evidence.delta_elpd)},
                   {"delta_elpd_se", number(r.evidence.delta_elpd_se)},
                   {"accepted", r.accepted()},
                   {"why", r.why}});
  }
  return out;
}

Json confidence_json(const std::vector<NameConfidence>& confidence) {
  Json out = Json::array();
  for (const NameConfidence& c : confidence)
    out.push_back({{"effect", c.effect}, {"probability", c.probability}});
  return out;
}

Json where_json(const std::vector<Where>& where) {
  Json out = Json::array();
  for (const Where& w : where) {
    Json one = {
        {"signal", w.signal}, {"against", w.against}, {"explained_fraction", number(w.explained_fraction)}};
    if (w.order > 0.0) one["order"] = w.order;
    out.push_back(std::move(one));
  }
  return out;
}

Json findings_json(const std::vector<DataFinding>& findings) {
  static constexpr const char* kGrades[] = {"note", "doubt", "fault"};
  Json out = Json::array();
  for (const DataFinding& f : findings) {
    out.push_back({{"grade", kGrades[static_cast<int>(f.grade)]},
                   {"kind", f.kind},
                   {"run", f.run},
                   {"signal", f.signal},
                   {"size", number(f.size)},
                   {"sentence", f.sentence}});
  }
  return out;
}

Json ladder_json(const std::vector<LadderStep>& ladder) {
  Json out = Json::array();
  for (const LadderStep& step : ladder) {
    Json one = {{"added", step.added}};
    add_errors(step.comparison, one);
    one["parameters"] = parameters_json(step.parameters);
    one["ranking"] = ranking_json(step.ranking);
    out.push_back(std::move(one));
  }
  return out;
}

Json unknown_json(const UnknownStructure& unknown) {
  return {{"where", where_json(unknown.where)},
          {"formula", unknown.formula},
          {"expression", unknown.expression_toml},
          {"sentence", unknown.sentence}};
}

}  // namespace

std::string diagnosis_json(const Diagnosis& d, const DiagnosisJsonOptions& options) {
  Json baseline = {{"parameters", parameters_json(d.baseline.parameters)}};
  add_errors(d.baseline_comparison, baseline);
  Json last = Json::object();
  add_errors(d.final_comparison, last);
  last["parameters"] = parameters_json(d.final_fit.parameters);
  last["model"] = options.model;
  Json confounded = Json::array();
  for (const ConfoundedSet& set : d.confounded) confounded.push_back(set.members);
  const Json out = {
      {"format", "omnihil-diagnosis/1"},
      {"dataset", d.dataset},
      {"seed", d.seed},
      {"elapsed_s", number(options.elapsed_s)},
      {"signals", signals_json(d.baseline_comparison)},
      {"baseline", std::move(baseline)},
      {"verdict", verdict_name(d.verdict)},
      {"outcome", outcome_name(d.outcome)},
      {"not_searched", d.not_searched},
      {"searched_despite", d.searched_despite},
      {"effects", d.effects},
      {"confidence", confidence_json(d.confidence)},
      {"ranking", ranking_json(d.ranking)},
      {"indistinguishable", std::move(confounded)},
      {"where", where_json(d.where)},
      {"next_experiment",
       {{"what", d.next_experiment.what},
        {"command", d.next_experiment.command},
        {"separates", d.next_experiment.separates}}},
      {"final", std::move(last)},
      {"complete", d.complete},
      {"findings", findings_json(d.findings)},
      {"unknown", unknown_json(d.unknown)},
      {"not_visible", d.not_visible},
      {"ladder", ladder_json(d.ladder)},
  };
  return json_text(out, 2) + "\n";
}

}  // namespace omnihil

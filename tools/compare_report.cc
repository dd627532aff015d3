#include "tools/compare_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace omnihil {
namespace {

using Json = nlohmann::ordered_json;

constexpr Split kAllSplits[] = {Split::kTraining, Split::kValidation, Split::kExtrapolation};

std::string error_table(const CompareReport& r) {
  std::size_t wide = 6;
  for (const SignalError& e : r.comparison.errors) wide = std::max(wide, e.signal.size());
  std::string out =
      fmt::format("{:<{}}  {:<13} {:>8}  {:>10} {:<6} {:>8} {:>10} {:>10} {:>10}  {}\n", "signal", wide,
                  "runs", "samples", "RMSE", "unit", "% of std", "mean |e|", "bias", "noise", "x noise");
  for (const Split split : kAllSplits) {
    for (const SignalError& e : r.comparison.errors) {
      if (e.split != split) continue;
      out += fmt::format(
          "{:<{}}  {:<13} {:>8}  {:>10.4g} {:<6} {:>8.3g} {:>10.4g} {:>+10.3g} {:>10.3g}  {:.3g}\n", e.signal,
          wide, split_name(split), e.samples, e.rmse, e.unit, e.nrmse_percent, e.mean_absolute, e.bias,
          e.noise_sigma, e.in_sigmas);
    }
  }
  out +=
      "noise: 1-sigma floor that no model can pass, as stated or estimated from differences; x noise: error "
      "in those (whitened), 1 is perfect\n";
  for (const SignalError& e : r.comparison.errors) {
    if (e.averaging_s > 0.0 && e.split == Split::kTraining)
      out += fmt::format(
          "{}: means over {:.3g} s, the time in which the sensor of position resolves the motion\n", e.signal,
          e.averaging_s);
  }
  for (const SignalError& e : r.comparison.errors) {
    if (e.repeat_sigma > 0.0 && e.split == Split::kTraining)
      out += fmt::format("{}: the same input given twice brings answers that differ by {:.3g} {} (1-sigma)\n",
                         e.signal, e.repeat_sigma, e.unit);
  }
  return out;
}

std::string worst_text(const CompareReport& r) {
  constexpr int kShown = 4;  // of each use; all are in the JSON
  std::string out;
  for (const Split split : kAllSplits) {
    int shown = 0;
    for (const WorstRegime& w : r.comparison.worst) {
      if (w.split == split && shown++ < kShown)
        out += fmt::format("{:<14}{}\n", split_name(split), w.sentence);
    }
  }
  return out.empty() ? "" : "\nWhere it is worst\n" + out;
}

std::string run_table(const CompareReport& r) {
  std::string out = "\n";
  std::size_t wide = 4;
  for (const std::string& file : r.run_files) wide = std::max(wide, file.size());
  out +=
      fmt::format("{:<{}}  {:<20} {:>10} {:>10} {:>10}\n", "run", wide, "signal", "RMSE", "mean |e|", "bias");
  for (const RunError& e : r.comparison.runs) {
    out += fmt::format("{:<{}}  {:<20} {:>10.4g} {:>10.4g} {:>+10.3g}\n",
                       r.run_files[static_cast<std::size_t>(e.run)], wide, e.signal, e.rmse, e.mean_absolute,
                       e.bias);
  }
  return out;
}

std::string tubes_text(const CompareReport& r) {
  std::string out;
  for (const auto& [tube, held] : r.tubes) {
    out += fmt::format("tube {} +- {:g}{}{}: ", tube.signal, tube.tolerance,
                       tube.relative ? " % of its range" : "",
                       tube.time_s > 0.0 ? fmt::format(", {:g} s", tube.time_s) : "");
    out += held.outside == 0
               ? fmt::format("all {} samples inside\n", held.samples)
               : fmt::format(
                     "{} of {} samples outside, the first in {} at {:.4f} s, the worst in {} at {:.4f} s by "
                     "{:.4g}\n",
                     held.outside, held.samples, held.first_run, held.first_s, held.worst_run, held.worst_s,
                     held.worst);
  }
  return out.empty() ? "" : "\n" + out;
}

std::string findings_text(const CompareReport& r) {
  std::string out;
  for (const DataFinding& f : r.findings) {
    if (f.grade == DataFinding::Grade::kFault) out += "data fault: " + f.sentence + "\n";
    if (f.grade == DataFinding::Grade::kDoubt) out += "doubtful: " + f.sentence + "\n";
    if (f.grade == DataFinding::Grade::kNote) out += "note: " + f.sentence + "\n";
  }
  for (const std::string& note : r.notes) out += "note: " + note + "\n";
  for (const std::string& left_out : r.left_out) out += "left out: " + left_out + "\n";
  return out.empty() ? "" : out + "\n";
}

std::string offsets_text(const CompareReport& r) {
  std::string out;
  for (const auto& [signal, offset] : r.offsets) {
    if (!offset.significant) continue;
    out += fmt::format(
        "clock: {} comes {:.2f} ms {} than the model says (+- {:.2g} ms, {:.0f} % of the error "
        "energy). Not applied: a late clock and a delay of the drive look alike.\n",
        signal, 1e3 * std::abs(offset.seconds), offset.seconds > 0.0 ? "later" : "earlier",
        1e3 * offset.sigma_s, 100.0 * offset.error_share);
  }
  return out.empty() ? "" : "\n" + out;
}

Json number(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }

Json errors_json(const Comparison& c, Split split) {
  Json out = Json::object();
  for (const SignalError& e : c.errors) {
    if (e.split != split) continue;
    out[e.signal] = {{"unit", e.unit},
                     {"samples", e.samples},
                     {"rmse", number(e.rmse)},
                     {"nrmse_percent", number(e.nrmse_percent)},
                     {"mean_absolute", number(e.mean_absolute)},
                     {"bias", number(e.bias)},
                     {"noise_sigma", number(e.noise_sigma)},
                     {"repeat_sigma", number(e.repeat_sigma)},
                     {"averaging_s", number(e.averaging_s)},
                     {"in_sigmas", number(e.in_sigmas)}};
  }
  return out;
}

Json runs_json(const CompareReport& r) {
  Json out = Json::array();
  for (const RunError& e : r.comparison.runs) {
    out.push_back({{"run", r.run_files[static_cast<std::size_t>(e.run)]},
                   {"signal", e.signal},
                   {"rmse", number(e.rmse)},
                   {"mean_absolute", number(e.mean_absolute)},
                   {"bias", number(e.bias)}});
  }
  return out;
}

}  // namespace

bool CompareReport::outside() const {
  return std::any_of(tubes.begin(), tubes.end(), [](const auto& t) { return t.second.outside > 0; });
}

std::string compare_text(const CompareReport& r) {
  std::string out =
      fmt::format("{} against {}\n", r.dataset, r.model.empty() ? "its nominal model" : r.model);
  out += r.method == Method::kForward
             ? "The model runs freely on the measured input.\n\n"
             : "The measured motion is imposed; the input that the model needs for it is compared.\n\n";
  out += findings_text(r) + error_table(r);
  for (const auto& [split, error] : r.force_errors)
    out += fmt::format("relative force error, {}: {:.3f} %\n", split_name(split), 100.0 * error);
  out += worst_text(r) + offsets_text(r);
  if (r.per_run) out += run_table(r);
  for (const std::string& run : r.comparison.diverged)
    out += fmt::format("{}: the model's state stopped being finite\n", run);
  return out + tubes_text(r);
}

std::string compare_json(const CompareReport& r) {
  Json out = {{"format", "omnihil-comparison/1"},
              {"dataset", r.dataset},
              {"method", r.method == Method::kForward ? "forward" : "inverse"}};
  if (!r.model.empty()) out["model"] = r.model;
  for (const Split split : kAllSplits) {
    Json errors = errors_json(r.comparison, split);
    if (!errors.empty()) out[std::string(split_name(split))] = std::move(errors);
  }
  out["worst"] = Json::array();
  for (const WorstRegime& w : r.comparison.worst) {
    out["worst"].push_back({{"signal", w.signal},
                            {"use", split_name(w.split)},
                            {"against", w.axis},
                            {"error_share", w.share},
                            {"time_share", w.time_share},
                            {"sentence", w.sentence}});
  }
  out["runs"] = runs_json(r);
  if (!r.left_out.empty()) out["left_out"] = r.left_out;
  for (const auto& [split, error] : r.force_errors)
    out["relative_force_error"][std::string(split_name(split))] = number(error);
  for (const auto& [signal, offset] : r.offsets) {
    out["clock_offset_s"][signal] = {{"value", offset.seconds},
                                     {"sigma", number(offset.sigma_s)},
                                     {"error_share", offset.error_share},
                                     {"significant", offset.significant}};
  }
  out["findings"] = Json::array();
  for (const DataFinding& f : r.findings) {
    constexpr const char* kGrades[] = {"note", "doubt", "fault"};
    out["findings"].push_back({{"grade", kGrades[static_cast<int>(f.grade)]},
                               {"kind", f.kind},
                               {"run", f.run},
                               {"signal", f.signal},
                               {"sentence", f.sentence}});
  }
  out["notes"] = r.notes;
  out["diverged"] = r.comparison.diverged;
  out["tubes"] = Json::array();
  for (const auto& [tube, held] : r.tubes) {
    out["tubes"].push_back({{"signal", tube.signal},
                            {"tolerance", tube.tolerance},
                            {"relative_percent", tube.relative},
                            {"time_s", tube.time_s},
                            {"samples", held.samples},
                            {"outside", held.outside},
                            {"worst", held.worst}});
  }
  return out.dump(2) + "\n";
}

}  // namespace omnihil

#include "hil/report/report_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "hil/report/report_text.h"
#include "hil/report/report_thin.h"
#include "hil/text/json_text.h"

namespace omnihil {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostPoints = 90'000;  // of all overlays together; 13 to 19 bytes each
constexpr std::size_t kMostOverlays = 220;
constexpr std::size_t kLeastPoints = 400, kMostPointsEach = 6'000;
constexpr std::size_t kMostMaps = 60, kMostBins = 80;
constexpr Split kAllSplits[] = {Split::kTraining, Split::kValidation, Split::kExtrapolation};

// Four digits are more than a chart shows.
Json rounded(double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::strtod(fmt::format("{:.4g}", value).c_str(), nullptr);
}

Json numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double v : values) list.push_back(rounded(v));
  return list;
}

Json series(const ThinClock& clock, const std::vector<double>& values) {
  const PackedSeries p = packed(thinned(clock, values));
  return {{"low", p.low}, {"high", p.high}, {"data", p.base64}};
}

std::vector<double> residual(const std::vector<double>& measured, const std::vector<double>& model) {
  std::vector<double> r(measured.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < std::min(measured.size(), model.size()); ++i) r[i] = measured[i] - model[i];
  return r;
}

// Mean square of what the final model leaves, over the noise.
double misfit(const ReportOverlay& o) {
  double sum = 0.0;
  std::size_t n = 0;
  for (const double r : residual(o.measured, o.final_model)) {
    if (!std::isfinite(r)) continue;
    sum += r * r;
    ++n;
  }
  const double noise = o.noise_sigma > 0.0 ? o.noise_sigma : 1.0;
  return n > 0 ? sum / static_cast<double>(n) / (noise * noise) : 0.0;
}

// Which overlays are shown: all, or the worst of too many, in the order of the runs.
std::vector<std::size_t> shown_overlays(const std::vector<ReportOverlay>& overlays) {
  std::vector<std::size_t> order(overlays.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (order.size() <= kMostOverlays) return order;
  std::vector<double> worth;
  for (const ReportOverlay& o : overlays) worth.push_back(misfit(o));
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return worth[a] > worth[b]; });
  order.resize(kMostOverlays);
  std::ranges::sort(order);
  return order;
}

Json overlay(const ReportOverlay& o, std::size_t points) {
  const ThinClock clock = thin_clock(o.time_s, points / 2);
  Json j{{"run", o.run},
         {"use", split_name(o.split)},
         {"signal", o.signal},
         {"unit", o.unit},
         {"noise", rounded(o.noise_sigma)},
         {"samples", o.time_s.size()},
         {"points", clock.time_s.size()},
         {"misfit", rounded(misfit(o))}};
  if (clock.exact) {
    j["time"] = packed_floats(clock.time_s);
  } else {
    j["interval_s"] = clock.interval_s;
  }
  j["measured"] = series(clock, o.measured);
  j["baseline"] = series(clock, o.baseline);
  j["final"] = series(clock, o.final_model);
  j["residual_baseline"] = series(clock, residual(o.measured, o.baseline));
  j["residual_final"] = series(clock, residual(o.measured, o.final_model));
  return j;
}

Json overlays(const std::vector<ReportOverlay>& all) {
  Json list = Json::array();
  const std::vector<std::size_t> shown = shown_overlays(all);
  if (shown.empty()) return list;
  const std::size_t points = std::clamp(kMostPoints / shown.size(), kLeastPoints, kMostPointsEach);
  for (const std::size_t i : shown) list.push_back(overlay(all[i], points));
  return list;
}

Json bins(const RegimeError* curve) {
  if (curve == nullptr) return nullptr;
  Json list = Json::array();
  for (std::size_t i = 0; i < std::min(curve->bins.size(), kMostBins); ++i) {
    const RegimeBin& b = curve->bins[i];
    list.push_back(numbers({b.from, b.to, b.mean, b.sigma, b.energy_share, b.time_share}));
  }
  return list;
}

// The bin with most error energy beyond its share of the time.
std::ptrdiff_t worst_bin(const RegimeError& curve) {
  const auto excess = [](const RegimeBin& b) { return b.energy_share - b.time_share; };
  const auto worst = std::ranges::max_element(curve.bins, {}, excess);
  return worst == curve.bins.end() || !(excess(*worst) > 0.0) ? -1 : worst - curve.bins.begin();
}

const RegimeError* same_axis(const std::vector<RegimeError>& curves, const RegimeError& like) {
  const auto it = std::ranges::find_if(curves, [&](const RegimeError& c) {
    return c.signal == like.signal && c.axis == like.axis && c.split == like.split;
  });
  return it == curves.end() ? nullptr : &*it;
}

Json maps(const Diagnosis& d, std::size_t& left_out) {
  std::map<std::string, std::string> unit_of;
  for (const auto& e : d.baseline_comparison.errors) unit_of[e.signal] = e.unit;
  const Split split = judging_split(d.baseline_comparison);
  std::vector<const RegimeError*> curves;
  for (const RegimeError& c : d.baseline_comparison.regimes) {
    // A measured signal against itself shows its own noise as a slope.
    if (c.split == split && !c.bins.empty() && c.axis != c.signal) curves.push_back(&c);
  }
  std::ranges::stable_sort(curves,
                           [](auto* a, auto* b) { return a->explained_fraction > b->explained_fraction; });
  left_out = curves.size() - std::min(curves.size(), kMostMaps);
  curves.resize(curves.size() - left_out);
  Json list = Json::array();
  for (const RegimeError* c : curves) {
    const RegimeError* after = same_axis(d.final_comparison.regimes, *c);
    Json j{{"signal", c->signal},      {"signal_unit", unit_of[c->signal]},
           {"axis", c->axis},          {"unit", c->unit},
           {"use", split_name(split)}, {"explained", rounded(c->explained_fraction)}};
    j["explained_final"] = after != nullptr ? rounded(after->explained_fraction) : Json(nullptr);
    j["worst"] = worst_bin(*c);
    for (const WorstRegime& w : d.baseline_comparison.worst) {
      if (w.signal == c->signal && w.axis == c->axis) j["sentence"] = w.sentence;
    }
    j["baseline"] = bins(c);
    j["final"] = bins(after);
    list.push_back(j);
  }
  return list;
}

Json ladder(const std::vector<LadderStep>& steps) {
  Json j{{"steps", Json::array()}, {"errors", Json::object()}};
  for (const LadderStep& s : steps) j["steps"].push_back(s.added);
  for (const Split split : kAllSplits) {
    if (!std::ranges::any_of(steps, [&](const LadderStep& s) { return has_split(s.comparison, split); }))
      continue;
    Json list = Json::array();
    for (const LadderStep& s : steps) list.push_back(rounded(s.comparison.pooled(split)));
    j["errors"][std::string(split_name(split))] = list;
  }
  return j;
}

// How the base parameters moved, in tolerances of the model file, step by step.
Json drift(const std::vector<ParameterEstimate>& base, const std::vector<LadderStep>& steps) {
  Json list = Json::array();
  for (const ParameterEstimate& p : base) {
    if (!(p.prior_sigma > 0.0)) continue;
    Json values = Json::array();
    for (const LadderStep& s : steps) {
      const auto it = std::ranges::find(s.parameters, p.path, &ParameterEstimate::path);
      values.push_back(it == s.parameters.end() ? Json(nullptr) : rounded(it->prior_deviation_sigmas));
    }
    list.push_back({{"path", p.path}, {"sigmas", values}});
  }
  return list;
}

}  // namespace

std::string chart_data(const ReportInput& input) {
  const std::vector<LadderStep> steps = ladder_shown(input.diagnosis);
  std::size_t maps_left_out = 0;
  Json j{{"ladder", ladder(steps)},
         {"drift", drift(input.diagnosis.baseline.parameters, steps)},
         {"maps", maps(input.diagnosis, maps_left_out)}};
  j["maps_left_out"] = maps_left_out;
  j["overlays"] = overlays(input.overlays);
  j["overlays_left_out"] = input.overlays.size() - j["overlays"].size();
  j["spectra"] = Json::array();
  for (const OrderSpectrum& s : input.spectra) {
    j["spectra"].push_back({{"signal", s.signal},
                            {"unit", s.unit},
                            {"angle", s.angle},
                            {"order", numbers(s.order)},
                            {"baseline", numbers(s.baseline)},
                            {"final", numbers(s.final_model)},
                            {"floor", rounded(s.floor)}});
  }
  // "<" would let a name end the element that holds the JSON; invalid UTF-8 is replaced.
  const std::string text = json_text(j);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) safe += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return safe;
}

}  // namespace omnihil

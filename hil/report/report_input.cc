// Runs the two models of a diagnosis over every run and gathers what the charts show.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "hil/report/report_html.h"
#include "hil/report/report_orders.h"
#include "hil/report/report_text.h"
#include "identify/record/parallel.h"

namespace omnihil {
namespace {

constexpr std::size_t kOrders = 192;
constexpr double kLeastTurns = 2.0;
constexpr std::size_t kMostSpectra = 16;

struct SpectrumPart {
  std::string signal, unit, angle;
  OrderSums baseline, final_model;
};

struct RunPart {
  std::vector<ReportOverlay> overlays;
  std::vector<SpectrumPart> spectra;
};

// "rotor_angle_2" belongs to "encoder_2"; an angle without a number belongs to every signal.
bool belong(const std::string& signal, const std::string& angle) {
  const auto wheel = [](const std::string& name) {
    const std::size_t at = name.size() < 2 ? std::string::npos : name.size() - 2;
    return at != std::string::npos && name[at] == '_' && name[at + 1] >= '1' && name[at + 1] <= '9'
               ? name[at + 1]
               : ' ';
  };
  return wheel(angle) == ' ' || wheel(angle) == wheel(signal);
}

std::vector<double> difference(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> d(a.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) d[i] = a[i] - b[i];
  return d;
}

// NaN where both have none.
bool same(const std::vector<double>& a, const std::vector<double>& b) {
  return std::ranges::equal(a, b,
                            [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

RunPart run_part(const Predictor& predictor, const Diagnosis& d, int run, bool spectra) {
  RunPart part;
  const std::vector<ComparedSignal>& compared = predictor.compared(run);
  const Prediction before = has_model(d.baseline) ? predictor.predict(d.baseline.model, run) : Prediction{};
  const Prediction after = has_model(d.final_fit) ? predictor.predict(d.final_fit.model, run) : before;
  const auto values_of = [](const Prediction& p, std::size_t s) {
    return s < p.values.size() ? p.values[s] : std::vector<double>{};
  };
  for (std::size_t s = 0; s < compared.size(); ++s) {
    const ComparedSignal& c = compared[s];
    part.overlays.push_back({predictor.run(run).file, predictor.run(run).split, c.name, c.unit,
                             averaged_sigma(c), c.time_s, averaged(c, c.measured),
                             averaged(c, values_of(before, s)), averaged(c, values_of(after, s))});
  }
  if (!spectra || !has_model(d.baseline)) return part;
  std::vector<double> last;  // without a gear the output's angle is the rotor's
  for (const RegimeTrack& track : predictor.regimes(d.baseline.model, run)) {
    if (track.name.find("angle") == std::string::npos || same(track.value, last)) continue;
    last = track.value;
    for (const ReportOverlay& o : part.overlays) {
      if (!belong(o.signal, track.name)) continue;
      part.spectra.push_back({o.signal, o.unit, track.name,
                              order_sums(track.value, difference(o.measured, o.baseline), kOrders),
                              order_sums(track.value, difference(o.measured, o.final_model), kOrders)});
    }
  }
  return part;
}

std::vector<double> amplitudes(const OrderSums& sums) {
  std::vector<double> a;
  for (std::size_t n = 0; n < sums.power.size(); ++n) {
    a.push_back(sums.weight[n] > 0.0 ? std::sqrt(sums.power[n] / sums.weight[n]) : 0.0);
  }
  return a;
}

void add(OrderSums& into, const OrderSums& from) {
  into.turns += from.turns;
  into.power.resize(kOrders, 0.0);
  into.weight.resize(kOrders, 0.0);
  for (std::size_t n = 0; n < kOrders; ++n) {
    into.power[n] += from.power[n];
    into.weight[n] += from.weight[n];
  }
}

// The runs' powers are averaged by turned angle: an angle counted from where a run began has another phase in
// each.
std::vector<OrderSpectrum> spectra_of(const std::vector<RunPart>& parts) {
  std::map<std::pair<std::string, std::string>, SpectrumPart> sums;
  for (const RunPart& part : parts) {
    for (const SpectrumPart& s : part.spectra) {
      SpectrumPart& sum =
          sums.try_emplace({s.signal, s.angle}, SpectrumPart{s.signal, s.unit, s.angle, {}, {}})
              .first->second;
      add(sum.baseline, s.baseline);
      add(sum.final_model, s.final_model);
    }
  }
  std::vector<OrderSpectrum> spectra;
  for (const auto& [key, sum] : sums) {
    if (sum.baseline.turns < kLeastTurns || spectra.size() == kMostSpectra) continue;
    OrderSpectrum spectrum{
        sum.signal, sum.unit, sum.angle, {}, amplitudes(sum.baseline), amplitudes(sum.final_model), 0.0};
    for (std::size_t n = 1; n <= kOrders; ++n) spectrum.order.push_back(static_cast<double>(n));
    spectrum.floor = order_floor(spectrum.final_model);
    spectra.push_back(std::move(spectrum));
  }
  return spectra;
}

}  // namespace

ReportInput report_input(const Dataset& dataset, const Predictor& predictor, const Diagnosis& diagnosis,
                         const ReportOptions& options) {
  ReportInput input;
  input.diagnosis = diagnosis;
  input.title = dataset.title;
  input.notes = dataset.notes;
  const Split judged = dataset.has(Split::kValidation) ? Split::kValidation : Split::kTraining;
  std::vector<RunPart> parts(static_cast<std::size_t>(predictor.run_count()));
  parallel_for(options.jobs, predictor.run_count(), [&](int run) {
    parts[static_cast<std::size_t>(run)] =
        run_part(predictor, diagnosis, run, predictor.run(run).split == judged);
  });
  input.spectra = spectra_of(parts);
  for (RunPart& part : parts) {
    for (ReportOverlay& overlay : part.overlays) input.overlays.push_back(std::move(overlay));
  }
  return input;
}

}  // namespace omnihil

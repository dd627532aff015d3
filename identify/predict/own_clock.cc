#include "identify/predict/own_clock.h"

#include <algorithm>
#include <cmath>

#include "identify/predict/predictor.h"

namespace omnihil {
namespace {

struct Row {
  std::size_t signal, sample;
  double rate, q;  // in the signal's unit, and in its noise's, per s
};

// Of a signal's readings, what a second of its clock moves each by.
void add_rows(const OwnClock& clock, std::size_t signal, const ComparedSignal& c,
              const std::vector<double>& values, std::vector<Row>& rows) {
  std::vector<std::size_t> seen;
  std::vector<double> t, y, gain;  // y: the path's own, without what it followed
  double followed = 0.0;
  for (std::size_t k = 0; k < c.measured.size(); ++k) {
    if (!std::isfinite(c.measured[k]) || !std::isfinite(values[k])) continue;
    const double span_s = t.empty() ? 0.0 : c.time_s[k] - t.back();
    seen.push_back(k), t.push_back(c.time_s[k]), y.push_back(values[k] - followed);
    gain.push_back(follow_gain(span_s, clock.follow_s, static_cast<double>(seen.size())));
    followed += gain.back() * (c.measured[k] - values[k]);
  }
  double left_out = seen.empty() ? 0.0 : rate_at(t, y, 0);  // of the rate: as of the path
  for (std::size_t n = 0; n < seen.size(); ++n) {
    const double rate = rate_at(t, y, n) - left_out;
    left_out += gain[n] * rate;
    rows.push_back({signal, seen[n], rate, rate / c.noise_sigma});
  }
}

}  // namespace

double follow_gain(double span_s, double follow_s, double count) {
  return follow_s > 0.0 ? std::max(-std::expm1(-span_s / follow_s), 1.0 / (count + 1.0)) : 0.0;
}

double rate_at(const std::vector<double>& t, const std::vector<double>& y, std::size_t k) {
  const std::size_t from = k > 0 ? k - 1 : 0, to = k + 1 < y.size() ? k + 1 : k;
  return to > from ? (y[to] - y[from]) / (t[to] - t[from]) : 0.0;
}

void fit_clock(const OwnClock& clock, const std::vector<ComparedSignal>& compared, Prediction& p) {
  if (!(clock.sigma_s > 0.0)) return;
  std::vector<Row> rows;
  for (const std::size_t s : clock.signals) add_rows(clock, s, compared[s], p.values[s], rows);
  double square = 0.0;
  for (const Row& row : rows) square += row.q * row.q;
  if (!(square > 0.0)) return;
  const double part = (1.0 - 1.0 / std::sqrt(1.0 + clock.sigma_s * clock.sigma_s * square)) / square;
  double shift_s = 0.0;
  for (const Row& row : rows) {
    const ComparedSignal& c = compared[row.signal];
    shift_s += part * row.q * (c.measured[row.sample] - p.values[row.signal][row.sample]) / c.noise_sigma;
  }
  for (const Row& row : rows) p.values[row.signal][row.sample] += row.rate * shift_s;
  if (p.derivatives.empty()) return;
  Eigen::RowVectorXd shifts = Eigen::RowVectorXd::Zero(p.derivatives[clock.signals.front()].cols());
  const auto derivatives_of = [&](const Row& row) {
    return p.derivatives[row.signal].row(static_cast<Eigen::Index>(row.sample));
  };
  for (const Row& row : rows) shifts += part * row.q / compared[row.signal].noise_sigma * derivatives_of(row);
  for (const Row& row : rows) derivatives_of(row) -= row.rate * shifts;
}

}  // namespace omnihil

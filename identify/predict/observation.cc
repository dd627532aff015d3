#include "identify/predict/observation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "identify/record/statistics.h"
#include "sim/law/random.h"

namespace omnihil {
namespace {

double mean_period_s(const std::vector<double>& t) {
  return t.size() > 1 ? (t.back() - t.front()) / static_cast<double>(t.size() - 1) : 0.0;
}

// A speed integrated to a position, which is rounded by its sensor and differenced again.
template <typename Draw>
void add_position_noise(const ComparedSignal& c, const std::vector<std::size_t>& from, double start,
                        Draw draw, std::vector<double>& v) {
  const std::vector<double>& t = c.time_s;
  const double dt = t.size() > 1 ? mean_period_s(t) : 1.0;
  const double q = c.quantum * dt, sigma = c.noise_sigma * dt / std::sqrt(2.0);
  const double rest = std::sqrt(std::max(0.0, sigma * sigma - q * q / 12.0));
  std::vector<double> x(v.size(), 0.0), seen(v.size(), 0.0);
  for (std::size_t k = 0; k < v.size(); ++k) {
    if (from[k] < k)
      x[k] = x[from[k]] + v[k] * (t[k] - t[from[k]]);
    else if (k > 0)
      x[k] = x[k - 1];
    const double noisy = x[k] + rest * draw(k) + start * q;  // counts do not start on an edge
    seen[k] = q > 0.0 ? std::floor(noisy / q) * q : noisy;
    if (from[k] < k) v[k] = (seen[k] - seen[from[k]]) / (t[k] - t[from[k]]);
  }
}

// White noise in the filter's band.
template <typename Draw>
void add_band_noise(const LowPass& filter, double sigma, Draw draw, std::vector<double>& v) {
  std::vector<double> white(v.size());
  for (std::size_t k = 0; k < v.size(); ++k) white[k] = draw(k);
  const std::vector<double> low = zero_phase(filter, white);
  double square = 0.0;
  for (const double x : low) square += x * x / static_cast<double>(low.size());
  for (std::size_t k = 0; k < v.size(); ++k) v[k] += sigma * low[k] / std::sqrt(square);
}

// 0: the signal's own period.
double resolving_time(const Dataset& dataset, std::span<RigRun* const> runs, const std::string& name) {
  constexpr double kLongest_s = 0.5;  // a block of the bootstrap (whitened_residuals.cc): a choice
  double period_s = 0.0;
  std::vector<ComparedSignal> training;
  for (std::size_t n = 0; n < runs.size(); ++n) {
    for (const ComparedSignal& c : runs[n]->compared) {
      if (period_s <= 0.0) period_s = mean_period_s(c.time_s);
      if (c.name == name && dataset.runs[n].split == Split::kTraining) training.push_back(c);
    }
  }
  for (double seconds = period_s; seconds > 0.0; seconds *= 2.0) {
    double square = 0.0, noise = 0.0, count = 0.0;
    for (ComparedSignal& c : training) {
      c.averaging_s = seconds;
      for (const double v : averaged(c, c.measured)) {
        if (std::isfinite(v)) square += v * v, noise += std::pow(averaged_sigma(c), 2), count += 1.0;
      }
    }
    if (count == 0.0) return 0.0;
    if (square >= kResolved_sigmas * kResolved_sigmas * noise || 2.0 * seconds > kLongest_s)
      return seconds > period_s ? seconds : 0.0;
  }
  return 0.0;
}

}  // namespace

ComparedSignal& add_signal(RigRun& run, Observation how, std::string name, std::string unit,
                           const std::vector<double>& time_s, std::vector<double> measured) {
  const bool mean = how.view == View::kMean || how.view == View::kLevel;
  if (mean && !measured.empty()) measured.front() = kMissing;
  ComparedSignal& c = run.compared.emplace_back();
  c.name = std::move(name);
  c.unit = std::move(unit);
  c.time_s = time_s;
  c.measured = std::move(measured);
  run.seen.push_back(std::move(how));
  return c;
}

ComparedSignal& add_signal(RigRun& run, Observation how, std::string name, std::string unit,
                           const std::vector<double>& time_s, std::vector<double> measured,
                           double stated_sigma) {
  ComparedSignal& c =
      add_signal(run, std::move(how), std::move(name), std::move(unit), time_s, std::move(measured));
  set_noise(stated_sigma, estimate_noise(c.measured), c);
  run.seen.back().channel_sigma = c.noise_sigma;
  return c;
}

ComparedSignal& add_channel(RigRun& run, Observation how, const Channel& channel,
                            const std::vector<double>& time_s, std::vector<double> measured) {
  how.channel = channel.signal;
  return add_signal(run, std::move(how), channel.signal, channel.unit, time_s, std::move(measured),
                    channel.sigma);
}

ComparedSignal& add_difference(RigRun& run, Observation how, std::string name, std::string unit,
                               const std::vector<double>& time_s, const std::vector<double>& x, double gap_s,
                               double sigma, double quantum, double whitening_s) {
  std::vector<double> v(x.size(), kMissing);
  how.from.resize(x.size());
  std::size_t last = x.size();
  for (std::size_t k = 0; k < x.size(); ++k) {
    how.from[k] = k;
    if (!std::isfinite(x[k])) continue;
    if (last < k && time_s[k] - time_s[k - 1] <= gap_s) {
      v[k] = (x[k] - x[last]) / (how.per_unit * (time_s[k] - time_s[last]));
      how.from[k] = last;
    }
    last = k;
  }
  ComparedSignal& c = add_signal(run, std::move(how), std::move(name), std::move(unit), time_s, std::move(v));
  const double dt_s = median_period_s(time_s);
  c.noise_is_stated = sigma > 0.0;
  c.quantum = quantum / dt_s;
  // v = (x_i - x_{i-1}) / dt; high-passed by the leak a: var = sigma^2 2 / (1 + a)
  c.noise_sigma = std::sqrt(2.0) * sigma / dt_s;
  c.whitening_s = whitening_s;
  c.whitened_sigma =
      whitening_s > 0.0 ? sigma * std::sqrt(2.0 / (1.0 + std::exp(-dt_s / whitening_s))) : c.noise_sigma;
  return c;
}

void complete(const RigRun& run, std::size_t signal, bool is_value, Eigen::Ref<Eigen::VectorXd> column) {
  const Observation& how = run.seen[signal];
  if (how.view == View::kLevel) {
    const std::vector<double>& measured = run.compared[signal].measured;
    double gap = 0.0, n = 0.0;
    for (std::size_t k = 0; k < measured.size(); ++k) {
      if (!std::isfinite(measured[k])) continue;
      gap += (is_value ? measured[k] : 0.0) - column[static_cast<Eigen::Index>(k)], n += 1.0;
    }
    if (n > 0.0) column.array() += gap / n;
    return;
  }
  if (!run.filter.sections.empty()) column = zero_phase(run.filter, Eigen::MatrixXd(column)).col(0);
  if (is_value && how.quantity == Quantity::kNeededInput)
    column += Eigen::Map<const Eigen::VectorXd>(run.given.data(), column.size());
}

void complete(const RigRun& run, Prediction& p) {
  for (std::size_t c = 0; c < p.values.size(); ++c) {
    const std::vector<double>& measured = run.compared[c].measured;
    const auto rows = static_cast<Eigen::Index>(p.values[c].size());
    if (rows == 0) continue;
    Eigen::Map<Eigen::VectorXd> values(p.values[c].data(), rows);
    for (Eigen::Index k = 0; k < rows; ++k)
      p.finite =
          p.finite && (std::isfinite(values[k]) || !std::isfinite(measured[static_cast<std::size_t>(k)]));
    complete(run, c, true, values);
    for (Eigen::Index u = 0; !p.derivatives.empty() && u < p.derivatives[c].cols(); ++u) {
      for (Eigen::Index k = 0; k < rows; ++k) {
        if (!std::isfinite(p.derivatives[c](k, u))) p.derivatives[c](k, u) = 0.0;
      }
      complete(run, c, false, p.derivatives[c].col(u));
    }
  }
  if (p.finite) fit_clock(run.clock, run.compared, p);
}

double distance(const RigRun& run, const Prediction& a, const Prediction& b) {
  double largest = 0.0;
  for (std::size_t c = 0; c < a.values.size(); ++c) {
    const ComparedSignal& signal = run.compared[c];
    std::vector<double> d(a.values[c].size());
    for (std::size_t k = 0; k < d.size(); ++k) d[k] = a.values[c][k] - b.values[c][k];
    const auto size_of = [&](const std::vector<double>& v, double sigma) {
      double square = 0.0, count = 0.0;
      for (std::size_t k = 0; k < v.size(); ++k) {
        if (!std::isfinite(v[k]) || !std::isfinite(signal.measured[k])) continue;
        square += v[k] * v[k], count += 1.0;
      }
      return count > 0.0 && sigma > 0.0 ? std::sqrt(square / count) / sigma : 0.0;
    };
    largest = std::max(
        {largest, size_of(d, signal.noise_sigma), size_of(whitened(signal, d), signal.whitened_sigma)});
  }
  return largest;
}

void add_sensor_noise(const RigRun& run, std::size_t s, std::uint64_t seed, std::uint64_t stream,
                      std::vector<double>& v) {
  const ComparedSignal& c = run.compared[s];
  const auto draw = [&](std::size_t k) { return gaussian(seed, stream, k); };
  const double start = uniform(seed, stream, 1u << 30);
  if (c.counted.window_s > 0.0) {
    add_counting_noise(c.counted, c.time_s, v, start);
    for (std::size_t k = 0; k < v.size(); ++k) v[k] += c.counted.sensor_sigma * draw(k);
  } else if (c.whitening_s > 0.0) {
    add_position_noise(c, run.seen[s].from, start, draw, v);
  } else if (!run.filter.sections.empty()) {
    add_band_noise(run.filter, c.noise_sigma, draw, v);
  } else {
    for (std::size_t k = 0; k < v.size(); ++k) v[k] = reading(v[k], c.noise_sigma, c.quantum, draw(k));
  }
  for (std::size_t k = 0; k < v.size(); ++k) {
    if (!std::isfinite(c.measured[k])) v[k] = kMissing;
  }
}

void keep_sensors(const RigRun& from, RigRun& to) {
  for (std::size_t s = 0; s < to.seen.size(); ++s) {
    to.seen[s].channel_sigma = from.seen[s].channel_sigma;
    to.compared[s].noise_sigma = from.compared[s].noise_sigma;
    to.compared[s].whitened_sigma = from.compared[s].whitened_sigma;
  }
}

void share_noise(std::span<RigRun* const> runs) {
  std::map<std::string, std::vector<std::pair<ComparedSignal*, Observation*>>> by_name;
  for (RigRun* const run : runs) {
    if (!run->filter.sections.empty()) continue;
    for (std::size_t s = 0; s < run->compared.size(); ++s) {
      ComparedSignal& c = run->compared[s];
      if (!c.noise_is_stated && c.whitening_s <= 0.0) by_name[c.name].emplace_back(&c, &run->seen[s]);
    }
  }
  for (const auto& [name, same] : by_name) {
    std::vector<double> sigmas;
    for (const auto& [c, how] : same) sigmas.push_back(c->noise_sigma);
    const double sigma = median_in_place(sigmas);
    for (const auto& [c, how] : same) c->noise_sigma = c->whitened_sigma = how->channel_sigma = sigma;
  }
}

void choose_averaging(const Dataset& dataset, std::span<RigRun* const> runs) {
  std::set<std::string> names;
  for (const RigRun* const run : runs) {
    for (const ComparedSignal& c : run->compared) {
      if (c.whitening_s > 0.0) names.insert(c.name);
    }
  }
  for (const std::string& name : names) {
    const double seconds = resolving_time(dataset, runs, name);
    for (RigRun* const run : runs) {
      for (ComparedSignal& c : run->compared) {
        if (c.name == name) c.averaging_s = seconds;
      }
    }
  }
}

}  // namespace omnihil

#include "identify/predict/channel.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "identify/record/bus_voltage.h"
#include "identify/record/quantum.h"
#include "identify/record/statistics.h"

namespace omnihil {
namespace {

// Of a signal that never changes: so that an error of it counts as one. A choice.
constexpr double kNoNoise = 1e-12;  // as above

bool finite(double v) { return std::isfinite(v); }

// White noise by second differences where the reading does not stand still: at rest a sensor that counts has none, which
// says nothing of its noise in motion. 0: it stands nowhere, or nearly everywhere.
double noise_in_motion(const std::vector<double>& x) {
  constexpr std::size_t kStands = 50;  // rows of one reading; a choice
  // Of the rows: a count that changes every 50th has 3 in 50 beside a change.
  constexpr double kLeastMoving = 0.1;  // derived
  constexpr double kTrimmed = 0.95;     // of the squares: steps of the motion are beyond; a choice
  std::vector<double> squares;
  std::size_t stood = 0, rows = 0;
  for (std::size_t k = 2, same = 0; k < x.size(); ++k) {
    same = x[k] == x[k - 1] ? same + 1 : 0;
    std::size_t ahead = 0;
    while (ahead < kStands && k + ahead + 1 < x.size() && x[k + ahead + 1] == x[k]) ++ahead;
    const double d = x[k] - 2.0 * x[k - 1] + x[k - 2];
    if (!finite(d)) continue;
    ++rows;
    if (d == 0.0 && same + ahead >= kStands) {
      ++stood;
    } else {
      squares.push_back(d * d);
    }
  }
  if (stood == 0 || static_cast<double>(squares.size()) < kLeastMoving * static_cast<double>(rows))
    return 0.0;
  std::ranges::sort(squares);
  squares.resize(static_cast<std::size_t>(kTrimmed * static_cast<double>(squares.size())));
  double sum = 0.0;
  for (const double s : squares) sum += s;
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(squares.size(), 1)) / 6.0);
}

}  // namespace

NoiseEstimate estimate_noise(const std::vector<double>& values) {
  // Relative standard errors of a sigma by MAD: 1.17 / sqrt(n) each (asymptotic, of a normal), n / 2 of the differences being as
  // good as independent: three of them.
  constexpr double kChance = 5.0;  // derived: 3 x 1.17 x sqrt(2)
  const std::vector<double> known = finite_values(values);
  NoiseEstimate out;
  if (known.size() < 4) return out;
  std::vector<double> second, third;
  for (std::size_t k = 2; k < values.size(); ++k) {
    const double d = values[k] - 2.0 * values[k - 1] + values[k - 2];
    if (finite(d)) second.push_back(std::abs(d));
    const double before = k > 2 ? values[k - 1] - 2.0 * values[k - 2] + values[k - 3] : kMissing;
    if (finite(d - before)) third.push_back(std::abs(d - before));
  }
  out.quantum = quantum_of(known);
  // white noise: variance of the second difference is 6 sigma^2, of the third 20 sigma^2
  const double chance = kChance / std::sqrt(static_cast<double>(std::max<std::size_t>(third.size(), 1)));
  const bool has_third = !third.empty();
  double robust = sigma_by_mad(std::move(second)) / std::sqrt(6.0);
  const double unbent = sigma_by_mad(std::move(third)) / std::sqrt(20.0);
  if (has_third && unbent < robust * (1.0 - chance)) robust = unbent;
  if (robust == 0.0) robust = noise_in_motion(values);
  out.sigma = std::max({robust, out.quantum / std::sqrt(12.0), kLeastNoiseShare * rms_about_mean(known)});
  return out;
}

void set_noise(double stated_sigma, const NoiseEstimate& estimate, ComparedSignal& signal) {
  signal.quantum = estimate.quantum;
  signal.noise_is_stated = stated_sigma > 0.0;
  signal.noise_sigma = signal.noise_is_stated ? std::hypot(stated_sigma, estimate.quantum / std::sqrt(12.0))
                                              : std::max(estimate.sigma, kNoNoise);
  signal.whitened_sigma = signal.noise_sigma;
}

double noise_sigma_of(const Dataset& dataset, std::string_view channel, const std::vector<double>& values) {
  const Channel* c = dataset.channel(channel);
  return c != nullptr && c->sigma > 0.0 ? c->sigma : estimate_noise(values).sigma;
}

double reading(double value, double sigma, double quantum, double normal) {
  const double rest = sigma * sigma - quantum * quantum / 12.0;
  const double noisy = value + normal * std::sqrt(std::max(0.0, rest));
  return quantum > 0.0 ? std::round(noisy / quantum) * quantum : noisy;
}

double first_known(const std::vector<double>& values, double otherwise) {
  const auto at = std::find_if(values.begin(), values.end(), finite);
  return at == values.end() ? otherwise : *at;
}

std::vector<double> held(const std::vector<double>* column, std::size_t first) {
  std::vector<double> out;
  if (column == nullptr) return out;
  double last = first_known(*column, kMissing);
  if (!finite(last)) return out;
  for (std::size_t i = 0; i < column->size(); ++i) {
    if (finite((*column)[i])) last = (*column)[i];
    if (i >= first) out.push_back(last);
  }
  return out;
}

std::vector<double> without_noise(const std::vector<double>& x, double sigma, const NoiseWindows& windows) {
  const std::size_t n = x.size();
  if (n < 2 * windows.half.back() + 1 || !(sigma > 0.0)) return x;
  std::vector<double> sum(n + 1, 0.0), square(n + 1, 0.0), out(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double d = x[k] - x.front();
    sum[k + 1] = sum[k] + d, square[k + 1] = square[k] + d * d;
  }
  for (std::size_t k = 0; k < n; ++k) {
    for (const std::size_t half : windows.half) {
      const std::size_t from = k > half ? k - half : 0, to = std::min(n, k + half + 1);
      const double count = static_cast<double>(to - from);
      const double mean = (sum[to] - sum[from]) / count;
      const double variance = (square[to] - square[from]) / count - mean * mean;
      out[k] = x.front() + mean;
      if (variance <= windows.tolerated * sigma * sigma) break;
      if (half == windows.half.back()) out[k] += (1.0 - sigma * sigma / variance) * (x[k] - x.front() - mean);
    }
  }
  return out;
}

BusReading read_bus(const Dataset& dataset, const Run& run, std::size_t first, const NoiseWindows& windows) {
  BusReading out;
  const std::vector<double>* measured = run.signal("bus_voltage");
  if (measured == nullptr) return out;
  const std::vector<double> bus_V = plausible_bus_voltage(*measured);
  for (std::size_t k = first; k < bus_V.size(); ++k) {
    if (finite((*measured)[k]) && !finite(bus_V[k])) ++out.left_out;
  }
  const std::vector<double> given_V = held(&bus_V, first);
  out.sigma_V = noise_sigma_of(dataset, "bus_voltage", given_V);
  // Settled points have no order: their neighbours' voltages are those of other points.
  out.input_V = run.steady ? given_V : without_noise(given_V, out.sigma_V, windows);
  out.measured_V = from_row(&bus_V, first);
  return out;
}

void say_left_out(const BusReading& bus, ComparedSignal& signal) {
  if (bus.left_out == 0) return;
  if (!signal.left_out.empty()) signal.left_out += ", ";
  signal.left_out += fmt::format("{} readings of bus_voltage that no supply gives", bus.left_out);
}

std::vector<double> from_row(const std::vector<double>* column, std::size_t first) {
  if (column == nullptr) return {};
  std::vector<double> out(column->begin() + static_cast<std::ptrdiff_t>(first), column->end());
  if (std::none_of(out.begin(), out.end(), finite)) out.clear();
  return out;
}

double first_slope(const std::vector<double>& t, const std::vector<double>& x, std::size_t from,
                   std::size_t to) {
  std::vector<Eigen::Vector3d> rows;
  std::vector<double> values;
  for (std::size_t i = from; i < to; ++i) {
    if (!finite(x[i])) continue;
    const double ti = t[i] - t[from];
    rows.push_back({1.0, ti, ti * ti});
    values.push_back(x[i] - x[from]);
  }
  if (rows.size() < 4 || !finite(x[from])) return kMissing;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    normal += rows[i] * rows[i].transpose();
    right += rows[i] * values[i];
  }
  const Eigen::Matrix3d inverse = normal.inverse();
  const Eigen::Vector3d fit = inverse * right;
  double square = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) square += std::pow(values[i] - rows[i].dot(fit), 2);
  const double error = std::sqrt(square / static_cast<double>(rows.size() - 3) * inverse(1, 1));
  const double gained = 2.0 * std::abs(fit[2]) * rows.back()[1];
  return std::abs(fit[1]) > 3.0 * error + 0.1 * gained ? fit[1] : 0.0;
}

std::vector<double> since_step(const std::vector<double>& time_s,
                               const std::vector<std::vector<double>>& inputs) {
  constexpr double kStep = 0.05;  // of the input's range: a choice
  std::vector<double> step, level, out;
  for (const std::vector<double>& in : inputs) {
    double low = kMissing, high = kMissing;
    for (const double v : in) low = std::fmin(low, v), high = std::fmax(high, v);
    step.push_back(kStep * (high - low));
    level.push_back(first_known(in, 0.0));
  }
  double last_s = time_s.empty() ? 0.0 : time_s.front();
  for (std::size_t k = 0; k < time_s.size(); ++k) {
    bool moved = false;
    for (std::size_t i = 0; i < inputs.size(); ++i)
      moved = moved || std::abs(inputs[i][k] - level[i]) > step[i];
    if (moved) last_s = time_s[k];
    for (std::size_t i = 0; i < inputs.size() && moved; ++i) {
      if (finite(inputs[i][k])) level[i] = inputs[i][k];
    }
    out.push_back(time_s[k] - last_s);
  }
  return out;
}

}  // namespace omnihil

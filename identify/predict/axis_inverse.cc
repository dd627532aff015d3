// Inverse method and steady points (axis_setup.h).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "identify/predict/axis_outputs.h"
#include "identify/predict/interpolation.h"
#include "identify/predict/undetermined.h"
#include "identify/record/band_noise.h"
#include "identify/record/periodogram.h"
#include "identify/record/statistics.h"
#include "identify/record/surface_noise.h"
#include "identify/record/wiener.h"
#include "sim/bench/axis_signal.h"

namespace omnihil {
namespace {

constexpr int kOrder = 4;                      // with the cutoff's share: source as below
constexpr double kShareOfNyquist = 0.2;        // source: Janot, Gautier, Brunot 2019
constexpr double kHighestCutoff_Hz = 100.0;    // of faster records: beyond a drive's mechanics; a choice
constexpr double kMotionShareOfNyquist = 0.8;  // where a low pass of that cutoff is still one; a choice
constexpr double kEndsInPeriods = 5.0;  // of the cutoff, left out at either end: the filter settles; a choice

double cutoff_for(double rate_Hz) { return std::min(kHighestCutoff_Hz, kShareOfNyquist * 0.5 * rate_Hz); }
// Standard deviation of (error / estimated noise)^2 over 24 benches of the hidden plant with nothing hidden: how far the noise of
// a motion's second derivative in a band is known.
constexpr double kLevelSigma = 0.2;  // measured, as above
constexpr double kLeastBand = 0.1;   // of that cutoff, however noisy the motion is; a choice

// d/dt of an evenly sampled signal.
std::vector<double> rate_of(const std::vector<double>& x, double rate_Hz) {
  std::vector<double> out = central_differences(x);
  for (double& v : out) v *= rate_Hz;
  return out;
}

// An even clock of the record's median period.
std::vector<double> even_clock(const AxisRecord& r) {
  const double span = r.time_s.back() - r.time_s.front();
  const auto n = static_cast<std::size_t>(span / r.period_s + 0.5);
  std::vector<double> t;
  for (std::size_t i = 0; i <= n; ++i) t.push_back(r.time_s.front() + static_cast<double>(i) * r.period_s);
  return t;
}

// Mean of a sampled signal from each sample to the next, of the cubic through four samples: that of the line loses 3 % of
// what turns once in ten samples, where the compared band ends. The line at either end.
std::vector<double> interval_means(const std::vector<double>& x) {
  std::vector<double> out = x;
  for (std::size_t k = 0; k + 1 < x.size(); ++k) {
    const double line = 0.5 * (x[k] + x[k + 1]);
    const bool inside = k > 0 && k + 2 < x.size();
    out[k] = inside ? (13.0 * (x[k] + x[k + 1]) - x[k - 1] - x[k + 2]) / 24.0 : line;
  }
  return out;
}

// A law that is not linear (friction at a reversal) does not commute with a filter: the motion keeps what stands out of
// its noise, up to a drive's mechanics, and only what the laws make of it is brought into the compared band. Short records
// have no spectrum: that band. No sections: no filter.
LowPass motion_filter(const LowPass& compared, std::size_t samples, double rate_Hz) {
  if (samples < kLeastOfSpectrum) return compared;
  if (kHighestCutoff_Hz >= kMotionShareOfNyquist * 0.5 * rate_Hz) return {};
  return butterworth(kOrder, kHighestCutoff_Hz, rate_Hz);
}

// What a needed input is named after; a servo's target is no input of the winding.
CommandKind needed_kind(CommandKind kind) {
  return kind == CommandKind::kPositionTarget ? CommandKind::kDuty : kind;
}

void add(const Dataset& dataset, AxisSetup& s, std::string_view name, Quantity quantity,
         std::vector<double> measured, double sigma, bool stated) {
  const Channel* channel = dataset.channel(name);  // null: the duty of a servo
  ComparedSignal& c =
      add_signal(s, {.quantity = quantity}, std::string(name), channel != nullptr ? channel->unit : "1",
                 s.input.time_s, std::move(measured));
  c.noise_sigma = c.whitened_sigma = std::max(sigma, kLeastNoiseShare * rms_about_mean(c.measured));
  c.noise_is_stated = stated;
}

// Where the sensor sees no motion for half of the filter's time, and as much to either side: a count that stays within one
// step (less than two), or without a position every speed within four sigmas of zero. (By a position without steps a rest
// cannot be told from a turn.)
std::vector<bool> rest_of(const AxisRecord& r, const std::vector<double>& clock, std::size_t of_filter) {
  constexpr double kWithin_sigmas = 4.0;  // one in 16,000 leaves it by chance (normal); a choice
  const std::size_t half = of_filter / 2;
  if (const std::vector<double> x = resampled(r.time_s, r.position_or_counts(), clock); !x.empty()) {
    const bool counted = r.position.empty() && !r.counts.empty();
    const double quantum =
        counted ? 1.0 / std::abs(r.counts_per_output_rad) : estimate_noise(r.position).quantum;
    return quantum > 0.0 ? standing_still(x, 1.5 * quantum, half, half) : std::vector<bool>();
  }
  const double limit = kWithin_sigmas * estimate_noise(r.velocity).sigma;
  std::vector<double> moving = resampled(r.time_s, r.velocity, clock);  // rows so far that do
  double rows = 0.0;
  for (double& v : moving) v = rows += std::abs(v) > limit ? 1.0 : 0.0;
  return standing_still(moving, 0.0, half, half);
}

// Leaves out the ends, where the filter has transients, and the gaps, where samples are interpolated.
void leave_out(const AxisRecord& r, double ends_s, AxisSetup& s) {
  const std::vector<double>& clock = s.input.time_s;
  std::vector<bool> out(clock.size());
  for (std::size_t i = 0; i < clock.size(); ++i) {
    out[i] = clock[i] < clock.front() + ends_s || clock[i] > clock.back() - ends_s;
  }
  std::size_t in_gaps = 0;
  for (std::size_t k = 1; k < r.size(); ++k) {
    if (!r.gap_before(k)) continue;
    const auto from = std::lower_bound(clock.begin(), clock.end(), r.time_s[k - 1] - ends_s);
    const auto to = std::upper_bound(clock.begin(), clock.end(), r.time_s[k] + ends_s);
    for (auto at = from; at != to; ++at) {
      out[static_cast<std::size_t>(at - clock.begin())] = true;
      ++in_gaps;
    }
  }
  for (ComparedSignal& c : s.compared) {
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (out[i]) c.measured[i] = kMissing;
    }
    c.left_out = fmt::format("{:.3g} s at either end (filter)", ends_s);
    if (in_gaps > 0) c.left_out += fmt::format(", {} samples in and around gaps", in_gaps);
  }
}

}  // namespace

std::vector<double> smoothed_velocity(const AxisRecord& record) {
  const std::vector<double> clock = even_clock(record);
  if (clock.size() < 30 || clock.size() > 4 * record.size()) return record.velocity;
  const double rate = 1.0 / record.period_s;
  const bool fast = !record.velocity.empty();
  const std::vector<double> x =
      resampled(record.time_s, fast ? record.velocity : record.position_or_counts(), clock);
  if (x.empty()) return {};
  const std::vector<double> low = zero_phase(butterworth(kOrder, cutoff_for(rate), rate), x);
  return resampled(clock, fast ? low : rate_of(low, rate), record.time_s);
}

void make_inverse_setup(const Dataset& dataset, const DriveParams<double>& drive, const AxisRecord& r,
                        AxisSetup& s) {
  const CommandKind kind = s.input.kind;
  const bool speed_imposed = speed_is_imposed(dataset);
  const double rate = 1.0 / r.period_s;
  AxisInput& in = s.input;
  in.time_s = even_clock(r);
  const auto linear = [&](const std::vector<double>& x) { return resampled(r.time_s, x, in.time_s); };
  const auto steps = [&](const std::vector<double>& x) {
    constexpr double kLate = 1e-6;  // of a period: time stamps are sums; a choice
    return resampled(r.time_s, x, in.time_s, [&](const KnownValues& known, double at_s) {
      return known.held_at(at_s, kLate * r.period_s);
    });
  };
  const bool by_torque = is_torque(kind);
  const std::vector<double> command = by_torque ? linear(r.command) : steps(r.command);
  in.command = by_torque ? interval_means(command) : command;
  for (const double e : steps(r.enable)) in.enable.push_back(e != 0.0 ? 1 : 0);
  if (!by_torque) in.bus_voltage_V = steps(r.bus.input_V);
  const bool bench_torque = speed_imposed && !r.load_torque_Nm.empty();
  if (!bench_torque) in.load_torque_Nm = steps(r.load_torque_Nm);
  std::vector<double> position = linear(r.position_or_counts());
  std::vector<double> velocity = linear(r.velocity);
  // The motion is the regressor here: its noise would make the inertia small (wiener.h).
  NoiseSpectrum spectrum = NoiseSpectrum::kWhite;
  if (velocity.empty()) {
    const Channel* encoder = dataset.channel("encoder");
    in.imposed_at_rotor = r.position.empty() && encoder != nullptr && !encoder->on_output;
    spectrum = NoiseSpectrum::kDifferenced;
    velocity = rate_of(position, rate);
    position = wiener_smoothed(position, NoiseSpectrum::kWhite).value;
  }
  const std::vector<double> raw_velocity = velocity;
  const WienerEstimate smoothed = wiener_smoothed(velocity, spectrum);
  // What the sensor does not resolve of the motion the torque still has: it is compared as far as both have it.
  const double cutoff =
      std::clamp(smoothed.resolved * 0.5 * rate, kLeastBand * cutoff_for(rate), cutoff_for(rate));
  const double band = cutoff / (0.5 * rate);
  s.filter = butterworth(kOrder, cutoff, rate);
  const LowPass motion = motion_filter(s.filter, velocity.size(), rate);
  const double inertia_sigma_Nm = needed_torque_sigma(
      smoothed.error_spectrum, inertia_at_rotor(drive) * drive.gear_ratio, motion, s.filter, rate);
  velocity = motion.sections.empty() ? smoothed.value : zero_phase(motion, smoothed.value);
  in.imposed_velocity_rad_s = velocity;
  in.measured_position_rad = position;
  if (!position.empty()) in.initial_position_rad = position.front();
  s.velocity = velocity;
  s.position = position;
  s.measured_current = linear(r.current);
  s.measured_temperature = linear(r.temperature);
  const auto add_filtered = [&](std::string_view name, Quantity quantity, const std::vector<double>& raw) {
    const Channel* channel = dataset.channel(name);
    const bool is_input = quantity == Quantity::kNeededInput;
    const bool stated = channel != nullptr && channel->sigma > 0.0 && (!is_input || by_torque);
    std::vector<double> low = zero_phase(s.filter, raw);
    // White noise of the channel, in the filter's band; of a torque, which is compared as the mean of two samples, that of
    // its samples. What a controller commands faster than the band is no noise where the motion follows it.
    const bool of_means = is_input && by_torque;
    const std::vector<double>& samples = of_means ? command : raw;
    double sigma = stated
                       ? channel->sigma
                       : std::fmin(white_noise(samples, of_means ? zero_phase(s.filter, command) : low, band),
                                   incoherent_sigma(samples, raw_velocity, band));
    sigma *= std::sqrt(of_means ? kept_of_means(band) : kept_of_samples(band));
    if (quantity == Quantity::kLoadTorque) sigma = std::hypot(sigma, drive.gear_ratio * inertia_sigma_Nm);
    if (quantity == Quantity::kNeededInput) {
      const double bus_V = in.bus_voltage_V.empty() ? 0.0 : median(in.bus_voltage_V);
      sigma = std::hypot(sigma, inertia_sigma_Nm * input_per_torque(kind, drive, bus_V));
    }
    add(dataset, s, name, quantity, std::move(low), sigma, stated);
    if (is_input || quantity == Quantity::kLoadTorque) s.compared.back().noise_level_sigma = kLevelSigma;
  };
  std::vector<bool> still, jumps;  // of the needed input
  if (bench_torque) {
    add_filtered("load_torque", Quantity::kLoadTorque, linear(r.load_torque_Nm));
  } else if (!speed_imposed || by_torque || r.current.empty()) {
    std::vector<double> input = in.command;  // at the end of the interval that each is held in
    std::shift_right(input.begin(), input.end(), 1);
    in.command_is_compared = true;
    s.given = zero_phase(s.filter, input);
    add_filtered(command_name(needed_kind(kind)), Quantity::kNeededInput, input);
    const auto of_filter = static_cast<std::size_t>(rate / cutoff + 0.5);  // samples of its time
    still = rest_of(r, in.time_s, of_filter);
    if (by_torque) jumps = unresolved_jumps(command, band, s.compared.back().noise_sigma, of_filter);
  }
  if (!r.current.empty() && !by_torque) add_filtered("motor_current", Quantity::kCurrent, s.measured_current);
  if (!r.temperature.empty() && !by_torque)
    add_filtered("winding_temperature", Quantity::kTemperature, s.measured_temperature);
  leave_out(r, kEndsInPeriods / cutoff, s);
  for (ComparedSignal& c : s.compared) {
    if (c.name == command_name(needed_kind(kind))) leave_out_undetermined(still, jumps, c);
  }
}

// Of the input that a settled point takes: the input's own and that of the speed, where either is stated. 0: neither.
double stated_noise(const Dataset& dataset, const Channel* input, const AxisRecord& r, bool by_torque) {
  const Channel* speed = by_torque ? nullptr : dataset.channel("velocity");
  const double of_speed = speed != nullptr ? speed->sigma * command_slope(r.command, r.velocity) : 0.0;
  return std::hypot(input != nullptr ? input->sigma : 0.0, of_speed);
}

// The settled points of all runs, one after another.
struct SettledPoints {
  std::vector<double> command, velocity, load_torque_Nm;
};

SettledPoints all_settled_points(const Dataset& dataset, CommandKind kind) {
  SettledPoints out;
  for (const Run& run : dataset.runs) {
    const std::vector<double>* command = run.signal(command_name(kind));
    if (!run.steady || command == nullptr) continue;
    const auto append = [&](const char* name, std::vector<double>& to) {
      const std::vector<double>* values = run.signal(name);
      for (std::size_t k = 0; k < command->size(); ++k) to.push_back(values != nullptr ? (*values)[k] : 0.0);
    };
    out.command.insert(out.command.end(), command->begin(), command->end());
    append("velocity", out.velocity);
    append("load_torque", out.load_torque_Nm);
  }
  return out;
}

// A measured input's: by the points before and after, which a map by the angle needs, or about a surface, either is an upper
// bound. A command's (duty, voltage): that of the speeds of one command, else about the surface.
double estimated_noise(const Dataset& dataset, const AxisRecord& r, const AxisInput& in) {
  const SettledPoints all = all_settled_points(dataset, in.kind);
  std::vector<std::vector<double>> of = {all.velocity};
  if (!in.load_torque_Nm.empty()) of.push_back(all.load_torque_Nm);
  const double about_surface = surface_noise(all.command, of);
  if (is_torque(in.kind)) return std::fmin(estimate_noise(r.command).sigma, about_surface);
  const double of_repeats = command_noise(all.command, all.velocity);
  if (std::isfinite(of_repeats)) return of_repeats;
  return std::isfinite(about_surface) ? about_surface : estimate_noise(r.command).sigma;
}

void make_steady_setup(const Dataset& dataset, const AxisRecord& r, AxisSetup& s) {
  constexpr double kShareOfRange = 1e-3;  // hysteresis of the approach's direction; a choice (axis_setup.h)
  AxisInput& in = s.input;
  s.given = in.command;
  in.command_is_compared = true;
  s.position = r.position_or_counts();
  in.measured_position_rad = s.position;
  in.imposed_velocity_rad_s.assign(r.size(), 0.0);
  for (std::size_t k = 0; k < r.velocity.size(); ++k) {
    if (std::isfinite(r.velocity[k])) in.imposed_velocity_rad_s[k] = r.velocity[k];
  }
  s.velocity = in.imposed_velocity_rad_s;
  s.measured_current = r.current;
  s.approach.assign(r.size(), 0.0);
  if (!s.position.empty()) {
    const auto [low, high] = std::minmax_element(s.position.begin(), s.position.end());
    const double least = std::max(kShareOfRange * (*high - *low), 3.0 * estimate_noise(s.position).quantum);
    double turned_at = s.position.front(), direction = 0.0;
    std::size_t first = r.size();
    for (std::size_t k = 1; k < r.size(); ++k) {
      const double displacement = s.position[k] - turned_at;
      if (displacement * direction > 0.0) {
        turned_at = s.position[k];
      } else if (std::abs(displacement) > least) {
        direction = displacement > 0.0 ? 1.0 : -1.0;
        turned_at = s.position[k];
        first = std::min(first, k);
      }
      s.approach[k] = direction;
    }
    for (std::size_t k = 0; k < first && first < r.size(); ++k) s.approach[k] = s.approach[first];
  }
  const std::string_view name = command_name(needed_kind(in.kind));
  const Channel* channel = dataset.channel(name);
  add(dataset, s, name, Quantity::kNeededInput, r.command, 0.0, false);
  ComparedSignal& c = s.compared.back();
  const double stated = stated_noise(dataset, channel, r, is_torque(in.kind));
  c.noise_is_stated = stated > 0.0;
  c.noise_sigma = std::max(c.noise_is_stated ? stated : estimated_noise(dataset, r, in), c.noise_sigma);
  c.whitened_sigma = c.noise_sigma;
}

}  // namespace omnihil

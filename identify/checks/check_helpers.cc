#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "identify/checks/check_list.h"
#include "identify/record/quantum.h"
#include "identify/record/rig.h"
#include "identify/record/statistics.h"
#include "sim/law/symmetric.h"
#include "sim/model/rolling_model.h"

namespace omnihil {
namespace {

// Where the drive's position comes from, in rad (m) of the output.
void add_position(const Dataset& dataset, const Candidate& nominal, const Run& run, DriveView& view) {
  const std::string encoder = "encoder" + view.suffix;
  if (const std::vector<double>* counts = run.signal(encoder)) {
    const Channel& channel = *dataset.channel(encoder);
    const double gear = nominal_value(nominal, "gear.ratio").value_or(1.0);
    view.position_name = encoder;
    view.position = counts;
    view.quantum = std::abs(channel.scale);
    view.rad_per_position =
        2.0 * std::numbers::pi / channel.counts_per_rev / (channel.on_output ? 1.0 : gear);
  } else if (view.suffix.empty() && run.signal("position") != nullptr) {
    view.position_name = "position";
    view.position = run.signal("position");
    view.quantum = quantum_of(*view.position);
  }
}

std::vector<DriveView> drives_of(const Dataset& dataset, const Candidate& nominal, const Run& run) {
  std::vector<DriveView> views;
  const std::vector<std::string> suffixes = dataset.rig->whole_robot
                                                ? per_wheel("", wheel_count(nominal.file.parameters))
                                                : std::vector<std::string>{""};
  for (const std::string& suffix : suffixes) {
    DriveView view{.suffix = suffix, .drive_name = "", .position_name = ""};
    for (const char* name : {"duty", "motor_voltage", "motor_torque", "position_target", "command_wheel"}) {
      if (const std::vector<double>* drive = run.signal(name + suffix)) {
        view.drive_name = name + suffix;
        view.drive = drive;
      }
    }
    view.current = run.signal("motor_current" + suffix);
    const Channel* amps = dataset.channel("motor_current" + suffix);
    if (view.drive == nullptr && amps != nullptr && amps->imposed) {
      view.drive_name = amps->signal;
      view.drive = std::exchange(view.current, nullptr);
    }
    if (suffix.empty()) view.velocity = run.signal("velocity");
    add_position(dataset, nominal, run, view);
    views.push_back(std::move(view));
  }
  return views;
}

}  // namespace

CheckContext check_context(const Dataset& dataset, const Candidate& nominal) {
  CheckContext context{
      .dataset = dataset, .nominal = nominal, .runs = {}, .rows_held = rows_held_in(dataset, nominal)};
  for (const Run& run : dataset.runs) {
    context.runs.push_back(
        {.run = &run, .period_s = median_period_s(run.time_s), .drives = drives_of(dataset, nominal, run)});
  }
  return context;
}

double quantile_of(std::vector<double> values, double share) {
  return quantile(finite_values(values), share, QuantileRank::kNearest);
}

double median_of(std::vector<double> values) { return quantile_of(std::move(values), 0.5); }

std::optional<double> nominal_value(const Candidate& nominal, std::string_view path) {
  const Parameter* p = nominal.file.parameters.find(path);
  return p == nullptr || p->values.empty() ? std::nullopt : std::optional(p->value());
}

double tolerance_of(const Candidate& nominal, std::string_view path) {
  const Parameter* p = nominal.file.parameters.find(path);
  return p == nullptr ? 0.0 : p->tolerance.value_or(0.0);
}

std::vector<double> asked_voltage(const CheckContext& data, const RunView& view, const DriveView& drive) {
  if (drive.drive == nullptr) return {};
  if (drive.drive_name.starts_with("motor_voltage")) return *drive.drive;
  if (!drive.drive_name.starts_with("duty")) return {};
  const std::vector<double>* bus = view.run->signal("bus_voltage");
  double last_V = nominal_value(data.nominal, "supply.voltage_V").value_or(0.0);
  std::vector<double> voltage = *drive.drive;
  for (std::size_t k = 0; k < voltage.size(); ++k) {
    if (bus != nullptr && std::isfinite((*bus)[k])) last_V = (*bus)[k];
    voltage[k] = std::clamp(voltage[k], -1.0, 1.0) * last_V;
  }
  return voltage;
}

WindowMeans window_means(const RunView& view, const DriveView& drive, const std::vector<double>& input,
                         double window_s) {
  WindowMeans out;
  const std::vector<double>& t = view.run->time_s;
  const double window = std::max(window_s, 5.0 * view.period_s);
  std::size_t from = 0;
  while (from + 1 < t.size()) {
    std::size_t to = from + 1;
    double area = 0.0, speed = 0.0, amps = 0.0;
    bool whole = true;
    for (; to < t.size() && t[to - 1] - t[from] < window; ++to) {
      const double dt = t[to] - t[to - 1];
      whole = whole && dt < 3.0 * view.period_s;
      area += input[to - 1] * dt;  // held from its sample on
      if (drive.velocity != nullptr) speed += 0.5 * ((*drive.velocity)[to] + (*drive.velocity)[to - 1]) * dt;
      if (drive.current != nullptr) amps += (*drive.current)[to] * dt;  // mean of the period that ends there
    }
    const std::size_t last = to - 1;
    const double span = t[last] - t[from];
    if (drive.position != nullptr)
      speed = ((*drive.position)[last] - (*drive.position)[from]) * drive.rad_per_position;
    if (whole && span >= 0.8 * window && std::isfinite(area) && std::isfinite(speed)) {
      out.drive.push_back(area / span);
      out.speed.push_back(speed / span);
      out.current.push_back(drive.current != nullptr ? amps / span : NAN);
      out.time_s.push_back(t[from]);
    }
    from = last;
  }
  return out;
}

LineFit fit_line(const std::vector<std::vector<double>>& x, const std::vector<double>& y) {
  LineFit out;
  const auto n = static_cast<Eigen::Index>(y.size()), m = static_cast<Eigen::Index>(x.size());
  out.samples = y.size();
  if (n < m + 3) return out;
  Eigen::MatrixXd a(n, m);
  Eigen::VectorXd b(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    b(i) = y[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < m; ++j)
      a(i, j) = x[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)];
  }
  const Eigen::MatrixXd normal = a.transpose() * a;
  const Eigen::VectorXd c = ldlt_solve(normal, a.transpose() * b);
  const double left = (b - a * c).squaredNorm(), all = b.squaredNorm();
  const Eigen::MatrixXd inverse = ldlt_solve_columns(normal, Eigen::MatrixXd::Identity(m, m));
  for (Eigen::Index j = 0; j < m; ++j) {
    out.coefficient.push_back(c(j));
    out.sigma.push_back(std::sqrt(std::max(0.0, inverse(j, j)) * left / static_cast<double>(n - m)));
  }
  out.explained = all > 0.0 && std::isfinite(left) ? 1.0 - left / all : 0.0;
  return out;
}

}  // namespace omnihil

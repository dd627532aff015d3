// Records taken under a controller: the input follows from the output, so that a fit finds the controller's
// gain in place of friction.
//
// By torque: the level, tau = c - K w; an open loop shows friction there, K < 0. By voltage: the changes,
// d u = -K d w from row to row; an open loop's input does not know its output.
// Cannot: see a controller whose reference moves as fast as the output.
#include <fmt/format.h>

#include <cmath>

#include "identify/checks/check_list.h"

namespace omnihil {
namespace {

constexpr double kExplained = 0.5;  // R^2 of the line of input over speed; tuned
// Of the rows, with a new input: that of a controller is never still.
constexpr double kChanging = 0.3;  // tuned

std::vector<double> speed_of(const RunView& view, const DriveView& drive) {
  if (drive.velocity != nullptr) return *drive.velocity;
  std::vector<double> speed(view.run->time_s.size(), NAN);
  for (std::size_t k = 1; k < speed.size(); ++k) {
    speed[k] = ((*drive.position)[k] - (*drive.position)[k - 1]) * drive.rad_per_position /
               (view.run->time_s[k] - view.run->time_s[k - 1]);
  }
  return speed;
}

struct Pairs {
  std::vector<double> input, output;
};

Pairs levels(const std::vector<double>& u, const std::vector<double>& w) {
  Pairs p;
  double mean_u = 0.0, mean_w = 0.0;
  for (std::size_t k = 0; k < u.size(); ++k) {
    if (!std::isfinite(u[k]) || !std::isfinite(w[k])) continue;
    p.input.push_back(u[k]);
    p.output.push_back(w[k]);
    mean_u += u[k];
    mean_w += w[k];
  }
  for (double& v : p.input) v -= mean_u / static_cast<double>(p.input.size());
  for (double& v : p.output) v -= mean_w / static_cast<double>(p.output.size());
  return p;
}

Pairs changes(const std::vector<double>& u, const std::vector<double>& w) {
  Pairs p;
  for (std::size_t k = 1; k < u.size(); ++k) {
    const double du = u[k] - u[k - 1], dw = w[k] - w[k - 1];
    if (!std::isfinite(du) || !std::isfinite(dw)) continue;
    p.input.push_back(du);
    p.output.push_back(dw);
  }
  return p;
}

double changing_share(const std::vector<double>& u) {
  double changing = 0.0;
  for (std::size_t k = 1; k < u.size(); ++k) changing += u[k] != u[k - 1] ? 1.0 : 0.0;
  return changing / static_cast<double>(u.size());
}

}  // namespace

void check_closed_loop(const CheckContext& data, std::vector<DataFinding>& findings) {
  for (const RunView& view : data.runs) {
    if (view.run->steady || view.run->time_s.size() < 100) continue;
    for (const DriveView& drive : view.drives) {
      const bool by_torque =
          drive.drive_name == "motor_torque" || drive.drive_name.starts_with("motor_current");
      const bool moves = drive.position != nullptr || drive.velocity != nullptr;
      if (drive.drive == nullptr || !moves || drive.drive_name == "position_target") continue;
      if (drive.drive_name.starts_with("command") || changing_share(*drive.drive) < kChanging) continue;
      const std::vector<double> speed = speed_of(view, drive);
      const Pairs p = by_torque ? levels(*drive.drive, speed) : changes(*drive.drive, speed);
      const LineFit line = fit_line({p.output}, p.input);
      if (line.coefficient.empty() || line.explained < kExplained || line.coefficient[0] >= 0.0) continue;
      findings.push_back(
          {DataFinding::Grade::kDoubt, "closed_loop", view.run->file, drive.drive_name, -line.coefficient[0],
           fmt::format("{} follows the speed as a controller does, with a gain of {:.3g} per unit of "
                       "speed ({:.0f} % explained): a fit can take that gain for a negative friction",
                       drive.drive_name, -line.coefficient[0], 100.0 * line.explained)});
    }
  }
}

}  // namespace omnihil

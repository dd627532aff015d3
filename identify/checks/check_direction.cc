// Signs: does the drive turn the way it is asked to, do two sensors of one motion agree on its direction.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "identify/checks/check_list.h"
#include "identify/record/rig.h"
#include "identify/record/statistics.h"

namespace omnihil {
namespace {

using Grade = DataFinding::Grade;

constexpr double kWindow_s = 0.1;         // several mechanical time constants of a small bare motor; a choice
constexpr double kOpposite = -0.4;        // correlation about zero; tuned
constexpr std::size_t kLeastWindows = 5;  // a correlation of fewer is chance; tuned

// sum a b / sqrt(sum a^2 sum b^2): about zero, so that steady motion counts.
double alignment(const std::vector<double>& a, const std::vector<double>& b) {
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) ab += a[i] * b[i], aa += a[i] * a[i], bb += b[i] * b[i];
  return aa > 0.0 && bb > 0.0 ? ab / std::sqrt(aa * bb) : 0.0;
}

// Does the drive turn at all in this run, beside what it does in the others? Below its breakaway what is left is an offset of the
// sensor, or rounding, and has any sign.
bool turns(const CheckContext& data, const DriveView& drive, const std::vector<double>& speed) {
  constexpr double kLeastOfTop = 0.01;  // a scale's or an offset's error of a cheap sensor; a choice
  double top = 0.0;
  for (const RunView& view : data.runs) {
    for (const DriveView& other : view.drives) {
      if (other.drive != nullptr && other.drive_name == drive.drive_name)
        top = std::max(top, largest_size(window_means(view, other, *other.drive, kWindow_s).speed));
    }
  }
  return largest_size(speed) > kLeastOfTop * top;
}

void drive_against_motion(const CheckContext& data, const RunView& view, const DriveView& drive,
                          std::vector<DataFinding>& findings) {
  const bool by_voltage = drive.drive_name.starts_with("duty") ||
                          drive.drive_name.starts_with("motor_voltage") ||
                          drive.drive_name.starts_with("command_wheel");
  if (!by_voltage || (drive.position == nullptr && drive.velocity == nullptr)) return;
  const WindowMeans w = window_means(view, drive, *drive.drive, kWindow_s);
  const double along = alignment(w.drive, w.speed);
  if (w.drive.size() < kLeastWindows || along > kOpposite || !turns(data, drive, w.speed)) return;
  const std::string motion = drive.position != nullptr ? drive.position_name : std::string("velocity");
  findings.push_back(
      {Grade::kFault, "swapped_sign", view.run->file, motion, along,
       fmt::format("the drive turns opposite to what it is asked: the sign of {} or of {} is swapped "
                   "(the encoder counts backwards, or the motor's leads are reversed)",
                   motion, drive.drive_name)});
}

// A log of a duty's size whose direction went to another pin: never below zero, the drive turns both ways, and the size
// of the speed follows the duty where the speed does not. A load that pushes a drive back does not do so in proportion
// to the duty.
void drive_without_sign(const RunView& view, const DriveView& drive, std::vector<DataFinding>& findings) {
  constexpr double kFollows = 0.5;    // share of the squares that a line through zero explains; tuned
  constexpr double kBackwards = 0.1;  // share of the squares that is motion against the drive; tuned
  const bool by_voltage =
      drive.drive_name.starts_with("duty") || drive.drive_name.starts_with("motor_voltage");
  if (!by_voltage || (drive.position == nullptr && drive.velocity == nullptr)) return;
  const double least = quantile_of(*drive.drive, 0.0), most = quantile_of(*drive.drive, 1.0);
  if (least < 0.0 && most > 0.0) return;
  const WindowMeans w = window_means(view, drive, *drive.drive, kWindow_s);
  std::vector<double> size;
  double all = 0.0, against = 0.0;
  for (std::size_t i = 0; i < w.speed.size(); ++i) {
    size.push_back(std::abs(w.speed[i]));
    all += w.speed[i] * w.speed[i];
    if (w.speed[i] * (most > 0.0 ? 1.0 : -1.0) < 0.0) against += w.speed[i] * w.speed[i];
  }
  const LineFit of_size = fit_line({w.drive}, size), of_speed = fit_line({w.drive}, w.speed);
  if (w.speed.size() < kLeastWindows || of_size.coefficient.empty() || of_speed.coefficient.empty()) return;
  if (of_size.explained < kFollows || of_speed.explained > kFollows * of_size.explained) return;
  if (against < kBackwards * all) return;
  findings.push_back(
      {Grade::kFault, "drive_without_sign", view.run->file, drive.drive_name, against / all,
       fmt::format("{} is never {} zero, yet the drive turns both ways, as fast as {} is large: the "
                   "direction was not "
                   "logged (a pin of its own); give {} a sign",
                   drive.drive_name, most > 0.0 ? "below" : "above", drive.drive_name, drive.drive_name)});
}

void position_against_velocity(const RunView& view, const DriveView& drive,
                               std::vector<DataFinding>& findings) {
  if (drive.position == nullptr || drive.velocity == nullptr) return;
  DriveView by_speed = drive;
  by_speed.position = nullptr;
  const std::vector<double> none(view.run->time_s.size(), 0.0);
  const WindowMeans a = window_means(view, drive, none, kWindow_s);
  const WindowMeans b = window_means(view, by_speed, none, kWindow_s);
  if (a.speed.size() != b.speed.size() || a.speed.size() < kLeastWindows) return;
  const double along = alignment(a.speed, b.speed);
  if (along > kOpposite) return;
  findings.push_back({Grade::kFault, "swapped_sign", view.run->file, drive.position_name, along,
                      fmt::format("{} and velocity run in opposite directions: the sign of one is swapped",
                                  drive.position_name)});
}

// How far a position moves towards its target: the alignment of its speed with what is left of the way. Positive of a servo that
// comes late by half a period, too; where the sign is swapped it is negative after steps and about zero on ramps.
double towards(const std::vector<double>& target, const std::vector<double>& position) {
  std::vector<double> left, step;
  for (std::size_t k = 0; k + 1 < position.size(); ++k) {
    left.push_back(target[k] - position[k]);
    step.push_back(position[k + 1] - position[k]);
  }
  return alignment(left, step);
}

void target_against_position(const RunView& view, const DriveView& drive,
                             std::vector<DataFinding>& findings) {
  const std::vector<double>* position = view.run->signal("position");
  if (drive.drive_name != "position_target" || position == nullptr) return;
  std::vector<double> a, b;
  double mean_a = 0.0, mean_b = 0.0;
  for (std::size_t k = 0; k < position->size(); ++k) {
    if (!std::isfinite((*position)[k]) || !std::isfinite((*drive.drive)[k])) continue;
    a.push_back((*drive.drive)[k]);
    b.push_back((*position)[k]);
    mean_a += a.back();
    mean_b += b.back();
  }
  for (double& v : a) v -= mean_a / static_cast<double>(a.size());
  for (double& v : b) v -= mean_b / static_cast<double>(b.size());
  constexpr double kFollows = 0.2;  // of `towards`: between a late servo's and a swapped sign's; a choice
  const double along = alignment(a, b);
  if (a.size() < 50 || along > kOpposite || towards(a, b) > kFollows) return;
  findings.push_back({Grade::kFault, "swapped_sign", view.run->file, "position", along,
                      "position moves opposite to position_target: the sign of one is swapped"});
}

// tau = J a + b w + l + c sgn w + g sin theta + h cos theta: the inertia of a sound record is positive. The load goes with
// the angle (an arm's weight, an imbalance): where a position loop moves it, its torque rises while the motion slows.
// Reported beyond 5 standard errors (one-sided p = 3e-7 of a normal), where the line explains half of the torque's
// variance (tuned): a torque that is held constant says nothing of an acceleration.
void torque_against_acceleration(const RunView& view, const DriveView& drive,
                                 std::vector<DataFinding>& findings) {
  // From which on the load's sine and cosine differ from its level and from one another.
  constexpr double kLeastAngle = 0.05;  // rad; a choice
  if (drive.drive_name != "motor_torque" || (drive.position == nullptr && drive.velocity == nullptr)) return;
  const WindowMeans w = window_means(view, drive, *drive.drive, 0.02);
  std::vector<double> torque, acceleration, speed, side, along_sine, along_cosine;
  double angle = 0.0, least = 0.0, most = 0.0;
  for (std::size_t i = 1; i + 1 < w.speed.size(); ++i) {
    angle += w.speed[i] * (w.time_s[i] - w.time_s[i - 1]);
    least = std::min(least, angle), most = std::max(most, angle);
    torque.push_back(w.drive[i]);
    acceleration.push_back((w.speed[i + 1] - w.speed[i - 1]) / (w.time_s[i + 1] - w.time_s[i - 1]));
    speed.push_back(w.speed[i]);
    side.push_back(w.speed[i] > 0.0 ? 1.0 : -1.0);
    along_sine.push_back(std::sin(angle));
    along_cosine.push_back(std::cos(angle));
  }
  std::vector<std::vector<double>> x = {acceleration, speed, std::vector<double>(torque.size(), 1.0)};
  if (std::ranges::find(side, 1.0) != side.end() && std::ranges::find(side, -1.0) != side.end())
    x.push_back(side);
  if (most - least > kLeastAngle) x.insert(x.end(), {along_sine, along_cosine});
  // Of its variance in its mean square: a thousandth of the level is the rounding of a set point. A choice.
  constexpr double kHeld = 1e-6;  // a choice
  const LineFit line = fit_line(x, torque);
  double square = 0.0;
  for (const double v : torque) square += v * v / static_cast<double>(torque.size());
  const double varies = std::pow(rms_about_mean(torque), 2) / std::max(square, 1e-300);
  if (line.coefficient.empty() || varies < kHeld || 1.0 - line.explained > 0.5 * varies) return;
  if (line.coefficient[0] > -5.0 * line.sigma[0]) return;
  findings.push_back({Grade::kFault, "swapped_sign", view.run->file, "motor_torque", line.coefficient[0],
                      "the axis accelerates against motor_torque: the sign of the torque or of the motion is "
                      "swapped"});
}

// Gyro against the wheels: yaw rate = mean rim speed / R_b.
void gyro_against_wheels(const CheckContext& data, const RunView& view, std::vector<DataFinding>& findings) {
  const std::vector<double>* gyro = view.run->signal("gyro_z");
  const double radius = nominal_value(data.nominal, "robot.wheel_radius_m").value_or(0.0);
  const double arm = nominal_value(data.nominal, "robot.wheel_center_radius_m").value_or(0.0);
  if (gyro == nullptr || radius <= 0.0 || arm <= 0.0) return;
  std::vector<double> yaw;
  for (const DriveView& drive : view.drives) {
    if (drive.position == nullptr) return;
    const WindowMeans w =
        window_means(view, drive, std::vector<double>(view.run->time_s.size(), 0.0), kWindow_s);
    yaw.resize(w.speed.size(), 0.0);
    for (std::size_t i = 0; i < std::min(yaw.size(), w.speed.size()); ++i)
      yaw[i] += w.speed[i] * radius / arm / static_cast<double>(view.drives.size());
  }
  DriveView turned;
  turned.velocity = gyro;
  const WindowMeans g =
      window_means(view, turned, std::vector<double>(view.run->time_s.size(), 0.0), kWindow_s);
  if (g.speed.size() != yaw.size() || yaw.size() < kLeastWindows) return;
  const double along = alignment(g.speed, yaw);
  if (along > kOpposite) return;
  findings.push_back(
      {Grade::kFault, "swapped_sign", view.run->file, "gyro_z", along,
       "gyro_z turns opposite to the wheels: its sign is swapped (counter-clockwise is positive)"});
}

}  // namespace

void check_direction(const CheckContext& data, std::vector<DataFinding>& findings) {
  for (const RunView& view : data.runs) {
    if (view.run->steady) continue;
    for (const DriveView& drive : view.drives) {
      if (drive.drive != nullptr) {
        drive_against_motion(data, view, drive, findings);
        drive_without_sign(view, drive, findings);
        target_against_position(view, drive, findings);
        torque_against_acceleration(view, drive, findings);
      }
      position_against_velocity(view, drive, findings);
    }
    if (data.dataset.rig->whole_robot) gyro_against_wheels(data, view, findings);
  }
}

}  // namespace omnihil

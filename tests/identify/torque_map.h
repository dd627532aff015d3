// The torque that an axis takes at each of many settled speeds, against a brake whose torque is measured. Made up: what
// is to be found in it is a closed form.
//
//   y_i = b w_i + (C + G (1 - exp(-|w_i| / w_G)) + D w_i^2) sgn w_i - L_i - M + noise
//   speeds w_i from -w_max to w_max, brake L_i either way; hidden: load M, Coulomb friction C, grease's drag G,
//   drag D of the air
//
//   TorqueMap map({.load_Nm = 0.004});
//   map.dataset; map.nominal;         // whose viscous friction is not known exactly, and which has no load
#pragma once
#include "sim/law/random.h"
#include "tests/identify/linear_predictor.h"

namespace omnihil {

struct TorqueMapRecipe {
  double friction_Nm_s_per_rad = 1.3e-5;
  double load_Nm = 0.0;
  double sigma_Nm = 1e-4;
  bool braked = true;
  double coulomb_Nm = 0.0;
  double grease_Nm = 0.0;
  double grease_speed_rad_s = 30.0;
  double drag_Nm_s2_per_rad2 = 0.0;
  double share_of_speed = 1.0;  // that the fit and held-out runs reach
  bool another = false;         // an extrapolation run, to the fastest
  double swing_Nm =
      0.0;  // in that alone: a torque that no law of a drive has, seven times up and down over its points
};

class TorqueMap {
 public:
  static constexpr int kPoints = 200;
  static constexpr double kFastest_rad_s = 300.0;
  static constexpr double kPeriod_s = 0.5;

  explicit TorqueMap(const TorqueMapRecipe& recipe) {
    dataset.rig = &rig_axis();
    dataset.channels = {
        {.signal = "motor_torque", .column = "torque", .unit = "N m", .sigma = recipe.sigma_Nm},
        {.signal = "velocity", .column = "speed", .unit = "rad/s", .imposed = true},
        {.signal = "load_torque", .column = "brake", .unit = "N m", .imposed = true}};
    if (!recipe.braked) dataset.channels.pop_back();
    for (const Split split : {kTraining, kValidation}) dataset.runs.push_back(run(recipe, split));
    if (recipe.another) dataset.runs.push_back(run(recipe, kExtrapolation));
  }

  static double speed_rad_s(int point) { return kFastest_rad_s * (2.0 * point / (kPoints - 1) - 1.0); }
  // Driving and driven at either direction; orthogonal to speed and to a constant. From point to point it changes
  // by less than the noise, which a record without stated noise is taken by.
  static double brake_Nm(int point) { return 0.01 * std::cos(2.0 * M_PI * (point + 0.5) / kPoints); }
  // sum w_i^2
  static double speeds_squared() {
    double sum = 0.0;
    for (int i = 0; i < kPoints; ++i) sum += speed_rad_s(i) * speed_rad_s(i);
    return sum;
  }
  // What is left of the torque without the brake: b w_i - M + noise.
  double without_brake_Nm(Split split, int point) const {
    return (*dataset.runs[split].signal("motor_torque"))[static_cast<std::size_t>(point)] + brake_Nm(point);
  }

  Dataset dataset;
  Candidate nominal = axis_with_unknown_friction();

 private:
  static omnihil::Run run(const TorqueMapRecipe& recipe, Split split) {
    omnihil::Run out;
    out.file = split == kTraining ? "fit.csv" : split == kValidation ? "held.csv" : "another.csv";
    out.split = split;
    out.steady = true;
    for (int i = 0; i < kPoints; ++i) {
      const double w = (split == kExtrapolation ? 1.0 : recipe.share_of_speed) * speed_rad_s(i);
      const double swing =
          split == kExtrapolation ? recipe.swing_Nm * std::sin(14.0 * M_PI * (i + 0.5) / kPoints) : 0.0;
      const double noise = recipe.sigma_Nm * gaussian(7, split, static_cast<std::uint64_t>(i));
      const double grease = recipe.grease_Nm * -std::expm1(-std::abs(w) / recipe.grease_speed_rad_s);
      const double drag = recipe.drag_Nm_s2_per_rad2 * w * w;
      out.time_s.push_back(kPeriod_s * i);
      out.signals["velocity"].push_back(w);
      const double brake = recipe.braked ? brake_Nm(i) : 0.0;
      if (recipe.braked) out.signals["load_torque"].push_back(brake_Nm(i));
      out.signals["motor_torque"].push_back(recipe.friction_Nm_s_per_rad * w +
                                            std::copysign(recipe.coulomb_Nm + grease + drag, w) - brake -
                                            recipe.load_Nm + swing + noise);
    }
    return out;
  }
};

}  // namespace omnihil

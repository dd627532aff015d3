#include "sim/model/model_figures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hil/loop/model_store.h"

namespace omnihil {
namespace {

double figure(const std::vector<ModelFigure>& figures, const std::string& name, const std::string& unit) {
  for (const ModelFigure& f : figures) {
    if (f.name == name && f.unit == unit) return f.value;
  }
  ADD_FAILURE() << "no figure " << name << " in " << unit;
  return 0.0;
}

ModelFile robot() {
  return load_model("omni_default", {OMNIHIL_SOURCE_DIR "/models"}).model.value_or(ModelFile{});
}

TEST(ModelFigures, MotorFiguresAreTheFormulasOfTheSheet) {
  MotorParams m;
  m.resistance_ohm = 1.2;
  m.inductance_H = 0.6e-3;
  m.torque_constant_Nm_per_A = 0.025;
  m.rotor_inertia_kg_m2 = 1e-5;
  const auto figures = motor_figures(m, 12.0);
  EXPECT_NEAR(figure(figures, "no-load speed", "rad/s"), 12.0 / 0.025, 1e-9);
  EXPECT_NEAR(figure(figures, "no-load speed", "rpm"), 480.0 * 60.0 / (2.0 * std::numbers::pi), 1e-6);
  EXPECT_NEAR(figure(figures, "stall torque", "N m"), 0.25, 1e-12);
  EXPECT_NEAR(figure(figures, "electrical time constant", "ms"), 0.5, 1e-12);
  EXPECT_NEAR(figure(figures, "mechanical time constant", "ms"), 1e3 * 1e-5 * 1.2 / (0.025 * 0.025), 1e-9);
}

TEST(ModelFigures, WheelLoadsSumToTheWeight) {
  const ModelFile model = robot();
  const auto figures = model_figures(model);
  double sum_N = 0.0;
  for (int wheel = 1; wheel <= 4; ++wheel)
    sum_N += figure(figures, "load on wheel " + std::to_string(wheel), "N");
  EXPECT_NEAR(sum_N, model.robot->mass_kg * 9.80665, 1e-9);
}

TEST(ModelFigures, AtTopSpeedForwardTheFastestWheelTurnsAtNoLoadSpeed) {
  const ModelFile model = robot();
  const auto figures = model_figures(model);
  const double top_m_s = figure(figures, "top speed forward", "m/s");
  double fastest_rad_s = 0.0;
  for (const double angle : model.robot->wheel_angle_rad) {
    fastest_rad_s =
        std::max(fastest_rad_s, std::abs(-std::sin(angle) * top_m_s) / model.robot->wheel_radius_m);
  }
  EXPECT_NEAR(fastest_rad_s * model.robot->gear_ratio, figure(figures, "no-load speed", "rad/s"), 1e-9);
}

}  // namespace
}  // namespace omnihil

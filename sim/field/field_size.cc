#include "sim/field/field_size.h"

#include <cmath>

namespace omnihil {
namespace {
constexpr FieldSize kSizes[] = {kFieldDivisionA, kFieldDivisionB, kFieldSeedPaper};
}

std::span<const FieldSize> field_sizes() { return kSizes; }

const FieldSize* find_field(std::string_view name) {
  for (const FieldSize& size : kSizes)
    if (size.name == name) return &size;
  return nullptr;
}

std::array<Board, 6> goal_boards(const FieldSize& field) {
  const double line_m = field.half_length_m(), depth_m = field.goal_depth_mm / 1000.0;
  const double half_m = field.goal_width_mm / 2000.0, back_m = line_m + depth_m;
  std::array<Board, 6> boards{};
  for (std::size_t side = 0; side < 2; ++side) {
    const auto put = [&](std::size_t i, double near_m, double far_m, double y_from_m, double y_to_m) {
      if (side == 0)
        boards[i] = {-far_m, -near_m, y_from_m, y_to_m, kGoalHeight_m};
      else
        boards[3 + i] = {near_m, far_m, y_from_m, y_to_m, kGoalHeight_m};
    };
    put(0, back_m, back_m + kGoalBoard_m, -half_m - kGoalBoard_m, half_m + kGoalBoard_m);
    put(1, line_m, back_m, half_m, half_m + kGoalBoard_m);
    put(2, line_m, back_m, -half_m - kGoalBoard_m, -half_m);
  }
  return boards;
}

int goal_at(const FieldSize& field, double ball_radius_m, double x_m, double y_m, double z_m) {
  const bool within = std::abs(y_m) < field.goal_width_mm / 2000.0 && z_m < kGoalHeight_m &&
                      std::abs(x_m) < field.half_length_m() + field.goal_depth_mm / 1000.0;
  if (!within || std::abs(x_m) < field.half_length_m() + ball_radius_m) return 0;
  return x_m > 0.0 ? 1 : -1;
}

}  // namespace omnihil

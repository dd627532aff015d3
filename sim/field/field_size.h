// Fields: sizes of the league's rules and of the seed paper, their boards and goals.
//
//   const FieldSize& field = kFieldDivisionB;                       // 9 x 6 m
//   for (const Board& board : goal_boards(field)) …                 // what a ball and a robot can run into
//
// Frame: field's middle, x towards the yellow half's goal line, y to the left. Boards stand boundary_mm outside the
// lines, 0.1 m high; goals are open boxes of 20 mm boards, 0.16 m high.
#pragma once
#include <array>
#include <span>
#include <string_view>

namespace omnihil {

// mm, as the league's vision tells them.
struct FieldSize {
  const char* name;
  int length_mm, width_mm, goal_width_mm, goal_depth_mm, boundary_mm, penalty_depth_mm, penalty_width_mm;
  double half_length_m() const { return length_mm / 2000.0; }
  double half_width_m() const { return width_mm / 2000.0; }
};
inline constexpr FieldSize kFieldDivisionA{"division-a", 12000, 9000, 1800, 180, 300, 1800, 3600};
inline constexpr FieldSize kFieldDivisionB{"division-b", 9000, 6000, 1000, 180, 300, 1000, 2000};
inline constexpr FieldSize kFieldSeedPaper{"seed-paper", 6050, 4050, 700, 180, 300, 500, 1350};

std::span<const FieldSize> field_sizes();
const FieldSize* find_field(std::string_view name);

inline constexpr double kBoardHeight_m = 0.1, kGoalHeight_m = 0.16, kGoalBoard_m = 0.02;

struct Board {
  double x_from_m, x_to_m, y_from_m, y_to_m, height_m;
};
// Left goal (x < 0): back, two sides; then the right one.
std::array<Board, 6> goal_boards(const FieldSize& field);

// +1: the ball is over the right goal's line, within the goal; -1: the left one's; 0: no goal.
int goal_at(const FieldSize& field, double ball_radius_m, double x_m, double y_m, double z_m);

}  // namespace omnihil

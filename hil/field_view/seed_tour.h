// The seed paper's systems one after another, each with the figure it gives here.
//
//   for (const TourRow& row : seed_tour(model)) std::puts(row.text().c_str());
//
// Every row runs what it tells of: nothing is remembered. Source: Bakhshandeh Babarsad and Sharbafi 2012.
#pragma once
#include <string>
#include <vector>

#include "sim/robot/robot_model.h"

namespace omnihil {

struct TourRow {
  std::string system, paper, here;
  std::string text() const;
};

std::vector<TourRow> seed_tour(const RobotModel& model);

}  // namespace omnihil

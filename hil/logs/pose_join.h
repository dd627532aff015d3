// A robot's log with the poses that another device took of it beside: one table on the robot's clock.
//
//   JoinedPose joined = join_pose(run.table, pose_table, asked, geometry, context, "drive.csv", "video.csv");
//   joined.table;  joined.asked;  joined.note;             // "video.csv: 0.38 s +- 0.02 s late …"
//
// The poses stand at their nearest rows within half a period, shifted by the offset of pose_clock.h; where the poses have no
// heading of their own, their places are turned into the frame of the robot's. How well lag and angle are known says how
// well a place is, whatever the camera's own noise. Tables by rows only. Throws BadLog where
// something is missing or the two do not tell one motion.
#pragma once
#include <string>
#include <vector>

#include "hil/logs/recognise.h"
#include "sim/robot/geometry.h"

namespace omnihil {

struct PoseGeometry {
  WheelGeometry<double> wheels;
  double gear_ratio = 1.0;
  double counts_per_rotor_turn = 0.0;  // of the encoders; 0: not known
};

struct JoinedPose {
  LogTable table;
  std::vector<ColumnMap> asked;      // of this table
  std::vector<std::string> columns;  // of the poses
  double clock_sigma_s = 0.0;
  // Of places in this frame, rms: what its angle is not known to moves them; 0: the frame is the poses' own.
  double place_sigma_m = 0.0;
  std::string note;
};

JoinedPose join_pose(const LogTable& log, const LogTable& pose, const std::vector<ColumnMap>& asked,
                     const PoseGeometry& geometry, const MeaningContext& context, const std::string& log_name,
                     const std::string& pose_name);

}  // namespace omnihil

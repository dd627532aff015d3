// Every robot and ball that the cameras of a match saw, a row each.
//
//   GameLogReader log("final.log.gz");
//   const VisionCsv csv = vision_csv(log);
//   csv.text;              // time_s,received_s,camera,frame,object,id,x_m,y_m,yaw_rad,confidence
//
// `time_s` is the camera's (t_capture, Unix time of the vision computer), `received_s` that of whoever wrote the log; `object` is
// yellow, blue or ball, which has neither id nor yaw. As each camera saw it: a robot in the view of two has two rows a frame.
// Left out and said: messages that cannot be read, rows with a number that is none. Referee and tracker are counted.
#pragma once
#include <string>

#include "hil/game_log/game_log.h"

namespace omnihil {

struct VisionCsv {
  std::string text;
  std::size_t frames = 0, robots = 0, balls = 0, other_records = 0;
};

VisionCsv vision_csv(GameLogReader& log);

}  // namespace omnihil

// Poses that repeat while the wheels drive the robot on (silent_frames.h): left out of the frames, and said.
#include <fmt/format.h>

#include <cmath>

#include "identify/checks/check_list.h"
#include "identify/predict/robot_record.h"
#include "identify/record/rig.h"
#include "sim/model/rolling_model.h"

namespace omnihil {

void check_silent(const CheckContext& data, std::vector<DataFinding>& findings) {
  if (!data.dataset.rig->whole_robot) return;
  const RollingParams<double> nominal = rolling_params(data.nominal.file.parameters);
  for (const RunView& view : data.runs) {
    const Run& run = *view.run;
    for (const SilentStretch& s : robot_record(data.dataset, run, nominal).silent) {
      const bool heading = s.signal == "vision_theta";
      findings.push_back(
          {DataFinding::Grade::kDoubt, "silent", run.file, s.signal, run.time_s[s.to] - run.time_s[s.from],
           fmt::format(
               "{} repeats {:.6g} from {:.2f} s to {:.2f} s while the wheels {} the robot by {:.2g} {}: its "
               "sensor went silent; these rows of it are not used",
               heading ? "vision_theta" : "vision_x, vision_y", (*run.signal(s.signal))[s.from] + 0.0,
               run.time_s[s.from], run.time_s[s.to], heading ? "turn" : "drive", s.moved,
               heading ? "rad" : "m")});
    }
  }
}

}  // namespace omnihil

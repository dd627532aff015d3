// Records too short to identify anything.
#include <fmt/format.h>

#include "identify/checks/check_list.h"
#include "identify/record/rig.h"

namespace omnihil {

void check_length(const CheckContext& data, std::vector<DataFinding>& findings) {
  constexpr std::size_t kFewRows = 30;       // not twice the base model's dozen parameters; a choice
  constexpr double kFewTimeConstants = 5.0;  // a first-order step has settled to 1 - e^-5 = 99.3 %: derived
  const DriveParams<double> drive =
      data.dataset.rig->of_robot ? DriveParams<double>{} : drive_of(data.nominal);
  const double k = drive.torque_constant_Nm_per_A;
  // mechanical time constant J R / k^2 of a voltage drive
  const double settle_s = k > 0.0 ? inertia_at_rotor(drive) * drive.resistance_ohm / (k * k) : 0.0;
  double fitted_s = 0.0;
  for (const RunView& view : data.runs) {
    const Run& run = *view.run;
    if (run.split == Split::kTraining) fitted_s += run.steady ? 1e9 : run.duration_s();
    if (run.time_s.size() < kFewRows) {
      findings.push_back(
          {DataFinding::Grade::kDoubt, "few_rows", run.file, "", run.duration_s(),
           fmt::format("has {} rows only: too few to tell an effect from noise", run.time_s.size())});
    }
  }
  if (fitted_s < kFewTimeConstants * settle_s) {
    findings.push_back(
        {DataFinding::Grade::kDoubt, "too_short", "", "", fitted_s,
         fmt::format("all runs to fit last {:.3g} s together, the drive needs {:.3g} s to settle "
                     "once: too short to see a steady speed",
                     fitted_s, settle_s)});
  }
}

}  // namespace omnihil

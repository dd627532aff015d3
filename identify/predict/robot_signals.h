// What rig "robot" is compared with: which of its channels see what of its motion; the regime variables; readings of a
// simulated motion.
//
//   RobotRun r = robot_run(dataset, run, nominal);
//   std::vector<std::vector<double>> y = robot_outputs(r, motion);    // [signal][row], before complete()
//
// bus_voltage, where measured, is an input of the model; its drop is compared with the model supply's, means
// made equal (the level drifts with the battery). velocity_i is the difference of the encoder's counts, on the rotor, on
// both sides.
#pragma once
#include "identify/predict/observation.h"
#include "identify/predict/robot_motion.h"

namespace omnihil {

struct RobotRun : RigRun {
  RobotRecord record;
};
RobotRun robot_run(const Dataset& dataset, const Run& run, const RollingParams<double>& nominal);

// Adds to the noise of each signal the response to the inputs' noise: `perturbed` is the same model on the
// record with_input_noise. No model can pass that floor.
void add_input_noise(const RobotMotion<double>& motion, const RobotMotion<double>& perturbed, RobotRun& run);

template <typename T>
const T& quantity_of(const RollingSample<T>& s, const Observation& how) {
  switch (how.quantity) {
    case Quantity::kCounts:
      return s.encoder_rad[how.part];
    case Quantity::kWheelSpeed:
      return s.wheel_rad_s[how.part];
    case Quantity::kCurrent:
      return s.current_A[how.part];
    case Quantity::kGyro:
      return s.gyro_rad_s;
    case Quantity::kAccelerometer:
      return s.accel_m_s2[how.part];
    case Quantity::kPose:
      return s.pose[how.part];
    case Quantity::kForce:
      return s.force_N[how.part];
    default:
      return s.supply_voltage_V;
  }
}
template <typename T>
std::vector<std::vector<T>> robot_outputs(const RobotRun& run, const RobotMotion<T>& motion) {
  return observed<T>(run, run.record.time_s, [&](const Observation& how, std::size_t k) {
    return quantity_of(motion.samples[k], how);
  });
}

std::vector<RegimeTrack> robot_regimes(const Run& run, const RobotRecord& record,
                                       const RobotMotion<double>& motion);

// Puts the sensors' readings of `motion` into `made`, with their noise drawn from `seed`: counts whole, frames
// where there were frames, gaps where there were gaps. The bus voltage is an input: its true values with their sensor's
// noise; what is compared of it is the model supply's, with noise of its own.
void measure_robot(const RobotRun& run, const RobotMotion<double>& motion, std::uint64_t seed, Run& made);
void measure_compared_bus(const RobotMotion<double>& motion, std::uint64_t seed, RobotRun& run);

}  // namespace omnihil

// The predictor of rig "robot": two to six wheels on the floor, driven by what the bridges were asked for.
//
//   std::unique_ptr<Predictor> p = make_robot_predictor(dataset, nominal, options);   // by make_predictor
//
// Run forward from the measured start (rolling_robot.h). Open loop a robot's speed decays within a tenth of a
// second, so errors of speed do not accumulate; integrals of speed do, and are corrected by the measurement:
//   angles    laws of the angle take the measured rotor angles
//   heading   forces in the field's directions, and the rotation of displacements from body to field, take the
//             measured heading: the gyro's integral, corrected to the camera's over a second
//   pose      the model's path is compared after a slow correction towards the camera (0.5 s), so that an
//             error of speed dv appears as 0.5 s dv and does not grow
// Compared: "velocity_1" … (rotor, differences of counts on both sides), "motor_current_1" …,
// "gyro_z", "accel_x", "accel_y", "vision_x", "vision_y", "vision_theta" (where there is a frame).
// bus_voltage, where measured, is an input of the bridges, smoothed; and its drop is compared with that of
// the model's supply. Without it the model's supply is the input. Where the record has radio commands and no
// duties, the model's [controller] (radio_controller.h) closes the loop over the simulated speeds; its numbers
// are parameters as any others, and "wheel_speed_1" … are compared where telemetry has them.
#pragma once
#include <memory>

#include "identify/predict/predictor.h"

namespace omnihil {

std::unique_ptr<Predictor> make_robot_predictor(const Dataset& dataset, const Candidate& nominal,
                                                const PredictOptions& options);

}  // namespace omnihil

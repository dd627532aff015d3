// The predictor of rig "robot": four wheels on the floor, driven by what the bridges were asked for.
//
//   std::unique_ptr<Predictor> p = make_robot_predictor(dataset, nominal, options);   // make_predictor calls
//   it
//
// Run forward from the measured start (rolling_robot.h). Open loop a robot forgets its speed within a tenth
// of a second, so speeds need no help from the measurement; only what adds up does:
//   angles    laws of the angle see the measured rotor angles
//   heading   forces that know the field's directions, and the way from body to field, see the measured
//             heading: the gyro's integral, held to the camera's over a second
//   pose      the model's way is compared after a slow correction towards the camera (0.5 s), so that an
//             error of speed dv stands as 0.5 s dv and does not grow
// Compared: "velocity_1" … "velocity_4" (rotor, differences of counts on both sides), "motor_current_1" …,
// "gyro_z", "accel_x", "accel_y", "vision_x", "vision_y", "vision_theta" (where there is a frame).
// bus_voltage, where measured, is what the bridges had: an input, less its noise; and its drop is compared
// with that of the model's supply. Without it the model's supply holds.
// Cannot: make duties of radio commands (command_vx …); the reader refuses a robot that logged nothing else.
#pragma once
#include <memory>

#include "identify/predict/predictor.h"

namespace omnihil {

std::unique_ptr<Predictor> make_robot_predictor(const Dataset& dataset, const Candidate& nominal,
                                                const PredictOptions& options);

}  // namespace omnihil

// The reference firmware that a robot's model asks for ([firmware] motor_loop), as a session takes it.
//
//   SessionConfig config = session_config(setup);
//   Session session(config, reference_firmware_for(config));
//
// duty: wheel duties, on any robot. foc, six_step: legs of three-phase bridges, on robots that have them.
#pragma once
#include "hil/loop/session.h"

namespace omnihil {

// What a firmware is told of the motors of a robot with three-phase drives.
MotorConfig motor_config(const RobotModel& model);

// By robot id: each robot of the session gets the firmware of its own model.
Session::FirmwareMaker reference_firmware_for(const SessionConfig& config);

}  // namespace omnihil

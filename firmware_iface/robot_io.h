// The plain SI structs that cross the boundary, under their C++ names. One definition: the C ABI's.
//
//   omnihil::RobotCommand command{};            // all-zero is neutral: coast, no kick
//   command.mode = OMNIHIL_MODE_BODY_VELOCITY;
//   command.v_forward_m_s = 1.0;
#pragma once
#include "firmware_iface/omnihil_firmware.h"

namespace omnihil {

inline constexpr int kWheels = OMNIHIL_WHEELS;
inline constexpr int kLegs = OMNIHIL_LEGS;

using RobotCommand = omnihil_command;
using RobotSensors = omnihil_sensors;
using RobotDrive = omnihil_drive;
using RobotFeedback = omnihil_feedback;
using RobotGains = omnihil_gains;
using RobotConfig = omnihil_robot_config;
using MotorConfig = omnihil_motor_config;
using MotorSensors = omnihil_motor_sensors;
using MotorDrive = omnihil_motor_drive;

}  // namespace omnihil

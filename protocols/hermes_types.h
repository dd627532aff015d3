// What the table of packets and the radio end of the robot both name: type codes and registers of RoboCup
// ULaval's HERMES packets, as the robots' firmware numbers them. Source: RobotMCU 44cc54f
// (Robot_stm32f4discovery/Src/robocup/hermes/).
#pragma once
#include <cstdint>
#include <string_view>

namespace omnihil::hermes {

enum Type : std::uint32_t {
  kPingRequest = 0,
  kPingResponse = 1,
  kSpeedMove = 2,
  kSetRegister = 3,
  kOpenLoopCommand = 4,
  kGetBatterie = 5,
  kBatterieResponse = 6,
  kGetNumRequest = 7,
  kNumRequestResponse = 8,
  kSpeedMoveAdvance = 9,
};

// Of SET_REGISTER.
enum Register : int { kLoop = 0, kKick = 1, kCharge = 2, kDribbler = 3 };

// Of OPEN_LOOP_COMMAND, wheel by wheel.
inline constexpr std::string_view kDutyFields[] = {"cmd[0]", "cmd[1]", "cmd[2]", "cmd[3]"};

}  // namespace omnihil::hermes

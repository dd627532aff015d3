-- Wireshark dissector of RoboTeam Twente REM, version 8. Generated from the packet tables by
-- `omnihil formats roboteam-rem-v8 --wireshark`; do not edit.
local PROTOCOL = "roboteam_rem_v8"
local proto = Proto(PROTOCOL, "RoboTeam Twente REM, version 8")

-- name, bytes, types: { first bit, bits, content }, fields: { name, first bit, bits, kind, unit, sign, of a scaled one the unit per count and the value at 0 }
local packets = {
  { name = "REM_Packet", size = 11, types = { { 0, 8, 33 } }, fields = {
    { "packetType", 0, 8, "number", "", "" },
    { "toRobotId", 8, 4, "number", "", "" },
    { "toColor", 12, 1, "number", "", "" },
    { "toBC", 13, 1, "number", "", "" },
    { "toBS", 14, 1, "number", "", "" },
    { "toPC", 15, 1, "number", "", "" },
    { "fromRobotId", 16, 4, "number", "", "" },
    { "fromColor", 20, 1, "number", "", "" },
    { "reserved", 21, 1, "number", "", "" },
    { "fromBS", 22, 1, "number", "", "" },
    { "fromPC", 23, 1, "number", "", "" },
    { "remVersion", 24, 4, "number", "", "" },
    { "messageId", 28, 4, "number", "", "" },
    { "timestamp", 32, 48, "number", "ms", "" },
    { "payloadSize", 80, 8, "number", "bytes", "" },
  } },
  { name = "REM_RobotCommand", size = 28, types = { { 0, 8, 34 } }, fields = {
    { "packetType", 0, 8, "number", "", "" },
    { "toRobotId", 8, 4, "number", "", "" },
    { "toColor", 12, 1, "number", "", "" },
    { "toBC", 13, 1, "number", "", "" },
    { "toBS", 14, 1, "number", "", "" },
    { "toPC", 15, 1, "number", "", "" },
    { "fromRobotId", 16, 4, "number", "", "" },
    { "fromColor", 20, 1, "number", "", "" },
    { "reserved", 21, 1, "number", "", "" },
    { "fromBS", 22, 1, "number", "", "" },
    { "fromPC", 23, 1, "number", "", "" },
    { "remVersion", 24, 4, "number", "", "" },
    { "messageId", 28, 4, "number", "", "" },
    { "timestamp", 32, 48, "number", "ms", "" },
    { "payloadSize", 80, 8, "number", "bytes", "" },
    { "rho", 88, 16, "scaled", "m/s", "", 0.000457770657, 0 },
    { "theta", 104, 16, "scaled", "rad", "", 9.58752644e-05, -3.14159265 },
    { "yaw", 120, 16, "scaled", "rad", "", 9.58752644e-05, -3.14159265 },
    { "angularVelocity", 136, 16, "scaled", "rad/s", "", 0.000958752644, -31.4159265 },
    { "cameraYaw", 152, 16, "scaled", "rad", "", 9.58752644e-05, -3.14159265 },
    { "acceleration_magnitude", 168, 16, "scaled", "m/s^2", "", 0.000457770657, -15 },
    { "acceleration_angle", 184, 16, "scaled", "rad", "", 9.58752644e-05, -3.14159265 },
    { "kickChipPower", 200, 8, "scaled", "m/s", "", 0.0313725509, 0 },
    { "doKick", 208, 1, "number", "", "" },
    { "doChip", 209, 1, "number", "", "" },
    { "kickAtYaw", 210, 1, "number", "", "" },
    { "doForce", 211, 1, "number", "", "" },
    { "useCameraYaw", 212, 1, "number", "", "" },
    { "useYaw", 213, 1, "number", "", "" },
    { "dribblerOn", 214, 1, "number", "", "" },
    { "dribblerOption1", 215, 1, "number", "", "" },
    { "dribblerOption2", 216, 1, "number", "", "" },
    { "dribblerOption3", 217, 1, "number", "", "" },
    { "dribblerOption4", 218, 1, "number", "", "" },
    { "dribblerOption5", 219, 1, "number", "", "" },
    { "dribblerOption6", 220, 1, "number", "", "" },
    { "sendStateInfo", 221, 1, "number", "", "" },
    { "wheelsOff", 222, 1, "number", "", "" },
    { "reboot", 223, 1, "number", "", "" },
  } },
  { name = "REM_RobotCommandTesting", size = 41, types = { { 0, 8, 36 } }, fields = {
    { "packetType", 0, 8, "number", "", "" },
    { "toRobotId", 8, 4, "number", "", "" },
    { "toColor", 12, 1, "number", "", "" },
    { "toBC", 13, 1, "number", "", "" },
    { "toBS", 14, 1, "number", "", "" },
    { "toPC", 15, 1, "number", "", "" },
    { "fromRobotId", 16, 4, "number", "", "" },
    { "fromColor", 20, 1, "number", "", "" },
    { "reserved", 21, 1, "number", "", "" },
    { "fromBS", 22, 1, "number", "", "" },
    { "fromPC", 23, 1, "number", "", "" },
    { "remVersion", 24, 4, "number", "", "" },
    { "messageId", 28, 4, "number", "", "" },
    { "timestamp", 32, 48, "number", "ms", "" },
    { "payloadSize", 80, 8, "number", "bytes", "" },
    { "rho", 88, 16, "scaled", "m/s", "", 0.000457770657, 0 },
    { "theta", 104, 16, "scaled", "rad", "", 9.58752644e-05, -3.14159265 },
    { "yaw", 120, 16, "scaled", "rad", "", 9.58752644e-05, -3.14159265 },
    { "angularVelocity", 136, 16, "scaled", "rad/s", "", 0.000958752644, -31.4159265 },
    { "cameraYaw", 152, 16, "scaled", "rad", "", 9.58752644e-05, -3.14159265 },
    { "wheelSpeedRef1", 168, 16, "scaled", "rad/s", "", 0.0305180438, -1000 },
    { "wheelSpeedRef2", 184, 16, "scaled", "rad/s", "", 0.0305180438, -1000 },
    { "wheelSpeedRef3", 200, 16, "scaled", "rad/s", "", 0.0305180438, -1000 },
    { "wheelSpeedRef4", 216, 16, "scaled", "rad/s", "", 0.0305180438, -1000 },
    { "wheelPWM1", 232, 16, "scaled", "", "", 3.05180438e-05, -1 },
    { "wheelPWM2", 248, 16, "scaled", "", "", 3.05180438e-05, -1 },
    { "wheelPWM3", 264, 16, "scaled", "", "", 3.05180438e-05, -1 },
    { "wheelPWM4", 280, 16, "scaled", "", "", 3.05180438e-05, -1 },
    { "useWheelSpeedRef", 296, 1, "number", "", "" },
    { "useWheelPWMRef", 297, 1, "number", "", "" },
    { "doKick", 298, 1, "number", "", "" },
    { "doChip", 299, 1, "number", "", "" },
    { "kickAtAngle", 300, 1, "number", "", "" },
    { "doForce", 301, 1, "number", "", "" },
    { "wheelsOff", 302, 1, "number", "", "" },
    { "feedback", 303, 1, "number", "", "" },
    { "kickChipPower", 304, 8, "scaled", "m/s", "", 0.0313725509, 0 },
    { "reboot", 312, 1, "number", "", "" },
    { "useCameraYaw", 313, 1, "number", "", "" },
    { "useAbsoluteYaw", 314, 1, "number", "", "" },
    { "unused", 315, 5, "number", "", "" },
    { "dribblerOn", 320, 1, "number", "", "" },
    { "dribblerOption1", 321, 1, "number", "", "" },
    { "dribblerOption2", 322, 1, "number", "", "" },
    { "dribblerOption3", 323, 1, "number", "", "" },
    { "dribblerOption4", 324, 1, "number", "", "" },
    { "dribblerOption5", 325, 1, "number", "", "" },
    { "dribblerOption6", 326, 1, "number", "", "" },
    { "sendStateInfo", 327, 1, "number", "", "" },
  } },
  { name = "REM_RobotFeedback", size = 28, types = { { 0, 8, 39 } }, fields = {
    { "packetType", 0, 8, "number", "", "" },
    { "toRobotId", 8, 4, "number", "", "" },
    { "toColor", 12, 1, "number", "", "" },
    { "toBC", 13, 1, "number", "", "" },
    { "toBS", 14, 1, "number", "", "" },
    { "toPC", 15, 1, "number", "", "" },
    { "fromRobotId", 16, 4, "number", "", "" },
    { "fromColor", 20, 1, "number", "", "" },
    { "reserved", 21, 1, "number", "", "" },
    { "fromBS", 22, 1, "number", "", "" },
    { "fromPC", 23, 1, "number", "", "" },
    { "remVersion", 24, 4, "number", "", "" },
    { "messageId", 28, 4, "number", "", "" },
    { "timestamp", 32, 48, "number", "ms", "" },
    { "payloadSize", 80, 8, "number", "bytes", "" },
    { "rho", 88, 16, "scaled", "m/s", "", 0.000457770657, 0 },
    { "theta", 104, 16, "scaled", "rad", "", 9.58752644e-05, -3.14159265 },
    { "yaw", 120, 16, "scaled", "rad", "", 9.58752644e-05, -3.14159265 },
    { "batteryLevel", 136, 16, "scaled", "V", "", 0.000228885328, 15 },
    { "XsensCalibrated", 152, 1, "number", "", "" },
    { "ballSensorWorking", 153, 1, "number", "", "" },
    { "ballSensorSeesBall", 154, 1, "number", "", "" },
    { "dribblerSeesBall", 155, 1, "number", "", "" },
    { "kickerFault", 156, 1, "number", "", "" },
    { "kickerOn", 157, 1, "number", "", "" },
    { "capacitorCharged", 158, 1, "number", "", "" },
    { "reserved1", 159, 1, "number", "", "" },
    { "kickerVoltage", 160, 10, "number", "V", "" },
    { "filler", 170, 54, "number", "", "" },
  } },
  { name = "REM_RobotStateInfo", size = 99, types = { { 0, 8, 40 } }, fields = {
    { "packetType", 0, 8, "number", "", "" },
    { "toRobotId", 8, 4, "number", "", "" },
    { "toColor", 12, 1, "number", "", "" },
    { "toBC", 13, 1, "number", "", "" },
    { "toBS", 14, 1, "number", "", "" },
    { "toPC", 15, 1, "number", "", "" },
    { "fromRobotId", 16, 4, "number", "", "" },
    { "fromColor", 20, 1, "number", "", "" },
    { "reserved", 21, 1, "number", "", "" },
    { "fromBS", 22, 1, "number", "", "" },
    { "fromPC", 23, 1, "number", "", "" },
    { "remVersion", 24, 4, "number", "", "" },
    { "messageId", 28, 4, "number", "", "" },
    { "timestamp", 32, 48, "number", "ms", "" },
    { "payloadSize", 80, 8, "number", "bytes", "" },
    { "xsensAcc1", 88, 16, "scaled", "m/s^2", "", 0.00305180438, -100 },
    { "xsensAcc2", 104, 16, "scaled", "m/s^2", "", 0.00305180438, -100 },
    { "xsensYaw", 120, 32, "scaled", "rad", "", 2.32830644e-05, -50000 },
    { "rateOfTurn", 152, 16, "scaled", "rad/s", "", 0.000610360876, -20 },
    { "wheelSpeed1", 168, 16, "scaled", "rad/s", "", 0.0305180438, -1000 },
    { "wheelSpeed2", 184, 16, "scaled", "rad/s", "", 0.0305180438, -1000 },
    { "wheelSpeed3", 200, 16, "scaled", "rad/s", "", 0.0305180438, -1000 },
    { "wheelSpeed4", 216, 16, "scaled", "rad/s", "", 0.0305180438, -1000 },
    { "dribbleSpeed", 232, 16, "scaled", "rad/s", "", 0.0762951076, 0 },
    { "filteredDribbleSpeed", 248, 16, "scaled", "rad/s", "", 0.0762951076, 0 },
    { "dribblespeedBeforeGotBall", 264, 16, "scaled", "rad/s", "", 0.0762951076, 0 },
    { "bodyXIntegral", 280, 16, "scaled", "", "", 0.00610360876, -200 },
    { "bodyYIntegral", 296, 16, "scaled", "", "", 0.00610360876, -200 },
    { "bodyWIntegral", 312, 16, "scaled", "", "", 0.00610360876, -200 },
    { "bodyYawIntegral", 328, 16, "scaled", "", "", 0.000305180438, -10 },
    { "wheel1Integral", 344, 16, "scaled", "", "", 0.0305180438, -1000 },
    { "wheel2Integral", 360, 16, "scaled", "", "", 0.0305180438, -1000 },
    { "wheel3Integral", 376, 16, "scaled", "", "", 0.0305180438, -1000 },
    { "wheel4Integral", 392, 16, "scaled", "", "", 0.0305180438, -1000 },
    { "wheelSpeedRef1", 408, 16, "scaled", "rad/s", "", 0.0305180438, -1000 },
    { "wheelSpeedRef2", 424, 16, "scaled", "rad/s", "", 0.0305180438, -1000 },
    { "wheelSpeedRef3", 440, 16, "scaled", "rad/s", "", 0.0305180438, -1000 },
    { "wheelSpeedRef4", 456, 16, "scaled", "rad/s", "", 0.0305180438, -1000 },
    { "wheelController_1", 472, 16, "scaled", "", "", 3.05180438e-05, -1 },
    { "wheelController_2", 488, 16, "scaled", "", "", 3.05180438e-05, -1 },
    { "wheelController_3", 504, 16, "scaled", "", "", 3.05180438e-05, -1 },
    { "wheelController_4", 520, 16, "scaled", "", "", 3.05180438e-05, -1 },
    { "bodyController_u", 536, 16, "scaled", "", "", 0.00305180438, -100 },
    { "bodyController_v", 552, 16, "scaled", "", "", 0.00305180438, -100 },
    { "bodyController_w", 568, 16, "scaled", "", "", 0.00305180438, -100 },
    { "bodyController_yaw", 584, 16, "scaled", "", "", 0.00305180438, -100 },
    { "bodyControllerRef_u", 600, 16, "scaled", "m/s", "", 0.00305180438, -100 },
    { "bodyControllerRef_v", 616, 16, "scaled", "m/s", "", 0.00305180438, -100 },
    { "bodyControllerRef_w", 632, 16, "scaled", "rad/s", "", 0.00305180438, -100 },
    { "bodyControllerRef_yaw", 648, 16, "scaled", "rad", "", 0.00305180438, -100 },
    { "wheelSpeedDerivativeFiltered1", 664, 16, "scaled", "rad/s^2", "", 0.0305180438, -1000 },
    { "wheelSpeedDerivativeFiltered2", 680, 16, "scaled", "rad/s^2", "", 0.0305180438, -1000 },
    { "wheelSpeedDerivativeFiltered3", 696, 16, "scaled", "rad/s^2", "", 0.0305180438, -1000 },
    { "wheelSpeedDerivativeFiltered4", 712, 16, "scaled", "rad/s^2", "", 0.0305180438, -1000 },
    { "bodyXDerivativeFiltered", 728, 16, "scaled", "m/s^2", "", 0.00305180438, -100 },
    { "bodyYDerivativeFiltered", 744, 16, "scaled", "m/s^2", "", 0.00305180438, -100 },
    { "bodyZDerivativeFiltered", 760, 16, "scaled", "m/s^2", "", 0.00305180438, -100 },
    { "bodyYawDerivativeFiltered", 776, 16, "scaled", "rad/s", "", 0.00305180438, -100 },
  } },
  { name = "REM_RobotBuzzer", size = 15, types = { { 0, 8, 43 } }, fields = {
    { "packetType", 0, 8, "number", "", "" },
    { "toRobotId", 8, 4, "number", "", "" },
    { "toColor", 12, 1, "number", "", "" },
    { "toBC", 13, 1, "number", "", "" },
    { "toBS", 14, 1, "number", "", "" },
    { "toPC", 15, 1, "number", "", "" },
    { "fromRobotId", 16, 4, "number", "", "" },
    { "fromColor", 20, 1, "number", "", "" },
    { "reserved", 21, 1, "number", "", "" },
    { "fromBS", 22, 1, "number", "", "" },
    { "fromPC", 23, 1, "number", "", "" },
    { "remVersion", 24, 4, "number", "", "" },
    { "messageId", 28, 4, "number", "", "" },
    { "timestamp", 32, 48, "number", "ms", "" },
    { "payloadSize", 80, 8, "number", "bytes", "" },
    { "period", 88, 12, "number", "", "" },
    { "duration", 100, 16, "scaled", "s", "", 7.62951095e-05, 0 },
    { "padding", 116, 4, "number", "", "" },
  } },
  { name = "REM_Log", size = 11, types = { { 0, 8, 45 } }, text_size_at = 10, fields = {
    { "packetType", 0, 8, "number", "", "" },
    { "toRobotId", 8, 4, "number", "", "" },
    { "toColor", 12, 1, "number", "", "" },
    { "toBC", 13, 1, "number", "", "" },
    { "toBS", 14, 1, "number", "", "" },
    { "toPC", 15, 1, "number", "", "" },
    { "fromRobotId", 16, 4, "number", "", "" },
    { "fromColor", 20, 1, "number", "", "" },
    { "reserved", 21, 1, "number", "", "" },
    { "fromBS", 22, 1, "number", "", "" },
    { "fromPC", 23, 1, "number", "", "" },
    { "remVersion", 24, 4, "number", "", "" },
    { "messageId", 28, 4, "number", "", "" },
    { "timestamp", 32, 48, "number", "ms", "" },
    { "payloadSize", 80, 8, "number", "bytes", "" },
  } },
  { name = "REM_BasestationGetConfiguration", size = 11, types = { { 0, 8, 46 } }, fields = {
    { "packetType", 0, 8, "number", "", "" },
    { "toRobotId", 8, 4, "number", "", "" },
    { "toColor", 12, 1, "number", "", "" },
    { "toBC", 13, 1, "number", "", "" },
    { "toBS", 14, 1, "number", "", "" },
    { "toPC", 15, 1, "number", "", "" },
    { "fromRobotId", 16, 4, "number", "", "" },
    { "fromColor", 20, 1, "number", "", "" },
    { "reserved", 21, 1, "number", "", "" },
    { "fromBS", 22, 1, "number", "", "" },
    { "fromPC", 23, 1, "number", "", "" },
    { "remVersion", 24, 4, "number", "", "" },
    { "messageId", 28, 4, "number", "", "" },
    { "timestamp", 32, 48, "number", "ms", "" },
    { "payloadSize", 80, 8, "number", "bytes", "" },
  } },
  { name = "REM_BasestationConfiguration", size = 12, types = { { 0, 8, 48 } }, fields = {
    { "packetType", 0, 8, "number", "", "" },
    { "toRobotId", 8, 4, "number", "", "" },
    { "toColor", 12, 1, "number", "", "" },
    { "toBC", 13, 1, "number", "", "" },
    { "toBS", 14, 1, "number", "", "" },
    { "toPC", 15, 1, "number", "", "" },
    { "fromRobotId", 16, 4, "number", "", "" },
    { "fromColor", 20, 1, "number", "", "" },
    { "reserved", 21, 1, "number", "", "" },
    { "fromBS", 22, 1, "number", "", "" },
    { "fromPC", 23, 1, "number", "", "" },
    { "remVersion", 24, 4, "number", "", "" },
    { "messageId", 28, 4, "number", "", "" },
    { "timestamp", 32, 48, "number", "ms", "" },
    { "payloadSize", 80, 8, "number", "bytes", "" },
    { "channel", 88, 1, "number", "", "" },
    { "padding", 89, 7, "number", "", "" },
  } },
  { name = "REM_RobotGetPIDGains", size = 11, types = { { 0, 8, 51 } }, fields = {
    { "packetType", 0, 8, "number", "", "" },
    { "toRobotId", 8, 4, "number", "", "" },
    { "toColor", 12, 1, "number", "", "" },
    { "toBC", 13, 1, "number", "", "" },
    { "toBS", 14, 1, "number", "", "" },
    { "toPC", 15, 1, "number", "", "" },
    { "fromRobotId", 16, 4, "number", "", "" },
    { "fromColor", 20, 1, "number", "", "" },
    { "reserved", 21, 1, "number", "", "" },
    { "fromBS", 22, 1, "number", "", "" },
    { "fromPC", 23, 1, "number", "", "" },
    { "remVersion", 24, 4, "number", "", "" },
    { "messageId", 28, 4, "number", "", "" },
    { "timestamp", 32, 48, "number", "ms", "" },
    { "payloadSize", 80, 8, "number", "bytes", "" },
  } },
  { name = "REM_RobotPIDGains", size = 49, types = { { 0, 8, 53 } }, fields = {
    { "packetType", 0, 8, "number", "", "" },
    { "toRobotId", 8, 4, "number", "", "" },
    { "toColor", 12, 1, "number", "", "" },
    { "toBC", 13, 1, "number", "", "" },
    { "toBS", 14, 1, "number", "", "" },
    { "toPC", 15, 1, "number", "", "" },
    { "fromRobotId", 16, 4, "number", "", "" },
    { "fromColor", 20, 1, "number", "", "" },
    { "reserved", 21, 1, "number", "", "" },
    { "fromBS", 22, 1, "number", "", "" },
    { "fromPC", 23, 1, "number", "", "" },
    { "remVersion", 24, 4, "number", "", "" },
    { "messageId", 28, 4, "number", "", "" },
    { "timestamp", 32, 48, "number", "ms", "" },
    { "payloadSize", 80, 8, "number", "bytes", "" },
    { "PbodyX", 88, 16, "scaled", "", "", 0.00152590219, 0 },
    { "IbodyX", 104, 16, "scaled", "", "", 0.00152590219, 0 },
    { "DbodyX", 120, 16, "scaled", "", "", 0.00152590219, 0 },
    { "DbodyX2", 136, 16, "scaled", "", "", 0.00152590219, 0 },
    { "PbodyY", 152, 16, "scaled", "", "", 0.00152590219, 0 },
    { "IbodyY", 168, 16, "scaled", "", "", 0.00152590219, 0 },
    { "DbodyY", 184, 16, "scaled", "", "", 0.00152590219, 0 },
    { "DbodyY2", 200, 16, "scaled", "", "", 0.00152590219, 0 },
    { "PbodyW", 216, 16, "scaled", "", "", 0.00152590219, 0 },
    { "IbodyW", 232, 16, "scaled", "", "", 0.00152590219, 0 },
    { "DbodyW", 248, 16, "scaled", "", "", 0.00152590219, 0 },
    { "DbodyW2", 264, 16, "scaled", "", "", 0.00152590219, 0 },
    { "PbodyYaw", 280, 16, "scaled", "", "", 0.00152590219, 0 },
    { "IbodyYaw", 296, 16, "scaled", "", "", 0.00152590219, 0 },
    { "DbodyYaw", 312, 16, "scaled", "", "", 0.00152590219, 0 },
    { "DbodyYaw2", 328, 16, "scaled", "", "", 0.00152590219, 0 },
    { "Pwheels", 344, 16, "scaled", "", "", 0.00152590219, 0 },
    { "Iwheels", 360, 16, "scaled", "", "", 0.00152590219, 0 },
    { "Dwheels", 376, 16, "scaled", "", "", 0.00152590219, 0 },
  } },
  { name = "REM_RobotSetPIDGains", size = 67, types = { { 0, 8, 54 } }, fields = {
    { "packetType", 0, 8, "number", "", "" },
    { "toRobotId", 8, 4, "number", "", "" },
    { "toColor", 12, 1, "number", "", "" },
    { "toBC", 13, 1, "number", "", "" },
    { "toBS", 14, 1, "number", "", "" },
    { "toPC", 15, 1, "number", "", "" },
    { "fromRobotId", 16, 4, "number", "", "" },
    { "fromColor", 20, 1, "number", "", "" },
    { "reserved", 21, 1, "number", "", "" },
    { "fromBS", 22, 1, "number", "", "" },
    { "fromPC", 23, 1, "number", "", "" },
    { "remVersion", 24, 4, "number", "", "" },
    { "messageId", 28, 4, "number", "", "" },
    { "timestamp", 32, 48, "number", "ms", "" },
    { "payloadSize", 80, 8, "number", "bytes", "" },
    { "PbodyX", 88, 16, "scaled", "", "", 0.00152590219, 0 },
    { "IbodyX", 104, 16, "scaled", "", "", 0.00152590219, 0 },
    { "DbodyX", 120, 16, "scaled", "", "", 0.00152590219, 0 },
    { "DbodyX2", 136, 16, "scaled", "", "", 0.00152590219, 0 },
    { "PbodyY", 152, 16, "scaled", "", "", 0.00152590219, 0 },
    { "IbodyY", 168, 16, "scaled", "", "", 0.00152590219, 0 },
    { "DbodyY", 184, 16, "scaled", "", "", 0.00152590219, 0 },
    { "DbodyY2", 200, 16, "scaled", "", "", 0.00152590219, 0 },
    { "PbodyW", 216, 16, "scaled", "", "", 0.00152590219, 0 },
    { "IbodyW", 232, 16, "scaled", "", "", 0.00152590219, 0 },
    { "DbodyW", 248, 16, "scaled", "", "", 0.00152590219, 0 },
    { "DbodyW2", 264, 16, "scaled", "", "", 0.00152590219, 0 },
    { "PbodyYaw", 280, 16, "scaled", "", "", 0.00152590219, 0 },
    { "IbodyYaw", 296, 16, "scaled", "", "", 0.00152590219, 0 },
    { "DbodyYaw", 312, 16, "scaled", "", "", 0.00152590219, 0 },
    { "DbodyYaw2", 328, 16, "scaled", "", "", 0.00152590219, 0 },
    { "Pwheels", 344, 16, "scaled", "", "", 0.00152590219, 0 },
    { "Iwheels", 360, 16, "scaled", "", "", 0.00152590219, 0 },
    { "Dwheels", 376, 16, "scaled", "", "", 0.00152590219, 0 },
    { "boolean1", 392, 1, "number", "", "" },
    { "boolean2", 393, 1, "number", "", "" },
    { "boolean3", 394, 1, "number", "", "" },
    { "boolean4", 395, 1, "number", "", "" },
    { "boolean5", 396, 1, "number", "", "" },
    { "boolean6", 397, 1, "number", "", "" },
    { "boolean7", 398, 1, "number", "", "" },
    { "boolean8", 399, 1, "number", "", "" },
    { "boolean9", 400, 1, "number", "", "" },
    { "boolean10", 401, 1, "number", "", "" },
    { "boolean11", 402, 1, "number", "", "" },
    { "boolean12", 403, 1, "number", "", "" },
    { "boolean13", 404, 1, "number", "", "" },
    { "boolean14", 405, 1, "number", "", "" },
    { "boolean15", 406, 1, "number", "", "" },
    { "boolean16", 407, 1, "number", "", "" },
    { "unlabel1", 408, 16, "scaled", "", "", 0.016784925, -1000 },
    { "unlabel2", 424, 16, "scaled", "", "", 0.016784925, -1000 },
    { "unlabel3", 440, 16, "scaled", "", "", 0.016784925, -1000 },
    { "unlabel4", 456, 16, "scaled", "", "", 0.016784925, -1000 },
    { "unlabel5", 472, 16, "scaled", "", "", 0.016784925, -1000 },
    { "unlabel6", 488, 16, "scaled", "", "", 0.016784925, -1000 },
    { "unlabel7", 504, 16, "scaled", "", "", 0.016784925, -1000 },
    { "unlabel8", 520, 16, "scaled", "", "", 0.016784925, -1000 },
  } },
  { name = "REM_RobotAssuredPacket", size = 13, types = { { 0, 8, 57 } }, fields = {
    { "packetType", 0, 8, "number", "", "" },
    { "toRobotId", 8, 4, "number", "", "" },
    { "toColor", 12, 1, "number", "", "" },
    { "toBC", 13, 1, "number", "", "" },
    { "toBS", 14, 1, "number", "", "" },
    { "toPC", 15, 1, "number", "", "" },
    { "fromRobotId", 16, 4, "number", "", "" },
    { "fromColor", 20, 1, "number", "", "" },
    { "reserved", 21, 1, "number", "", "" },
    { "fromBS", 22, 1, "number", "", "" },
    { "fromPC", 23, 1, "number", "", "" },
    { "remVersion", 24, 4, "number", "", "" },
    { "messageId", 28, 4, "number", "", "" },
    { "timestamp", 32, 48, "number", "ms", "" },
    { "payloadSize", 80, 8, "number", "bytes", "" },
    { "sequenceNumber", 88, 8, "number", "", "" },
    { "messageLength", 96, 8, "number", "bytes", "" },
  } },
  { name = "REM_RobotAssuredAck", size = 12, types = { { 0, 8, 58 } }, fields = {
    { "packetType", 0, 8, "number", "", "" },
    { "toRobotId", 8, 4, "number", "", "" },
    { "toColor", 12, 1, "number", "", "" },
    { "toBC", 13, 1, "number", "", "" },
    { "toBS", 14, 1, "number", "", "" },
    { "toPC", 15, 1, "number", "", "" },
    { "fromRobotId", 16, 4, "number", "", "" },
    { "fromColor", 20, 1, "number", "", "" },
    { "reserved", 21, 1, "number", "", "" },
    { "fromBS", 22, 1, "number", "", "" },
    { "fromPC", 23, 1, "number", "", "" },
    { "remVersion", 24, 4, "number", "", "" },
    { "messageId", 28, 4, "number", "", "" },
    { "timestamp", 32, 48, "number", "ms", "" },
    { "payloadSize", 80, 8, "number", "bytes", "" },
    { "sequenceNumber", 88, 8, "number", "", "" },
  } },
  { name = "REM_RobotMusicCommand", size = 14, types = { { 0, 8, 60 } }, fields = {
    { "packetType", 0, 8, "number", "", "" },
    { "toRobotId", 8, 4, "number", "", "" },
    { "toColor", 12, 1, "number", "", "" },
    { "toBC", 13, 1, "number", "", "" },
    { "toBS", 14, 1, "number", "", "" },
    { "toPC", 15, 1, "number", "", "" },
    { "fromRobotId", 16, 4, "number", "", "" },
    { "fromColor", 20, 1, "number", "", "" },
    { "reserved", 21, 1, "number", "", "" },
    { "fromBS", 22, 1, "number", "", "" },
    { "fromPC", 23, 1, "number", "", "" },
    { "remVersion", 24, 4, "number", "", "" },
    { "messageId", 28, 4, "number", "", "" },
    { "timestamp", 32, 48, "number", "ms", "" },
    { "payloadSize", 80, 8, "number", "bytes", "" },
    { "play", 88, 1, "number", "", "" },
    { "pause", 89, 1, "number", "", "" },
    { "stop", 90, 1, "number", "", "" },
    { "previousSong", 91, 1, "number", "", "" },
    { "nextSong", 92, 1, "number", "", "" },
    { "volume", 93, 5, "number", "", "" },
    { "volumeUp", 98, 1, "number", "", "" },
    { "volumeDown", 99, 1, "number", "", "" },
    { "folderId", 100, 4, "number", "", "" },
    { "songId", 104, 8, "number", "", "" },
  } },
  { name = "REM_SX1280Filler", size = 6, types = { { 0, 8, 63 } }, fields = {
    { "header", 0, 8, "number", "", "" },
    { "remVersion", 8, 4, "number", "", "" },
    { "fillerBits", 12, 36, "number", "", "" },
  } },
  { name = "REM_RobotKillCommand", size = 11, types = { { 0, 8, 65 } }, fields = {
    { "packetType", 0, 8, "number", "", "" },
    { "toRobotId", 8, 4, "number", "", "" },
    { "toColor", 12, 1, "number", "", "" },
    { "toBC", 13, 1, "number", "", "" },
    { "toBS", 14, 1, "number", "", "" },
    { "toPC", 15, 1, "number", "", "" },
    { "fromRobotId", 16, 4, "number", "", "" },
    { "fromColor", 20, 1, "number", "", "" },
    { "reserved", 21, 1, "number", "", "" },
    { "fromBS", 22, 1, "number", "", "" },
    { "fromPC", 23, 1, "number", "", "" },
    { "remVersion", 24, 4, "number", "", "" },
    { "messageId", 28, 4, "number", "", "" },
    { "timestamp", 32, 48, "number", "ms", "" },
    { "payloadSize", 80, 8, "number", "bytes", "" },
  } },
}

local protocol_fields = {}
for _, packet in ipairs(packets) do
  for _, row in ipairs(packet.fields) do
    local filter = PROTOCOL .. "." .. packet.name .. "." .. row[1]:gsub("[^%w_]+", "_")
    local label = row[1] .. (row[5] ~= "" and " (" .. row[5] .. ")" or "")
    local make = row[4] == "float" and ProtoField.float or row[4] == "scaled" and ProtoField.double
      or row[6] ~= "" and (row[3] > 32 and ProtoField.int64 or ProtoField.int32)
      or row[3] > 32 and ProtoField.uint64 or ProtoField.uint32
    row.field = make(filter, label)
    protocol_fields[#protocol_fields + 1] = row.field
  end
end
proto.fields = protocol_fields

local fault = ProtoExpert.new(PROTOCOL .. ".fault", "Refused packet", expert.group.MALFORMED, expert.severity.ERROR)
proto.experts = { fault }

-- Content of some bits: a number, or a UInt64 above 32 bits.
local function raw_of(range, first, bits, lsb_first)
  if not lsb_first then return range:bitfield(first, bits) end
  if first % 8 == 0 and bits % 8 == 0 and bits > 32 then return range(first / 8, bits / 8):le_uint64() end
  local value, weight = 0, 1
  for bit = first, first + bits - 1 do
    local byte = range(math.floor(bit / 8), 1):uint()
    value = value + weight * (math.floor(byte / 2 ^ (bit % 8)) % 2)
    weight = weight * 2
  end
  return value
end

-- The integer in a field, with its sign.
local function integer_of(range, row, lsb_first)
  local first, bits, sign = row[2], row[3], row[6]
  if sign ~= "" and bits > 32 then
    local bytes = range(math.floor(first / 8), bits / 8)
    return lsb_first and bytes:le_int64() or bytes:int64()
  end
  local raw = raw_of(range, first, bits, lsb_first)
  if sign == "" or raw < 2 ^ (bits - 1) then return raw end
  return sign == "signed" and raw - 2 ^ bits or 2 ^ (bits - 1) - raw
end

local function add_field(tree, range, row, lsb_first)
  local first, last = math.floor(row[2] / 8), math.floor((row[2] + row[3] - 1) / 8)
  local bytes = range(first, last - first + 1)
  if row[4] == "float" then
    if lsb_first then tree:add_le(row.field, bytes) else tree:add(row.field, bytes) end
  elseif row[4] == "scaled" then
    local count = integer_of(range, row, lsb_first)
    if count ~= row.none then tree:add(row.field, bytes, count * row[7] + row[8]) end
  else
    tree:add(row.field, bytes, integer_of(range, row, lsb_first))
  end
end

local function has_types_of(packet, range)
  for _, row in ipairs(packet.types) do
    if row[1] + row[2] > 8 * range:len() then return false end
    if raw_of(range, row[1], row[2], packet.lsb_first) ~= row[3] then return false end
  end
  return true
end

-- The packet that begins here: its type fields hold their code; of several, the one of this length.
local function packet_at(range)
  local found = nil
  for _, packet in ipairs(packets) do
    if has_types_of(packet, range) then
      if packet.size == range:len() then return packet end
      if not found and #packet.types > 0 then found = packet end
    end
  end
  return found
end

-- The fields of this packet; answers its length.
local function add_fields(tree, packet, range, pinfo)
  local size = packet.size
  if packet.text_size_at then
    size = math.max(size, math.min(range:len(), range(packet.text_size_at, 1):uint()))
  end
  local branch = tree:add(proto, range(0, size), packet.name)
  local contents = {}
  for _, row in ipairs(packet.fields) do
    if not row.only_if or contents[row.only_if] ~= 0 then add_field(branch, range, row, packet.lsb_first) end
    if row[3] <= 32 then contents[row[1]] = raw_of(range, row[2], row[3], packet.lsb_first) end
  end
  if size > packet.size then
    local text = range(packet.size, size - packet.size)
    branch:add(text, "text: " .. text:string())
  end
  pinfo.cols.info:append(" " .. packet.name)
  return size
end

-- One packet without framing; answers its length, 0 where no packet starts like this.
local function add_packet(tree, range, pinfo)
  local packet = packet_at(range)
  if not packet or range:len() < packet.size then
    tree:add(proto, range):add_proto_expert_info(fault, packet and "too short" or "unknown type")
    return 0
  end
  return add_fields(tree, packet, range, pinfo)
end

function proto.dissector(buffer, pinfo, tree)
  pinfo.cols.protocol = PROTOCOL
  local at = 0
  while at < buffer:len() do
    local size = add_packet(tree, buffer(at), pinfo)
    if size == 0 then return end
    at = at + size
  end
end

-- Chosen with "Decode As": a UDP port, or the link type USER 0 of a capture of serial bytes.
DissectorTable.get("udp.port"):add_for_decode_as(proto)
DissectorTable.get("wtap_encap"):add(wtap.USER0, proto)

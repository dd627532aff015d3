-- Wireshark dissector of RoboTeam Twente REM, version 5. Generated from the packet tables by
-- `omnihil formats roboteam-rem-v5 --wireshark`; do not edit.
local PROTOCOL = "roboteam_rem_v5"
local proto = Proto(PROTOCOL, "RoboTeam Twente REM, version 5")

-- name, bytes, types: { first bit, bits, content }, fields: { name, first bit, bits, kind, unit, sign, of a scaled one the unit per count and the value at 0 }
local packets = {
  { name = "REM_Packet", size = 10, types = { { 0, 8, 33 } }, fields = {
    { "header", 0, 8, "number", "", "" },
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
    { "timestamp", 32, 40, "number", "10 ms", "" },
    { "payloadSize", 72, 8, "number", "bytes", "" },
  } },
  { name = "REM_RobotCommand", size = 22, types = { { 0, 8, 34 } }, fields = {
    { "header", 0, 8, "number", "", "" },
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
    { "timestamp", 32, 40, "number", "10 ms", "" },
    { "payloadSize", 72, 8, "number", "bytes", "" },
    { "rho", 80, 16, "scaled", "m/s", "", 0.000122072175, 0 },
    { "theta", 96, 16, "scaled", "rad", "", 9.58752644e-05, -3.14159265 },
    { "angle", 112, 16, "scaled", "rad", "", 9.58752644e-05, -3.14159265 },
    { "angularVelocity", 128, 16, "scaled", "rad/s", "", 0.000383501058, -12.5663706 },
    { "cameraAngle", 144, 16, "scaled", "rad", "", 9.58752644e-05, -3.14159265 },
    { "useCameraAngle", 160, 1, "number", "", "" },
    { "useAbsoluteAngle", 161, 1, "number", "", "" },
    { "dribbler", 162, 3, "scaled", "", "", 0.142857149, 0 },
    { "doKick", 165, 1, "number", "", "" },
    { "doChip", 166, 1, "number", "", "" },
    { "kickAtAngle", 167, 1, "number", "", "" },
    { "kickChipPower", 168, 4, "scaled", "m/s", "", 0.433333337, 0 },
    { "doForce", 172, 1, "number", "", "" },
    { "feedback", 173, 1, "number", "", "" },
    { "padding", 174, 2, "number", "", "" },
  } },
  { name = "REM_RobotFeedback", size = 20, types = { { 0, 8, 36 } }, fields = {
    { "header", 0, 8, "number", "", "" },
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
    { "timestamp", 32, 40, "number", "10 ms", "" },
    { "payloadSize", 72, 8, "number", "bytes", "" },
    { "rho", 80, 16, "scaled", "m/s", "", 0.000122072175, 0 },
    { "theta", 96, 16, "scaled", "rad", "", 9.58752644e-05, -3.14159265 },
    { "angle", 112, 16, "scaled", "rad", "", 9.58752644e-05, -3.14159265 },
    { "batteryLevel", 128, 4, "number", "", "" },
    { "XsensCalibrated", 132, 1, "number", "", "" },
    { "capacitorCharged", 133, 1, "number", "", "" },
    { "ballSensorWorking", 134, 1, "number", "", "" },
    { "ballSensorSeesBall", 135, 1, "number", "", "" },
    { "ballPos", 136, 4, "scaled", "", "", 0.0666666701, -0.5 },
    { "dribblerSeesBall", 140, 1, "number", "", "" },
    { "reserved1", 141, 3, "number", "", "" },
    { "wheelLocked", 144, 4, "number", "", "" },
    { "wheelBraking", 148, 4, "number", "", "" },
    { "rssi", 152, 8, "number", "", "" },
  } },
  { name = "REM_RobotStateInfo", size = 50, types = { { 0, 8, 39 } }, fields = {
    { "header", 0, 8, "number", "", "" },
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
    { "timestamp", 32, 40, "number", "10 ms", "" },
    { "payloadSize", 72, 8, "number", "bytes", "" },
    { "xsensAcc1", 80, 16, "scaled", "m/s^2", "", 0.00479011238, -156.96 },
    { "xsensAcc2", 96, 16, "scaled", "m/s^2", "", 0.00479011238, -156.96 },
    { "xsensYaw", 112, 32, "scaled", "rad", "", 2.32830644e-05, -50000 },
    { "rateOfTurn", 144, 16, "scaled", "rad/s", "", 0.000610360876, -20 },
    { "wheelSpeed1", 160, 16, "scaled", "rad/s", "", 0.0305180438, -1000 },
    { "wheelSpeed2", 176, 16, "scaled", "rad/s", "", 0.0305180438, -1000 },
    { "wheelSpeed3", 192, 16, "scaled", "rad/s", "", 0.0305180438, -1000 },
    { "wheelSpeed4", 208, 16, "scaled", "rad/s", "", 0.0305180438, -1000 },
    { "dribbleSpeed", 224, 16, "scaled", "rad/s", "", 0.0762951076, 0 },
    { "filteredDribbleSpeed", 240, 16, "scaled", "rad/s", "", 0.0762951076, 0 },
    { "dribblespeedBeforeGotBall", 256, 16, "scaled", "rad/s", "", 0.0762951076, 0 },
    { "bodyXIntegral", 272, 16, "scaled", "", "", 0.152590215, -5000 },
    { "bodyYIntegral", 288, 16, "scaled", "", "", 0.152590215, -5000 },
    { "bodyWIntegral", 304, 16, "scaled", "", "", 0.152590215, -5000 },
    { "bodyYawIntegral", 320, 16, "scaled", "", "", 0.152590215, -5000 },
    { "wheel1Integral", 336, 16, "scaled", "", "", 0.152590215, -5000 },
    { "wheel2Integral", 352, 16, "scaled", "", "", 0.152590215, -5000 },
    { "wheel3Integral", 368, 16, "scaled", "", "", 0.152590215, -5000 },
    { "wheel4Integral", 384, 16, "scaled", "", "", 0.152590215, -5000 },
  } },
  { name = "REM_RobotBuzzer", size = 14, types = { { 0, 8, 40 } }, fields = {
    { "header", 0, 8, "number", "", "" },
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
    { "timestamp", 32, 40, "number", "10 ms", "" },
    { "payloadSize", 72, 8, "number", "bytes", "" },
    { "period", 80, 12, "number", "", "" },
    { "duration", 92, 16, "scaled", "s", "", 7.62951095e-05, 0 },
    { "padding", 108, 4, "number", "", "" },
  } },
  { name = "REM_Log", size = 10, types = { { 0, 8, 43 } }, text_size_at = 9, fields = {
    { "header", 0, 8, "number", "", "" },
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
    { "timestamp", 32, 40, "number", "10 ms", "" },
    { "payloadSize", 72, 8, "number", "bytes", "" },
  } },
  { name = "REM_BasestationGetConfiguration", size = 10, types = { { 0, 8, 45 } }, fields = {
    { "header", 0, 8, "number", "", "" },
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
    { "timestamp", 32, 40, "number", "10 ms", "" },
    { "payloadSize", 72, 8, "number", "bytes", "" },
  } },
  { name = "REM_BasestationConfiguration", size = 11, types = { { 0, 8, 46 } }, fields = {
    { "header", 0, 8, "number", "", "" },
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
    { "timestamp", 32, 40, "number", "10 ms", "" },
    { "payloadSize", 72, 8, "number", "bytes", "" },
    { "channel", 80, 1, "number", "", "" },
    { "padding", 81, 7, "number", "", "" },
  } },
  { name = "REM_RobotGetPIDGains", size = 10, types = { { 0, 8, 48 } }, fields = {
    { "header", 0, 8, "number", "", "" },
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
    { "timestamp", 32, 40, "number", "10 ms", "" },
    { "payloadSize", 72, 8, "number", "bytes", "" },
  } },
  { name = "REM_RobotPIDGains", size = 40, types = { { 0, 8, 51 } }, fields = {
    { "header", 0, 8, "number", "", "" },
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
    { "timestamp", 32, 40, "number", "10 ms", "" },
    { "payloadSize", 72, 8, "number", "bytes", "" },
    { "PbodyX", 80, 16, "scaled", "", "", 0.000610360876, 0 },
    { "IbodyX", 96, 16, "scaled", "", "", 0.000305180438, 0 },
    { "DbodyX", 112, 16, "scaled", "", "", 0.000152590219, 0 },
    { "PbodyY", 128, 16, "scaled", "", "", 0.000610360876, 0 },
    { "IbodyY", 144, 16, "scaled", "", "", 0.000305180438, 0 },
    { "DbodyY", 160, 16, "scaled", "", "", 0.000152590219, 0 },
    { "PbodyW", 176, 16, "scaled", "", "", 0.000610360876, 0 },
    { "IbodyW", 192, 16, "scaled", "", "", 0.000305180438, 0 },
    { "DbodyW", 208, 16, "scaled", "", "", 0.000152590219, 0 },
    { "PbodyYaw", 224, 16, "scaled", "", "", 0.000610360876, 0 },
    { "IbodyYaw", 240, 16, "scaled", "", "", 0.000305180438, 0 },
    { "DbodyYaw", 256, 16, "scaled", "", "", 0.000152590219, 0 },
    { "Pwheels", 272, 16, "scaled", "", "", 0.000610360876, 0 },
    { "Iwheels", 288, 16, "scaled", "", "", 0.000305180438, 0 },
    { "Dwheels", 304, 16, "scaled", "", "", 0.000152590219, 0 },
  } },
  { name = "REM_RobotSetPIDGains", size = 40, types = { { 0, 8, 53 } }, fields = {
    { "header", 0, 8, "number", "", "" },
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
    { "timestamp", 32, 40, "number", "10 ms", "" },
    { "payloadSize", 72, 8, "number", "bytes", "" },
    { "PbodyX", 80, 16, "scaled", "", "", 0.000610360876, 0 },
    { "IbodyX", 96, 16, "scaled", "", "", 0.000305180438, 0 },
    { "DbodyX", 112, 16, "scaled", "", "", 0.000152590219, 0 },
    { "PbodyY", 128, 16, "scaled", "", "", 0.000610360876, 0 },
    { "IbodyY", 144, 16, "scaled", "", "", 0.000305180438, 0 },
    { "DbodyY", 160, 16, "scaled", "", "", 0.000152590219, 0 },
    { "PbodyW", 176, 16, "scaled", "", "", 0.000610360876, 0 },
    { "IbodyW", 192, 16, "scaled", "", "", 0.000305180438, 0 },
    { "DbodyW", 208, 16, "scaled", "", "", 0.000152590219, 0 },
    { "PbodyYaw", 224, 16, "scaled", "", "", 0.000610360876, 0 },
    { "IbodyYaw", 240, 16, "scaled", "", "", 0.000305180438, 0 },
    { "DbodyYaw", 256, 16, "scaled", "", "", 0.000152590219, 0 },
    { "Pwheels", 272, 16, "scaled", "", "", 0.000610360876, 0 },
    { "Iwheels", 288, 16, "scaled", "", "", 0.000305180438, 0 },
    { "Dwheels", 304, 16, "scaled", "", "", 0.000152590219, 0 },
  } },
  { name = "REM_RobotAssuredPacket", size = 12, types = { { 0, 8, 54 } }, fields = {
    { "header", 0, 8, "number", "", "" },
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
    { "timestamp", 32, 40, "number", "10 ms", "" },
    { "payloadSize", 72, 8, "number", "bytes", "" },
    { "sequenceNumber", 80, 8, "number", "", "" },
    { "messageLength", 88, 8, "number", "bytes", "" },
  } },
  { name = "REM_RobotAssuredAck", size = 11, types = { { 0, 8, 57 } }, fields = {
    { "header", 0, 8, "number", "", "" },
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
    { "timestamp", 32, 40, "number", "10 ms", "" },
    { "payloadSize", 72, 8, "number", "bytes", "" },
    { "sequenceNumber", 80, 8, "number", "", "" },
  } },
  { name = "REM_RobotMusicCommand", size = 13, types = { { 0, 8, 58 } }, fields = {
    { "header", 0, 8, "number", "", "" },
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
    { "timestamp", 32, 40, "number", "10 ms", "" },
    { "payloadSize", 72, 8, "number", "bytes", "" },
    { "play", 80, 1, "number", "", "" },
    { "pause", 81, 1, "number", "", "" },
    { "stop", 82, 1, "number", "", "" },
    { "previousSong", 83, 1, "number", "", "" },
    { "nextSong", 84, 1, "number", "", "" },
    { "volume", 85, 5, "number", "", "" },
    { "volumeUp", 90, 1, "number", "", "" },
    { "volumeDown", 91, 1, "number", "", "" },
    { "folderId", 92, 4, "number", "", "" },
    { "songId", 96, 8, "number", "", "" },
  } },
  { name = "REM_SX1280Filler", size = 6, types = { { 0, 8, 60 } }, fields = {
    { "header", 0, 8, "number", "", "" },
    { "remVersion", 8, 4, "number", "", "" },
    { "fillerBits", 12, 36, "number", "", "" },
  } },
  { name = "REM_RobotKillCommand", size = 10, types = { { 0, 8, 63 } }, fields = {
    { "header", 0, 8, "number", "", "" },
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
    { "timestamp", 32, 40, "number", "10 ms", "" },
    { "payloadSize", 72, 8, "number", "bytes", "" },
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

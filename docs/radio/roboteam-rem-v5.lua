-- Wireshark dissector of RoboTeam Twente REM, version 5. Generated from the packet tables by
-- `omnihil formats roboteam-rem-v5 --wireshark`; do not edit.
local PROTOCOL = "roboteam_rem_v5"
local TYPE_BYTE = 0
local proto = Proto(PROTOCOL, "RoboTeam Twente REM, version 5")

-- [type] = name, bytes, fields: { name, first bit, bits, kind, unit, scale and lowest value of a ranged one }
local packets = {
  [0x21] = { name = "REM_Packet", size = 10, fields = {
    { "header", 0, 8, "number", "" },
    { "toRobotId", 8, 4, "number", "" },
    { "toColor", 12, 1, "number", "" },
    { "toBC", 13, 1, "number", "" },
    { "toBS", 14, 1, "number", "" },
    { "toPC", 15, 1, "number", "" },
    { "fromRobotId", 16, 4, "number", "" },
    { "fromColor", 20, 1, "number", "" },
    { "reserved", 21, 1, "number", "" },
    { "fromBS", 22, 1, "number", "" },
    { "fromPC", 23, 1, "number", "" },
    { "remVersion", 24, 4, "number", "" },
    { "messageId", 28, 4, "number", "" },
    { "timestamp", 32, 40, "number", "10 ms" },
    { "payloadSize", 72, 8, "number", "bytes" },
  } },
  [0x22] = { name = "REM_RobotCommand", size = 22, fields = {
    { "header", 0, 8, "number", "" },
    { "toRobotId", 8, 4, "number", "" },
    { "toColor", 12, 1, "number", "" },
    { "toBC", 13, 1, "number", "" },
    { "toBS", 14, 1, "number", "" },
    { "toPC", 15, 1, "number", "" },
    { "fromRobotId", 16, 4, "number", "" },
    { "fromColor", 20, 1, "number", "" },
    { "reserved", 21, 1, "number", "" },
    { "fromBS", 22, 1, "number", "" },
    { "fromPC", 23, 1, "number", "" },
    { "remVersion", 24, 4, "number", "" },
    { "messageId", 28, 4, "number", "" },
    { "timestamp", 32, 40, "number", "10 ms" },
    { "payloadSize", 72, 8, "number", "bytes" },
    { "rho", 80, 16, "ranged", "m/s", 0.000122072175, 0 },
    { "theta", 96, 16, "ranged", "rad", 9.58752644e-05, -3.14159265 },
    { "angle", 112, 16, "ranged", "rad", 9.58752644e-05, -3.14159265 },
    { "angularVelocity", 128, 16, "ranged", "rad/s", 0.000383501058, -12.5663706 },
    { "cameraAngle", 144, 16, "ranged", "rad", 9.58752644e-05, -3.14159265 },
    { "useCameraAngle", 160, 1, "number", "" },
    { "useAbsoluteAngle", 161, 1, "number", "" },
    { "dribbler", 162, 3, "ranged", "", 0.142857149, 0 },
    { "doKick", 165, 1, "number", "" },
    { "doChip", 166, 1, "number", "" },
    { "kickAtAngle", 167, 1, "number", "" },
    { "kickChipPower", 168, 4, "ranged", "m/s", 0.433333337, 0 },
    { "doForce", 172, 1, "number", "" },
    { "feedback", 173, 1, "number", "" },
    { "padding", 174, 2, "number", "" },
  } },
  [0x24] = { name = "REM_RobotFeedback", size = 20, fields = {
    { "header", 0, 8, "number", "" },
    { "toRobotId", 8, 4, "number", "" },
    { "toColor", 12, 1, "number", "" },
    { "toBC", 13, 1, "number", "" },
    { "toBS", 14, 1, "number", "" },
    { "toPC", 15, 1, "number", "" },
    { "fromRobotId", 16, 4, "number", "" },
    { "fromColor", 20, 1, "number", "" },
    { "reserved", 21, 1, "number", "" },
    { "fromBS", 22, 1, "number", "" },
    { "fromPC", 23, 1, "number", "" },
    { "remVersion", 24, 4, "number", "" },
    { "messageId", 28, 4, "number", "" },
    { "timestamp", 32, 40, "number", "10 ms" },
    { "payloadSize", 72, 8, "number", "bytes" },
    { "rho", 80, 16, "ranged", "m/s", 0.000122072175, 0 },
    { "theta", 96, 16, "ranged", "rad", 9.58752644e-05, -3.14159265 },
    { "angle", 112, 16, "ranged", "rad", 9.58752644e-05, -3.14159265 },
    { "batteryLevel", 128, 4, "number", "" },
    { "XsensCalibrated", 132, 1, "number", "" },
    { "capacitorCharged", 133, 1, "number", "" },
    { "ballSensorWorking", 134, 1, "number", "" },
    { "ballSensorSeesBall", 135, 1, "number", "" },
    { "ballPos", 136, 4, "ranged", "", 0.0666666701, -0.5 },
    { "dribblerSeesBall", 140, 1, "number", "" },
    { "reserved1", 141, 3, "number", "" },
    { "wheelLocked", 144, 4, "number", "" },
    { "wheelBraking", 148, 4, "number", "" },
    { "rssi", 152, 8, "number", "" },
  } },
  [0x27] = { name = "REM_RobotStateInfo", size = 50, fields = {
    { "header", 0, 8, "number", "" },
    { "toRobotId", 8, 4, "number", "" },
    { "toColor", 12, 1, "number", "" },
    { "toBC", 13, 1, "number", "" },
    { "toBS", 14, 1, "number", "" },
    { "toPC", 15, 1, "number", "" },
    { "fromRobotId", 16, 4, "number", "" },
    { "fromColor", 20, 1, "number", "" },
    { "reserved", 21, 1, "number", "" },
    { "fromBS", 22, 1, "number", "" },
    { "fromPC", 23, 1, "number", "" },
    { "remVersion", 24, 4, "number", "" },
    { "messageId", 28, 4, "number", "" },
    { "timestamp", 32, 40, "number", "10 ms" },
    { "payloadSize", 72, 8, "number", "bytes" },
    { "xsensAcc1", 80, 16, "ranged", "m/s^2", 0.00479011238, -156.96 },
    { "xsensAcc2", 96, 16, "ranged", "m/s^2", 0.00479011238, -156.96 },
    { "xsensYaw", 112, 32, "ranged", "rad", 2.32830644e-05, -50000 },
    { "rateOfTurn", 144, 16, "ranged", "rad/s", 0.000610360876, -20 },
    { "wheelSpeed1", 160, 16, "ranged", "rad/s", 0.0305180438, -1000 },
    { "wheelSpeed2", 176, 16, "ranged", "rad/s", 0.0305180438, -1000 },
    { "wheelSpeed3", 192, 16, "ranged", "rad/s", 0.0305180438, -1000 },
    { "wheelSpeed4", 208, 16, "ranged", "rad/s", 0.0305180438, -1000 },
    { "dribbleSpeed", 224, 16, "ranged", "rad/s", 0.0762951076, 0 },
    { "filteredDribbleSpeed", 240, 16, "ranged", "rad/s", 0.0762951076, 0 },
    { "dribblespeedBeforeGotBall", 256, 16, "ranged", "rad/s", 0.0762951076, 0 },
    { "bodyXIntegral", 272, 16, "ranged", "", 0.152590215, -5000 },
    { "bodyYIntegral", 288, 16, "ranged", "", 0.152590215, -5000 },
    { "bodyWIntegral", 304, 16, "ranged", "", 0.152590215, -5000 },
    { "bodyYawIntegral", 320, 16, "ranged", "", 0.152590215, -5000 },
    { "wheel1Integral", 336, 16, "ranged", "", 0.152590215, -5000 },
    { "wheel2Integral", 352, 16, "ranged", "", 0.152590215, -5000 },
    { "wheel3Integral", 368, 16, "ranged", "", 0.152590215, -5000 },
    { "wheel4Integral", 384, 16, "ranged", "", 0.152590215, -5000 },
  } },
  [0x28] = { name = "REM_RobotBuzzer", size = 14, fields = {
    { "header", 0, 8, "number", "" },
    { "toRobotId", 8, 4, "number", "" },
    { "toColor", 12, 1, "number", "" },
    { "toBC", 13, 1, "number", "" },
    { "toBS", 14, 1, "number", "" },
    { "toPC", 15, 1, "number", "" },
    { "fromRobotId", 16, 4, "number", "" },
    { "fromColor", 20, 1, "number", "" },
    { "reserved", 21, 1, "number", "" },
    { "fromBS", 22, 1, "number", "" },
    { "fromPC", 23, 1, "number", "" },
    { "remVersion", 24, 4, "number", "" },
    { "messageId", 28, 4, "number", "" },
    { "timestamp", 32, 40, "number", "10 ms" },
    { "payloadSize", 72, 8, "number", "bytes" },
    { "period", 80, 12, "number", "" },
    { "duration", 92, 16, "ranged", "s", 7.62951095e-05, 0 },
    { "padding", 108, 4, "number", "" },
  } },
  [0x2B] = { name = "REM_Log", size = 10, text_size_at = 9, fields = {
    { "header", 0, 8, "number", "" },
    { "toRobotId", 8, 4, "number", "" },
    { "toColor", 12, 1, "number", "" },
    { "toBC", 13, 1, "number", "" },
    { "toBS", 14, 1, "number", "" },
    { "toPC", 15, 1, "number", "" },
    { "fromRobotId", 16, 4, "number", "" },
    { "fromColor", 20, 1, "number", "" },
    { "reserved", 21, 1, "number", "" },
    { "fromBS", 22, 1, "number", "" },
    { "fromPC", 23, 1, "number", "" },
    { "remVersion", 24, 4, "number", "" },
    { "messageId", 28, 4, "number", "" },
    { "timestamp", 32, 40, "number", "10 ms" },
    { "payloadSize", 72, 8, "number", "bytes" },
  } },
  [0x2D] = { name = "REM_BasestationGetConfiguration", size = 10, fields = {
    { "header", 0, 8, "number", "" },
    { "toRobotId", 8, 4, "number", "" },
    { "toColor", 12, 1, "number", "" },
    { "toBC", 13, 1, "number", "" },
    { "toBS", 14, 1, "number", "" },
    { "toPC", 15, 1, "number", "" },
    { "fromRobotId", 16, 4, "number", "" },
    { "fromColor", 20, 1, "number", "" },
    { "reserved", 21, 1, "number", "" },
    { "fromBS", 22, 1, "number", "" },
    { "fromPC", 23, 1, "number", "" },
    { "remVersion", 24, 4, "number", "" },
    { "messageId", 28, 4, "number", "" },
    { "timestamp", 32, 40, "number", "10 ms" },
    { "payloadSize", 72, 8, "number", "bytes" },
  } },
  [0x2E] = { name = "REM_BasestationConfiguration", size = 11, fields = {
    { "header", 0, 8, "number", "" },
    { "toRobotId", 8, 4, "number", "" },
    { "toColor", 12, 1, "number", "" },
    { "toBC", 13, 1, "number", "" },
    { "toBS", 14, 1, "number", "" },
    { "toPC", 15, 1, "number", "" },
    { "fromRobotId", 16, 4, "number", "" },
    { "fromColor", 20, 1, "number", "" },
    { "reserved", 21, 1, "number", "" },
    { "fromBS", 22, 1, "number", "" },
    { "fromPC", 23, 1, "number", "" },
    { "remVersion", 24, 4, "number", "" },
    { "messageId", 28, 4, "number", "" },
    { "timestamp", 32, 40, "number", "10 ms" },
    { "payloadSize", 72, 8, "number", "bytes" },
    { "channel", 80, 1, "number", "" },
    { "padding", 81, 7, "number", "" },
  } },
  [0x30] = { name = "REM_RobotGetPIDGains", size = 10, fields = {
    { "header", 0, 8, "number", "" },
    { "toRobotId", 8, 4, "number", "" },
    { "toColor", 12, 1, "number", "" },
    { "toBC", 13, 1, "number", "" },
    { "toBS", 14, 1, "number", "" },
    { "toPC", 15, 1, "number", "" },
    { "fromRobotId", 16, 4, "number", "" },
    { "fromColor", 20, 1, "number", "" },
    { "reserved", 21, 1, "number", "" },
    { "fromBS", 22, 1, "number", "" },
    { "fromPC", 23, 1, "number", "" },
    { "remVersion", 24, 4, "number", "" },
    { "messageId", 28, 4, "number", "" },
    { "timestamp", 32, 40, "number", "10 ms" },
    { "payloadSize", 72, 8, "number", "bytes" },
  } },
  [0x33] = { name = "REM_RobotPIDGains", size = 40, fields = {
    { "header", 0, 8, "number", "" },
    { "toRobotId", 8, 4, "number", "" },
    { "toColor", 12, 1, "number", "" },
    { "toBC", 13, 1, "number", "" },
    { "toBS", 14, 1, "number", "" },
    { "toPC", 15, 1, "number", "" },
    { "fromRobotId", 16, 4, "number", "" },
    { "fromColor", 20, 1, "number", "" },
    { "reserved", 21, 1, "number", "" },
    { "fromBS", 22, 1, "number", "" },
    { "fromPC", 23, 1, "number", "" },
    { "remVersion", 24, 4, "number", "" },
    { "messageId", 28, 4, "number", "" },
    { "timestamp", 32, 40, "number", "10 ms" },
    { "payloadSize", 72, 8, "number", "bytes" },
    { "PbodyX", 80, 16, "ranged", "", 0.000610360876, 0 },
    { "IbodyX", 96, 16, "ranged", "", 0.000305180438, 0 },
    { "DbodyX", 112, 16, "ranged", "", 0.000152590219, 0 },
    { "PbodyY", 128, 16, "ranged", "", 0.000610360876, 0 },
    { "IbodyY", 144, 16, "ranged", "", 0.000305180438, 0 },
    { "DbodyY", 160, 16, "ranged", "", 0.000152590219, 0 },
    { "PbodyW", 176, 16, "ranged", "", 0.000610360876, 0 },
    { "IbodyW", 192, 16, "ranged", "", 0.000305180438, 0 },
    { "DbodyW", 208, 16, "ranged", "", 0.000152590219, 0 },
    { "PbodyYaw", 224, 16, "ranged", "", 0.000610360876, 0 },
    { "IbodyYaw", 240, 16, "ranged", "", 0.000305180438, 0 },
    { "DbodyYaw", 256, 16, "ranged", "", 0.000152590219, 0 },
    { "Pwheels", 272, 16, "ranged", "", 0.000610360876, 0 },
    { "Iwheels", 288, 16, "ranged", "", 0.000305180438, 0 },
    { "Dwheels", 304, 16, "ranged", "", 0.000152590219, 0 },
  } },
  [0x35] = { name = "REM_RobotSetPIDGains", size = 40, fields = {
    { "header", 0, 8, "number", "" },
    { "toRobotId", 8, 4, "number", "" },
    { "toColor", 12, 1, "number", "" },
    { "toBC", 13, 1, "number", "" },
    { "toBS", 14, 1, "number", "" },
    { "toPC", 15, 1, "number", "" },
    { "fromRobotId", 16, 4, "number", "" },
    { "fromColor", 20, 1, "number", "" },
    { "reserved", 21, 1, "number", "" },
    { "fromBS", 22, 1, "number", "" },
    { "fromPC", 23, 1, "number", "" },
    { "remVersion", 24, 4, "number", "" },
    { "messageId", 28, 4, "number", "" },
    { "timestamp", 32, 40, "number", "10 ms" },
    { "payloadSize", 72, 8, "number", "bytes" },
    { "PbodyX", 80, 16, "ranged", "", 0.000610360876, 0 },
    { "IbodyX", 96, 16, "ranged", "", 0.000305180438, 0 },
    { "DbodyX", 112, 16, "ranged", "", 0.000152590219, 0 },
    { "PbodyY", 128, 16, "ranged", "", 0.000610360876, 0 },
    { "IbodyY", 144, 16, "ranged", "", 0.000305180438, 0 },
    { "DbodyY", 160, 16, "ranged", "", 0.000152590219, 0 },
    { "PbodyW", 176, 16, "ranged", "", 0.000610360876, 0 },
    { "IbodyW", 192, 16, "ranged", "", 0.000305180438, 0 },
    { "DbodyW", 208, 16, "ranged", "", 0.000152590219, 0 },
    { "PbodyYaw", 224, 16, "ranged", "", 0.000610360876, 0 },
    { "IbodyYaw", 240, 16, "ranged", "", 0.000305180438, 0 },
    { "DbodyYaw", 256, 16, "ranged", "", 0.000152590219, 0 },
    { "Pwheels", 272, 16, "ranged", "", 0.000610360876, 0 },
    { "Iwheels", 288, 16, "ranged", "", 0.000305180438, 0 },
    { "Dwheels", 304, 16, "ranged", "", 0.000152590219, 0 },
  } },
  [0x36] = { name = "REM_RobotAssuredPacket", size = 12, fields = {
    { "header", 0, 8, "number", "" },
    { "toRobotId", 8, 4, "number", "" },
    { "toColor", 12, 1, "number", "" },
    { "toBC", 13, 1, "number", "" },
    { "toBS", 14, 1, "number", "" },
    { "toPC", 15, 1, "number", "" },
    { "fromRobotId", 16, 4, "number", "" },
    { "fromColor", 20, 1, "number", "" },
    { "reserved", 21, 1, "number", "" },
    { "fromBS", 22, 1, "number", "" },
    { "fromPC", 23, 1, "number", "" },
    { "remVersion", 24, 4, "number", "" },
    { "messageId", 28, 4, "number", "" },
    { "timestamp", 32, 40, "number", "10 ms" },
    { "payloadSize", 72, 8, "number", "bytes" },
    { "sequenceNumber", 80, 8, "number", "" },
    { "messageLength", 88, 8, "number", "bytes" },
  } },
  [0x39] = { name = "REM_RobotAssuredAck", size = 11, fields = {
    { "header", 0, 8, "number", "" },
    { "toRobotId", 8, 4, "number", "" },
    { "toColor", 12, 1, "number", "" },
    { "toBC", 13, 1, "number", "" },
    { "toBS", 14, 1, "number", "" },
    { "toPC", 15, 1, "number", "" },
    { "fromRobotId", 16, 4, "number", "" },
    { "fromColor", 20, 1, "number", "" },
    { "reserved", 21, 1, "number", "" },
    { "fromBS", 22, 1, "number", "" },
    { "fromPC", 23, 1, "number", "" },
    { "remVersion", 24, 4, "number", "" },
    { "messageId", 28, 4, "number", "" },
    { "timestamp", 32, 40, "number", "10 ms" },
    { "payloadSize", 72, 8, "number", "bytes" },
    { "sequenceNumber", 80, 8, "number", "" },
  } },
  [0x3A] = { name = "REM_RobotMusicCommand", size = 13, fields = {
    { "header", 0, 8, "number", "" },
    { "toRobotId", 8, 4, "number", "" },
    { "toColor", 12, 1, "number", "" },
    { "toBC", 13, 1, "number", "" },
    { "toBS", 14, 1, "number", "" },
    { "toPC", 15, 1, "number", "" },
    { "fromRobotId", 16, 4, "number", "" },
    { "fromColor", 20, 1, "number", "" },
    { "reserved", 21, 1, "number", "" },
    { "fromBS", 22, 1, "number", "" },
    { "fromPC", 23, 1, "number", "" },
    { "remVersion", 24, 4, "number", "" },
    { "messageId", 28, 4, "number", "" },
    { "timestamp", 32, 40, "number", "10 ms" },
    { "payloadSize", 72, 8, "number", "bytes" },
    { "play", 80, 1, "number", "" },
    { "pause", 81, 1, "number", "" },
    { "stop", 82, 1, "number", "" },
    { "previousSong", 83, 1, "number", "" },
    { "nextSong", 84, 1, "number", "" },
    { "volume", 85, 5, "number", "" },
    { "volumeUp", 90, 1, "number", "" },
    { "volumeDown", 91, 1, "number", "" },
    { "folderId", 92, 4, "number", "" },
    { "songId", 96, 8, "number", "" },
  } },
  [0x3C] = { name = "REM_SX1280Filler", size = 6, fields = {
    { "header", 0, 8, "number", "" },
    { "remVersion", 8, 4, "number", "" },
    { "fillerBits", 12, 36, "number", "" },
  } },
  [0x3F] = { name = "REM_RobotKillCommand", size = 10, fields = {
    { "header", 0, 8, "number", "" },
    { "toRobotId", 8, 4, "number", "" },
    { "toColor", 12, 1, "number", "" },
    { "toBC", 13, 1, "number", "" },
    { "toBS", 14, 1, "number", "" },
    { "toPC", 15, 1, "number", "" },
    { "fromRobotId", 16, 4, "number", "" },
    { "fromColor", 20, 1, "number", "" },
    { "reserved", 21, 1, "number", "" },
    { "fromBS", 22, 1, "number", "" },
    { "fromPC", 23, 1, "number", "" },
    { "remVersion", 24, 4, "number", "" },
    { "messageId", 28, 4, "number", "" },
    { "timestamp", 32, 40, "number", "10 ms" },
    { "payloadSize", 72, 8, "number", "bytes" },
  } },
}

local protocol_fields = {}
for _, packet in pairs(packets) do
  for _, row in ipairs(packet.fields) do
    local filter = PROTOCOL .. "." .. packet.name .. "." .. row[1]:gsub("[^%w_]", "_")
    local label = row[1] .. (row[5] ~= "" and " (" .. row[5] .. ")" or "")
    local make = row[4] == "float" and ProtoField.float or row[4] == "ranged" and ProtoField.double
      or row[3] > 32 and ProtoField.uint64 or ProtoField.uint32
    row.field = make(filter, label)
    protocol_fields[#protocol_fields + 1] = row.field
  end
end
proto.fields = protocol_fields

local fault = ProtoExpert.new(PROTOCOL .. ".fault", "Refused packet", expert.group.MALFORMED, expert.severity.ERROR)
proto.experts = { fault }

-- Content of a field: a number, or a UInt64 above 32 bits.
local function raw_of(range, row, lsb_first)
  local first, bits = row[2], row[3]
  if not lsb_first then return range:bitfield(first, bits) end
  local value, weight = 0, 1
  for bit = first, first + bits - 1 do
    local byte = range(math.floor(bit / 8), 1):uint()
    value = value + weight * (math.floor(byte / 2 ^ (bit % 8)) % 2)
    weight = weight * 2
  end
  return value
end

local function add_field(tree, range, row, lsb_first)
  local first, last = math.floor(row[2] / 8), math.floor((row[2] + row[3] - 1) / 8)
  local bytes = range(first, last - first + 1)
  if row[4] == "float" then
    if lsb_first then tree:add_le(row.field, bytes) else tree:add(row.field, bytes) end
  elseif row[4] == "ranged" then
    tree:add(row.field, bytes, raw_of(range, row, lsb_first) * row[6] + row[7])
  else
    tree:add(row.field, bytes, raw_of(range, row, lsb_first))
  end
end

-- One packet without framing; answers its length, 0 where no packet starts like this.
local function add_packet(tree, range, pinfo)
  local packet = range:len() > TYPE_BYTE and packets[range(TYPE_BYTE, 1):uint()]
  if not packet or range:len() < packet.size then
    tree:add(proto, range):add_proto_expert_info(fault, packet and "too short" or "unknown type")
    return 0
  end
  local size = packet.size
  if packet.text_size_at then
    size = math.max(size, math.min(range:len(), range(packet.text_size_at, 1):uint()))
  end
  local branch = tree:add(proto, range(0, size), packet.name)
  for _, row in ipairs(packet.fields) do add_field(branch, range, row, packet.lsb_first) end
  if size > packet.size then
    local text = range(packet.size, size - packet.size)
    branch:add(text, "text: " .. text:string())
  end
  pinfo.cols.info:append(" " .. packet.name)
  return size
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

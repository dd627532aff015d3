-- Wireshark dissector of TIGERs Mannheim base station. Generated from the packet tables by
-- `omnihil formats tigers-base-station --wireshark`; do not edit.
local PROTOCOL = "tigers_base_station"
local proto = Proto(PROTOCOL, "TIGERs Mannheim base station")

-- name, bytes, types: { first bit, bits, content }, fields: { name, first bit, bits, kind, unit, sign, of a scaled one the unit per count and the value at 0 }
local packets = {
  { name = "emergency", size = 13, types = { { 0, 8, 96 }, { 16, 8, 5 }, { 96, 8, 0 } }, lsb_first = true, fields = {
    { "command", 0, 8, "number", "", "" },
    { "bot", 8, 8, "number", "", "" },
    { "app", 16, 8, "number", "", "" },
    { "curPosition[0]", 24, 16, "number", "mm", "signed" },
    { "curPosition[1]", 40, 16, "number", "mm", "signed" },
    { "curPosition[2]", 56, 16, "number", "mrad", "signed" },
    { "posDelay", 72, 8, "number", "0.25 ms", "" },
    { "camId", 80, 8, "number", "", "" },
    { "flags", 88, 8, "number", "", "" },
    { "skillId", 96, 8, "number", "", "" },
  } },
  { name = "wheel_vel", size = 24, types = { { 0, 8, 96 }, { 16, 8, 5 }, { 96, 8, 1 } }, lsb_first = true, fields = {
    { "command", 0, 8, "number", "", "" },
    { "bot", 8, 8, "number", "", "" },
    { "app", 16, 8, "number", "", "" },
    { "curPosition[0]", 24, 16, "number", "mm", "signed" },
    { "curPosition[1]", 40, 16, "number", "mm", "signed" },
    { "curPosition[2]", 56, 16, "number", "mrad", "signed" },
    { "posDelay", 72, 8, "number", "0.25 ms", "" },
    { "camId", 80, 8, "number", "", "" },
    { "flags", 88, 8, "number", "", "" },
    { "skillId", 96, 8, "number", "", "" },
    { "skill_in.wheel[0]", 104, 16, "number", "0.005 rad/s", "signed" },
    { "skill_in.wheel[1]", 120, 16, "number", "0.005 rad/s", "signed" },
    { "skill_in.wheel[2]", 136, 16, "number", "0.005 rad/s", "signed" },
    { "skill_in.wheel[3]", 152, 16, "number", "0.005 rad/s", "signed" },
    { "skill_in.kickSpeed", 168, 9, "scaled", "m/s", "", 0.02, 0 },
    { "skill_in.kickDevice", 177, 1, "number", "", "" },
    { "skill_in.kickMode", 178, 2, "number", "", "" },
    { "skill_in.dribbleSpeed", 180, 6, "scaled", "m/s", "", 0.125, 0 },
    { "skill_in.dribbleForce", 186, 6, "scaled", "N", "", 0.25, 0 },
  } },
  { name = "local_vel", size = 26, types = { { 0, 8, 96 }, { 16, 8, 5 }, { 96, 8, 2 } }, lsb_first = true, fields = {
    { "command", 0, 8, "number", "", "" },
    { "bot", 8, 8, "number", "", "" },
    { "app", 16, 8, "number", "", "" },
    { "curPosition[0]", 24, 16, "number", "mm", "signed" },
    { "curPosition[1]", 40, 16, "number", "mm", "signed" },
    { "curPosition[2]", 56, 16, "number", "mrad", "signed" },
    { "posDelay", 72, 8, "number", "0.25 ms", "" },
    { "camId", 80, 8, "number", "", "" },
    { "flags", 88, 8, "number", "", "" },
    { "skillId", 96, 8, "number", "", "" },
    { "skill_in.xyw[0]", 104, 16, "number", "mm/s", "signed" },
    { "skill_in.xyw[1]", 120, 16, "number", "mm/s", "signed" },
    { "skill_in.xyw[2]", 136, 16, "number", "mrad/s", "signed" },
    { "skill_in.accMaxXY", 152, 8, "number", "10/255 m/s^2", "" },
    { "skill_in.accMaxW", 160, 8, "number", "100/255 rad/s^2", "" },
    { "skill_in.jerkMaxXY", 168, 8, "number", "", "" },
    { "skill_in.jerkMaxW", 176, 8, "number", "", "" },
    { "skill_in.kickSpeed", 184, 9, "scaled", "m/s", "", 0.02, 0 },
    { "skill_in.kickDevice", 193, 1, "number", "", "" },
    { "skill_in.kickMode", 194, 2, "number", "", "" },
    { "skill_in.dribbleSpeed", 196, 6, "scaled", "m/s", "", 0.125, 0 },
    { "skill_in.dribbleForce", 202, 6, "scaled", "N", "", 0.25, 0 },
  } },
  { name = "global_vel", size = 26, types = { { 0, 8, 96 }, { 16, 8, 5 }, { 96, 8, 3 } }, lsb_first = true, fields = {
    { "command", 0, 8, "number", "", "" },
    { "bot", 8, 8, "number", "", "" },
    { "app", 16, 8, "number", "", "" },
    { "curPosition[0]", 24, 16, "number", "mm", "signed" },
    { "curPosition[1]", 40, 16, "number", "mm", "signed" },
    { "curPosition[2]", 56, 16, "number", "mrad", "signed" },
    { "posDelay", 72, 8, "number", "0.25 ms", "" },
    { "camId", 80, 8, "number", "", "" },
    { "flags", 88, 8, "number", "", "" },
    { "skillId", 96, 8, "number", "", "" },
    { "skill_in.xyw[0]", 104, 16, "number", "mm/s", "signed" },
    { "skill_in.xyw[1]", 120, 16, "number", "mm/s", "signed" },
    { "skill_in.xyw[2]", 136, 16, "number", "mrad/s", "signed" },
    { "skill_in.accMaxXY", 152, 8, "number", "10/255 m/s^2", "" },
    { "skill_in.accMaxW", 160, 8, "number", "100/255 rad/s^2", "" },
    { "skill_in.jerkMaxXY", 168, 8, "number", "", "" },
    { "skill_in.jerkMaxW", 176, 8, "number", "", "" },
    { "skill_in.kickSpeed", 184, 9, "scaled", "m/s", "", 0.02, 0 },
    { "skill_in.kickDevice", 193, 1, "number", "", "" },
    { "skill_in.kickMode", 194, 2, "number", "", "" },
    { "skill_in.dribbleSpeed", 196, 6, "scaled", "m/s", "", 0.125, 0 },
    { "skill_in.dribbleForce", 202, 6, "scaled", "N", "", 0.25, 0 },
  } },
  { name = "global_pos", size = 27, types = { { 0, 8, 96 }, { 16, 8, 5 }, { 96, 8, 4 } }, lsb_first = true, fields = {
    { "command", 0, 8, "number", "", "" },
    { "bot", 8, 8, "number", "", "" },
    { "app", 16, 8, "number", "", "" },
    { "curPosition[0]", 24, 16, "number", "mm", "signed" },
    { "curPosition[1]", 40, 16, "number", "mm", "signed" },
    { "curPosition[2]", 56, 16, "number", "mrad", "signed" },
    { "posDelay", 72, 8, "number", "0.25 ms", "" },
    { "camId", 80, 8, "number", "", "" },
    { "flags", 88, 8, "number", "", "" },
    { "skillId", 96, 8, "number", "", "" },
    { "skill_in.xyw[0]", 104, 16, "number", "mm", "signed" },
    { "skill_in.xyw[1]", 120, 16, "number", "mm", "signed" },
    { "skill_in.xyw[2]", 136, 16, "number", "mrad", "signed" },
    { "skill_in.velMaxXY", 152, 8, "number", "5/255 m/s", "" },
    { "skill_in.velMaxW", 160, 8, "number", "30/255 rad/s", "" },
    { "skill_in.accMaxXY", 168, 8, "number", "10/255 m/s^2", "" },
    { "skill_in.accMaxW", 176, 8, "number", "100/255 rad/s^2", "" },
    { "skill_in.kickSpeed", 184, 9, "scaled", "m/s", "", 0.02, 0 },
    { "skill_in.kickDevice", 193, 1, "number", "", "" },
    { "skill_in.kickMode", 194, 2, "number", "", "" },
    { "skill_in.dribbleSpeed", 196, 6, "scaled", "m/s", "", 0.125, 0 },
    { "skill_in.dribbleForce", 202, 6, "scaled", "N", "", 0.25, 0 },
    { "skill_in.primaryDirection", 208, 8, "number", "", "signed" },
  } },
  { name = "match_feedback", size = 32, types = { { 0, 8, 96 }, { 16, 8, 6 } }, lsb_first = true, fields = {
    { "command", 0, 8, "number", "", "" },
    { "bot", 8, 8, "number", "", "" },
    { "app", 16, 8, "number", "", "" },
    { "curPosition[0]", 24, 16, "number", "mm", "signed" },
    { "curPosition[1]", 40, 16, "number", "mm", "signed" },
    { "curPosition[2]", 56, 16, "number", "mrad", "signed" },
    { "curVelocity[0]", 72, 16, "number", "mm/s", "signed" },
    { "curVelocity[1]", 88, 16, "number", "mm/s", "signed" },
    { "curVelocity[2]", 104, 16, "number", "mrad/s", "signed" },
    { "kickerLevel", 120, 8, "number", "V", "" },
    { "kickerMax", 128, 8, "number", "V", "" },
    { "dribblerState", 136, 8, "number", "", "" },
    { "batteryLevel", 144, 8, "number", "0.1 V", "" },
    { "batteryPercent", 152, 8, "number", "1/255", "" },
    { "flags", 160, 8, "number", "", "" },
    { "features", 168, 16, "number", "", "" },
    { "hardwareId", 184, 8, "number", "", "" },
    { "ballPosAge", 192, 8, "number", "ms", "" },
    { "ballPosition[0]", 200, 16, "number", "mm", "signed" },
    { "ballPosition[1]", 216, 16, "number", "mm", "signed" },
    { "lastKickDuration", 232, 8, "number", "0.05 ms", "" },
    { "lastKickDribbleVelDev", 240, 8, "number", "", "" },
    { "lastKickDribbleForce", 248, 8, "number", "0.0625 N", "" },
  } },
  { name = "broadcast", size = 23, types = { { 0, 8, 103 } }, lsb_first = true, fields = {
    { "command", 0, 8, "number", "", "" },
    { "baseStationId", 8, 8, "number", "", "" },
    { "allocatedBotIds", 16, 32, "number", "", "" },
    { "unixTime", 48, 32, "number", "s", "" },
    { "flags", 80, 8, "number", "", "" },
    { "ballPosition[0]", 88, 16, "number", "mm", "signed" },
    { "ballPosition[1]", 104, 16, "number", "mm", "signed" },
    { "ballPosDelay", 120, 8, "number", "0.25 ms", "" },
    { "ballCamId", 128, 8, "number", "", "" },
    { "fieldSize[0]", 136, 8, "number", "", "" },
    { "fieldSize[1]", 144, 8, "number", "", "" },
    { "fieldSize[2]", 152, 8, "number", "", "" },
    { "boundaryWidth", 160, 8, "number", "cm", "" },
    { "goalWidth", 168, 8, "number", "cm", "" },
    { "goalDepth", 176, 8, "number", "cm", "" },
  } },
  { name = "ping", size = 1, types = { { 0, 8, 97 } }, lsb_first = true, fields = {
    { "command", 0, 8, "number", "", "" },
  } },
  { name = "auth", size = 5, types = { { 0, 8, 98 } }, lsb_first = true, fields = {
    { "command", 0, 8, "number", "", "" },
    { "key", 8, 32, "number", "", "" },
  } },
  { name = "config_v3", size = 10, types = { { 0, 8, 102 } }, lsb_first = true, fields = {
    { "command", 0, 8, "number", "", "" },
    { "visionIp[0]", 8, 8, "number", "", "" },
    { "visionIp[1]", 16, 8, "number", "", "" },
    { "visionIp[2]", 24, 8, "number", "", "" },
    { "visionIp[3]", 32, 8, "number", "", "" },
    { "visionPort", 40, 16, "number", "", "" },
    { "channel", 56, 8, "number", "", "" },
    { "maxBots", 64, 8, "number", "", "" },
    { "fixedRuntime", 72, 8, "number", "", "" },
  } },
  { name = "cam_viewport", size = 10, types = { { 0, 8, 101 } }, lsb_first = true, fields = {
    { "command", 0, 8, "number", "", "" },
    { "camId", 8, 8, "number", "", "" },
    { "minX", 16, 16, "number", "mm", "signed" },
    { "minY", 32, 16, "number", "mm", "signed" },
    { "maxX", 48, 16, "number", "mm", "signed" },
    { "maxY", 64, 16, "number", "mm", "signed" },
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

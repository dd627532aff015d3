-- Wireshark dissector of RoboJackets, base station and motor boards of 2024. Generated from the packet tables by
-- `omnihil formats robojackets-2024 --wireshark`; do not edit.
local PROTOCOL = "robojackets_2024"
local proto = Proto(PROTOCOL, "RoboJackets, base station and motor boards of 2024")

-- name, bytes, types: { first bit, bits, content }, fields: { name, first bit, bits, kind, unit, sign, of a scaled one the unit per count and the value at 0 }
local packets = {
  { name = "control_message", size = 10, types = { }, lsb_first = true, fields = {
    { "trigger_mode", 0, 2, "number", "", "" },
    { "shoot_mode", 2, 1, "number", "", "" },
    { "robot_id", 3, 4, "number", "", "" },
    { "team", 7, 1, "number", "", "" },
    { "body_x", 8, 16, "scaled", "m/s", "signed", 0.000999999948, 0 },
    { "body_y", 24, 16, "scaled", "m/s", "signed", 0.000999999948, 0 },
    { "body_w", 40, 16, "scaled", "rad/s", "signed", 0.000999999948, 0 },
    { "dribbler_speed", 56, 8, "number", "%", "signed" },
    { "kick_strength", 64, 8, "number", "", "" },
    { "mode", 72, 6, "number", "", "" },
    { "role", 78, 2, "number", "", "" },
  } },
  { name = "robot_status_message", size = 3, types = { }, lsb_first = true, fields = {
    { "kick_healthy", 0, 1, "number", "", "" },
    { "kick_status", 1, 1, "number", "", "" },
    { "ball_sense_status", 2, 1, "number", "", "" },
    { "robot_id", 3, 4, "number", "", "" },
    { "team", 7, 1, "number", "", "" },
    { "battery_voltage", 8, 8, "number", "", "" },
    { "unused", 16, 2, "number", "", "" },
    { "fpga_status", 18, 1, "number", "", "" },
    { "motor_errors", 19, 5, "number", "", "" },
  } },
  { name = "motor_command_move", size = 13, types = { { 0, 8, 1 } }, lsb_first = true, fields = {
    { "command", 0, 8, "number", "", "" },
    { "ticks_per_second", 8, 32, "number", "1/s", "signed" },
    { "rest", 40, 64, "number", "", "" },
  } },
  { name = "motor_command_set_pid", size = 13, types = { { 0, 8, 2 } }, lsb_first = true, fields = {
    { "command", 0, 8, "number", "", "" },
    { "kp", 8, 32, "float", "", "" },
    { "ki", 40, 32, "float", "", "" },
    { "kd", 72, 32, "float", "", "" },
  } },
  { name = "motor_move_response", size = 5, types = { }, lsb_first = true, fields = {
    { "status", 0, 8, "number", "", "" },
    { "ticks_per_second", 8, 32, "number", "1/s", "signed" },
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

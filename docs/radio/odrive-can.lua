-- Wireshark dissector of ODrive CANSimple. Generated from the packet tables by
-- `omnihil formats odrive-can --wireshark`; do not edit.
local PROTOCOL = "odrive_can"
local proto = Proto(PROTOCOL, "ODrive CANSimple")

-- name, bytes, types: { first bit, bits, content }, fields: { name, first bit, bits, kind, unit, sign, of a scaled one the unit per count and the value at 0 }
local packets = {
  { name = "Heartbeat", size = 16, types = { { 0, 5, 1 } }, lsb_first = true, fields = {
    { "command", 0, 5, "number", "", "" },
    { "node", 5, 6, "number", "", "" },
    { "id_29", 11, 18, "number", "", "" },
    { "err_rtr_eff", 29, 3, "number", "", "" },
    { "dlc", 32, 8, "number", "", "" },
    { "padding", 40, 24, "number", "", "" },
    { "Axis_Error", 64, 32, "number", "", "" },
    { "Axis_State", 96, 8, "number", "", "" },
    { "Procedure_Result", 104, 8, "number", "", "" },
    { "Trajectory_Done_Flag", 112, 1, "number", "", "" },
    { "unused", 113, 15, "number", "", "" },
  } },
  { name = "Estop", size = 16, types = { { 0, 5, 2 } }, lsb_first = true, fields = {
    { "command", 0, 5, "number", "", "" },
    { "node", 5, 6, "number", "", "" },
    { "id_29", 11, 18, "number", "", "" },
    { "err_rtr_eff", 29, 3, "number", "", "" },
    { "dlc", 32, 8, "number", "", "" },
    { "padding", 40, 24, "number", "", "" },
    { "rest", 64, 64, "number", "", "" },
  } },
  { name = "Get_Error", size = 16, types = { { 0, 5, 3 } }, lsb_first = true, fields = {
    { "command", 0, 5, "number", "", "" },
    { "node", 5, 6, "number", "", "" },
    { "id_29", 11, 18, "number", "", "" },
    { "err_rtr_eff", 29, 3, "number", "", "" },
    { "dlc", 32, 8, "number", "", "" },
    { "padding", 40, 24, "number", "", "" },
    { "Active_Errors", 64, 32, "number", "", "" },
    { "Disarm_Reason", 96, 32, "number", "", "" },
  } },
  { name = "Set_Axis_State", size = 16, types = { { 0, 5, 7 } }, lsb_first = true, fields = {
    { "command", 0, 5, "number", "", "" },
    { "node", 5, 6, "number", "", "" },
    { "id_29", 11, 18, "number", "", "" },
    { "err_rtr_eff", 29, 3, "number", "", "" },
    { "dlc", 32, 8, "number", "", "" },
    { "padding", 40, 24, "number", "", "" },
    { "Axis_Requested_State", 64, 32, "number", "", "" },
    { "rest", 96, 32, "number", "", "" },
  } },
  { name = "Get_Encoder_Estimates", size = 16, types = { { 0, 5, 9 } }, lsb_first = true, fields = {
    { "command", 0, 5, "number", "", "" },
    { "node", 5, 6, "number", "", "" },
    { "id_29", 11, 18, "number", "", "" },
    { "err_rtr_eff", 29, 3, "number", "", "" },
    { "dlc", 32, 8, "number", "", "" },
    { "padding", 40, 24, "number", "", "" },
    { "Pos_Estimate", 64, 32, "float", "rev", "" },
    { "Vel_Estimate", 96, 32, "float", "rev/s", "" },
  } },
  { name = "Set_Controller_Mode", size = 16, types = { { 0, 5, 11 } }, lsb_first = true, fields = {
    { "command", 0, 5, "number", "", "" },
    { "node", 5, 6, "number", "", "" },
    { "id_29", 11, 18, "number", "", "" },
    { "err_rtr_eff", 29, 3, "number", "", "" },
    { "dlc", 32, 8, "number", "", "" },
    { "padding", 40, 24, "number", "", "" },
    { "Control_Mode", 64, 32, "number", "", "" },
    { "Input_Mode", 96, 32, "number", "", "" },
  } },
  { name = "Set_Input_Pos", size = 16, types = { { 0, 5, 12 } }, lsb_first = true, fields = {
    { "command", 0, 5, "number", "", "" },
    { "node", 5, 6, "number", "", "" },
    { "id_29", 11, 18, "number", "", "" },
    { "err_rtr_eff", 29, 3, "number", "", "" },
    { "dlc", 32, 8, "number", "", "" },
    { "padding", 40, 24, "number", "", "" },
    { "Input_Pos", 64, 32, "float", "rev", "" },
    { "Vel_FF", 96, 16, "scaled", "rev/s", "signed", 0.000999999948, 0 },
    { "Torque_FF", 112, 16, "scaled", "Nm", "signed", 0.000999999948, 0 },
  } },
  { name = "Set_Input_Vel", size = 16, types = { { 0, 5, 13 } }, lsb_first = true, fields = {
    { "command", 0, 5, "number", "", "" },
    { "node", 5, 6, "number", "", "" },
    { "id_29", 11, 18, "number", "", "" },
    { "err_rtr_eff", 29, 3, "number", "", "" },
    { "dlc", 32, 8, "number", "", "" },
    { "padding", 40, 24, "number", "", "" },
    { "Input_Vel", 64, 32, "float", "rev/s", "" },
    { "Input_Torque_FF", 96, 32, "float", "Nm", "" },
  } },
  { name = "Set_Input_Torque", size = 16, types = { { 0, 5, 14 } }, lsb_first = true, fields = {
    { "command", 0, 5, "number", "", "" },
    { "node", 5, 6, "number", "", "" },
    { "id_29", 11, 18, "number", "", "" },
    { "err_rtr_eff", 29, 3, "number", "", "" },
    { "dlc", 32, 8, "number", "", "" },
    { "padding", 40, 24, "number", "", "" },
    { "Input_Torque", 64, 32, "float", "Nm", "" },
    { "rest", 96, 32, "number", "", "" },
  } },
  { name = "Set_Limits", size = 16, types = { { 0, 5, 15 } }, lsb_first = true, fields = {
    { "command", 0, 5, "number", "", "" },
    { "node", 5, 6, "number", "", "" },
    { "id_29", 11, 18, "number", "", "" },
    { "err_rtr_eff", 29, 3, "number", "", "" },
    { "dlc", 32, 8, "number", "", "" },
    { "padding", 40, 24, "number", "", "" },
    { "Velocity_Limit", 64, 32, "float", "rev/s", "" },
    { "Current_Limit", 96, 32, "float", "A", "" },
  } },
  { name = "Get_Iq", size = 16, types = { { 0, 5, 20 } }, lsb_first = true, fields = {
    { "command", 0, 5, "number", "", "" },
    { "node", 5, 6, "number", "", "" },
    { "id_29", 11, 18, "number", "", "" },
    { "err_rtr_eff", 29, 3, "number", "", "" },
    { "dlc", 32, 8, "number", "", "" },
    { "padding", 40, 24, "number", "", "" },
    { "Iq_Setpoint", 64, 32, "float", "A", "" },
    { "Iq_Measured", 96, 32, "float", "A", "" },
  } },
  { name = "Get_Temperature", size = 16, types = { { 0, 5, 21 } }, lsb_first = true, fields = {
    { "command", 0, 5, "number", "", "" },
    { "node", 5, 6, "number", "", "" },
    { "id_29", 11, 18, "number", "", "" },
    { "err_rtr_eff", 29, 3, "number", "", "" },
    { "dlc", 32, 8, "number", "", "" },
    { "padding", 40, 24, "number", "", "" },
    { "FET_Temperature", 64, 32, "float", "deg C", "" },
    { "Motor_Temperature", 96, 32, "float", "deg C", "" },
  } },
  { name = "Reboot", size = 16, types = { { 0, 5, 22 } }, lsb_first = true, fields = {
    { "command", 0, 5, "number", "", "" },
    { "node", 5, 6, "number", "", "" },
    { "id_29", 11, 18, "number", "", "" },
    { "err_rtr_eff", 29, 3, "number", "", "" },
    { "dlc", 32, 8, "number", "", "" },
    { "padding", 40, 24, "number", "", "" },
    { "rest", 64, 64, "number", "", "" },
  } },
  { name = "Get_Bus_Voltage_Current", size = 16, types = { { 0, 5, 23 } }, lsb_first = true, fields = {
    { "command", 0, 5, "number", "", "" },
    { "node", 5, 6, "number", "", "" },
    { "id_29", 11, 18, "number", "", "" },
    { "err_rtr_eff", 29, 3, "number", "", "" },
    { "dlc", 32, 8, "number", "", "" },
    { "padding", 40, 24, "number", "", "" },
    { "Bus_Voltage", 64, 32, "float", "V", "" },
    { "Bus_Current", 96, 32, "float", "A", "" },
  } },
  { name = "Clear_Errors", size = 16, types = { { 0, 5, 24 } }, lsb_first = true, fields = {
    { "command", 0, 5, "number", "", "" },
    { "node", 5, 6, "number", "", "" },
    { "id_29", 11, 18, "number", "", "" },
    { "err_rtr_eff", 29, 3, "number", "", "" },
    { "dlc", 32, 8, "number", "", "" },
    { "padding", 40, 24, "number", "", "" },
    { "rest", 64, 64, "number", "", "" },
  } },
  { name = "Set_Absolute_Position", size = 16, types = { { 0, 5, 25 } }, lsb_first = true, fields = {
    { "command", 0, 5, "number", "", "" },
    { "node", 5, 6, "number", "", "" },
    { "id_29", 11, 18, "number", "", "" },
    { "err_rtr_eff", 29, 3, "number", "", "" },
    { "dlc", 32, 8, "number", "", "" },
    { "padding", 40, 24, "number", "", "" },
    { "Position", 64, 32, "float", "rev", "" },
    { "rest", 96, 32, "number", "", "" },
  } },
  { name = "Set_Pos_Gain", size = 16, types = { { 0, 5, 26 } }, lsb_first = true, fields = {
    { "command", 0, 5, "number", "", "" },
    { "node", 5, 6, "number", "", "" },
    { "id_29", 11, 18, "number", "", "" },
    { "err_rtr_eff", 29, 3, "number", "", "" },
    { "dlc", 32, 8, "number", "", "" },
    { "padding", 40, 24, "number", "", "" },
    { "Pos_Gain", 64, 32, "float", "(rev/s)/rev", "" },
    { "rest", 96, 32, "number", "", "" },
  } },
  { name = "Set_Vel_Gains", size = 16, types = { { 0, 5, 27 } }, lsb_first = true, fields = {
    { "command", 0, 5, "number", "", "" },
    { "node", 5, 6, "number", "", "" },
    { "id_29", 11, 18, "number", "", "" },
    { "err_rtr_eff", 29, 3, "number", "", "" },
    { "dlc", 32, 8, "number", "", "" },
    { "padding", 40, 24, "number", "", "" },
    { "Vel_Gain", 64, 32, "float", "Nm/(rev/s)", "" },
    { "Vel_Integrator_Gain", 96, 32, "float", "Nm/rev", "" },
  } },
  { name = "Get_Torques", size = 16, types = { { 0, 5, 28 } }, lsb_first = true, fields = {
    { "command", 0, 5, "number", "", "" },
    { "node", 5, 6, "number", "", "" },
    { "id_29", 11, 18, "number", "", "" },
    { "err_rtr_eff", 29, 3, "number", "", "" },
    { "dlc", 32, 8, "number", "", "" },
    { "padding", 40, 24, "number", "", "" },
    { "Torque_Target", 64, 32, "float", "Nm", "" },
    { "Torque_Estimate", 96, 32, "float", "Nm", "" },
  } },
  { name = "Get_Powers", size = 16, types = { { 0, 5, 29 } }, lsb_first = true, fields = {
    { "command", 0, 5, "number", "", "" },
    { "node", 5, 6, "number", "", "" },
    { "id_29", 11, 18, "number", "", "" },
    { "err_rtr_eff", 29, 3, "number", "", "" },
    { "dlc", 32, 8, "number", "", "" },
    { "padding", 40, 24, "number", "", "" },
    { "Electrical_Power", 64, 32, "float", "W", "" },
    { "Mechanical_Power", 96, 32, "float", "W", "" },
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

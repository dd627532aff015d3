-- Wireshark dissector of ibis-ssl Orion: commands of eleven robots in one datagram (2026). Generated from the packet tables by
-- `omnihil formats ibis-broadcast-715 --wireshark`; do not edit.
local PROTOCOL = "ibis_broadcast_715"
local proto = Proto(PROTOCOL, "ibis-ssl Orion: commands of eleven robots in one datagram (2026)")

-- name, bytes, types: { first bit, bits, content }, fields: { name, first bit, bits, kind, unit, sign, of a scaled one the unit per count and the value at 0 }
local packets = {
  { name = "LOCAL_CAMERA", size = 65, types = { { 192, 8, 0 } }, fields = {
    { "robot_id", 0, 8, "number", "", "" },
    { "header", 8, 8, "number", "", "" },
    { "check_counter", 16, 8, "number", "", "" },
    { "vision_global_pos[0]", 24, 16, "scaled", "m", "", 0.000999999939, -32.7669983 },
    { "vision_global_pos[1]", 40, 16, "scaled", "m", "", 0.000999999939, -32.7669983 },
    { "vision_global_theta", 56, 16, "scaled", "rad", "", 9.58767273e-05, -3.14159274 },
    { "target_global_theta", 72, 16, "scaled", "rad", "", 9.58767273e-05, -3.14159274 },
    { "kick_power", 88, 8, "scaled", "", "", 0.05, 0 },
    { "dribble_power", 96, 8, "scaled", "", "", 0.05, 0 },
    { "acceleration_limit", 104, 16, "scaled", "m/s^2", "", 0.000999999939, -32.7669983 },
    { "linear_velocity_limit", 120, 16, "scaled", "m/s", "", 0.000999999939, -32.7669983 },
    { "angular_velocity_limit", 136, 16, "scaled", "rad/s", "", 0.000999999939, -32.7669983 },
    { "latency_time_ms", 152, 16, "number", "ms", "" },
    { "elapsed_time_ms_since_last_vision", 168, 16, "number", "ms", "" },
    { "flags_6_7", 184, 2, "number", "", "" },
    { "prioritize_accurate_acceleration", 186, 1, "number", "", "" },
    { "prioritize_move", 187, 1, "number", "", "" },
    { "stop_emergency", 188, 1, "number", "", "" },
    { "lift_dribbler", 189, 1, "number", "", "" },
    { "enable_chip", 190, 1, "number", "", "" },
    { "is_vision_available", 191, 1, "number", "", "" },
    { "control_mode", 192, 8, "number", "", "" },
    { "mode_args.ball_pos[0]", 200, 16, "scaled", "m", "", 0.000999999939, -32.7669983 },
    { "mode_args.ball_pos[1]", 216, 16, "scaled", "m", "", 0.000999999939, -32.7669983 },
    { "mode_args.ball_vel[0]", 232, 16, "scaled", "m/s", "", 0.000999999939, -32.7669983 },
    { "mode_args.ball_vel[1]", 248, 16, "scaled", "m/s", "", 0.000999999939, -32.7669983 },
    { "mode_args.target_global_vel[0]", 264, 16, "scaled", "m/s", "", 0.000999999939, -32.7669983 },
    { "mode_args.target_global_vel[1]", 280, 16, "scaled", "m/s", "", 0.000999999939, -32.7669983 },
    { "rest[0]", 296, 64, "number", "", "" },
    { "rest[1]", 360, 64, "number", "", "" },
    { "rest[2]", 424, 64, "number", "", "" },
    { "rest[3]", 488, 32, "number", "", "" },
  } },
  { name = "POSITION_TARGET", size = 65, types = { { 192, 8, 1 } }, fields = {
    { "robot_id", 0, 8, "number", "", "" },
    { "header", 8, 8, "number", "", "" },
    { "check_counter", 16, 8, "number", "", "" },
    { "vision_global_pos[0]", 24, 16, "scaled", "m", "", 0.000999999939, -32.7669983 },
    { "vision_global_pos[1]", 40, 16, "scaled", "m", "", 0.000999999939, -32.7669983 },
    { "vision_global_theta", 56, 16, "scaled", "rad", "", 9.58767273e-05, -3.14159274 },
    { "target_global_theta", 72, 16, "scaled", "rad", "", 9.58767273e-05, -3.14159274 },
    { "kick_power", 88, 8, "scaled", "", "", 0.05, 0 },
    { "dribble_power", 96, 8, "scaled", "", "", 0.05, 0 },
    { "acceleration_limit", 104, 16, "scaled", "m/s^2", "", 0.000999999939, -32.7669983 },
    { "linear_velocity_limit", 120, 16, "scaled", "m/s", "", 0.000999999939, -32.7669983 },
    { "angular_velocity_limit", 136, 16, "scaled", "rad/s", "", 0.000999999939, -32.7669983 },
    { "latency_time_ms", 152, 16, "number", "ms", "" },
    { "elapsed_time_ms_since_last_vision", 168, 16, "number", "ms", "" },
    { "flags_6_7", 184, 2, "number", "", "" },
    { "prioritize_accurate_acceleration", 186, 1, "number", "", "" },
    { "prioritize_move", 187, 1, "number", "", "" },
    { "stop_emergency", 188, 1, "number", "", "" },
    { "lift_dribbler", 189, 1, "number", "", "" },
    { "enable_chip", 190, 1, "number", "", "" },
    { "is_vision_available", 191, 1, "number", "", "" },
    { "control_mode", 192, 8, "number", "", "" },
    { "mode_args.target_global_pos[0]", 200, 16, "scaled", "m", "", 0.000999999939, -32.7669983 },
    { "mode_args.target_global_pos[1]", 216, 16, "scaled", "m", "", 0.000999999939, -32.7669983 },
    { "mode_args.terminal_velocity", 232, 16, "scaled", "m/s", "", 0.000999999939, -32.7669983 },
    { "rest[0]", 248, 64, "number", "", "" },
    { "rest[1]", 312, 64, "number", "", "" },
    { "rest[2]", 376, 64, "number", "", "" },
    { "rest[3]", 440, 64, "number", "", "" },
    { "rest[4]", 504, 16, "number", "", "" },
  } },
  { name = "SIMPLE_VELOCITY_TARGET", size = 65, types = { { 192, 8, 2 } }, fields = {
    { "robot_id", 0, 8, "number", "", "" },
    { "header", 8, 8, "number", "", "" },
    { "check_counter", 16, 8, "number", "", "" },
    { "vision_global_pos[0]", 24, 16, "scaled", "m", "", 0.000999999939, -32.7669983 },
    { "vision_global_pos[1]", 40, 16, "scaled", "m", "", 0.000999999939, -32.7669983 },
    { "vision_global_theta", 56, 16, "scaled", "rad", "", 9.58767273e-05, -3.14159274 },
    { "target_global_theta", 72, 16, "scaled", "rad", "", 9.58767273e-05, -3.14159274 },
    { "kick_power", 88, 8, "scaled", "", "", 0.05, 0 },
    { "dribble_power", 96, 8, "scaled", "", "", 0.05, 0 },
    { "acceleration_limit", 104, 16, "scaled", "m/s^2", "", 0.000999999939, -32.7669983 },
    { "linear_velocity_limit", 120, 16, "scaled", "m/s", "", 0.000999999939, -32.7669983 },
    { "angular_velocity_limit", 136, 16, "scaled", "rad/s", "", 0.000999999939, -32.7669983 },
    { "latency_time_ms", 152, 16, "number", "ms", "" },
    { "elapsed_time_ms_since_last_vision", 168, 16, "number", "ms", "" },
    { "flags_6_7", 184, 2, "number", "", "" },
    { "prioritize_accurate_acceleration", 186, 1, "number", "", "" },
    { "prioritize_move", 187, 1, "number", "", "" },
    { "stop_emergency", 188, 1, "number", "", "" },
    { "lift_dribbler", 189, 1, "number", "", "" },
    { "enable_chip", 190, 1, "number", "", "" },
    { "is_vision_available", 191, 1, "number", "", "" },
    { "control_mode", 192, 8, "number", "", "" },
    { "mode_args.target_global_vel[0]", 200, 16, "scaled", "m/s", "", 0.000999999939, -32.7669983 },
    { "mode_args.target_global_vel[1]", 216, 16, "scaled", "m/s", "", 0.000999999939, -32.7669983 },
    { "rest[0]", 232, 64, "number", "", "" },
    { "rest[1]", 296, 64, "number", "", "" },
    { "rest[2]", 360, 64, "number", "", "" },
    { "rest[3]", 424, 64, "number", "", "" },
    { "rest[4]", 488, 32, "number", "", "" },
  } },
  { name = "POLAR_VELOCITY_TARGET", size = 65, types = { { 192, 8, 3 } }, fields = {
    { "robot_id", 0, 8, "number", "", "" },
    { "header", 8, 8, "number", "", "" },
    { "check_counter", 16, 8, "number", "", "" },
    { "vision_global_pos[0]", 24, 16, "scaled", "m", "", 0.000999999939, -32.7669983 },
    { "vision_global_pos[1]", 40, 16, "scaled", "m", "", 0.000999999939, -32.7669983 },
    { "vision_global_theta", 56, 16, "scaled", "rad", "", 9.58767273e-05, -3.14159274 },
    { "target_global_theta", 72, 16, "scaled", "rad", "", 9.58767273e-05, -3.14159274 },
    { "kick_power", 88, 8, "scaled", "", "", 0.05, 0 },
    { "dribble_power", 96, 8, "scaled", "", "", 0.05, 0 },
    { "acceleration_limit", 104, 16, "scaled", "m/s^2", "", 0.000999999939, -32.7669983 },
    { "linear_velocity_limit", 120, 16, "scaled", "m/s", "", 0.000999999939, -32.7669983 },
    { "angular_velocity_limit", 136, 16, "scaled", "rad/s", "", 0.000999999939, -32.7669983 },
    { "latency_time_ms", 152, 16, "number", "ms", "" },
    { "elapsed_time_ms_since_last_vision", 168, 16, "number", "ms", "" },
    { "flags_6_7", 184, 2, "number", "", "" },
    { "prioritize_accurate_acceleration", 186, 1, "number", "", "" },
    { "prioritize_move", 187, 1, "number", "", "" },
    { "stop_emergency", 188, 1, "number", "", "" },
    { "lift_dribbler", 189, 1, "number", "", "" },
    { "enable_chip", 190, 1, "number", "", "" },
    { "is_vision_available", 191, 1, "number", "", "" },
    { "control_mode", 192, 8, "number", "", "" },
    { "mode_args.target_global_velocity_r", 200, 16, "scaled", "m/s", "", 0.000999999939, -32.7669983 },
    { "mode_args.target_global_velocity_theta", 216, 16, "scaled", "rad", "", 0.000999999939, -32.7669983 },
    { "rest[0]", 232, 64, "number", "", "" },
    { "rest[1]", 296, 64, "number", "", "" },
    { "rest[2]", 360, 64, "number", "", "" },
    { "rest[3]", 424, 64, "number", "", "" },
    { "rest[4]", 488, 32, "number", "", "" },
  } },
  { name = "FEEDBACK", size = 128, types = { { 0, 8, 171 }, { 8, 8, 234 } }, lsb_first = true, fields = {
    { "sync0", 0, 8, "number", "", "" },
    { "sync1", 8, 8, "number", "", "" },
    { "checksum", 16, 8, "number", "", "" },
    { "check_counter", 24, 8, "number", "", "" },
    { "imu_yaw_deg", 32, 32, "float", "deg", "" },
    { "battery_voltage_bldc_right", 64, 32, "float", "V", "" },
    { "ball_detection[0]", 96, 8, "number", "", "" },
    { "ball_detection[1]", 104, 8, "number", "", "" },
    { "ball_detection[2]", 112, 8, "number", "", "" },
    { "kick_state_div10", 120, 8, "number", "", "" },
    { "current_error_id", 128, 16, "number", "", "" },
    { "current_error_info", 144, 16, "number", "", "" },
    { "current_error_value", 160, 32, "float", "", "" },
    { "motor_current_x10[0]", 192, 8, "number", "0.1 A", "" },
    { "motor_current_x10[1]", 200, 8, "number", "0.1 A", "" },
    { "motor_current_x10[2]", 208, 8, "number", "0.1 A", "" },
    { "motor_current_x10[3]", 216, 8, "number", "0.1 A", "" },
    { "ball_detection_extra", 224, 8, "number", "", "" },
    { "temp_motor[0]", 232, 8, "number", "deg C", "" },
    { "temp_motor[1]", 240, 8, "number", "deg C", "" },
    { "temp_motor[2]", 248, 8, "number", "deg C", "" },
    { "temp_motor[3]", 256, 8, "number", "deg C", "" },
    { "temp_fet", 264, 8, "number", "deg C", "" },
    { "temp_coil[0]", 272, 8, "number", "deg C", "" },
    { "temp_coil[1]", 280, 8, "number", "deg C", "" },
    { "diff_angle_deg", 288, 32, "float", "deg", "" },
    { "capacitor_boost_voltage", 320, 32, "float", "V", "" },
    { "vision_based_position_x", 352, 32, "float", "m", "" },
    { "vision_based_position_y", 384, 32, "float", "m", "" },
    { "global_odom_speed_x", 416, 32, "float", "m/s", "" },
    { "global_odom_speed_y", 448, 32, "float", "m/s", "" },
    { "camera_pos_x_div2", 480, 8, "number", "2 px", "" },
    { "camera_pos_y", 488, 8, "number", "px", "" },
    { "camera_radius_div4", 496, 8, "number", "4 px", "" },
    { "camera_fps", 504, 8, "number", "1/s", "" },
    { "tx_value_array[0]", 512, 32, "float", "m", "" },
    { "tx_value_array[1]", 544, 32, "float", "m", "" },
    { "tx_value_array[2]", 576, 32, "float", "m/s", "" },
    { "tx_value_array[3]", 608, 32, "float", "m/s", "" },
    { "tx_value_array[4]", 640, 32, "float", "m/s", "" },
    { "tx_value_array[5]", 672, 32, "float", "m/s", "" },
    { "tx_value_array[6]", 704, 32, "float", "rev/s", "" },
    { "tx_value_array[7]", 736, 32, "float", "rev/s", "" },
    { "tx_value_array[8]", 768, 32, "float", "rev/s", "" },
    { "tx_value_array[9]", 800, 32, "float", "rev/s", "" },
    { "tx_value_array[10]", 832, 32, "float", "m/s", "" },
    { "tx_value_array[11]", 864, 32, "float", "m/s", "" },
    { "tx_value_array[12]", 896, 32, "float", "rad/s", "" },
    { "tx_value_array[13]", 928, 32, "float", "", "" },
    { "reserved", 960, 64, "number", "", "" },
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

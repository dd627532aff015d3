-- Wireshark dissector of SSL A-Team RNP and motor UART, 2025. Generated from the packet tables by
-- `omnihil formats ateam-rnp-stspin-2025 --wireshark`; do not edit.
local PROTOCOL = "ateam_rnp_stspin_2025"
local proto = Proto(PROTOCOL, "SSL A-Team RNP and motor UART, 2025")

-- name, bytes, types: { first bit, bits, content }, fields: { name, first bit, bits, kind, unit, sign, of a scaled one the unit per count and the value at 0 }
local packets = {
  { name = "uart_motor_command_motion", size = 52, types = { { 0, 8, 33 }, { 8, 24, 0 }, { 32, 32, 0 } }, lsb_first = true, fields = {
    { "type", 0, 8, "number", "", "" },
    { "type_padding", 8, 24, "number", "", "" },
    { "crc", 32, 32, "number", "", "" },
    { "reset", 64, 1, "number", "", "" },
    { "enable_telemetry", 65, 1, "number", "", "" },
    { "flags", 66, 30, "number", "", "" },
    { "motion_control_type", 96, 8, "number", "", "" },
    { "control_padding", 104, 24, "number", "", "" },
    { "setpoint", 128, 32, "float", "rad/s", "" },
    { "rest[0]", 160, 64, "number", "", "" },
    { "rest[1]", 224, 64, "number", "", "" },
    { "rest[2]", 288, 64, "number", "", "" },
    { "rest[3]", 352, 64, "number", "", "" },
  } },
  { name = "uart_motor_command_params", size = 52, types = { { 0, 8, 32 }, { 8, 24, 0 }, { 32, 32, 0 } }, lsb_first = true, fields = {
    { "type", 0, 8, "number", "", "" },
    { "type_padding", 8, 24, "number", "", "" },
    { "crc", 32, 32, "number", "", "" },
    { "flags", 64, 32, "number", "", "" },
    { "timestamp", 96, 32, "number", "", "" },
    { "vel_pid_imax[0]", 128, 32, "float", "", "" },
    { "vel_pid_imax[1]", 160, 32, "float", "", "" },
    { "vel_pid_imax[2]", 192, 32, "float", "", "" },
    { "vel_pid_imax[3]", 224, 32, "float", "", "" },
    { "cur_pid_imax[0]", 256, 32, "float", "", "" },
    { "cur_pid_imax[1]", 288, 32, "float", "", "" },
    { "cur_pid_imax[2]", 320, 32, "float", "", "" },
    { "cur_pid_imax[3]", 352, 32, "float", "", "" },
    { "cur_clamp", 384, 16, "number", "", "" },
    { "end_padding", 400, 16, "number", "", "" },
  } },
  { name = "uart_motor_response_motion", size = 56, types = { { 0, 8, 129 }, { 8, 24, 0 }, { 32, 32, 0 } }, lsb_first = true, fields = {
    { "type", 0, 8, "number", "", "" },
    { "type_padding", 8, 24, "number", "", "" },
    { "crc", 32, 32, "number", "", "" },
    { "flags", 64, 32, "number", "", "" },
    { "vel_setpoint", 96, 32, "float", "rad/s", "" },
    { "vel_setpoint_clamped", 128, 32, "float", "rad/s", "" },
    { "encoder_delta", 160, 32, "number", "rad/s", "signed" },
    { "vel_enc_estimate", 192, 32, "float", "rad/s", "" },
    { "vel_computed_error", 224, 32, "float", "rad/s", "" },
    { "vel_computed_setpoint", 256, 32, "float", "", "" },
    { "torque_setpoint", 288, 32, "float", "N m", "" },
    { "current_estimate", 320, 32, "float", "A", "" },
    { "torque_estimate", 352, 32, "float", "N m", "" },
    { "torque_computed_error", 384, 32, "float", "N m", "" },
    { "torque_computed_setpoint", 416, 32, "float", "", "" },
  } },
  { name = "uart_motor_response_params", size = 56, types = { { 0, 8, 128 }, { 8, 24, 0 }, { 32, 32, 0 } }, lsb_first = true, fields = {
    { "type", 0, 8, "number", "", "" },
    { "type_padding", 8, 24, "number", "", "" },
    { "crc", 32, 32, "number", "", "" },
    { "version[0]", 64, 8, "number", "", "" },
    { "version[1]", 72, 8, "number", "", "" },
    { "version[2]", 80, 16, "number", "", "" },
    { "timestamp", 96, 32, "number", "", "" },
    { "vel_pid_imax[0]", 128, 32, "float", "", "" },
    { "vel_pid_imax[1]", 160, 32, "float", "", "" },
    { "vel_pid_imax[2]", 192, 32, "float", "", "" },
    { "vel_pid_imax[3]", 224, 32, "float", "", "" },
    { "cur_pid_imax[0]", 256, 32, "float", "", "" },
    { "cur_pid_imax[1]", 288, 32, "float", "", "" },
    { "cur_pid_imax[2]", 320, 32, "float", "", "" },
    { "cur_pid_imax[3]", 352, 32, "float", "", "" },
    { "cur_clamp", 384, 16, "number", "", "" },
    { "end_padding", 400, 16, "number", "", "" },
    { "wheel_img_hash[0]", 416, 8, "number", "", "" },
    { "wheel_img_hash[1]", 424, 8, "number", "", "" },
    { "wheel_img_hash[2]", 432, 8, "number", "", "" },
    { "wheel_img_hash[3]", 440, 8, "number", "", "" },
  } },
  { name = "empty", size = 12, types = { }, lsb_first = true, fields = {
    { "crc32", 0, 32, "number", "", "" },
    { "version_major", 32, 16, "number", "", "" },
    { "version_minor", 48, 16, "number", "", "" },
    { "command_code", 64, 8, "number", "", "" },
    { "header_padding", 72, 8, "number", "", "" },
    { "data_length", 80, 16, "number", "bytes", "" },
  } },
  { name = "hello_request", size = 14, types = { { 64, 8, 101 } }, lsb_first = true, fields = {
    { "crc32", 0, 32, "number", "", "" },
    { "version_major", 32, 16, "number", "", "" },
    { "version_minor", 48, 16, "number", "", "" },
    { "command_code", 64, 8, "number", "", "" },
    { "header_padding", 72, 8, "number", "", "" },
    { "data_length", 80, 16, "number", "bytes", "" },
    { "robot_id", 96, 8, "number", "", "" },
    { "color", 104, 8, "number", "", "" },
  } },
  { name = "hello_response", size = 18, types = { { 64, 8, 202 } }, lsb_first = true, fields = {
    { "crc32", 0, 32, "number", "", "" },
    { "version_major", 32, 16, "number", "", "" },
    { "version_minor", 48, 16, "number", "", "" },
    { "command_code", 64, 8, "number", "", "" },
    { "header_padding", 72, 8, "number", "", "" },
    { "data_length", 80, 16, "number", "bytes", "" },
    { "ipv4[0]", 96, 8, "number", "", "" },
    { "ipv4[1]", 104, 8, "number", "", "" },
    { "ipv4[2]", 112, 8, "number", "", "" },
    { "ipv4[3]", 120, 8, "number", "", "" },
    { "port", 128, 16, "number", "", "" },
  } },
  { name = "control", size = 36, types = { { 64, 8, 201 } }, lsb_first = true, fields = {
    { "crc32", 0, 32, "number", "", "" },
    { "version_major", 32, 16, "number", "", "" },
    { "version_minor", 48, 16, "number", "", "" },
    { "command_code", 64, 8, "number", "", "" },
    { "header_padding", 72, 8, "number", "", "" },
    { "data_length", 80, 16, "number", "bytes", "" },
    { "vel_x", 96, 32, "float", "m/s", "" },
    { "vel_y", 128, 32, "float", "m/s", "" },
    { "vel_z", 160, 32, "float", "rad/s", "" },
    { "kick_vel", 192, 32, "float", "m/s", "" },
    { "dribbler_speed", 224, 32, "float", "rpm", "" },
    { "kick_request", 256, 32, "number", "", "" },
  } },
  { name = "telemetry", size = 52, types = { { 64, 8, 102 } }, lsb_first = true, fields = {
    { "crc32", 0, 32, "number", "", "" },
    { "version_major", 32, 16, "number", "", "" },
    { "version_minor", 48, 16, "number", "", "" },
    { "command_code", 64, 8, "number", "", "" },
    { "header_padding", 72, 8, "number", "", "" },
    { "data_length", 80, 16, "number", "bytes", "" },
    { "sequence", 96, 16, "number", "", "" },
    { "rev[0]", 112, 8, "number", "", "" },
    { "rev[1]", 120, 8, "number", "", "" },
    { "battery", 128, 32, "float", "V", "" },
    { "battery_temp", 160, 32, "float", "deg C", "" },
    { "flags.power_error", 192, 1, "number", "", "" },
    { "flags.tipped_error", 193, 1, "number", "", "" },
    { "flags.breakbeam_error", 194, 1, "number", "", "" },
    { "flags.breakbeam_ball_detected", 195, 1, "number", "", "" },
    { "flags.accelerometer_0_error", 196, 1, "number", "", "" },
    { "flags.accelerometer_1_error", 197, 1, "number", "", "" },
    { "flags.gyroscope_0_error", 198, 1, "number", "", "" },
    { "flags.gyroscope_1_error", 199, 1, "number", "", "" },
    { "flags.motor_0_general_error", 200, 1, "number", "", "" },
    { "flags.motor_0_hall_error", 201, 1, "number", "", "" },
    { "flags.motor_1_general_error", 202, 1, "number", "", "" },
    { "flags.motor_1_hall_error", 203, 1, "number", "", "" },
    { "flags.motor_2_general_error", 204, 1, "number", "", "" },
    { "flags.motor_2_hall_error", 205, 1, "number", "", "" },
    { "flags.motor_3_general_error", 206, 1, "number", "", "" },
    { "flags.motor_3_hall_error", 207, 1, "number", "", "" },
    { "flags.motor_4_general_error", 208, 1, "number", "", "" },
    { "flags.motor_4_hall_error", 209, 1, "number", "", "" },
    { "flags.chipper_available", 210, 1, "number", "", "" },
    { "flags.kicker_available", 211, 1, "number", "", "" },
    { "flags.rest", 212, 12, "number", "", "" },
    { "motor_temp[0]", 224, 32, "float", "deg C", "" },
    { "motor_temp[1]", 256, 32, "float", "deg C", "" },
    { "motor_temp[2]", 288, 32, "float", "deg C", "" },
    { "motor_temp[3]", 320, 32, "float", "deg C", "" },
    { "motor_temp[4]", 352, 32, "float", "deg C", "" },
    { "kicker_charge", 384, 32, "float", "V", "" },
  } },
  { name = "control_debug_telemetry", size = 308, types = { { 64, 8, 103 } }, lsb_first = true, fields = {
    { "crc32", 0, 32, "number", "", "" },
    { "version_major", 32, 16, "number", "", "" },
    { "version_minor", 48, 16, "number", "", "" },
    { "command_code", 64, 8, "number", "", "" },
    { "header_padding", 72, 8, "number", "", "" },
    { "data_length", 80, 16, "number", "bytes", "" },
    { "motor_fl.flags", 96, 32, "number", "", "" },
    { "motor_fl.vel_setpoint", 128, 32, "float", "rad/s", "" },
    { "motor_fl.vel_setpoint_clamped", 160, 32, "float", "rad/s", "" },
    { "motor_fl.encoder_delta", 192, 32, "number", "rad/s", "signed" },
    { "motor_fl.vel_enc_estimate", 224, 32, "float", "rad/s", "" },
    { "motor_fl.vel_computed_error", 256, 32, "float", "rad/s", "" },
    { "motor_fl.vel_computed_setpoint", 288, 32, "float", "", "" },
    { "motor_fl.torque_setpoint", 320, 32, "float", "N m", "" },
    { "motor_fl.current_estimate", 352, 32, "float", "A", "" },
    { "motor_fl.torque_estimate", 384, 32, "float", "N m", "" },
    { "motor_fl.torque_computed_error", 416, 32, "float", "N m", "" },
    { "motor_fl.torque_computed_setpoint", 448, 32, "float", "", "" },
    { "motor_bl.flags", 480, 32, "number", "", "" },
    { "motor_bl.vel_setpoint", 512, 32, "float", "rad/s", "" },
    { "motor_bl.vel_setpoint_clamped", 544, 32, "float", "rad/s", "" },
    { "motor_bl.encoder_delta", 576, 32, "number", "rad/s", "signed" },
    { "motor_bl.vel_enc_estimate", 608, 32, "float", "rad/s", "" },
    { "motor_bl.vel_computed_error", 640, 32, "float", "rad/s", "" },
    { "motor_bl.vel_computed_setpoint", 672, 32, "float", "", "" },
    { "motor_bl.torque_setpoint", 704, 32, "float", "N m", "" },
    { "motor_bl.current_estimate", 736, 32, "float", "A", "" },
    { "motor_bl.torque_estimate", 768, 32, "float", "N m", "" },
    { "motor_bl.torque_computed_error", 800, 32, "float", "N m", "" },
    { "motor_bl.torque_computed_setpoint", 832, 32, "float", "", "" },
    { "motor_br.flags", 864, 32, "number", "", "" },
    { "motor_br.vel_setpoint", 896, 32, "float", "rad/s", "" },
    { "motor_br.vel_setpoint_clamped", 928, 32, "float", "rad/s", "" },
    { "motor_br.encoder_delta", 960, 32, "number", "rad/s", "signed" },
    { "motor_br.vel_enc_estimate", 992, 32, "float", "rad/s", "" },
    { "motor_br.vel_computed_error", 1024, 32, "float", "rad/s", "" },
    { "motor_br.vel_computed_setpoint", 1056, 32, "float", "", "" },
    { "motor_br.torque_setpoint", 1088, 32, "float", "N m", "" },
    { "motor_br.current_estimate", 1120, 32, "float", "A", "" },
    { "motor_br.torque_estimate", 1152, 32, "float", "N m", "" },
    { "motor_br.torque_computed_error", 1184, 32, "float", "N m", "" },
    { "motor_br.torque_computed_setpoint", 1216, 32, "float", "", "" },
    { "motor_fr.flags", 1248, 32, "number", "", "" },
    { "motor_fr.vel_setpoint", 1280, 32, "float", "rad/s", "" },
    { "motor_fr.vel_setpoint_clamped", 1312, 32, "float", "rad/s", "" },
    { "motor_fr.encoder_delta", 1344, 32, "number", "rad/s", "signed" },
    { "motor_fr.vel_enc_estimate", 1376, 32, "float", "rad/s", "" },
    { "motor_fr.vel_computed_error", 1408, 32, "float", "rad/s", "" },
    { "motor_fr.vel_computed_setpoint", 1440, 32, "float", "", "" },
    { "motor_fr.torque_setpoint", 1472, 32, "float", "N m", "" },
    { "motor_fr.current_estimate", 1504, 32, "float", "A", "" },
    { "motor_fr.torque_estimate", 1536, 32, "float", "N m", "" },
    { "motor_fr.torque_computed_error", 1568, 32, "float", "N m", "" },
    { "motor_fr.torque_computed_setpoint", 1600, 32, "float", "", "" },
    { "imu_gyro[0]", 1632, 32, "float", "rad/s", "" },
    { "imu_gyro[1]", 1664, 32, "float", "rad/s", "" },
    { "imu_gyro[2]", 1696, 32, "float", "rad/s", "" },
    { "imu_accel[0]", 1728, 32, "float", "m/s^2", "" },
    { "imu_accel[1]", 1760, 32, "float", "m/s^2", "" },
    { "imu_accel[2]", 1792, 32, "float", "m/s^2", "" },
    { "commanded_body_velocity[0]", 1824, 32, "float", "m/s", "" },
    { "commanded_body_velocity[1]", 1856, 32, "float", "m/s", "" },
    { "commanded_body_velocity[2]", 1888, 32, "float", "rad/s", "" },
    { "clamped_commanded_body_velocity[0]", 1920, 32, "float", "m/s", "" },
    { "clamped_commanded_body_velocity[1]", 1952, 32, "float", "m/s", "" },
    { "clamped_commanded_body_velocity[2]", 1984, 32, "float", "rad/s", "" },
    { "cgkf_body_velocity_state_estimate[0]", 2016, 32, "float", "m/s", "" },
    { "cgkf_body_velocity_state_estimate[1]", 2048, 32, "float", "m/s", "" },
    { "cgkf_body_velocity_state_estimate[2]", 2080, 32, "float", "rad/s", "" },
    { "body_velocity_u[0]", 2112, 32, "float", "m/s", "" },
    { "body_velocity_u[1]", 2144, 32, "float", "m/s", "" },
    { "body_velocity_u[2]", 2176, 32, "float", "rad/s", "" },
    { "wheel_velocity_u[0]", 2208, 32, "float", "rad/s", "" },
    { "wheel_velocity_u[1]", 2240, 32, "float", "rad/s", "" },
    { "wheel_velocity_u[2]", 2272, 32, "float", "rad/s", "" },
    { "wheel_velocity_u[3]", 2304, 32, "float", "rad/s", "" },
    { "wheel_velocity_clamped_u[0]", 2336, 32, "float", "rad/s", "" },
    { "wheel_velocity_clamped_u[1]", 2368, 32, "float", "rad/s", "" },
    { "wheel_velocity_clamped_u[2]", 2400, 32, "float", "rad/s", "" },
    { "wheel_velocity_clamped_u[3]", 2432, 32, "float", "rad/s", "" },
  } },
  { name = "robot_parameter_command", size = 116, types = { { 64, 8, 104 } }, lsb_first = true, fields = {
    { "crc32", 0, 32, "number", "", "" },
    { "version_major", 32, 16, "number", "", "" },
    { "version_minor", 48, 16, "number", "", "" },
    { "command_code", 64, 8, "number", "", "" },
    { "header_padding", 72, 8, "number", "", "" },
    { "data_length", 80, 16, "number", "bytes", "" },
    { "code", 96, 8, "number", "", "" },
    { "format", 104, 8, "number", "", "" },
    { "name", 112, 8, "number", "", "" },
    { "padding", 120, 8, "number", "", "" },
    { "values[0]", 128, 32, "float", "", "" },
    { "values[1]", 160, 32, "float", "", "" },
    { "values[2]", 192, 32, "float", "", "" },
    { "values[3]", 224, 32, "float", "", "" },
    { "values[4]", 256, 32, "float", "", "" },
    { "values[5]", 288, 32, "float", "", "" },
    { "values[6]", 320, 32, "float", "", "" },
    { "values[7]", 352, 32, "float", "", "" },
    { "values[8]", 384, 32, "float", "", "" },
    { "values[9]", 416, 32, "float", "", "" },
    { "values[10]", 448, 32, "float", "", "" },
    { "values[11]", 480, 32, "float", "", "" },
    { "values[12]", 512, 32, "float", "", "" },
    { "values[13]", 544, 32, "float", "", "" },
    { "values[14]", 576, 32, "float", "", "" },
    { "values[15]", 608, 32, "float", "", "" },
    { "values[16]", 640, 32, "float", "", "" },
    { "values[17]", 672, 32, "float", "", "" },
    { "values[18]", 704, 32, "float", "", "" },
    { "values[19]", 736, 32, "float", "", "" },
    { "values[20]", 768, 32, "float", "", "" },
    { "values[21]", 800, 32, "float", "", "" },
    { "values[22]", 832, 32, "float", "", "" },
    { "values[23]", 864, 32, "float", "", "" },
    { "values[24]", 896, 32, "float", "", "" },
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

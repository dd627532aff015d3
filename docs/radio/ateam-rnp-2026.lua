-- Wireshark dissector of SSL A-Team RNP, 2026. Generated from the packet tables by
-- `omnihil formats ateam-rnp-2026 --wireshark`; do not edit.
local PROTOCOL = "ateam_rnp_2026"
local proto = Proto(PROTOCOL, "SSL A-Team RNP, 2026")

-- name, bytes, types: { first bit, bits, content }, fields: { name, first bit, bits, kind, unit, sign, of a scaled one the unit per count and the value at 0 }
local packets = {
  { name = "empty", size = 8, types = { }, lsb_first = true, fields = {
    { "crc32", 0, 32, "number", "", "" },
    { "command_code", 32, 8, "number", "", "" },
    { "header_reserved", 40, 8, "number", "", "" },
    { "data_length", 48, 16, "number", "bytes", "" },
  } },
  { name = "hello_request", size = 24, types = { { 32, 8, 21 } }, lsb_first = true, fields = {
    { "crc32", 0, 32, "number", "", "" },
    { "command_code", 32, 8, "number", "", "" },
    { "header_reserved", 40, 8, "number", "", "" },
    { "data_length", 48, 16, "number", "bytes", "" },
    { "robot_id", 64, 8, "number", "", "" },
    { "color", 72, 8, "number", "", "" },
    { "coms_dirty", 80, 1, "number", "", "" },
    { "controls_dirty", 81, 1, "number", "", "" },
    { "firmware_dirty", 82, 1, "number", "", "" },
    { "flags_rest", 83, 5, "number", "", "" },
    { "padding", 88, 8, "number", "", "" },
    { "coms_hash[0]", 96, 8, "number", "", "" },
    { "coms_hash[1]", 104, 8, "number", "", "" },
    { "coms_hash[2]", 112, 8, "number", "", "" },
    { "coms_hash[3]", 120, 8, "number", "", "" },
    { "controls_hash[0]", 128, 8, "number", "", "" },
    { "controls_hash[1]", 136, 8, "number", "", "" },
    { "controls_hash[2]", 144, 8, "number", "", "" },
    { "controls_hash[3]", 152, 8, "number", "", "" },
    { "firmware_hash[0]", 160, 8, "number", "", "" },
    { "firmware_hash[1]", 168, 8, "number", "", "" },
    { "firmware_hash[2]", 176, 8, "number", "", "" },
    { "firmware_hash[3]", 184, 8, "number", "", "" },
  } },
  { name = "hello_response", size = 14, types = { { 32, 8, 22 } }, lsb_first = true, fields = {
    { "crc32", 0, 32, "number", "", "" },
    { "command_code", 32, 8, "number", "", "" },
    { "header_reserved", 40, 8, "number", "", "" },
    { "data_length", 48, 16, "number", "bytes", "" },
    { "ipv4[0]", 64, 8, "number", "", "" },
    { "ipv4[1]", 72, 8, "number", "", "" },
    { "ipv4[2]", 80, 8, "number", "", "" },
    { "ipv4[3]", 88, 8, "number", "", "" },
    { "port", 96, 16, "number", "", "" },
  } },
  { name = "control_off", size = 92, types = { { 32, 8, 61 }, { 192, 8, 0 } }, lsb_first = true, fields = {
    { "crc32", 0, 32, "number", "", "" },
    { "command_code", 32, 8, "number", "", "" },
    { "header_reserved", 40, 8, "number", "", "" },
    { "data_length", 48, 16, "number", "bytes", "" },
    { "request_shutdown", 64, 1, "number", "", "" },
    { "request_reboot", 65, 1, "number", "", "" },
    { "game_in_stop", 66, 1, "number", "", "" },
    { "game_in_halt", 67, 1, "number", "", "" },
    { "emergency_stop", 68, 1, "number", "", "" },
    { "wheel_vel_control", 69, 1, "number", "", "" },
    { "wheel_torque_control", 70, 1, "number", "", "" },
    { "vision_update", 71, 1, "number", "", "" },
    { "reset_controller", 72, 1, "number", "", "" },
    { "flags_rest", 73, 23, "number", "", "" },
    { "vision.x", 96, 32, "float", "m", "" },
    { "vision.y", 128, 32, "float", "m", "" },
    { "vision.yaw", 160, 32, "float", "rad", "" },
    { "body_mode", 192, 8, "number", "", "" },
    { "kick_request", 200, 8, "number", "", "" },
    { "play_song", 208, 8, "number", "", "" },
    { "dribbler_mode", 216, 8, "number", "", "" },
    { "kick_vel", 224, 32, "float", "m/s", "" },
    { "dribbler_setpoint", 256, 32, "float", "", "" },
    { "rest[0]", 288, 64, "number", "", "" },
    { "rest[1]", 352, 64, "number", "", "" },
    { "rest[2]", 416, 64, "number", "", "" },
    { "rest[3]", 480, 64, "number", "", "" },
    { "rest[4]", 544, 64, "number", "", "" },
    { "rest[5]", 608, 64, "number", "", "" },
    { "rest[6]", 672, 64, "number", "", "" },
  } },
  { name = "control_estop_brake", size = 92, types = { { 32, 8, 61 }, { 192, 8, 1 } }, lsb_first = true, fields = {
    { "crc32", 0, 32, "number", "", "" },
    { "command_code", 32, 8, "number", "", "" },
    { "header_reserved", 40, 8, "number", "", "" },
    { "data_length", 48, 16, "number", "bytes", "" },
    { "request_shutdown", 64, 1, "number", "", "" },
    { "request_reboot", 65, 1, "number", "", "" },
    { "game_in_stop", 66, 1, "number", "", "" },
    { "game_in_halt", 67, 1, "number", "", "" },
    { "emergency_stop", 68, 1, "number", "", "" },
    { "wheel_vel_control", 69, 1, "number", "", "" },
    { "wheel_torque_control", 70, 1, "number", "", "" },
    { "vision_update", 71, 1, "number", "", "" },
    { "reset_controller", 72, 1, "number", "", "" },
    { "flags_rest", 73, 23, "number", "", "" },
    { "vision.x", 96, 32, "float", "m", "" },
    { "vision.y", 128, 32, "float", "m", "" },
    { "vision.yaw", 160, 32, "float", "rad", "" },
    { "body_mode", 192, 8, "number", "", "" },
    { "kick_request", 200, 8, "number", "", "" },
    { "play_song", 208, 8, "number", "", "" },
    { "dribbler_mode", 216, 8, "number", "", "" },
    { "kick_vel", 224, 32, "float", "m/s", "" },
    { "dribbler_setpoint", 256, 32, "float", "", "" },
    { "rest[0]", 288, 64, "number", "", "" },
    { "rest[1]", 352, 64, "number", "", "" },
    { "rest[2]", 416, 64, "number", "", "" },
    { "rest[3]", 480, 64, "number", "", "" },
    { "rest[4]", 544, 64, "number", "", "" },
    { "rest[5]", 608, 64, "number", "", "" },
    { "rest[6]", 672, 64, "number", "", "" },
  } },
  { name = "control_global_position", size = 92, types = { { 32, 8, 61 }, { 192, 8, 10 } }, lsb_first = true, fields = {
    { "crc32", 0, 32, "number", "", "" },
    { "command_code", 32, 8, "number", "", "" },
    { "header_reserved", 40, 8, "number", "", "" },
    { "data_length", 48, 16, "number", "bytes", "" },
    { "request_shutdown", 64, 1, "number", "", "" },
    { "request_reboot", 65, 1, "number", "", "" },
    { "game_in_stop", 66, 1, "number", "", "" },
    { "game_in_halt", 67, 1, "number", "", "" },
    { "emergency_stop", 68, 1, "number", "", "" },
    { "wheel_vel_control", 69, 1, "number", "", "" },
    { "wheel_torque_control", 70, 1, "number", "", "" },
    { "vision_update", 71, 1, "number", "", "" },
    { "reset_controller", 72, 1, "number", "", "" },
    { "flags_rest", 73, 23, "number", "", "" },
    { "vision.x", 96, 32, "float", "m", "" },
    { "vision.y", 128, 32, "float", "m", "" },
    { "vision.yaw", 160, 32, "float", "rad", "" },
    { "body_mode", 192, 8, "number", "", "" },
    { "kick_request", 200, 8, "number", "", "" },
    { "play_song", 208, 8, "number", "", "" },
    { "dribbler_mode", 216, 8, "number", "", "" },
    { "kick_vel", 224, 32, "float", "m/s", "" },
    { "dribbler_setpoint", 256, 32, "float", "", "" },
    { "command.x", 288, 32, "float", "m", "" },
    { "command.y", 320, 32, "float", "m", "" },
    { "command.theta", 352, 32, "float", "rad", "" },
    { "command.max_linear_vel", 384, 32, "float", "m/s", "" },
    { "command.max_angular_vel", 416, 32, "float", "rad/s", "" },
    { "command.max_linear_acc", 448, 32, "float", "m/s^2", "" },
    { "command.max_angular_acc", 480, 32, "float", "rad/s^2", "" },
    { "rest[0]", 512, 64, "number", "", "" },
    { "rest[1]", 576, 64, "number", "", "" },
    { "rest[2]", 640, 64, "number", "", "" },
    { "rest[3]", 704, 32, "number", "", "" },
  } },
  { name = "control_global_velocity", size = 92, types = { { 32, 8, 61 }, { 192, 8, 11 } }, lsb_first = true, fields = {
    { "crc32", 0, 32, "number", "", "" },
    { "command_code", 32, 8, "number", "", "" },
    { "header_reserved", 40, 8, "number", "", "" },
    { "data_length", 48, 16, "number", "bytes", "" },
    { "request_shutdown", 64, 1, "number", "", "" },
    { "request_reboot", 65, 1, "number", "", "" },
    { "game_in_stop", 66, 1, "number", "", "" },
    { "game_in_halt", 67, 1, "number", "", "" },
    { "emergency_stop", 68, 1, "number", "", "" },
    { "wheel_vel_control", 69, 1, "number", "", "" },
    { "wheel_torque_control", 70, 1, "number", "", "" },
    { "vision_update", 71, 1, "number", "", "" },
    { "reset_controller", 72, 1, "number", "", "" },
    { "flags_rest", 73, 23, "number", "", "" },
    { "vision.x", 96, 32, "float", "m", "" },
    { "vision.y", 128, 32, "float", "m", "" },
    { "vision.yaw", 160, 32, "float", "rad", "" },
    { "body_mode", 192, 8, "number", "", "" },
    { "kick_request", 200, 8, "number", "", "" },
    { "play_song", 208, 8, "number", "", "" },
    { "dribbler_mode", 216, 8, "number", "", "" },
    { "kick_vel", 224, 32, "float", "m/s", "" },
    { "dribbler_setpoint", 256, 32, "float", "", "" },
    { "command.xd", 288, 32, "float", "m/s", "" },
    { "command.yd", 320, 32, "float", "m/s", "" },
    { "command.omega", 352, 32, "float", "rad/s", "" },
    { "command.max_linear_acc", 384, 32, "float", "m/s^2", "" },
    { "command.max_angular_acc", 416, 32, "float", "rad/s^2", "" },
    { "rest[0]", 448, 64, "number", "", "" },
    { "rest[1]", 512, 64, "number", "", "" },
    { "rest[2]", 576, 64, "number", "", "" },
    { "rest[3]", 640, 64, "number", "", "" },
    { "rest[4]", 704, 32, "number", "", "" },
  } },
  { name = "control_local_velocity", size = 92, types = { { 32, 8, 61 }, { 192, 8, 12 } }, lsb_first = true, fields = {
    { "crc32", 0, 32, "number", "", "" },
    { "command_code", 32, 8, "number", "", "" },
    { "header_reserved", 40, 8, "number", "", "" },
    { "data_length", 48, 16, "number", "bytes", "" },
    { "request_shutdown", 64, 1, "number", "", "" },
    { "request_reboot", 65, 1, "number", "", "" },
    { "game_in_stop", 66, 1, "number", "", "" },
    { "game_in_halt", 67, 1, "number", "", "" },
    { "emergency_stop", 68, 1, "number", "", "" },
    { "wheel_vel_control", 69, 1, "number", "", "" },
    { "wheel_torque_control", 70, 1, "number", "", "" },
    { "vision_update", 71, 1, "number", "", "" },
    { "reset_controller", 72, 1, "number", "", "" },
    { "flags_rest", 73, 23, "number", "", "" },
    { "vision.x", 96, 32, "float", "m", "" },
    { "vision.y", 128, 32, "float", "m", "" },
    { "vision.yaw", 160, 32, "float", "rad", "" },
    { "body_mode", 192, 8, "number", "", "" },
    { "kick_request", 200, 8, "number", "", "" },
    { "play_song", 208, 8, "number", "", "" },
    { "dribbler_mode", 216, 8, "number", "", "" },
    { "kick_vel", 224, 32, "float", "m/s", "" },
    { "dribbler_setpoint", 256, 32, "float", "", "" },
    { "command.xd", 288, 32, "float", "m/s", "" },
    { "command.yd", 320, 32, "float", "m/s", "" },
    { "command.omega", 352, 32, "float", "rad/s", "" },
    { "command.max_linear_acc", 384, 32, "float", "m/s^2", "" },
    { "command.max_angular_acc", 416, 32, "float", "rad/s^2", "" },
    { "rest[0]", 448, 64, "number", "", "" },
    { "rest[1]", 512, 64, "number", "", "" },
    { "rest[2]", 576, 64, "number", "", "" },
    { "rest[3]", 640, 64, "number", "", "" },
    { "rest[4]", 704, 32, "number", "", "" },
  } },
  { name = "control_global_accel", size = 92, types = { { 32, 8, 61 }, { 192, 8, 13 } }, lsb_first = true, fields = {
    { "crc32", 0, 32, "number", "", "" },
    { "command_code", 32, 8, "number", "", "" },
    { "header_reserved", 40, 8, "number", "", "" },
    { "data_length", 48, 16, "number", "bytes", "" },
    { "request_shutdown", 64, 1, "number", "", "" },
    { "request_reboot", 65, 1, "number", "", "" },
    { "game_in_stop", 66, 1, "number", "", "" },
    { "game_in_halt", 67, 1, "number", "", "" },
    { "emergency_stop", 68, 1, "number", "", "" },
    { "wheel_vel_control", 69, 1, "number", "", "" },
    { "wheel_torque_control", 70, 1, "number", "", "" },
    { "vision_update", 71, 1, "number", "", "" },
    { "reset_controller", 72, 1, "number", "", "" },
    { "flags_rest", 73, 23, "number", "", "" },
    { "vision.x", 96, 32, "float", "m", "" },
    { "vision.y", 128, 32, "float", "m", "" },
    { "vision.yaw", 160, 32, "float", "rad", "" },
    { "body_mode", 192, 8, "number", "", "" },
    { "kick_request", 200, 8, "number", "", "" },
    { "play_song", 208, 8, "number", "", "" },
    { "dribbler_mode", 216, 8, "number", "", "" },
    { "kick_vel", 224, 32, "float", "m/s", "" },
    { "dribbler_setpoint", 256, 32, "float", "", "" },
    { "command.xdd", 288, 32, "float", "m/s^2", "" },
    { "command.ydd", 320, 32, "float", "m/s^2", "" },
    { "command.alpha", 352, 32, "float", "rad/s^2", "" },
    { "rest[0]", 384, 64, "number", "", "" },
    { "rest[1]", 448, 64, "number", "", "" },
    { "rest[2]", 512, 64, "number", "", "" },
    { "rest[3]", 576, 64, "number", "", "" },
    { "rest[4]", 640, 64, "number", "", "" },
    { "rest[5]", 704, 32, "number", "", "" },
  } },
  { name = "control_local_accel", size = 92, types = { { 32, 8, 61 }, { 192, 8, 14 } }, lsb_first = true, fields = {
    { "crc32", 0, 32, "number", "", "" },
    { "command_code", 32, 8, "number", "", "" },
    { "header_reserved", 40, 8, "number", "", "" },
    { "data_length", 48, 16, "number", "bytes", "" },
    { "request_shutdown", 64, 1, "number", "", "" },
    { "request_reboot", 65, 1, "number", "", "" },
    { "game_in_stop", 66, 1, "number", "", "" },
    { "game_in_halt", 67, 1, "number", "", "" },
    { "emergency_stop", 68, 1, "number", "", "" },
    { "wheel_vel_control", 69, 1, "number", "", "" },
    { "wheel_torque_control", 70, 1, "number", "", "" },
    { "vision_update", 71, 1, "number", "", "" },
    { "reset_controller", 72, 1, "number", "", "" },
    { "flags_rest", 73, 23, "number", "", "" },
    { "vision.x", 96, 32, "float", "m", "" },
    { "vision.y", 128, 32, "float", "m", "" },
    { "vision.yaw", 160, 32, "float", "rad", "" },
    { "body_mode", 192, 8, "number", "", "" },
    { "kick_request", 200, 8, "number", "", "" },
    { "play_song", 208, 8, "number", "", "" },
    { "dribbler_mode", 216, 8, "number", "", "" },
    { "kick_vel", 224, 32, "float", "m/s", "" },
    { "dribbler_setpoint", 256, 32, "float", "", "" },
    { "command.xdd", 288, 32, "float", "m/s^2", "" },
    { "command.ydd", 320, 32, "float", "m/s^2", "" },
    { "command.alpha", 352, 32, "float", "rad/s^2", "" },
    { "rest[0]", 384, 64, "number", "", "" },
    { "rest[1]", 448, 64, "number", "", "" },
    { "rest[2]", 512, 64, "number", "", "" },
    { "rest[3]", 576, 64, "number", "", "" },
    { "rest[4]", 640, 64, "number", "", "" },
    { "rest[5]", 704, 32, "number", "", "" },
  } },
  { name = "control_heading_pivot", size = 92, types = { { 32, 8, 61 }, { 192, 8, 20 } }, lsb_first = true, fields = {
    { "crc32", 0, 32, "number", "", "" },
    { "command_code", 32, 8, "number", "", "" },
    { "header_reserved", 40, 8, "number", "", "" },
    { "data_length", 48, 16, "number", "bytes", "" },
    { "request_shutdown", 64, 1, "number", "", "" },
    { "request_reboot", 65, 1, "number", "", "" },
    { "game_in_stop", 66, 1, "number", "", "" },
    { "game_in_halt", 67, 1, "number", "", "" },
    { "emergency_stop", 68, 1, "number", "", "" },
    { "wheel_vel_control", 69, 1, "number", "", "" },
    { "wheel_torque_control", 70, 1, "number", "", "" },
    { "vision_update", 71, 1, "number", "", "" },
    { "reset_controller", 72, 1, "number", "", "" },
    { "flags_rest", 73, 23, "number", "", "" },
    { "vision.x", 96, 32, "float", "m", "" },
    { "vision.y", 128, 32, "float", "m", "" },
    { "vision.yaw", 160, 32, "float", "rad", "" },
    { "body_mode", 192, 8, "number", "", "" },
    { "kick_request", 200, 8, "number", "", "" },
    { "play_song", 208, 8, "number", "", "" },
    { "dribbler_mode", 216, 8, "number", "", "" },
    { "kick_vel", 224, 32, "float", "m/s", "" },
    { "dribbler_setpoint", 256, 32, "float", "", "" },
    { "command.theta", 288, 32, "float", "rad", "" },
    { "command.max_vel", 320, 32, "float", "rad/s", "" },
    { "command.max_acc", 352, 32, "float", "rad/s^2", "" },
    { "command.radius", 384, 32, "float", "m", "" },
    { "command.inset", 416, 32, "float", "rad", "" },
    { "command.direction", 448, 8, "number", "", "" },
    { "command.compute_inset", 456, 8, "number", "", "" },
    { "command.padding", 464, 16, "number", "", "" },
    { "rest[0]", 480, 64, "number", "", "" },
    { "rest[1]", 544, 64, "number", "", "" },
    { "rest[2]", 608, 64, "number", "", "" },
    { "rest[3]", 672, 64, "number", "", "" },
  } },
  { name = "control_point_pivot", size = 92, types = { { 32, 8, 61 }, { 192, 8, 21 } }, lsb_first = true, fields = {
    { "crc32", 0, 32, "number", "", "" },
    { "command_code", 32, 8, "number", "", "" },
    { "header_reserved", 40, 8, "number", "", "" },
    { "data_length", 48, 16, "number", "bytes", "" },
    { "request_shutdown", 64, 1, "number", "", "" },
    { "request_reboot", 65, 1, "number", "", "" },
    { "game_in_stop", 66, 1, "number", "", "" },
    { "game_in_halt", 67, 1, "number", "", "" },
    { "emergency_stop", 68, 1, "number", "", "" },
    { "wheel_vel_control", 69, 1, "number", "", "" },
    { "wheel_torque_control", 70, 1, "number", "", "" },
    { "vision_update", 71, 1, "number", "", "" },
    { "reset_controller", 72, 1, "number", "", "" },
    { "flags_rest", 73, 23, "number", "", "" },
    { "vision.x", 96, 32, "float", "m", "" },
    { "vision.y", 128, 32, "float", "m", "" },
    { "vision.yaw", 160, 32, "float", "rad", "" },
    { "body_mode", 192, 8, "number", "", "" },
    { "kick_request", 200, 8, "number", "", "" },
    { "play_song", 208, 8, "number", "", "" },
    { "dribbler_mode", 216, 8, "number", "", "" },
    { "kick_vel", 224, 32, "float", "m/s", "" },
    { "dribbler_setpoint", 256, 32, "float", "", "" },
    { "command.target_x", 288, 32, "float", "m", "" },
    { "command.target_y", 320, 32, "float", "m", "" },
    { "command.max_vel", 352, 32, "float", "rad/s", "" },
    { "command.max_acc", 384, 32, "float", "rad/s^2", "" },
    { "command.radius", 416, 32, "float", "m", "" },
    { "command.inset", 448, 32, "float", "rad", "" },
    { "command.direction", 480, 8, "number", "", "" },
    { "command.compute_inset", 488, 8, "number", "", "" },
    { "command.padding", 496, 16, "number", "", "" },
    { "rest[0]", 512, 64, "number", "", "" },
    { "rest[1]", 576, 64, "number", "", "" },
    { "rest[2]", 640, 64, "number", "", "" },
    { "rest[3]", 704, 32, "number", "", "" },
  } },
  { name = "control_heading_line", size = 92, types = { { 32, 8, 61 }, { 192, 8, 30 } }, lsb_first = true, fields = {
    { "crc32", 0, 32, "number", "", "" },
    { "command_code", 32, 8, "number", "", "" },
    { "header_reserved", 40, 8, "number", "", "" },
    { "data_length", 48, 16, "number", "bytes", "" },
    { "request_shutdown", 64, 1, "number", "", "" },
    { "request_reboot", 65, 1, "number", "", "" },
    { "game_in_stop", 66, 1, "number", "", "" },
    { "game_in_halt", 67, 1, "number", "", "" },
    { "emergency_stop", 68, 1, "number", "", "" },
    { "wheel_vel_control", 69, 1, "number", "", "" },
    { "wheel_torque_control", 70, 1, "number", "", "" },
    { "vision_update", 71, 1, "number", "", "" },
    { "reset_controller", 72, 1, "number", "", "" },
    { "flags_rest", 73, 23, "number", "", "" },
    { "vision.x", 96, 32, "float", "m", "" },
    { "vision.y", 128, 32, "float", "m", "" },
    { "vision.yaw", 160, 32, "float", "rad", "" },
    { "body_mode", 192, 8, "number", "", "" },
    { "kick_request", 200, 8, "number", "", "" },
    { "play_song", 208, 8, "number", "", "" },
    { "dribbler_mode", 216, 8, "number", "", "" },
    { "kick_vel", 224, 32, "float", "m/s", "" },
    { "dribbler_setpoint", 256, 32, "float", "", "" },
    { "command.start_x", 288, 32, "float", "m", "" },
    { "command.start_y", 320, 32, "float", "m", "" },
    { "command.dir_x", 352, 32, "float", "", "" },
    { "command.dir_y", 384, 32, "float", "", "" },
    { "command.line_vel", 416, 32, "float", "m/s", "" },
    { "command.theta", 448, 32, "float", "rad", "" },
    { "command.max_vel_colinear", 480, 32, "float", "m/s", "" },
    { "command.max_vel_perpendicular", 512, 32, "float", "m/s", "" },
    { "command.max_vel_angular", 544, 32, "float", "rad/s", "" },
    { "command.max_acc_colinear", 576, 32, "float", "m/s^2", "" },
    { "command.max_acc_perpendicular", 608, 32, "float", "m/s^2", "" },
    { "command.max_acc_angular", 640, 32, "float", "rad/s^2", "" },
    { "command.start_threshold", 672, 32, "float", "m", "" },
    { "rest[0]", 704, 32, "number", "", "" },
  } },
  { name = "control_point_line", size = 92, types = { { 32, 8, 61 }, { 192, 8, 31 } }, lsb_first = true, fields = {
    { "crc32", 0, 32, "number", "", "" },
    { "command_code", 32, 8, "number", "", "" },
    { "header_reserved", 40, 8, "number", "", "" },
    { "data_length", 48, 16, "number", "bytes", "" },
    { "request_shutdown", 64, 1, "number", "", "" },
    { "request_reboot", 65, 1, "number", "", "" },
    { "game_in_stop", 66, 1, "number", "", "" },
    { "game_in_halt", 67, 1, "number", "", "" },
    { "emergency_stop", 68, 1, "number", "", "" },
    { "wheel_vel_control", 69, 1, "number", "", "" },
    { "wheel_torque_control", 70, 1, "number", "", "" },
    { "vision_update", 71, 1, "number", "", "" },
    { "reset_controller", 72, 1, "number", "", "" },
    { "flags_rest", 73, 23, "number", "", "" },
    { "vision.x", 96, 32, "float", "m", "" },
    { "vision.y", 128, 32, "float", "m", "" },
    { "vision.yaw", 160, 32, "float", "rad", "" },
    { "body_mode", 192, 8, "number", "", "" },
    { "kick_request", 200, 8, "number", "", "" },
    { "play_song", 208, 8, "number", "", "" },
    { "dribbler_mode", 216, 8, "number", "", "" },
    { "kick_vel", 224, 32, "float", "m/s", "" },
    { "dribbler_setpoint", 256, 32, "float", "", "" },
    { "command.start_x", 288, 32, "float", "m", "" },
    { "command.start_y", 320, 32, "float", "m", "" },
    { "command.dir_x", 352, 32, "float", "", "" },
    { "command.dir_y", 384, 32, "float", "", "" },
    { "command.line_vel", 416, 32, "float", "m/s", "" },
    { "command.target_x", 448, 32, "float", "m", "" },
    { "command.target_y", 480, 32, "float", "m", "" },
    { "command.max_vel_colinear", 512, 32, "float", "m/s", "" },
    { "command.max_vel_perpendicular", 544, 32, "float", "m/s", "" },
    { "command.max_vel_angular", 576, 32, "float", "rad/s", "" },
    { "command.max_acc_colinear", 608, 32, "float", "m/s^2", "" },
    { "command.max_acc_perpendicular", 640, 32, "float", "m/s^2", "" },
    { "command.max_acc_angular", 672, 32, "float", "rad/s^2", "" },
    { "command.start_threshold", 704, 32, "float", "m", "" },
  } },
  { name = "telemetry", size = 36, types = { { 32, 8, 41 } }, lsb_first = true, fields = {
    { "crc32", 0, 32, "number", "", "" },
    { "command_code", 32, 8, "number", "", "" },
    { "header_reserved", 40, 8, "number", "", "" },
    { "data_length", 48, 16, "number", "bytes", "" },
    { "transmission_sequence", 64, 8, "number", "", "" },
    { "control_sequence", 72, 8, "number", "", "" },
    { "body_mode", 80, 8, "number", "", "" },
    { "padding", 88, 8, "number", "", "" },
    { "flags.power_error", 96, 1, "number", "", "" },
    { "flags.power_board_error", 97, 1, "number", "", "" },
    { "flags.battery_error", 98, 1, "number", "", "" },
    { "flags.battery_low", 99, 1, "number", "", "" },
    { "flags.battery_crit", 100, 1, "number", "", "" },
    { "flags.shutdown_pending", 101, 1, "number", "", "" },
    { "flags.tipped_error", 102, 1, "number", "", "" },
    { "flags.breakbeam_error", 103, 1, "number", "", "" },
    { "flags.breakbeam_ball_detected", 104, 1, "number", "", "" },
    { "flags.accelerometer_0_error", 105, 1, "number", "", "" },
    { "flags.accelerometer_1_error", 106, 1, "number", "", "" },
    { "flags.gyroscope_0_error", 107, 1, "number", "", "" },
    { "flags.gyroscope_1_error", 108, 1, "number", "", "" },
    { "flags.motor_fl_general_error", 109, 1, "number", "", "" },
    { "flags.motor_fl_hall_error", 110, 1, "number", "", "" },
    { "flags.motor_bl_general_error", 111, 1, "number", "", "" },
    { "flags.motor_bl_hall_error", 112, 1, "number", "", "" },
    { "flags.motor_br_general_error", 113, 1, "number", "", "" },
    { "flags.motor_br_hall_error", 114, 1, "number", "", "" },
    { "flags.motor_fr_general_error", 115, 1, "number", "", "" },
    { "flags.motor_fr_hall_error", 116, 1, "number", "", "" },
    { "flags.motor_drib_general_error", 117, 1, "number", "", "" },
    { "flags.motor_drib_hall_error", 118, 1, "number", "", "" },
    { "flags.kicker_board_error", 119, 1, "number", "", "" },
    { "flags.chipper_available", 120, 1, "number", "", "" },
    { "flags.kicker_available", 121, 1, "number", "", "" },
    { "flags.controller_reset", 122, 1, "number", "", "" },
    { "flags.rest", 123, 5, "number", "", "" },
    { "battery_pct", 128, 16, "number", "%", "" },
    { "kicker_pct", 144, 16, "number", "%", "" },
    { "maneuver", 160, 32, "number", "", "" },
    { "position[0]", 192, 16, "number", "mm", "signed" },
    { "position[1]", 208, 16, "number", "mm", "signed" },
    { "position[2]", 224, 16, "number", "mrad", "signed" },
    { "velocity[0]", 240, 16, "number", "mm/s", "signed" },
    { "velocity[1]", 256, 16, "number", "mm/s", "signed" },
    { "velocity[2]", 272, 16, "number", "mrad/s", "signed" },
  } },
  { name = "error_telemetry", size = 72, types = { { 32, 8, 44 } }, lsb_first = true, fields = {
    { "crc32", 0, 32, "number", "", "" },
    { "command_code", 32, 8, "number", "", "" },
    { "header_reserved", 40, 8, "number", "", "" },
    { "data_length", 48, 16, "number", "bytes", "" },
    { "timestamp", 64, 32, "number", "", "" },
    { "message[0]", 96, 64, "number", "", "" },
    { "message[1]", 160, 64, "number", "", "" },
    { "message[2]", 224, 64, "number", "", "" },
    { "message[3]", 288, 64, "number", "", "" },
    { "message[4]", 352, 64, "number", "", "" },
    { "message[5]", 416, 64, "number", "", "" },
    { "message[6]", 480, 64, "number", "", "" },
    { "message[7]", 544, 32, "number", "", "" },
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

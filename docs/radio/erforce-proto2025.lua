-- Wireshark dissector of ER-Force packets of 2025, serial. Generated from the packet tables by
-- `omnihil formats erforce-proto2025 --wireshark`; do not edit.
local PROTOCOL = "erforce_proto2025"
local proto = Proto(PROTOCOL, "ER-Force packets of 2025, serial")

-- name, bytes, types: { first bit, bits, content }, fields: { name, first bit, bits, kind, unit, sign, of a scaled one the unit per count and the value at 0 }
local packets = {
  { name = "halt", size = 30, types = { { 7, 1, 0 }, { 76, 4, 0 }, { 80, 32, 0 }, { 112, 32, 0 }, { 144, 32, 0 }, { 176, 32, 0 }, { 208, 24, 0 } }, lsb_first = true, fields = {
    { "counter", 0, 6, "number", "", "" },
    { "acknum", 6, 1, "number", "", "" },
    { "datagram", 7, 1, "number", "", "" },
    { "time_offset", 8, 8, "number", "", "signed" },
    { "dribbler", 16, 8, "scaled", "", "signed", 0.00784313679, 0.003921628 },
    { "shot_power", 24, 8, "number", "", "" },
    { "chip", 32, 1, "number", "bool", "" },
    { "charge", 33, 1, "number", "bool", "" },
    { "force_kick", 34, 1, "number", "bool", "" },
    { "standby", 35, 1, "number", "bool", "" },
    { "eject_sdcard", 36, 1, "number", "bool", "" },
    { "has_detection", 37, 1, "number", "bool", "" },
    { "detection_pos_x", 38, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735, only_if = "has_detection" },
    { "detection_pos_y", 49, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735, only_if = "has_detection" },
    { "detection_phi", 60, 9, "scaled", "rad", "signed", 0.0122958623, 0.00614786148, only_if = "has_detection" },
    { "unused", 69, 7, "number", "", "" },
    { "trajectory_type", 76, 4, "number", "", "" },
    { "rest[0]", 80, 32, "number", "", "" },
    { "rest[1]", 112, 32, "number", "", "" },
    { "rest[2]", 144, 32, "number", "", "" },
    { "rest[3]", 176, 32, "number", "", "" },
    { "rest[4]", 208, 24, "number", "", "" },
    { "xor", 232, 8, "number", "", "" },
  } },
  { name = "path", size = 30, types = { { 7, 1, 0 }, { 76, 4, 1 } }, lsb_first = true, fields = {
    { "counter", 0, 6, "number", "", "" },
    { "acknum", 6, 1, "number", "", "" },
    { "datagram", 7, 1, "number", "", "" },
    { "time_offset", 8, 8, "number", "", "signed" },
    { "dribbler", 16, 8, "scaled", "", "signed", 0.00784313679, 0.003921628 },
    { "shot_power", 24, 8, "number", "", "" },
    { "chip", 32, 1, "number", "bool", "" },
    { "charge", 33, 1, "number", "bool", "" },
    { "force_kick", 34, 1, "number", "bool", "" },
    { "standby", 35, 1, "number", "bool", "" },
    { "eject_sdcard", 36, 1, "number", "bool", "" },
    { "has_detection", 37, 1, "number", "bool", "" },
    { "detection_pos_x", 38, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735, only_if = "has_detection" },
    { "detection_pos_y", 49, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735, only_if = "has_detection" },
    { "detection_phi", 60, 9, "scaled", "rad", "signed", 0.0122958623, 0.00614786148, only_if = "has_detection" },
    { "unused", 69, 7, "number", "", "" },
    { "trajectory_type", 76, 4, "number", "", "" },
    { "trajectory.start_x", 80, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735 },
    { "trajectory.start_y", 91, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735 },
    { "trajectory.start_phi", 102, 9, "scaled", "rad", "signed", 0.0122958623, 0.00614786148 },
    { "trajectory.start_vel_x", 111, 12, "scaled", "m/s", "signed", 0.00293040287, 0.00146532059 },
    { "trajectory.start_vel_y", 123, 12, "scaled", "m/s", "signed", 0.00293040287, 0.00146532059 },
    { "trajectory.end_phi", 135, 9, "scaled", "rad", "signed", 0.0122958623, 0.00614786148 },
    { "trajectory.end_vel_x", 144, 12, "scaled", "m/s", "signed", 0.00293040287, 0.00146532059 },
    { "trajectory.end_vel_y", 156, 12, "scaled", "m/s", "signed", 0.00293040287, 0.00146532059 },
    { "trajectory.alpha", 168, 15, "scaled", "rad", "signed", 0.000191753458, 9.58442688e-05 },
    { "trajectory.t", 183, 15, "scaled", "s", "", 0.00122074038, 0 },
    { "trajectory.acc", 198, 12, "scaled", "m/s^2", "", 0.00366300366, 0 },
    { "trajectory.v_max", 210, 12, "scaled", "m/s", "", 0.00146520147, 0 },
    { "trajectory.slow_down_time", 222, 9, "scaled", "s", "", 0.00195694716, 0 },
    { "trajectory.fast_end", 231, 1, "number", "bool", "" },
    { "xor", 232, 8, "number", "", "" },
  } },
  { name = "global_spline", size = 30, types = { { 7, 1, 0 }, { 76, 4, 2 } }, lsb_first = true, fields = {
    { "counter", 0, 6, "number", "", "" },
    { "acknum", 6, 1, "number", "", "" },
    { "datagram", 7, 1, "number", "", "" },
    { "time_offset", 8, 8, "number", "", "signed" },
    { "dribbler", 16, 8, "scaled", "", "signed", 0.00784313679, 0.003921628 },
    { "shot_power", 24, 8, "number", "", "" },
    { "chip", 32, 1, "number", "bool", "" },
    { "charge", 33, 1, "number", "bool", "" },
    { "force_kick", 34, 1, "number", "bool", "" },
    { "standby", 35, 1, "number", "bool", "" },
    { "eject_sdcard", 36, 1, "number", "bool", "" },
    { "has_detection", 37, 1, "number", "bool", "" },
    { "detection_pos_x", 38, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735, only_if = "has_detection" },
    { "detection_pos_y", 49, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735, only_if = "has_detection" },
    { "detection_phi", 60, 9, "scaled", "rad", "signed", 0.0122958623, 0.00614786148, only_if = "has_detection" },
    { "unused", 69, 7, "number", "", "" },
    { "trajectory_type", 76, 4, "number", "", "" },
    { "trajectory.x_pos", 80, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735 },
    { "trajectory.x_vel", 91, 12, "scaled", "m/s", "signed", 0.00293040287, 0.00146532059 },
    { "trajectory.x_acc", 103, 13, "scaled", "m/s^2", "signed", 0.00366255652, 0.00183105469 },
    { "trajectory.x_jerk", 116, 15, "scaled", "m/s^3", "signed", 0.0061037019, 0.00305175781 },
    { "trajectory.y_pos", 131, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735 },
    { "trajectory.y_vel", 142, 12, "scaled", "m/s", "signed", 0.00293040287, 0.00146532059 },
    { "trajectory.y_acc", 154, 13, "scaled", "m/s^2", "signed", 0.00366255652, 0.00183105469 },
    { "trajectory.y_jerk", 167, 15, "scaled", "m/s^3", "signed", 0.0061037019, 0.00305175781 },
    { "trajectory.phi_pos", 182, 9, "scaled", "rad", "signed", 0.0122958623, 0.00614786148 },
    { "trajectory.phi_vel", 191, 10, "scaled", "rad/s", "signed", 0.122838425, 0.0614204407 },
    { "trajectory.phi_acc", 201, 14, "scaled", "rad/s^2", "signed", 1.83116616, 0.916015625 },
    { "trajectory.phi_jerk", 215, 17, "scaled", "rad/s^3", "signed", 6.10356203, 3.0625 },
    { "xor", 232, 8, "number", "", "" },
  } },
  { name = "local_spline", size = 30, types = { { 7, 1, 0 }, { 76, 4, 3 } }, lsb_first = true, fields = {
    { "counter", 0, 6, "number", "", "" },
    { "acknum", 6, 1, "number", "", "" },
    { "datagram", 7, 1, "number", "", "" },
    { "time_offset", 8, 8, "number", "", "signed" },
    { "dribbler", 16, 8, "scaled", "", "signed", 0.00784313679, 0.003921628 },
    { "shot_power", 24, 8, "number", "", "" },
    { "chip", 32, 1, "number", "bool", "" },
    { "charge", 33, 1, "number", "bool", "" },
    { "force_kick", 34, 1, "number", "bool", "" },
    { "standby", 35, 1, "number", "bool", "" },
    { "eject_sdcard", 36, 1, "number", "bool", "" },
    { "has_detection", 37, 1, "number", "bool", "" },
    { "detection_pos_x", 38, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735, only_if = "has_detection" },
    { "detection_pos_y", 49, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735, only_if = "has_detection" },
    { "detection_phi", 60, 9, "scaled", "rad", "signed", 0.0122958623, 0.00614786148, only_if = "has_detection" },
    { "unused", 69, 7, "number", "", "" },
    { "trajectory_type", 76, 4, "number", "", "" },
    { "trajectory.x_pos", 80, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735 },
    { "trajectory.x_vel", 91, 12, "scaled", "m/s", "signed", 0.00293040287, 0.00146532059 },
    { "trajectory.x_acc", 103, 13, "scaled", "m/s^2", "signed", 0.00366255652, 0.00183105469 },
    { "trajectory.x_jerk", 116, 15, "scaled", "m/s^3", "signed", 0.0061037019, 0.00305175781 },
    { "trajectory.y_pos", 131, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735 },
    { "trajectory.y_vel", 142, 12, "scaled", "m/s", "signed", 0.00293040287, 0.00146532059 },
    { "trajectory.y_acc", 154, 13, "scaled", "m/s^2", "signed", 0.00366255652, 0.00183105469 },
    { "trajectory.y_jerk", 167, 15, "scaled", "m/s^3", "signed", 0.0061037019, 0.00305175781 },
    { "trajectory.phi_pos", 182, 9, "scaled", "rad", "signed", 0.0122958623, 0.00614786148 },
    { "trajectory.phi_vel", 191, 10, "scaled", "rad/s", "signed", 0.122838425, 0.0614204407 },
    { "trajectory.phi_acc", 201, 14, "scaled", "rad/s^2", "signed", 1.83116616, 0.916015625 },
    { "trajectory.phi_jerk", 215, 17, "scaled", "rad/s^3", "signed", 6.10356203, 3.0625 },
    { "xor", 232, 8, "number", "", "" },
  } },
  { name = "echo", size = 30, types = { { 7, 1, 1 }, { 9, 7, 0 } }, lsb_first = true, fields = {
    { "counter", 0, 6, "number", "", "" },
    { "acknum", 6, 1, "number", "", "" },
    { "datagram", 7, 1, "number", "", "" },
    { "seqnum", 8, 1, "number", "", "" },
    { "type", 9, 7, "number", "", "" },
    { "data[0]", 16, 8, "number", "", "" },
    { "data[1]", 24, 8, "number", "", "" },
    { "data[2]", 32, 8, "number", "", "" },
    { "data[3]", 40, 8, "number", "", "" },
    { "data[4]", 48, 8, "number", "", "" },
    { "data[5]", 56, 8, "number", "", "" },
    { "data[6]", 64, 8, "number", "", "" },
    { "data[7]", 72, 8, "number", "", "" },
    { "data[8]", 80, 8, "number", "", "" },
    { "data[9]", 88, 8, "number", "", "" },
    { "data[10]", 96, 8, "number", "", "" },
    { "data[11]", 104, 8, "number", "", "" },
    { "data[12]", 112, 8, "number", "", "" },
    { "data[13]", 120, 8, "number", "", "" },
    { "data[14]", 128, 8, "number", "", "" },
    { "data[15]", 136, 8, "number", "", "" },
    { "data[16]", 144, 8, "number", "", "" },
    { "data[17]", 152, 8, "number", "", "" },
    { "data[18]", 160, 8, "number", "", "" },
    { "data[19]", 168, 8, "number", "", "" },
    { "data[20]", 176, 8, "number", "", "" },
    { "data[21]", 184, 8, "number", "", "" },
    { "data[22]", 192, 8, "number", "", "" },
    { "data[23]", 200, 8, "number", "", "" },
    { "data[24]", 208, 8, "number", "", "" },
    { "data[25]", 216, 8, "number", "", "" },
    { "data[26]", 224, 8, "number", "", "" },
    { "xor", 232, 8, "number", "", "" },
  } },
  { name = "read_robot_id", size = 30, types = { { 7, 1, 1 }, { 9, 7, 1 } }, lsb_first = true, fields = {
    { "counter", 0, 6, "number", "", "" },
    { "acknum", 6, 1, "number", "", "" },
    { "datagram", 7, 1, "number", "", "" },
    { "seqnum", 8, 1, "number", "", "" },
    { "type", 9, 7, "number", "", "" },
    { "data[0]", 16, 8, "number", "", "" },
    { "data[1]", 24, 8, "number", "", "" },
    { "data[2]", 32, 8, "number", "", "" },
    { "data[3]", 40, 8, "number", "", "" },
    { "data[4]", 48, 8, "number", "", "" },
    { "data[5]", 56, 8, "number", "", "" },
    { "data[6]", 64, 8, "number", "", "" },
    { "data[7]", 72, 8, "number", "", "" },
    { "data[8]", 80, 8, "number", "", "" },
    { "data[9]", 88, 8, "number", "", "" },
    { "data[10]", 96, 8, "number", "", "" },
    { "data[11]", 104, 8, "number", "", "" },
    { "data[12]", 112, 8, "number", "", "" },
    { "data[13]", 120, 8, "number", "", "" },
    { "data[14]", 128, 8, "number", "", "" },
    { "data[15]", 136, 8, "number", "", "" },
    { "data[16]", 144, 8, "number", "", "" },
    { "data[17]", 152, 8, "number", "", "" },
    { "data[18]", 160, 8, "number", "", "" },
    { "data[19]", 168, 8, "number", "", "" },
    { "data[20]", 176, 8, "number", "", "" },
    { "data[21]", 184, 8, "number", "", "" },
    { "data[22]", 192, 8, "number", "", "" },
    { "data[23]", 200, 8, "number", "", "" },
    { "data[24]", 208, 8, "number", "", "" },
    { "data[25]", 216, 8, "number", "", "" },
    { "data[26]", 224, 8, "number", "", "" },
    { "xor", 232, 8, "number", "", "" },
  } },
  { name = "read_board_ids", size = 30, types = { { 7, 1, 1 }, { 9, 7, 2 } }, lsb_first = true, fields = {
    { "counter", 0, 6, "number", "", "" },
    { "acknum", 6, 1, "number", "", "" },
    { "datagram", 7, 1, "number", "", "" },
    { "seqnum", 8, 1, "number", "", "" },
    { "type", 9, 7, "number", "", "" },
    { "data[0]", 16, 8, "number", "", "" },
    { "data[1]", 24, 8, "number", "", "" },
    { "data[2]", 32, 8, "number", "", "" },
    { "data[3]", 40, 8, "number", "", "" },
    { "data[4]", 48, 8, "number", "", "" },
    { "data[5]", 56, 8, "number", "", "" },
    { "data[6]", 64, 8, "number", "", "" },
    { "data[7]", 72, 8, "number", "", "" },
    { "data[8]", 80, 8, "number", "", "" },
    { "data[9]", 88, 8, "number", "", "" },
    { "data[10]", 96, 8, "number", "", "" },
    { "data[11]", 104, 8, "number", "", "" },
    { "data[12]", 112, 8, "number", "", "" },
    { "data[13]", 120, 8, "number", "", "" },
    { "data[14]", 128, 8, "number", "", "" },
    { "data[15]", 136, 8, "number", "", "" },
    { "data[16]", 144, 8, "number", "", "" },
    { "data[17]", 152, 8, "number", "", "" },
    { "data[18]", 160, 8, "number", "", "" },
    { "data[19]", 168, 8, "number", "", "" },
    { "data[20]", 176, 8, "number", "", "" },
    { "data[21]", 184, 8, "number", "", "" },
    { "data[22]", 192, 8, "number", "", "" },
    { "data[23]", 200, 8, "number", "", "" },
    { "data[24]", 208, 8, "number", "", "" },
    { "data[25]", 216, 8, "number", "", "" },
    { "data[26]", 224, 8, "number", "", "" },
    { "xor", 232, 8, "number", "", "" },
  } },
  { name = "toggle_kick_calibration", size = 30, types = { { 7, 1, 1 }, { 9, 7, 3 } }, lsb_first = true, fields = {
    { "counter", 0, 6, "number", "", "" },
    { "acknum", 6, 1, "number", "", "" },
    { "datagram", 7, 1, "number", "", "" },
    { "seqnum", 8, 1, "number", "", "" },
    { "type", 9, 7, "number", "", "" },
    { "data[0]", 16, 8, "number", "", "" },
    { "data[1]", 24, 8, "number", "", "" },
    { "data[2]", 32, 8, "number", "", "" },
    { "data[3]", 40, 8, "number", "", "" },
    { "data[4]", 48, 8, "number", "", "" },
    { "data[5]", 56, 8, "number", "", "" },
    { "data[6]", 64, 8, "number", "", "" },
    { "data[7]", 72, 8, "number", "", "" },
    { "data[8]", 80, 8, "number", "", "" },
    { "data[9]", 88, 8, "number", "", "" },
    { "data[10]", 96, 8, "number", "", "" },
    { "data[11]", 104, 8, "number", "", "" },
    { "data[12]", 112, 8, "number", "", "" },
    { "data[13]", 120, 8, "number", "", "" },
    { "data[14]", 128, 8, "number", "", "" },
    { "data[15]", 136, 8, "number", "", "" },
    { "data[16]", 144, 8, "number", "", "" },
    { "data[17]", 152, 8, "number", "", "" },
    { "data[18]", 160, 8, "number", "", "" },
    { "data[19]", 168, 8, "number", "", "" },
    { "data[20]", 176, 8, "number", "", "" },
    { "data[21]", 184, 8, "number", "", "" },
    { "data[22]", 192, 8, "number", "", "" },
    { "data[23]", 200, 8, "number", "", "" },
    { "data[24]", 208, 8, "number", "", "" },
    { "data[25]", 216, 8, "number", "", "" },
    { "data[26]", 224, 8, "number", "", "" },
    { "xor", 232, 8, "number", "", "" },
  } },
  { name = "write_kick_calibration", size = 30, types = { { 7, 1, 1 }, { 9, 7, 4 } }, lsb_first = true, fields = {
    { "counter", 0, 6, "number", "", "" },
    { "acknum", 6, 1, "number", "", "" },
    { "datagram", 7, 1, "number", "", "" },
    { "seqnum", 8, 1, "number", "", "" },
    { "type", 9, 7, "number", "", "" },
    { "data[0]", 16, 8, "number", "", "" },
    { "data[1]", 24, 8, "number", "", "" },
    { "data[2]", 32, 8, "number", "", "" },
    { "data[3]", 40, 8, "number", "", "" },
    { "data[4]", 48, 8, "number", "", "" },
    { "data[5]", 56, 8, "number", "", "" },
    { "data[6]", 64, 8, "number", "", "" },
    { "data[7]", 72, 8, "number", "", "" },
    { "data[8]", 80, 8, "number", "", "" },
    { "data[9]", 88, 8, "number", "", "" },
    { "data[10]", 96, 8, "number", "", "" },
    { "data[11]", 104, 8, "number", "", "" },
    { "data[12]", 112, 8, "number", "", "" },
    { "data[13]", 120, 8, "number", "", "" },
    { "data[14]", 128, 8, "number", "", "" },
    { "data[15]", 136, 8, "number", "", "" },
    { "data[16]", 144, 8, "number", "", "" },
    { "data[17]", 152, 8, "number", "", "" },
    { "data[18]", 160, 8, "number", "", "" },
    { "data[19]", 168, 8, "number", "", "" },
    { "data[20]", 176, 8, "number", "", "" },
    { "data[21]", 184, 8, "number", "", "" },
    { "data[22]", 192, 8, "number", "", "" },
    { "data[23]", 200, 8, "number", "", "" },
    { "data[24]", 208, 8, "number", "", "" },
    { "data[25]", 216, 8, "number", "", "" },
    { "data[26]", 224, 8, "number", "", "" },
    { "xor", 232, 8, "number", "", "" },
  } },
  { name = "response", size = 30, types = { { 7, 1, 0 } }, lsb_first = true, fields = {
    { "counter", 0, 6, "number", "", "" },
    { "acknum", 6, 1, "number", "", "" },
    { "datagram", 7, 1, "number", "", "" },
    { "battery", 8, 8, "scaled", "", "", 0.00392156863, 0 },
    { "packet_loss", 16, 8, "scaled", "", "", 0.00392156863, 0 },
    { "motor_status[0].error", 24, 1, "number", "bool", "" },
    { "motor_status[0].overheated", 25, 1, "number", "bool", "" },
    { "motor_status[0].encoder_error", 26, 1, "number", "bool", "" },
    { "m0", 27, 5, "number", "", "" },
    { "motor_status[1].error", 32, 1, "number", "bool", "" },
    { "motor_status[1].overheated", 33, 1, "number", "bool", "" },
    { "motor_status[1].encoder_error", 34, 1, "number", "bool", "" },
    { "m1", 35, 5, "number", "", "" },
    { "motor_status[2].error", 40, 1, "number", "bool", "" },
    { "motor_status[2].overheated", 41, 1, "number", "bool", "" },
    { "motor_status[2].encoder_error", 42, 1, "number", "bool", "" },
    { "m2", 43, 5, "number", "", "" },
    { "motor_status[3].error", 48, 1, "number", "bool", "" },
    { "motor_status[3].overheated", 49, 1, "number", "bool", "" },
    { "motor_status[3].encoder_error", 50, 1, "number", "bool", "" },
    { "m3", 51, 5, "number", "", "" },
    { "dribbler_status.error", 56, 1, "number", "bool", "" },
    { "dribbler_status.overheated", 57, 1, "number", "bool", "" },
    { "dribbler_status.encoder_error", 58, 1, "number", "bool", "" },
    { "m4", 59, 5, "number", "", "" },
    { "kicker_status.error", 64, 1, "number", "bool", "" },
    { "kicker_status.break_beam_error", 65, 1, "number", "bool", "" },
    { "kicker_rest", 66, 6, "number", "", "" },
    { "imu_status.error", 72, 1, "number", "bool", "" },
    { "imu_rest", 73, 3, "number", "", "" },
    { "no_trajectory", 76, 4, "number", "", "" },
    { "sd_status.error", 80, 1, "number", "bool", "" },
    { "sd_status.mounted", 81, 1, "number", "bool", "" },
    { "sd_status.full", 82, 1, "number", "bool", "" },
    { "sd_rest", 83, 5, "number", "", "" },
    { "load_torque[0]", 88, 8, "scaled", "", "signed", 0.0784313698, 0.0392160416 },
    { "load_torque[1]", 96, 8, "scaled", "", "signed", 0.0784313698, 0.0392160416 },
    { "load_torque[2]", 104, 8, "scaled", "", "signed", 0.0784313698, 0.0392160416 },
    { "load_torque[3]", 112, 8, "scaled", "", "signed", 0.0784313698, 0.0392160416 },
    { "dribbler_load_torque", 120, 8, "scaled", "", "signed", 0.0784313698, 0.0392160416 },
    { "measured_pos_x", 128, 14, "scaled", "m", "signed", 0.000976622112, 0.00048828125 },
    { "measured_pos_y", 142, 14, "scaled", "m", "signed", 0.000976622112, 0.00048828125 },
    { "measured_phi", 156, 14, "scaled", "rad", "signed", 0.000383518624, 0.000191688538 },
    { "measured_vel_x", 170, 15, "scaled", "m/s", "signed", 0.000366222114, 0.000183105469 },
    { "measured_vel_y", 185, 15, "scaled", "m/s", "signed", 0.000366222114, 0.000183105469 },
    { "measured_omega", 200, 14, "scaled", "rad/s", "signed", 0.0076703726, 0.00383377075 },
    { "power_enabled", 214, 1, "number", "bool", "" },
    { "ball_detected", 215, 1, "number", "bool", "" },
    { "rest", 216, 16, "number", "", "" },
    { "xor", 232, 8, "number", "", "" },
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

-- The bytes behind COBS, nil where the codes do not fit.
local function uncobs(range)
  local out, at, length = ByteArray.new(), 0, range:len()
  out:set_size(length)
  local count = 0
  while at < length do
    local code = range(at, 1):uint()
    if code == 0 or at + code > length then return nil end
    for i = at + 1, at + code - 1 do
      out:set_index(count, range(i, 1):uint())
      count = count + 1
    end
    at = at + code
    if code < 255 and at < length then
      out:set_index(count, 0)
      count = count + 1
    end
  end
  if count == 0 then return nil end
  return out:subset(0, count)
end

function proto.dissector(buffer, pinfo, tree)
  pinfo.cols.protocol = PROTOCOL
  local first = 0
  for at = 0, buffer:len() - 1 do
    if buffer(at, 1):uint() == 0 then
      local data = at > first and uncobs(buffer(first, at - first))
      if data then
        add_packet(tree, data:tvb("without COBS")(), pinfo)
      else
        tree:add(proto, buffer(first, at - first + 1)):add_proto_expert_info(fault, "framing")
      end
      first = at + 1
    end
  end
end

-- Chosen with "Decode As": a UDP port, or the link type USER 0 of a capture of serial bytes.
DissectorTable.get("udp.port"):add_for_decode_as(proto)
DissectorTable.get("wtap_encap"):add(wtap.USER0, proto)

-- Wireshark dissector of ER-Force packets of 2025, udp2serial. Generated from the packet tables by
-- `omnihil formats erforce-proto2025-bridge --wireshark`; do not edit.
local PROTOCOL = "erforce_proto2025_bridge"
local proto = Proto(PROTOCOL, "ER-Force packets of 2025, udp2serial")

-- name, bytes, types: { first bit, bits, content }, fields: { name, first bit, bits, kind, unit, sign, of a scaled one the unit per count and the value at 0 }
local packets = {
  { name = "halt", size = 31, types = { { 0, 8, 0 }, { 15, 1, 0 }, { 84, 4, 0 }, { 88, 32, 0 }, { 120, 32, 0 }, { 152, 32, 0 }, { 184, 32, 0 }, { 216, 24, 0 } }, lsb_first = true, fields = {
    { "kind", 0, 8, "number", "", "" },
    { "counter", 8, 6, "number", "", "" },
    { "acknum", 14, 1, "number", "", "" },
    { "datagram", 15, 1, "number", "", "" },
    { "time_offset", 16, 8, "number", "", "signed" },
    { "dribbler", 24, 8, "scaled", "", "signed", 0.00784313679, 0.003921628 },
    { "shot_power", 32, 8, "number", "", "" },
    { "chip", 40, 1, "number", "bool", "" },
    { "charge", 41, 1, "number", "bool", "" },
    { "force_kick", 42, 1, "number", "bool", "" },
    { "standby", 43, 1, "number", "bool", "" },
    { "eject_sdcard", 44, 1, "number", "bool", "" },
    { "has_detection", 45, 1, "number", "bool", "" },
    { "detection_pos_x", 46, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735, only_if = "has_detection" },
    { "detection_pos_y", 57, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735, only_if = "has_detection" },
    { "detection_phi", 68, 9, "scaled", "rad", "signed", 0.0122958623, 0.00614786148, only_if = "has_detection" },
    { "unused", 77, 7, "number", "", "" },
    { "trajectory_type", 84, 4, "number", "", "" },
    { "rest[0]", 88, 32, "number", "", "" },
    { "rest[1]", 120, 32, "number", "", "" },
    { "rest[2]", 152, 32, "number", "", "" },
    { "rest[3]", 184, 32, "number", "", "" },
    { "rest[4]", 216, 24, "number", "", "" },
    { "xor", 240, 8, "number", "", "" },
  } },
  { name = "path", size = 31, types = { { 0, 8, 0 }, { 15, 1, 0 }, { 84, 4, 1 } }, lsb_first = true, fields = {
    { "kind", 0, 8, "number", "", "" },
    { "counter", 8, 6, "number", "", "" },
    { "acknum", 14, 1, "number", "", "" },
    { "datagram", 15, 1, "number", "", "" },
    { "time_offset", 16, 8, "number", "", "signed" },
    { "dribbler", 24, 8, "scaled", "", "signed", 0.00784313679, 0.003921628 },
    { "shot_power", 32, 8, "number", "", "" },
    { "chip", 40, 1, "number", "bool", "" },
    { "charge", 41, 1, "number", "bool", "" },
    { "force_kick", 42, 1, "number", "bool", "" },
    { "standby", 43, 1, "number", "bool", "" },
    { "eject_sdcard", 44, 1, "number", "bool", "" },
    { "has_detection", 45, 1, "number", "bool", "" },
    { "detection_pos_x", 46, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735, only_if = "has_detection" },
    { "detection_pos_y", 57, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735, only_if = "has_detection" },
    { "detection_phi", 68, 9, "scaled", "rad", "signed", 0.0122958623, 0.00614786148, only_if = "has_detection" },
    { "unused", 77, 7, "number", "", "" },
    { "trajectory_type", 84, 4, "number", "", "" },
    { "trajectory.start_x", 88, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735 },
    { "trajectory.start_y", 99, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735 },
    { "trajectory.start_phi", 110, 9, "scaled", "rad", "signed", 0.0122958623, 0.00614786148 },
    { "trajectory.start_vel_x", 119, 12, "scaled", "m/s", "signed", 0.00293040287, 0.00146532059 },
    { "trajectory.start_vel_y", 131, 12, "scaled", "m/s", "signed", 0.00293040287, 0.00146532059 },
    { "trajectory.end_phi", 143, 9, "scaled", "rad", "signed", 0.0122958623, 0.00614786148 },
    { "trajectory.end_vel_x", 152, 12, "scaled", "m/s", "signed", 0.00293040287, 0.00146532059 },
    { "trajectory.end_vel_y", 164, 12, "scaled", "m/s", "signed", 0.00293040287, 0.00146532059 },
    { "trajectory.alpha", 176, 15, "scaled", "rad", "signed", 0.000191753458, 9.58442688e-05 },
    { "trajectory.t", 191, 15, "scaled", "s", "", 0.00122074038, 0 },
    { "trajectory.acc", 206, 12, "scaled", "m/s^2", "", 0.00366300366, 0 },
    { "trajectory.v_max", 218, 12, "scaled", "m/s", "", 0.00146520147, 0 },
    { "trajectory.slow_down_time", 230, 9, "scaled", "s", "", 0.00195694716, 0 },
    { "trajectory.fast_end", 239, 1, "number", "bool", "" },
    { "xor", 240, 8, "number", "", "" },
  } },
  { name = "global_spline", size = 31, types = { { 0, 8, 0 }, { 15, 1, 0 }, { 84, 4, 2 } }, lsb_first = true, fields = {
    { "kind", 0, 8, "number", "", "" },
    { "counter", 8, 6, "number", "", "" },
    { "acknum", 14, 1, "number", "", "" },
    { "datagram", 15, 1, "number", "", "" },
    { "time_offset", 16, 8, "number", "", "signed" },
    { "dribbler", 24, 8, "scaled", "", "signed", 0.00784313679, 0.003921628 },
    { "shot_power", 32, 8, "number", "", "" },
    { "chip", 40, 1, "number", "bool", "" },
    { "charge", 41, 1, "number", "bool", "" },
    { "force_kick", 42, 1, "number", "bool", "" },
    { "standby", 43, 1, "number", "bool", "" },
    { "eject_sdcard", 44, 1, "number", "bool", "" },
    { "has_detection", 45, 1, "number", "bool", "" },
    { "detection_pos_x", 46, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735, only_if = "has_detection" },
    { "detection_pos_y", 57, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735, only_if = "has_detection" },
    { "detection_phi", 68, 9, "scaled", "rad", "signed", 0.0122958623, 0.00614786148, only_if = "has_detection" },
    { "unused", 77, 7, "number", "", "" },
    { "trajectory_type", 84, 4, "number", "", "" },
    { "trajectory.x_pos", 88, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735 },
    { "trajectory.x_vel", 99, 12, "scaled", "m/s", "signed", 0.00293040287, 0.00146532059 },
    { "trajectory.x_acc", 111, 13, "scaled", "m/s^2", "signed", 0.00366255652, 0.00183105469 },
    { "trajectory.x_jerk", 124, 15, "scaled", "m/s^3", "signed", 0.0061037019, 0.00305175781 },
    { "trajectory.y_pos", 139, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735 },
    { "trajectory.y_vel", 150, 12, "scaled", "m/s", "signed", 0.00293040287, 0.00146532059 },
    { "trajectory.y_acc", 162, 13, "scaled", "m/s^2", "signed", 0.00366255652, 0.00183105469 },
    { "trajectory.y_jerk", 175, 15, "scaled", "m/s^3", "signed", 0.0061037019, 0.00305175781 },
    { "trajectory.phi_pos", 190, 9, "scaled", "rad", "signed", 0.0122958623, 0.00614786148 },
    { "trajectory.phi_vel", 199, 10, "scaled", "rad/s", "signed", 0.122838425, 0.0614204407 },
    { "trajectory.phi_acc", 209, 14, "scaled", "rad/s^2", "signed", 1.83116616, 0.916015625 },
    { "trajectory.phi_jerk", 223, 17, "scaled", "rad/s^3", "signed", 6.10356203, 3.0625 },
    { "xor", 240, 8, "number", "", "" },
  } },
  { name = "local_spline", size = 31, types = { { 0, 8, 0 }, { 15, 1, 0 }, { 84, 4, 3 } }, lsb_first = true, fields = {
    { "kind", 0, 8, "number", "", "" },
    { "counter", 8, 6, "number", "", "" },
    { "acknum", 14, 1, "number", "", "" },
    { "datagram", 15, 1, "number", "", "" },
    { "time_offset", 16, 8, "number", "", "signed" },
    { "dribbler", 24, 8, "scaled", "", "signed", 0.00784313679, 0.003921628 },
    { "shot_power", 32, 8, "number", "", "" },
    { "chip", 40, 1, "number", "bool", "" },
    { "charge", 41, 1, "number", "bool", "" },
    { "force_kick", 42, 1, "number", "bool", "" },
    { "standby", 43, 1, "number", "bool", "" },
    { "eject_sdcard", 44, 1, "number", "bool", "" },
    { "has_detection", 45, 1, "number", "bool", "" },
    { "detection_pos_x", 46, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735, only_if = "has_detection" },
    { "detection_pos_y", 57, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735, only_if = "has_detection" },
    { "detection_phi", 68, 9, "scaled", "rad", "signed", 0.0122958623, 0.00614786148, only_if = "has_detection" },
    { "unused", 77, 7, "number", "", "" },
    { "trajectory_type", 84, 4, "number", "", "" },
    { "trajectory.x_pos", 88, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735 },
    { "trajectory.x_vel", 99, 12, "scaled", "m/s", "signed", 0.00293040287, 0.00146532059 },
    { "trajectory.x_acc", 111, 13, "scaled", "m/s^2", "signed", 0.00366255652, 0.00183105469 },
    { "trajectory.x_jerk", 124, 15, "scaled", "m/s^3", "signed", 0.0061037019, 0.00305175781 },
    { "trajectory.y_pos", 139, 11, "scaled", "m", "signed", 0.00781631656, 0.00390815735 },
    { "trajectory.y_vel", 150, 12, "scaled", "m/s", "signed", 0.00293040287, 0.00146532059 },
    { "trajectory.y_acc", 162, 13, "scaled", "m/s^2", "signed", 0.00366255652, 0.00183105469 },
    { "trajectory.y_jerk", 175, 15, "scaled", "m/s^3", "signed", 0.0061037019, 0.00305175781 },
    { "trajectory.phi_pos", 190, 9, "scaled", "rad", "signed", 0.0122958623, 0.00614786148 },
    { "trajectory.phi_vel", 199, 10, "scaled", "rad/s", "signed", 0.122838425, 0.0614204407 },
    { "trajectory.phi_acc", 209, 14, "scaled", "rad/s^2", "signed", 1.83116616, 0.916015625 },
    { "trajectory.phi_jerk", 223, 17, "scaled", "rad/s^3", "signed", 6.10356203, 3.0625 },
    { "xor", 240, 8, "number", "", "" },
  } },
  { name = "echo", size = 31, types = { { 0, 8, 0 }, { 15, 1, 1 }, { 17, 7, 0 } }, lsb_first = true, fields = {
    { "kind", 0, 8, "number", "", "" },
    { "counter", 8, 6, "number", "", "" },
    { "acknum", 14, 1, "number", "", "" },
    { "datagram", 15, 1, "number", "", "" },
    { "seqnum", 16, 1, "number", "", "" },
    { "type", 17, 7, "number", "", "" },
    { "data[0]", 24, 8, "number", "", "" },
    { "data[1]", 32, 8, "number", "", "" },
    { "data[2]", 40, 8, "number", "", "" },
    { "data[3]", 48, 8, "number", "", "" },
    { "data[4]", 56, 8, "number", "", "" },
    { "data[5]", 64, 8, "number", "", "" },
    { "data[6]", 72, 8, "number", "", "" },
    { "data[7]", 80, 8, "number", "", "" },
    { "data[8]", 88, 8, "number", "", "" },
    { "data[9]", 96, 8, "number", "", "" },
    { "data[10]", 104, 8, "number", "", "" },
    { "data[11]", 112, 8, "number", "", "" },
    { "data[12]", 120, 8, "number", "", "" },
    { "data[13]", 128, 8, "number", "", "" },
    { "data[14]", 136, 8, "number", "", "" },
    { "data[15]", 144, 8, "number", "", "" },
    { "data[16]", 152, 8, "number", "", "" },
    { "data[17]", 160, 8, "number", "", "" },
    { "data[18]", 168, 8, "number", "", "" },
    { "data[19]", 176, 8, "number", "", "" },
    { "data[20]", 184, 8, "number", "", "" },
    { "data[21]", 192, 8, "number", "", "" },
    { "data[22]", 200, 8, "number", "", "" },
    { "data[23]", 208, 8, "number", "", "" },
    { "data[24]", 216, 8, "number", "", "" },
    { "data[25]", 224, 8, "number", "", "" },
    { "data[26]", 232, 8, "number", "", "" },
    { "xor", 240, 8, "number", "", "" },
  } },
  { name = "read_robot_id", size = 31, types = { { 0, 8, 0 }, { 15, 1, 1 }, { 17, 7, 1 } }, lsb_first = true, fields = {
    { "kind", 0, 8, "number", "", "" },
    { "counter", 8, 6, "number", "", "" },
    { "acknum", 14, 1, "number", "", "" },
    { "datagram", 15, 1, "number", "", "" },
    { "seqnum", 16, 1, "number", "", "" },
    { "type", 17, 7, "number", "", "" },
    { "data[0]", 24, 8, "number", "", "" },
    { "data[1]", 32, 8, "number", "", "" },
    { "data[2]", 40, 8, "number", "", "" },
    { "data[3]", 48, 8, "number", "", "" },
    { "data[4]", 56, 8, "number", "", "" },
    { "data[5]", 64, 8, "number", "", "" },
    { "data[6]", 72, 8, "number", "", "" },
    { "data[7]", 80, 8, "number", "", "" },
    { "data[8]", 88, 8, "number", "", "" },
    { "data[9]", 96, 8, "number", "", "" },
    { "data[10]", 104, 8, "number", "", "" },
    { "data[11]", 112, 8, "number", "", "" },
    { "data[12]", 120, 8, "number", "", "" },
    { "data[13]", 128, 8, "number", "", "" },
    { "data[14]", 136, 8, "number", "", "" },
    { "data[15]", 144, 8, "number", "", "" },
    { "data[16]", 152, 8, "number", "", "" },
    { "data[17]", 160, 8, "number", "", "" },
    { "data[18]", 168, 8, "number", "", "" },
    { "data[19]", 176, 8, "number", "", "" },
    { "data[20]", 184, 8, "number", "", "" },
    { "data[21]", 192, 8, "number", "", "" },
    { "data[22]", 200, 8, "number", "", "" },
    { "data[23]", 208, 8, "number", "", "" },
    { "data[24]", 216, 8, "number", "", "" },
    { "data[25]", 224, 8, "number", "", "" },
    { "data[26]", 232, 8, "number", "", "" },
    { "xor", 240, 8, "number", "", "" },
  } },
  { name = "read_board_ids", size = 31, types = { { 0, 8, 0 }, { 15, 1, 1 }, { 17, 7, 2 } }, lsb_first = true, fields = {
    { "kind", 0, 8, "number", "", "" },
    { "counter", 8, 6, "number", "", "" },
    { "acknum", 14, 1, "number", "", "" },
    { "datagram", 15, 1, "number", "", "" },
    { "seqnum", 16, 1, "number", "", "" },
    { "type", 17, 7, "number", "", "" },
    { "data[0]", 24, 8, "number", "", "" },
    { "data[1]", 32, 8, "number", "", "" },
    { "data[2]", 40, 8, "number", "", "" },
    { "data[3]", 48, 8, "number", "", "" },
    { "data[4]", 56, 8, "number", "", "" },
    { "data[5]", 64, 8, "number", "", "" },
    { "data[6]", 72, 8, "number", "", "" },
    { "data[7]", 80, 8, "number", "", "" },
    { "data[8]", 88, 8, "number", "", "" },
    { "data[9]", 96, 8, "number", "", "" },
    { "data[10]", 104, 8, "number", "", "" },
    { "data[11]", 112, 8, "number", "", "" },
    { "data[12]", 120, 8, "number", "", "" },
    { "data[13]", 128, 8, "number", "", "" },
    { "data[14]", 136, 8, "number", "", "" },
    { "data[15]", 144, 8, "number", "", "" },
    { "data[16]", 152, 8, "number", "", "" },
    { "data[17]", 160, 8, "number", "", "" },
    { "data[18]", 168, 8, "number", "", "" },
    { "data[19]", 176, 8, "number", "", "" },
    { "data[20]", 184, 8, "number", "", "" },
    { "data[21]", 192, 8, "number", "", "" },
    { "data[22]", 200, 8, "number", "", "" },
    { "data[23]", 208, 8, "number", "", "" },
    { "data[24]", 216, 8, "number", "", "" },
    { "data[25]", 224, 8, "number", "", "" },
    { "data[26]", 232, 8, "number", "", "" },
    { "xor", 240, 8, "number", "", "" },
  } },
  { name = "toggle_kick_calibration", size = 31, types = { { 0, 8, 0 }, { 15, 1, 1 }, { 17, 7, 3 } }, lsb_first = true, fields = {
    { "kind", 0, 8, "number", "", "" },
    { "counter", 8, 6, "number", "", "" },
    { "acknum", 14, 1, "number", "", "" },
    { "datagram", 15, 1, "number", "", "" },
    { "seqnum", 16, 1, "number", "", "" },
    { "type", 17, 7, "number", "", "" },
    { "data[0]", 24, 8, "number", "", "" },
    { "data[1]", 32, 8, "number", "", "" },
    { "data[2]", 40, 8, "number", "", "" },
    { "data[3]", 48, 8, "number", "", "" },
    { "data[4]", 56, 8, "number", "", "" },
    { "data[5]", 64, 8, "number", "", "" },
    { "data[6]", 72, 8, "number", "", "" },
    { "data[7]", 80, 8, "number", "", "" },
    { "data[8]", 88, 8, "number", "", "" },
    { "data[9]", 96, 8, "number", "", "" },
    { "data[10]", 104, 8, "number", "", "" },
    { "data[11]", 112, 8, "number", "", "" },
    { "data[12]", 120, 8, "number", "", "" },
    { "data[13]", 128, 8, "number", "", "" },
    { "data[14]", 136, 8, "number", "", "" },
    { "data[15]", 144, 8, "number", "", "" },
    { "data[16]", 152, 8, "number", "", "" },
    { "data[17]", 160, 8, "number", "", "" },
    { "data[18]", 168, 8, "number", "", "" },
    { "data[19]", 176, 8, "number", "", "" },
    { "data[20]", 184, 8, "number", "", "" },
    { "data[21]", 192, 8, "number", "", "" },
    { "data[22]", 200, 8, "number", "", "" },
    { "data[23]", 208, 8, "number", "", "" },
    { "data[24]", 216, 8, "number", "", "" },
    { "data[25]", 224, 8, "number", "", "" },
    { "data[26]", 232, 8, "number", "", "" },
    { "xor", 240, 8, "number", "", "" },
  } },
  { name = "write_kick_calibration", size = 31, types = { { 0, 8, 0 }, { 15, 1, 1 }, { 17, 7, 4 } }, lsb_first = true, fields = {
    { "kind", 0, 8, "number", "", "" },
    { "counter", 8, 6, "number", "", "" },
    { "acknum", 14, 1, "number", "", "" },
    { "datagram", 15, 1, "number", "", "" },
    { "seqnum", 16, 1, "number", "", "" },
    { "type", 17, 7, "number", "", "" },
    { "data[0]", 24, 8, "number", "", "" },
    { "data[1]", 32, 8, "number", "", "" },
    { "data[2]", 40, 8, "number", "", "" },
    { "data[3]", 48, 8, "number", "", "" },
    { "data[4]", 56, 8, "number", "", "" },
    { "data[5]", 64, 8, "number", "", "" },
    { "data[6]", 72, 8, "number", "", "" },
    { "data[7]", 80, 8, "number", "", "" },
    { "data[8]", 88, 8, "number", "", "" },
    { "data[9]", 96, 8, "number", "", "" },
    { "data[10]", 104, 8, "number", "", "" },
    { "data[11]", 112, 8, "number", "", "" },
    { "data[12]", 120, 8, "number", "", "" },
    { "data[13]", 128, 8, "number", "", "" },
    { "data[14]", 136, 8, "number", "", "" },
    { "data[15]", 144, 8, "number", "", "" },
    { "data[16]", 152, 8, "number", "", "" },
    { "data[17]", 160, 8, "number", "", "" },
    { "data[18]", 168, 8, "number", "", "" },
    { "data[19]", 176, 8, "number", "", "" },
    { "data[20]", 184, 8, "number", "", "" },
    { "data[21]", 192, 8, "number", "", "" },
    { "data[22]", 200, 8, "number", "", "" },
    { "data[23]", 208, 8, "number", "", "" },
    { "data[24]", 216, 8, "number", "", "" },
    { "data[25]", 224, 8, "number", "", "" },
    { "data[26]", 232, 8, "number", "", "" },
    { "xor", 240, 8, "number", "", "" },
  } },
  { name = "response", size = 31, types = { { 0, 8, 0 }, { 15, 1, 0 } }, lsb_first = true, fields = {
    { "kind", 0, 8, "number", "", "" },
    { "counter", 8, 6, "number", "", "" },
    { "acknum", 14, 1, "number", "", "" },
    { "datagram", 15, 1, "number", "", "" },
    { "battery", 16, 8, "scaled", "", "", 0.00392156863, 0 },
    { "packet_loss", 24, 8, "scaled", "", "", 0.00392156863, 0 },
    { "motor_status[0].error", 32, 1, "number", "bool", "" },
    { "motor_status[0].overheated", 33, 1, "number", "bool", "" },
    { "motor_status[0].encoder_error", 34, 1, "number", "bool", "" },
    { "m0", 35, 5, "number", "", "" },
    { "motor_status[1].error", 40, 1, "number", "bool", "" },
    { "motor_status[1].overheated", 41, 1, "number", "bool", "" },
    { "motor_status[1].encoder_error", 42, 1, "number", "bool", "" },
    { "m1", 43, 5, "number", "", "" },
    { "motor_status[2].error", 48, 1, "number", "bool", "" },
    { "motor_status[2].overheated", 49, 1, "number", "bool", "" },
    { "motor_status[2].encoder_error", 50, 1, "number", "bool", "" },
    { "m2", 51, 5, "number", "", "" },
    { "motor_status[3].error", 56, 1, "number", "bool", "" },
    { "motor_status[3].overheated", 57, 1, "number", "bool", "" },
    { "motor_status[3].encoder_error", 58, 1, "number", "bool", "" },
    { "m3", 59, 5, "number", "", "" },
    { "dribbler_status.error", 64, 1, "number", "bool", "" },
    { "dribbler_status.overheated", 65, 1, "number", "bool", "" },
    { "dribbler_status.encoder_error", 66, 1, "number", "bool", "" },
    { "m4", 67, 5, "number", "", "" },
    { "kicker_status.error", 72, 1, "number", "bool", "" },
    { "kicker_status.break_beam_error", 73, 1, "number", "bool", "" },
    { "kicker_rest", 74, 6, "number", "", "" },
    { "imu_status.error", 80, 1, "number", "bool", "" },
    { "imu_rest", 81, 3, "number", "", "" },
    { "no_trajectory", 84, 4, "number", "", "" },
    { "sd_status.error", 88, 1, "number", "bool", "" },
    { "sd_status.mounted", 89, 1, "number", "bool", "" },
    { "sd_status.full", 90, 1, "number", "bool", "" },
    { "sd_rest", 91, 5, "number", "", "" },
    { "load_torque[0]", 96, 8, "scaled", "", "signed", 0.0784313698, 0.0392160416 },
    { "load_torque[1]", 104, 8, "scaled", "", "signed", 0.0784313698, 0.0392160416 },
    { "load_torque[2]", 112, 8, "scaled", "", "signed", 0.0784313698, 0.0392160416 },
    { "load_torque[3]", 120, 8, "scaled", "", "signed", 0.0784313698, 0.0392160416 },
    { "dribbler_load_torque", 128, 8, "scaled", "", "signed", 0.0784313698, 0.0392160416 },
    { "measured_pos_x", 136, 14, "scaled", "m", "signed", 0.000976622112, 0.00048828125 },
    { "measured_pos_y", 150, 14, "scaled", "m", "signed", 0.000976622112, 0.00048828125 },
    { "measured_phi", 164, 14, "scaled", "rad", "signed", 0.000383518624, 0.000191688538 },
    { "measured_vel_x", 178, 15, "scaled", "m/s", "signed", 0.000366222114, 0.000183105469 },
    { "measured_vel_y", 193, 15, "scaled", "m/s", "signed", 0.000366222114, 0.000183105469 },
    { "measured_omega", 208, 14, "scaled", "rad/s", "signed", 0.0076703726, 0.00383377075 },
    { "power_enabled", 222, 1, "number", "bool", "" },
    { "ball_detected", 223, 1, "number", "bool", "" },
    { "rest", 224, 16, "number", "", "" },
    { "xor", 240, 8, "number", "", "" },
  } },
  { name = "robot_id_request", size = 31, types = { { 0, 8, 1 } }, lsb_first = true, fields = {
    { "kind", 0, 8, "number", "", "" },
    { "rest[0]", 8, 64, "number", "", "" },
    { "rest[1]", 72, 64, "number", "", "" },
    { "rest[2]", 136, 64, "number", "", "" },
    { "rest[3]", 200, 40, "number", "", "" },
    { "xor", 240, 8, "number", "", "" },
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

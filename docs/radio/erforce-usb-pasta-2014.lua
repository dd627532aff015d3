-- Wireshark dissector of ER-Force USB transceiver, robots Pasta and 2014. Generated from the packet tables by
-- `omnihil formats erforce-usb-pasta-2014 --wireshark`; do not edit.
local PROTOCOL = "erforce_usb_pasta_2014"
local proto = Proto(PROTOCOL, "ER-Force USB transceiver, robots Pasta and 2014")

-- name, bytes, types: { first bit, bits, content }, fields: { name, first bit, bits, kind, unit, sign, of a scaled one the unit per count and the value at 0 }
local packets = {
  { name = "pasta_command", size = 34, types = { { 0, 8, 17 } }, lsb_first = true, fields = {
    { "command", 0, 8, "number", "", "" },
    { "size", 8, 8, "number", "bytes", "" },
    { "address_id", 16, 4, "number", "", "" },
    { "address[0]", 20, 4, "number", "", "" },
    { "address[1]", 24, 8, "number", "", "" },
    { "address[2]", 32, 8, "number", "", "" },
    { "address[3]", 40, 8, "number", "", "" },
    { "address[4]", 48, 8, "number", "", "" },
    { "expected_response_size", 56, 8, "number", "bytes", "" },
    { "counter", 64, 8, "number", "", "" },
    { "shot_power", 72, 8, "number", "", "" },
    { "chip", 80, 1, "number", "", "" },
    { "charge", 81, 1, "number", "", "" },
    { "standby", 82, 1, "number", "", "" },
    { "id", 83, 4, "number", "", "" },
    { "force_kick", 87, 1, "number", "", "" },
    { "dribbler", 88, 8, "scaled", "", "signed", 0.00999999985, 0 },
    { "v_x", 96, 16, "scaled", "m/s", "signed", 0.000999999948, 0, none = -32768 },
    { "v_y", 112, 16, "scaled", "m/s", "signed", 0.000999999948, 0, none = -32768 },
    { "omega", 128, 16, "scaled", "rad/s", "signed", 0.000999999948, 0, none = -32768 },
    { "ir_param", 144, 6, "number", "", "" },
    { "eject_sdcard", 150, 1, "number", "", "" },
    { "flag_7", 151, 1, "number", "", "" },
    { "cur_v_s", 152, 16, "scaled", "m/s", "signed", 0.000999999948, 0, none = -32768 },
    { "cur_v_f", 168, 16, "scaled", "m/s", "signed", 0.000999999948, 0, none = -32768 },
    { "cur_phi", 184, 16, "scaled", "rad", "signed", 9.58767278e-05, 0, none = -32768 },
    { "delta1[0]", 200, 8, "scaled", "m/s", "signed", 0.00200000006, 0 },
    { "delta1[1]", 208, 8, "scaled", "m/s", "signed", 0.00200000006, 0 },
    { "delta1[2]", 216, 8, "scaled", "rad/s", "signed", 0.00499999992, 0 },
    { "delta2[0]", 224, 8, "scaled", "m/s", "signed", 0.00200000006, 0 },
    { "delta2[1]", 232, 8, "scaled", "m/s", "signed", 0.00200000006, 0 },
    { "delta2[2]", 240, 8, "scaled", "rad/s", "signed", 0.00499999992, 0 },
    { "sync_counter", 248, 8, "number", "", "" },
    { "time_offset", 256, 16, "number", "us", "signed" },
  } },
  { name = "gen2014_command", size = 31, types = { { 0, 8, 17 } }, lsb_first = true, fields = {
    { "command", 0, 8, "number", "", "" },
    { "size", 8, 8, "number", "bytes", "" },
    { "address_id", 16, 4, "number", "", "" },
    { "address[0]", 20, 4, "number", "", "" },
    { "address[1]", 24, 8, "number", "", "" },
    { "address[2]", 32, 8, "number", "", "" },
    { "address[3]", 40, 8, "number", "", "" },
    { "address[4]", 48, 8, "number", "", "" },
    { "expected_response_size", 56, 8, "number", "bytes", "" },
    { "counter", 64, 8, "number", "", "" },
    { "shot_power", 72, 8, "number", "", "" },
    { "chip", 80, 1, "number", "", "" },
    { "charge", 81, 1, "number", "", "" },
    { "standby", 82, 1, "number", "", "" },
    { "id", 83, 4, "number", "", "" },
    { "force_kick", 87, 1, "number", "", "" },
    { "dribbler", 88, 8, "scaled", "", "signed", 0.00999999985, 0 },
    { "v_s", 96, 16, "scaled", "m/s", "signed", 0.000999999948, 0, none = -32768 },
    { "v_f", 112, 16, "scaled", "m/s", "signed", 0.000999999948, 0, none = -32768 },
    { "omega", 128, 16, "scaled", "rad/s", "signed", 0.000999999948, 0, none = -32768 },
    { "ir_param", 144, 6, "number", "", "" },
    { "eject_sdcard", 150, 1, "number", "", "" },
    { "flag_7", 151, 1, "number", "", "" },
    { "cur_v_s", 152, 16, "scaled", "m/s", "signed", 0.000999999948, 0, none = -32768 },
    { "cur_v_f", 168, 16, "scaled", "m/s", "signed", 0.000999999948, 0, none = -32768 },
    { "cur_omega", 184, 16, "scaled", "rad/s", "signed", 0.000999999948, 0, none = -32768 },
    { "delta1[0]", 200, 8, "scaled", "m/s", "signed", 0.00200000006, 0 },
    { "delta1[1]", 208, 8, "scaled", "m/s", "signed", 0.00200000006, 0 },
    { "delta1[2]", 216, 8, "scaled", "rad/s", "signed", 0.00499999992, 0 },
    { "delta2[0]", 224, 8, "scaled", "m/s", "signed", 0.00200000006, 0 },
    { "delta2[1]", 232, 8, "scaled", "m/s", "signed", 0.00200000006, 0 },
    { "delta2[2]", 240, 8, "scaled", "rad/s", "signed", 0.00499999992, 0 },
  } },
  { name = "gen2014_sync", size = 11, types = { { 0, 8, 17 } }, lsb_first = true, fields = {
    { "command", 0, 8, "number", "", "" },
    { "size", 8, 8, "number", "bytes", "" },
    { "address[0]", 16, 8, "number", "", "" },
    { "address[1]", 24, 8, "number", "", "" },
    { "address[2]", 32, 8, "number", "", "" },
    { "address[3]", 40, 8, "number", "", "" },
    { "address[4]", 48, 8, "number", "", "" },
    { "expected_response_size", 56, 8, "number", "bytes", "" },
    { "counter", 64, 8, "number", "", "" },
    { "time_offset", 72, 16, "number", "us", "signed" },
  } },
  { name = "init", size = 4, types = { { 0, 8, 0 } }, lsb_first = true, fields = {
    { "command", 0, 8, "number", "", "" },
    { "size", 8, 8, "number", "bytes", "" },
    { "protocol_version", 16, 16, "number", "", "" },
  } },
  { name = "ping", size = 10, types = { { 0, 8, 1 } }, lsb_first = true, fields = {
    { "command", 0, 8, "number", "", "" },
    { "size", 8, 8, "number", "bytes", "" },
    { "time", 16, 64, "number", "", "signed" },
  } },
  { name = "status", size = 2, types = { { 0, 8, 2 } }, lsb_first = true, fields = {
    { "command", 0, 8, "number", "", "" },
    { "size", 8, 8, "number", "bytes", "" },
  } },
  { name = "set_frequency", size = 3, types = { { 0, 8, 16 } }, lsb_first = true, fields = {
    { "command", 0, 8, "number", "", "" },
    { "size", 8, 8, "number", "bytes", "" },
    { "channel", 16, 8, "number", "", "" },
  } },
  { name = "init_reply", size = 4, types = { { 8, 8, 128 } }, lsb_first = true, fields = {
    { "size", 0, 8, "number", "bytes", "" },
    { "command", 8, 8, "number", "", "" },
    { "protocol_version", 16, 16, "number", "", "" },
  } },
  { name = "ping_reply", size = 10, types = { { 8, 8, 129 } }, lsb_first = true, fields = {
    { "size", 0, 8, "number", "bytes", "" },
    { "command", 8, 8, "number", "", "" },
    { "time", 16, 64, "number", "", "signed" },
  } },
  { name = "status_reply", size = 6, types = { { 8, 8, 130 } }, lsb_first = true, fields = {
    { "size", 0, 8, "number", "bytes", "" },
    { "command", 8, 8, "number", "", "" },
    { "dropped", 16, 32, "number", "", "" },
  } },
  { name = "response", size = 13, types = { { 8, 8, 144 }, { 56, 4, 0 } }, lsb_first = true, fields = {
    { "size", 0, 8, "number", "bytes", "" },
    { "command", 8, 8, "number", "", "" },
    { "generation", 16, 8, "number", "", "" },
    { "counter", 24, 8, "number", "", "" },
    { "id", 32, 4, "number", "", "" },
    { "power_enabled", 36, 1, "number", "", "" },
    { "error_present", 37, 1, "number", "", "" },
    { "ball_detected", 38, 1, "number", "", "" },
    { "cap_charged", 39, 1, "number", "", "" },
    { "battery", 40, 8, "scaled", "", "", 0.00392156863, 0 },
    { "packet_loss_rx", 48, 8, "scaled", "", "", 0.00390625, 0 },
    { "extension_id", 56, 4, "number", "", "" },
    { "v_s", 60, 14, "scaled", "m/s", "signed", 0.000999999998, 0 },
    { "v_f", 74, 14, "scaled", "m/s", "signed", 0.000999999998, 0 },
    { "omega", 88, 16, "scaled", "rad/s", "signed", 0.000999999948, 0 },
  } },
  { name = "response_errors", size = 13, types = { { 8, 8, 144 }, { 56, 4, 1 } }, lsb_first = true, fields = {
    { "size", 0, 8, "number", "bytes", "" },
    { "command", 8, 8, "number", "", "" },
    { "generation", 16, 8, "number", "", "" },
    { "counter", 24, 8, "number", "", "" },
    { "id", 32, 4, "number", "", "" },
    { "power_enabled", 36, 1, "number", "", "" },
    { "error_present", 37, 1, "number", "", "" },
    { "ball_detected", 38, 1, "number", "", "" },
    { "cap_charged", 39, 1, "number", "", "" },
    { "error_motor_1", 40, 1, "number", "", "" },
    { "error_motor_2", 41, 1, "number", "", "" },
    { "error_motor_3", 42, 1, "number", "", "" },
    { "error_motor_4", 43, 1, "number", "", "" },
    { "error_dribbler", 44, 1, "number", "", "" },
    { "error_kicker", 45, 1, "number", "", "" },
    { "error_break_beam", 46, 1, "number", "", "" },
    { "error_encoder", 47, 1, "number", "", "" },
    { "error_main_sensor", 48, 1, "number", "", "" },
    { "temperature", 49, 7, "number", "", "" },
    { "extension_id", 56, 4, "number", "", "" },
    { "v_s", 60, 14, "scaled", "m/s", "signed", 0.000999999998, 0 },
    { "v_f", 74, 14, "scaled", "m/s", "signed", 0.000999999998, 0 },
    { "omega", 88, 16, "scaled", "rad/s", "signed", 0.000999999948, 0 },
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

-- Wireshark dissector of rocos, 25-byte packets by UDP. Generated from the packet tables by
-- `omnihil formats rocos-udp --wireshark`; do not edit.
local PROTOCOL = "rocos_udp"
local proto = Proto(PROTOCOL, "rocos, 25-byte packets by UDP")

-- name, bytes, types: { first bit, bits, content }, fields: { name, first bit, bits, kind, unit, sign, of a scaled one the unit per count and the value at 0 }
local packets = {
  { name = "packets", size = 25, types = { { 0, 4, 4 } }, fields = {
    { "kind", 0, 4, "number", "", "" },
    { "robot[0].present", 4, 1, "number", "", "" },
    { "robot[1].present", 5, 1, "number", "", "" },
    { "robot[2].present", 6, 1, "number", "", "" },
    { "robot[3].present", 7, 1, "number", "", "" },
    { "robot[0].gap", 8, 1, "number", "", "" },
    { "robot[0].chip", 9, 1, "number", "", "" },
    { "robot[0].dribble", 10, 2, "scaled", "", "", 0.333333333, 0 },
    { "robot[0].id", 12, 4, "number", "", "" },
    { "robot[0].vx_sign", 16, 1, "number", "", "" },
    { "robot[0].vx_low", 17, 7, "number", "cm/s", "" },
    { "robot[0].vy_sign", 24, 1, "number", "", "" },
    { "robot[0].vy_low", 25, 7, "number", "cm/s", "" },
    { "robot[0].vr_sign", 32, 1, "number", "", "" },
    { "robot[0].vr_low", 33, 7, "number", "1/160 rad/s", "" },
    { "robot[1].gap", 40, 1, "number", "", "" },
    { "robot[1].chip", 41, 1, "number", "", "" },
    { "robot[1].dribble", 42, 2, "scaled", "", "", 0.333333333, 0 },
    { "robot[1].id", 44, 4, "number", "", "" },
    { "robot[1].vx_sign", 48, 1, "number", "", "" },
    { "robot[1].vx_low", 49, 7, "number", "cm/s", "" },
    { "robot[1].vy_sign", 56, 1, "number", "", "" },
    { "robot[1].vy_low", 57, 7, "number", "cm/s", "" },
    { "robot[1].vr_sign", 64, 1, "number", "", "" },
    { "robot[1].vr_low", 65, 7, "number", "1/160 rad/s", "" },
    { "robot[2].gap", 72, 1, "number", "", "" },
    { "robot[2].chip", 73, 1, "number", "", "" },
    { "robot[2].dribble", 74, 2, "scaled", "", "", 0.333333333, 0 },
    { "robot[2].id", 76, 4, "number", "", "" },
    { "robot[2].vx_sign", 80, 1, "number", "", "" },
    { "robot[2].vx_low", 81, 7, "number", "cm/s", "" },
    { "robot[2].vy_sign", 88, 1, "number", "", "" },
    { "robot[2].vy_low", 89, 7, "number", "cm/s", "" },
    { "robot[2].vr_sign", 96, 1, "number", "", "" },
    { "robot[2].vr_low", 97, 7, "number", "1/160 rad/s", "" },
    { "robot[3].gap", 104, 1, "number", "", "" },
    { "robot[3].chip", 105, 1, "number", "", "" },
    { "robot[3].dribble", 106, 2, "scaled", "", "", 0.333333333, 0 },
    { "robot[3].id", 108, 4, "number", "", "" },
    { "robot[3].vx_sign", 112, 1, "number", "", "" },
    { "robot[3].vx_low", 113, 7, "number", "cm/s", "" },
    { "robot[3].vy_sign", 120, 1, "number", "", "" },
    { "robot[3].vy_low", 121, 7, "number", "cm/s", "" },
    { "robot[3].vr_sign", 128, 1, "number", "", "" },
    { "robot[3].vr_low", 129, 7, "number", "1/160 rad/s", "" },
    { "robot[0].vx_high", 136, 2, "number", "128 cm/s", "" },
    { "robot[0].vy_high", 138, 2, "number", "128 cm/s", "" },
    { "robot[0].vr_high", 140, 4, "number", "128/160 rad/s", "" },
    { "robot[1].vx_high", 144, 2, "number", "128 cm/s", "" },
    { "robot[1].vy_high", 146, 2, "number", "128 cm/s", "" },
    { "robot[1].vr_high", 148, 4, "number", "128/160 rad/s", "" },
    { "robot[2].vx_high", 152, 2, "number", "128 cm/s", "" },
    { "robot[2].vy_high", 154, 2, "number", "128 cm/s", "" },
    { "robot[2].vr_high", 156, 4, "number", "128/160 rad/s", "" },
    { "robot[3].vx_high", 160, 2, "number", "128 cm/s", "" },
    { "robot[3].vy_high", 162, 2, "number", "128 cm/s", "" },
    { "robot[3].vr_high", 164, 4, "number", "128/160 rad/s", "" },
    { "robot[0].unused", 168, 1, "number", "", "" },
    { "robot[0].power", 169, 7, "number", "", "" },
    { "robot[1].unused", 176, 1, "number", "", "" },
    { "robot[1].power", 177, 7, "number", "", "" },
    { "robot[2].unused", 184, 1, "number", "", "" },
    { "robot[2].power", 185, 7, "number", "", "" },
    { "robot[3].unused", 192, 1, "number", "", "" },
    { "robot[3].power", 193, 7, "number", "", "" },
  } },
  { name = "answer", size = 26, types = { { 0, 8, 255 }, { 8, 8, 2 } }, fields = {
    { "sync", 0, 8, "number", "", "" },
    { "answer", 8, 8, "number", "", "" },
    { "number", 16, 8, "number", "", "" },
    { "flag_7", 24, 1, "number", "", "" },
    { "infrared", 25, 1, "number", "", "" },
    { "flat", 26, 1, "number", "", "" },
    { "chip", 27, 1, "number", "", "" },
    { "flags_3_to_0", 28, 4, "number", "", "" },
    { "battery", 32, 8, "number", "", "" },
    { "capacitance", 40, 8, "number", "", "" },
    { "wheelVel[0]", 48, 16, "number", "", "signed" },
    { "wheelVel[1]", 64, 16, "number", "", "signed" },
    { "wheelVel[2]", 80, 16, "number", "", "signed" },
    { "wheelVel[3]", 96, 16, "number", "", "signed" },
    { "rest[0]", 112, 64, "number", "", "" },
    { "rest[1]", 176, 32, "number", "", "" },
  } },
  { name = "start_transmitter", size = 6, types = { { 0, 8, 240 }, { 24, 8, 1 } }, fields = {
    { "start", 0, 8, "number", "", "" },
    { "channel", 8, 8, "number", "", "" },
    { "channel_again", 16, 8, "number", "", "" },
    { "whom", 24, 8, "number", "", "" },
    { "mode", 32, 8, "number", "", "" },
    { "sum", 40, 8, "number", "", "" },
  } },
  { name = "start_receiver", size = 6, types = { { 0, 8, 240 }, { 24, 8, 2 } }, fields = {
    { "start", 0, 8, "number", "", "" },
    { "channel", 8, 8, "number", "", "" },
    { "channel_again", 16, 8, "number", "", "" },
    { "whom", 24, 8, "number", "", "" },
    { "mode", 32, 8, "number", "", "" },
    { "sum", 40, 8, "number", "", "" },
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

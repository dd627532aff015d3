-- Wireshark dissector of rocos, 25-byte serial packets. Generated from the packet tables by
-- `omnihil formats rocos-serial-25 --wireshark`; do not edit.
local PROTOCOL = "rocos_serial_25"
local proto = Proto(PROTOCOL, "rocos, 25-byte serial packets")

-- name, bytes, types: { first bit, bits, content }, fields: { name, first bit, bits, kind, unit, sign, of a scaled one the unit per count and the value at 0 }
local packets = {
  { name = "packets", size = 25, types = { { 172, 4, 7 } }, fields = {
    { "sync", 0, 8, "number", "", "" },
    { "robots_15_to_8", 8, 8, "number", "", "" },
    { "robots_7_to_0", 16, 8, "number", "", "" },
    { "robot[0].high", 24, 1, "number", "", "" },
    { "robot[0].chip", 25, 1, "number", "", "" },
    { "robot[0].dribble", 26, 2, "scaled", "", "", 0.333333333, 0 },
    { "robot[0].present", 28, 4, "number", "", "" },
    { "robot[0].gap", 32, 2, "number", "", "" },
    { "robot[0].vx", 34, 10, "scaled", "cm/s", "magnitude", 1, 0 },
    { "robot[0].vy", 44, 10, "scaled", "cm/s", "magnitude", 1, 0 },
    { "robot[0].vr", 54, 10, "scaled", "1/40 rad/s", "magnitude", 1, 0 },
    { "robot[0].low", 64, 1, "number", "", "" },
    { "robot[0].power", 65, 7, "scaled", "", "", 1, 0 },
    { "robot[1].high", 72, 1, "number", "", "" },
    { "robot[1].chip", 73, 1, "number", "", "" },
    { "robot[1].dribble", 74, 2, "scaled", "", "", 0.333333333, 0 },
    { "robot[1].present", 76, 4, "number", "", "" },
    { "robot[1].gap", 80, 2, "number", "", "" },
    { "robot[1].vx", 82, 10, "scaled", "cm/s", "magnitude", 1, 0 },
    { "robot[1].vy", 92, 10, "scaled", "cm/s", "magnitude", 1, 0 },
    { "robot[1].vr", 102, 10, "scaled", "1/40 rad/s", "magnitude", 1, 0 },
    { "robot[1].low", 112, 1, "number", "", "" },
    { "robot[1].power", 113, 7, "scaled", "", "", 1, 0 },
    { "robot[2].high", 120, 1, "number", "", "" },
    { "robot[2].chip", 121, 1, "number", "", "" },
    { "robot[2].dribble", 122, 2, "scaled", "", "", 0.333333333, 0 },
    { "robot[2].present", 124, 4, "number", "", "" },
    { "robot[2].gap", 128, 2, "number", "", "" },
    { "robot[2].vx", 130, 10, "scaled", "cm/s", "magnitude", 1, 0 },
    { "robot[2].vy", 140, 10, "scaled", "cm/s", "magnitude", 1, 0 },
    { "robot[2].vr", 150, 10, "scaled", "1/40 rad/s", "magnitude", 1, 0 },
    { "robot[2].low", 160, 1, "number", "", "" },
    { "robot[2].power", 161, 7, "scaled", "", "", 1, 0 },
    { "frequency", 168, 4, "number", "", "" },
    { "kind", 172, 4, "number", "", "" },
    { "rest", 176, 24, "number", "", "" },
  } },
  { name = "answer", size = 25, types = { { 8, 8, 2 }, { 172, 4, 0 } }, fields = {
    { "sync", 0, 8, "number", "", "" },
    { "answer", 8, 8, "number", "", "" },
    { "number", 16, 8, "number", "", "" },
    { "flag_7", 24, 1, "number", "", "" },
    { "ball", 25, 1, "number", "", "" },
    { "kicked_flat", 26, 1, "number", "", "" },
    { "kicked_chip", 27, 1, "number", "", "" },
    { "flags_3_to_0", 28, 4, "number", "", "" },
    { "rest[0]", 32, 64, "number", "", "" },
    { "rest[1]", 96, 64, "number", "", "" },
    { "rest[2]", 160, 8, "number", "", "" },
    { "kind_high", 168, 4, "number", "", "" },
    { "kind", 172, 4, "number", "", "" },
    { "rest[3]", 176, 8, "number", "", "" },
    { "counts_from_1", 184, 8, "number", "", "" },
    { "rest[4]", 192, 8, "number", "", "" },
  } },
  { name = "start1", size = 25, types = { { 16, 24, 66051 }, { 172, 4, 0 } }, fields = {
    { "sync", 0, 8, "number", "", "" },
    { "start", 8, 8, "number", "", "" },
    { "step", 16, 24, "number", "", "" },
    { "channel", 40, 8, "number", "", "" },
    { "rest[0]", 48, 64, "number", "", "" },
    { "rest[1]", 112, 56, "number", "", "" },
    { "kind_high", 168, 4, "number", "", "" },
    { "kind", 172, 4, "number", "", "" },
    { "rest[2]", 176, 16, "number", "", "" },
    { "crc", 192, 8, "number", "", "" },
  } },
  { name = "start2", size = 25, types = { { 16, 24, 263430 }, { 172, 4, 0 } }, fields = {
    { "sync", 0, 8, "number", "", "" },
    { "start", 8, 8, "number", "", "" },
    { "step", 16, 24, "number", "", "" },
    { "channel_high", 40, 4, "number", "", "" },
    { "frequency", 44, 4, "number", "", "" },
    { "rest[0]", 48, 64, "number", "", "" },
    { "rest[1]", 112, 56, "number", "", "" },
    { "kind_high", 168, 4, "number", "", "" },
    { "kind", 172, 4, "number", "", "" },
    { "rest[2]", 176, 16, "number", "", "" },
    { "crc", 192, 8, "number", "", "" },
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

-- Wireshark dissector of RoboCup ULaval HERMES v1. Generated from the packet tables by
-- `omnihil formats ulaval-hermes --wireshark`; do not edit.
local PROTOCOL = "ulaval_hermes"
local proto = Proto(PROTOCOL, "RoboCup ULaval HERMES v1")

-- name, bytes, types: { first bit, bits, content }, fields: { name, first bit, bits, kind, unit, sign, of a scaled one the unit per count and the value at 0 }
local packets = {
  { name = "PING_REQUEST", size = 5, types = { { 24, 8, 0 } }, lsb_first = true, fields = {
    { "version", 0, 8, "number", "", "" },
    { "source", 8, 8, "number", "", "" },
    { "robot", 16, 8, "number", "", "" },
    { "type", 24, 8, "number", "", "" },
    { "checksum", 32, 8, "number", "", "" },
  } },
  { name = "PING_RESPONSE", size = 5, types = { { 24, 8, 1 } }, lsb_first = true, fields = {
    { "version", 0, 8, "number", "", "" },
    { "robot", 8, 8, "number", "", "" },
    { "destination", 16, 8, "number", "", "" },
    { "type", 24, 8, "number", "", "" },
    { "checksum", 32, 8, "number", "", "" },
  } },
  { name = "SPEED_MOVE", size = 17, types = { { 24, 8, 2 } }, lsb_first = true, fields = {
    { "version", 0, 8, "number", "", "" },
    { "source", 8, 8, "number", "", "" },
    { "robot", 16, 8, "number", "", "" },
    { "type", 24, 8, "number", "", "" },
    { "checksum", 32, 8, "number", "", "" },
    { "vx", 40, 32, "float", "m/s", "" },
    { "vy", 72, 32, "float", "m/s", "" },
    { "vtheta", 104, 32, "float", "rad/s", "" },
  } },
  { name = "SET_REGISTER", size = 7, types = { { 24, 8, 3 } }, lsb_first = true, fields = {
    { "version", 0, 8, "number", "", "" },
    { "source", 8, 8, "number", "", "" },
    { "robot", 16, 8, "number", "", "" },
    { "type", 24, 8, "number", "", "" },
    { "checksum", 32, 8, "number", "", "" },
    { "register", 40, 8, "number", "", "" },
    { "value", 48, 8, "number", "", "" },
  } },
  { name = "OPEN_LOOP_COMMAND", size = 21, types = { { 24, 8, 4 } }, lsb_first = true, fields = {
    { "version", 0, 8, "number", "", "" },
    { "source", 8, 8, "number", "", "" },
    { "robot", 16, 8, "number", "", "" },
    { "type", 24, 8, "number", "", "" },
    { "checksum", 32, 8, "number", "", "" },
    { "cmd[0]", 40, 32, "float", "", "" },
    { "cmd[1]", 72, 32, "float", "", "" },
    { "cmd[2]", 104, 32, "float", "", "" },
    { "cmd[3]", 136, 32, "float", "", "" },
  } },
  { name = "GET_BATTERIE", size = 5, types = { { 24, 8, 5 } }, lsb_first = true, fields = {
    { "version", 0, 8, "number", "", "" },
    { "source", 8, 8, "number", "", "" },
    { "robot", 16, 8, "number", "", "" },
    { "type", 24, 8, "number", "", "" },
    { "checksum", 32, 8, "number", "", "" },
  } },
  { name = "BATTERIE_RESPONSE", size = 6, types = { { 24, 8, 6 } }, lsb_first = true, fields = {
    { "version", 0, 8, "number", "", "" },
    { "robot", 8, 8, "number", "", "" },
    { "destination", 16, 8, "number", "", "" },
    { "type", 24, 8, "number", "", "" },
    { "checksum", 32, 8, "number", "", "" },
    { "decivolts", 40, 8, "number", "0.1 V", "" },
  } },
  { name = "GET_NUM_REQUEST", size = 5, types = { { 24, 8, 7 } }, lsb_first = true, fields = {
    { "version", 0, 8, "number", "", "" },
    { "source", 8, 8, "number", "", "" },
    { "robot", 16, 8, "number", "", "" },
    { "type", 24, 8, "number", "", "" },
    { "checksum", 32, 8, "number", "", "" },
  } },
  { name = "NUM_REQUEST_RESPONSE", size = 9, types = { { 24, 8, 8 } }, lsb_first = true, fields = {
    { "version", 0, 8, "number", "", "" },
    { "robot", 8, 8, "number", "", "" },
    { "destination", 16, 8, "number", "", "" },
    { "type", 24, 8, "number", "", "" },
    { "checksum", 32, 8, "number", "", "" },
    { "value", 40, 32, "number", "", "" },
  } },
  { name = "SPEED_MOVE_ADVANCE", size = 19, types = { { 24, 8, 9 } }, lsb_first = true, fields = {
    { "version", 0, 8, "number", "", "" },
    { "source", 8, 8, "number", "", "" },
    { "robot", 16, 8, "number", "", "" },
    { "type", 24, 8, "number", "", "" },
    { "checksum", 32, 8, "number", "", "" },
    { "vx", 40, 32, "float", "m/s", "" },
    { "vy", 72, 32, "float", "m/s", "" },
    { "vtheta", 104, 32, "float", "rad/s", "" },
    { "dribbler", 136, 7, "number", "", "" },
    { "charge", 143, 1, "number", "bool", "" },
    { "kick_force", 144, 8, "number", "0.1 ms", "" },
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

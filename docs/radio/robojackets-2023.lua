-- Wireshark dissector of RoboJackets, robots on Wi-Fi until 2023 (rtp). Generated from the packet tables by
-- `omnihil formats robojackets-2023 --wireshark`; do not edit.
local PROTOCOL = "robojackets_2023"
local proto = Proto(PROTOCOL, "RoboJackets, robots on Wi-Fi until 2023 (rtp)")

-- name, bytes, types: { first bit, bits, content }, fields: { name, first bit, bits, kind, unit, sign, of a scaled one the unit per count and the value at 0 }
local packets = {
  { name = "ControlMessage", size = 12, types = { { 0, 8, 0 } }, lsb_first = true, fields = {
    { "header.address", 0, 8, "number", "", "" },
    { "header.port", 8, 4, "number", "", "" },
    { "header.type", 12, 4, "number", "", "" },
    { "uid", 16, 6, "number", "", "" },
    { "messageType", 22, 2, "number", "", "" },
    { "bodyX", 24, 16, "scaled", "m/s", "signed", 0.000999999948, 0 },
    { "bodyY", 40, 16, "scaled", "m/s", "signed", 0.000999999948, 0 },
    { "bodyW", 56, 16, "scaled", "rad/s", "signed", 0.000999999948, 0 },
    { "dribbler", 72, 8, "number", "", "signed" },
    { "kickStrength", 80, 8, "number", "", "" },
    { "shootMode", 88, 1, "number", "", "" },
    { "triggerMode", 89, 2, "number", "", "" },
    { "role", 91, 2, "number", "", "" },
    { "padding", 93, 3, "number", "", "" },
  } },
  { name = "RobotStatusMessage", size = 42, types = { { 0, 8, 254 } }, lsb_first = true, fields = {
    { "header.address", 0, 8, "number", "", "" },
    { "header.port", 8, 4, "number", "", "" },
    { "header.type", 12, 4, "number", "", "" },
    { "uid", 16, 8, "number", "", "" },
    { "battVoltage", 24, 8, "number", "", "" },
    { "motorErrors", 32, 5, "number", "", "" },
    { "ballSenseStatus", 37, 1, "number", "", "" },
    { "kickStatus", 38, 1, "number", "", "" },
    { "kickHealthy", 39, 1, "number", "", "" },
    { "fpgaStatus", 40, 1, "number", "", "" },
    { "padding", 41, 7, "number", "", "" },
    { "encDeltas[0]", 48, 16, "number", "", "signed" },
    { "encDeltas[1]", 64, 16, "number", "", "signed" },
    { "encDeltas[2]", 80, 16, "number", "", "signed" },
    { "encDeltas[3]", 96, 16, "number", "", "signed" },
    { "encDeltas[4]", 112, 16, "number", "", "signed" },
    { "encDeltas[5]", 128, 16, "number", "", "signed" },
    { "encDeltas[6]", 144, 16, "number", "", "signed" },
    { "encDeltas[7]", 160, 16, "number", "", "signed" },
    { "encDeltas[8]", 176, 16, "number", "", "signed" },
    { "encDeltas[9]", 192, 16, "number", "", "signed" },
    { "encDeltas[10]", 208, 16, "number", "", "signed" },
    { "encDeltas[11]", 224, 16, "number", "", "signed" },
    { "encDeltas[12]", 240, 16, "number", "", "signed" },
    { "encDeltas[13]", 256, 16, "number", "", "signed" },
    { "encDeltas[14]", 272, 16, "number", "", "signed" },
    { "encDeltas[15]", 288, 16, "number", "", "signed" },
    { "encDeltas[16]", 304, 16, "number", "", "signed" },
    { "encDeltas[17]", 320, 16, "number", "", "signed" },
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

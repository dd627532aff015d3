-- Wireshark dissector of NAMeC, protobuf to the base station. Generated from the packet tables by
-- `omnihil formats namec-pc-to-base --wireshark`; do not edit.
local PROTOCOL = "namec_pc_to_base"
local proto = Proto(PROTOCOL, "NAMeC, protobuf to the base station")

-- name, bytes, types: { first bit, bits, content }, fields: { name, first bit, bits, kind, unit, sign, of a scaled one the unit per count and the value at 0 }
local packets = {
  { name = "BaseCommand", size = 26, types = { }, lsb_first = true, fields = {
    { "robot_id", 0, 32, "number", "", "", number = 1, lo = 0, hi = 15 },
    { "normal_velocity", 32, 32, "float", "m/s", "", number = 2 },
    { "tangential_velocity", 64, 32, "float", "m/s", "", number = 3 },
    { "angular_velocity", 96, 32, "float", "rad/s", "", number = 4 },
    { "kick", 128, 8, "number", "", "", number = 5, lo = 0, hi = 2 },
    { "kick_power", 136, 32, "float", "", "", number = 6, lo = 0, hi = 10 },
    { "charge", 168, 8, "number", "", "", number = 8, lo = 0, hi = 1 },
    { "dribbler", 176, 32, "float", "", "", number = 9 },
  } },
  { name = "BaseFeedback", size = 25, types = { }, lsb_first = true, fields = {
    { "robot_id", 0, 32, "number", "", "", number = 1, lo = 0, hi = 15 },
    { "motor_1_speed", 32, 32, "float", "rad/s", "", number = 2 },
    { "motor_2_speed", 64, 32, "float", "rad/s", "", number = 3 },
    { "motor_3_speed", 96, 32, "float", "rad/s", "", number = 4 },
    { "motor_4_speed", 128, 32, "float", "rad/s", "", number = 5 },
    { "voltage", 160, 32, "float", "V", "", number = 6 },
    { "ir", 192, 8, "number", "", "", number = 7, lo = 0, hi = 1 },
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

-- The varint at `at` and the place behind it, nil where it is cut off.
local function varint_at(range, at)
  local value, weight = 0, 1
  while at < range:len() do
    local byte = range(at, 1):uint()
    value, weight, at = value + weight * (byte % 128), weight * 128, at + 1
    if byte < 128 then return value, at end
  end
  return nil, at
end

-- The fields of a protobuf message side by side, as the packet's rows have them; nil where it is not that packet.
local function flat(packet, range)
  local out, at = ByteArray.new(), 0
  out:set_size(packet.size)
  for i = 0, packet.size - 1 do out:set_index(i, 0) end
  while at < range:len() do
    local key, row = nil, nil
    key, at = varint_at(range, at)
    for _, each in ipairs(packet.fields) do
      if key and each.number == math.floor(key / 8) then row = each end
    end
    if not row or key % 8 ~= (row[4] == "float" and 5 or 0) then return nil end
    local first, bytes = row[2] / 8, row[3] / 8
    if row[4] == "float" then
      if at + 4 > range:len() then return nil end
      for i = 0, 3 do out:set_index(first + i, range(at + i, 1):uint()) end
      local number = range(at, 4):le_float()
      if row.lo and (number < row.lo or number > row.hi) then return nil end
      at = at + 4
    else
      local value
      value, at = varint_at(range, at)
      if not value or value >= 2 ^ row[3] or row.lo and (value < row.lo or value > row.hi) then return nil end
      for i = 0, bytes - 1 do out:set_index(first + i, math.floor(value / 256 ^ i) % 256) end
    end
  end
  return out
end

function proto.dissector(buffer, pinfo, tree)
  pinfo.cols.protocol = PROTOCOL
  local start = 0
  while start < buffer:len() do
    local stop = start + 1 + buffer(start, 1):uint()
    local at = start + 1
    while at < stop do
      local size, first = nil, at
      if stop <= buffer:len() and buffer(at, 1):uint() == 10 then size, first = varint_at(buffer(), at + 1) end
      if not size or first + size > stop then
        tree:add(proto, buffer(start)):add_proto_expert_info(fault, "framing")
        return
      end
      local found = nil
      for _, packet in ipairs(packets) do
        local bytes = size > 0 and flat(packet, buffer(first, size)) or size == 0 and ByteArray.new(string.rep("00", packet.size))
        if bytes then
          found = { packet, bytes }
          break
        end
      end
      if found then
        add_fields(tree, found[1], found[2]:tvb("fields side by side")(), pinfo)
      else
        tree:add(proto, buffer(at, first + size - at)):add_proto_expert_info(fault, "unknown type")
      end
      at = first + size
    end
    start = stop
  end
end

-- Chosen with "Decode As": a UDP port, or the link type USER 0 of a capture of serial bytes.
DissectorTable.get("udp.port"):add_for_decode_as(proto)
DissectorTable.get("wtap_encap"):add(wtap.USER0, proto)

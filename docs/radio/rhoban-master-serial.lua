-- Wireshark dissector of Rhoban and NAMeC (AMC) master. Generated from the packet tables by
-- `omnihil formats rhoban-master-serial --wireshark`; do not edit.
local PROTOCOL = "rhoban_master_serial"
local proto = Proto(PROTOCOL, "Rhoban and NAMeC (AMC) master")

-- name, bytes, types: { first bit, bits, content }, fields: { name, first bit, bits, kind, unit, sign, of a scaled one the unit per count and the value at 0 }
local packets = {
  { name = "master", size = 17, types = { { 8, 8, 0 } }, lsb_first = true, fields = {
    { "robot", 0, 8, "number", "", "" },
    { "instruction", 8, 8, "number", "", "" },
    { "actions", 16, 8, "number", "", "" },
    { "x_speed", 24, 16, "number", "mm/s", "signed" },
    { "y_speed", 40, 16, "number", "mm/s", "signed" },
    { "t_speed", 56, 16, "number", "mrad/s", "signed" },
    { "kick_power", 72, 8, "number", "30 us", "" },
    { "rest", 80, 56, "number", "", "" },
  } },
  { name = "params", size = 17, types = { { 8, 8, 1 } }, lsb_first = true, fields = {
    { "robot", 0, 8, "number", "", "" },
    { "instruction", 8, 8, "number", "", "" },
    { "kp", 16, 32, "float", "", "" },
    { "ki", 48, 32, "float", "", "" },
    { "kd", 80, 32, "float", "", "" },
    { "rest", 112, 24, "number", "", "" },
  } },
  { name = "music", size = 17, types = { { 8, 8, 2 } }, lsb_first = true, fields = {
    { "robot", 0, 8, "number", "", "" },
    { "instruction", 8, 8, "number", "", "" },
    { "instrument", 16, 8, "number", "", "" },
    { "note", 24, 16, "number", "Hz", "" },
    { "duration", 40, 16, "number", "", "" },
    { "rest[0]", 56, 64, "number", "", "" },
    { "rest[1]", 120, 16, "number", "", "" },
  } },
  { name = "status", size = 11, types = { }, lsb_first = true, fields = {
    { "robot", 0, 8, "number", "", "" },
    { "id", 8, 8, "number", "", "" },
    { "status", 16, 8, "number", "", "" },
    { "cap_volt", 24, 8, "number", "V", "" },
    { "voltage_raw", 32, 8, "number", "0.125 V", "" },
    { "xpos", 40, 16, "number", "mm", "signed" },
    { "ypos", 56, 16, "number", "mm", "signed" },
    { "ang_raw", 72, 16, "number", "mrad", "signed" },
  } },
}
local LIST_BEGIN, LIST_END = { 170, 85 }, 255

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
    local rest = buffer(at)
    local head = #LIST_BEGIN + 1
    local is_list = rest:len() > head
    for i, byte in ipairs(LIST_BEGIN) do is_list = is_list and rest(i - 1, 1):uint() == byte end
    local number = is_list and rest(#LIST_BEGIN, 1):uint() or 0
    -- Packets of a list have one length: that which brings the end to its place.
    local size = nil
    for _, packet in ipairs(packets) do
      local last = head + number * packet.size
      if is_list and last < rest:len() and rest(last, 1):uint() == LIST_END then
        if last + 1 == rest:len() or not size then size = packet.size end
      end
    end
    if not size then
      tree:add(proto, rest):add_proto_expert_info(fault, "framing")
      return
    end
    for i = 0, number - 1 do add_packet(tree, rest(head + i * size, size), pinfo) end
    at = at + head + number * size + 1
  end
end

-- Chosen with "Decode As": a UDP port, or the link type USER 0 of a capture of serial bytes.
DissectorTable.get("udp.port"):add_for_decode_as(proto)
DissectorTable.get("wtap_encap"):add(wtap.USER0, proto)

#include <cstdio>

#include "protocols/codec.h"
#include "protocols/emit/emit.h"

namespace omnihil {
namespace {

// The part of the dissector that is the same for every format. Rows of `packets`:
//   {name, size, lsb_first, types = {{first bit, bits, content}, …},
//    fields = {{name, first bit, bits, kind, unit, sign, scale, at 0}, …}}
constexpr std::string_view kEngine = R"lua(
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
)lua";

constexpr std::string_view kDissectRaw = R"lua(
function proto.dissector(buffer, pinfo, tree)
  pinfo.cols.protocol = PROTOCOL
  local at = 0
  while at < buffer:len() do
    local size = add_packet(tree, buffer(at), pinfo)
    if size == 0 then return end
    at = at + size
  end
end
)lua";

constexpr std::string_view kDissectCobs = R"lua(
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
)lua";

constexpr std::string_view kDissectList = R"lua(
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
)lua";

constexpr std::string_view kDissectProtobuf = R"lua(
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
)lua";

constexpr std::string_view kRegister = R"lua(
-- Chosen with "Decode As": a UDP port, or the link type USER 0 of a capture of serial bytes.
DissectorTable.get("udp.port"):add_for_decode_as(proto)
DissectorTable.get("wtap_encap"):add(wtap.USER0, proto)
)lua";

std::string_view kind_text(FieldKind kind) {
  if (kind == FieldKind::kFloat32) return "float";
  if (kind == FieldKind::kRanged32 || kind == FieldKind::kScaled) return "scaled";
  return "number";
}

std::string_view sign_word(Sign sign) {
  if (sign == Sign::kNone) return "";
  return sign == Sign::kMagnitude ? "magnitude" : "signed";
}

std::string field_row(const Field& field) {
  std::string row = "    { \"" + std::string(field.name) + "\", " + std::to_string(field.bit) + ", " +
                    std::to_string(field.bits) + ", \"" + std::string(kind_text(field.kind)) + "\", \"" +
                    std::string(field.unit) + "\", \"" + std::string(sign_word(field.sign)) + "\"";
  if (kind_text(field.kind) == "scaled") {
    const double at_0 = field.kind == FieldKind::kScaled ? field.scale->number(field, 0) : field.lo;
    char scale[64];
    std::snprintf(scale, sizeof scale, ", %.9g, %.9g", field_step(field), at_0);
    row += scale;
  }
  if (field.kind == FieldKind::kScaled && field.scale->none_at_lowest)
    row += ", none = " + std::to_string(integer_of(field, 1ull << (field.bits - 1)));
  if (field.tag != 0) {
    row += ", number = " + std::to_string(field.tag);
    char limits[64];
    std::snprintf(limits, sizeof limits, ", lo = %.9g, hi = %.9g", field.lo, field.hi);
    if (field.lo != field.hi) row += limits;
  }
  if (!field.only_if.empty()) row += ", only_if = \"" + std::string(field.only_if) + "\"";
  return row + " },\n";
}

std::string type_rows(const Message& message) {
  std::string rows;
  for (const Field& field : message.fields) {
    if (field.kind != FieldKind::kType) continue;
    rows += (rows.empty() ? "{ " : ", { ") + std::to_string(field.bit) + ", " + std::to_string(field.bits) +
            ", " + std::to_string(required_raw(field, message, 0)) + " }";
  }
  return "{ " + rows + (rows.empty() ? "}" : " }");
}

int byte_of(const Message& message, FieldKind kind) {
  for (const Field& field : message.fields) {
    if (field.kind == kind) return field.bit / 8;
  }
  return 0;
}

std::string packet_entry(const Message& message) {
  std::string out = "  { name = \"" + std::string(message.name) +
                    "\", size = " + std::to_string(message.size_bytes) + ", types = " + type_rows(message);
  if (message.bit_order == BitOrder::kLsbFirst) out += ", lsb_first = true";
  if (message.text_tail) out += ", text_size_at = " + std::to_string(byte_of(message, FieldKind::kLength));
  out += ", fields = {\n";
  for (const Field& field : message.fields) out += field_row(field);
  return out + "  } },\n";
}

std::string list_rows(const PacketList& list) {
  std::string begin;
  for (const std::uint8_t byte : list.begin) begin += (begin.empty() ? "" : ", ") + std::to_string(byte);
  return "local LIST_BEGIN, LIST_END = { " + begin + " }, " + std::to_string(list.end) + "\n";
}

std::string_view dissector_of(Framing framing) {
  if (framing == Framing::kCobsZero) return kDissectCobs;
  if (framing == Framing::kProtobuf) return kDissectProtobuf;
  return framing == Framing::kList ? kDissectList : kDissectRaw;
}

std::string lua_name(std::string_view id) {
  std::string name(id);
  for (char& c : name) {
    if (c == '-') c = '_';
  }
  return name;
}

}  // namespace

std::string emit_wireshark(const RadioFormat& format) {
  std::string out =
      "-- Wireshark dissector of " + std::string(format.title) + ". Generated from the packet tables by\n";
  out += "-- `omnihil formats " + std::string(format.id) + " --wireshark`; do not edit.\n";
  out += "local PROTOCOL = \"" + lua_name(format.id) + "\"\n";
  out += "local proto = Proto(PROTOCOL, \"" + std::string(format.title) + "\")\n\n";
  out +=
      "-- name, bytes, types: { first bit, bits, content }, fields: { name, first bit, bits, kind, unit, "
      "sign, "
      "of a scaled one the unit per count and the value at 0 }\n";
  out += "local packets = {\n";
  for (const Message& message : format.messages) out += packet_entry(message);
  out += "}\n";
  if (format.framing == Framing::kList) out += list_rows(*format.list);
  out += kEngine;
  out += dissector_of(format.framing);
  out += kRegister;
  return out;
}

}  // namespace omnihil

#include "hil/radio_file/radio_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "protocols/meaning.h"
#include "protocols/scale_rules.h"
#include "protocols/table_words.h"

namespace omnihil {
namespace {

constexpr std::int64_t kAnyWhole = std::numeric_limits<std::int64_t>::max();

bool flag(TomlKeys& keys, const toml::table& t, const std::string& path, std::string_view key) {
  const toml::node* node = t.get(key);
  if (node == nullptr) return false;
  if (node->is_boolean()) return *node->value<bool>();
  keys.wrong(*node, key_path(path, key), fmt::format("is {}", kind_of(*node)), "allowed: true, false");
  return false;
}

template <class Rows, class Name>
std::vector<std::string_view> names_of(const Rows& rows, Name name) {
  std::vector<std::string_view> names;
  for (const auto& row : rows) names.push_back(name(row));
  return names;
}

// Keys of every field, and those of its kind alone.
constexpr std::string_view kKeysOfAll[] = {"name",     "bits",  "kind",  "unit",    "what",   "role",
                                           "envelope", "means", "times", "only_if", "number", "names"};
std::vector<std::string_view> keys_of(FieldKind kind) {
  std::vector<std::string_view> keys(std::begin(kKeysOfAll), std::end(kKeysOfAll));
  const auto add = [&](std::initializer_list<std::string_view> more) { keys.insert(keys.end(), more); };
  switch (kind) {
    case FieldKind::kInteger:
      add({"sign", "lo", "hi"});
      break;
    case FieldKind::kConst:
      add({"is", "cause"});
      break;
    case FieldKind::kType:
      add({"from_bit"});
      break;
    case FieldKind::kLength:
      add({"not_counted"});
      break;
    case FieldKind::kFloat32:
    case FieldKind::kRanged32:
      add({"lo", "hi"});
      break;
    case FieldKind::kScaled:
      add({"sign", "rule", "lo", "hi"});
      break;
    case FieldKind::kChecksum:
      add({"sum", "from", "until"});
      break;
    case FieldKind::kReserved:
      break;
  }
  return keys;
}

std::int64_t largest_of(int bits) { return bits >= 63 ? kAnyWhole : (std::int64_t{1} << bits) - 1; }

}  // namespace

std::optional<std::int64_t> whole_number(TomlKeys& keys, const toml::table& table, const std::string& path,
                                         std::string_view key, std::int64_t lo, std::int64_t hi) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return std::nullopt;
  const std::string allowed = fmt::format("allowed: a whole number, {} to {}", lo, hi);
  if (!node->is_integer()) {
    keys.wrong(*node, key_path(path, key), fmt::format("is {}", kind_of(*node)), allowed);
    return std::nullopt;
  }
  const std::int64_t value = *node->value<std::int64_t>();
  if (value >= lo && value <= hi) return value;
  keys.wrong(*node, key_path(path, key), "is out of range", allowed);
  return std::nullopt;
}

void PacketReader::read(const toml::table& t) {
  const std::string path = fmt::format("packet[{}]", out_.messages.size());
  static constexpr std::string_view kKeys[] = {"name", "type",        "direction", "bit_order",
                                               "role", "answer_type", "asks",      "frame",
                                               "what", "fields",      "text"};
  keys_.only(t, path, kKeys);
  Message message;
  if (t.get("name") == nullptr) keys_.missing(t, path, "name", "the packet's name");
  message.name = out_.keep(keys_.text(t, path, "name").value_or(""));
  message.type = static_cast<std::uint32_t>(whole_number(keys_, t, path, "type", 0, 0xFFFFFFFF).value_or(0));
  if (t.get("direction") == nullptr) keys_.missing(t, path, "direction", "\"to robot\", \"from robot\", …");
  message.direction =
      static_cast<Direction>(keys_.word(t, path, "direction", kDirectionWords, 0).value_or(0));
  if (t.get("bit_order") == nullptr) keys_.missing(t, path, "bit_order", "\"msb first\" or \"lsb first\"");
  message.bit_order = static_cast<BitOrder>(keys_.word(t, path, "bit_order", kBitOrderWords, 0).value_or(0));
  message.role = static_cast<MessageRole>(keys_.word(t, path, "role", kMessageRoleWords, 0).value_or(0));
  message.answer_type =
      static_cast<std::uint32_t>(whole_number(keys_, t, path, "answer_type", 0, 0xFFFFFFFF).value_or(0));
  if (t.get("asks") != nullptr)
    message.asks = static_cast<int>(keys_.word(t, path, "asks", kAsksWords, 0).value_or(0));
  message.in_field_frame = keys_.word(t, path, "frame", kFrameWords, 0).value_or(0) == 1;
  message.what = out_.keep(keys_.text(t, path, "what").value_or(std::string(message.name)));
  message.text_tail = flag(keys_, t, path, "text");
  fields(t, path, message);
  if (message.text_tail &&
      std::ranges::none_of(message.fields, [](const Field& f) { return f.kind == FieldKind::kLength; }))
    keys_.wrong(*t.get("text"), path + ".text", "has no length", "needed: a field of kind \"length\"");
  out_.messages.push_back(message);
}

void PacketReader::fields(const toml::table& t, const std::string& path, Message& message) {
  const toml::node* node = t.get("fields");
  if (node == nullptr)
    return keys_.missing(t, path, "fields", "fields = [ { name = …, bits = …, kind = … }, … ]");
  const bool rows = node->is_array() && !node->as_array()->empty() &&
                    std::all_of(node->as_array()->begin(), node->as_array()->end(),
                                [](const toml::node& row) { return row.is_table(); });
  if (!rows)
    return keys_.wrong(*node, path + ".fields", "is no list of fields",
                       "needed: { name = …, bits = …, kind = … }, …");
  std::vector<Field>& all = out_.rows.emplace_back();
  int bit = 0;
  for (const toml::node& row : *node->as_array()) {
    message.fields = all;  // those before: for what depends on them
    Field next = field(*row.as_table(), fmt::format("{}.fields[{}]", path, all.size()), message);
    next.bit = bit;
    bit += next.bits;
    all.push_back(next);
  }
  message.fields = all;
  message.size_bytes = bit / 8;
  if (bit % 8 != 0)
    keys_.wrong(*node, path + ".fields", fmt::format("fill {} bits", bit),
                fmt::format("needed: whole bytes, {} bits more", 8 - bit % 8));
  if (all.size() > kMaxFields)
    keys_.wrong(*node, path + ".fields", fmt::format("are {}", all.size()),
                fmt::format("allowed: {}", kMaxFields));
  // Sums need the packet's length.
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].check == nullptr) continue;
    const int end = all[i].check->until > 0 ? all[i].check->until : message.size_bytes + all[i].check->until;
    if (all[i].check->from < end && end <= message.size_bytes) continue;
    const toml::table& row = *node->as_array()->get(i)->as_table();
    keys_.wrong(
        row, fmt::format("{}.fields[{}]", path, i),
        fmt::format("is the sum of bytes {} to {} of {}", all[i].check->from, end - 1, message.size_bytes),
        "needed: from < until, inside the packet (0 and less are counted from its end)");
  }
}

Field PacketReader::field(const toml::table& t, const std::string& path, const Message& message) {
  Field out;
  if (t.get("name") == nullptr) keys_.missing(t, path, "name", "the field's name");
  out.name = out_.keep(keys_.text(t, path, "name").value_or(""));
  if (t.get("bits") == nullptr) keys_.missing(t, path, "bits", "1 to 64");
  out.bits = static_cast<int>(whole_number(keys_, t, path, "bits", 1, 64).value_or(8));
  if (t.get("kind") == nullptr) keys_.missing(t, path, "kind", "\"integer\", \"float32\", \"scaled\", …");
  const auto kind = keys_.word(t, path, "kind", kKindWords, 0);
  out.kind = static_cast<FieldKind>(kind.value_or(0));
  if (kind) keys_.only(t, path, keys_of(out.kind));
  out.sign = static_cast<Sign>(keys_.word(t, path, "sign", kSignWords, 0).value_or(0));
  if (out.sign != Sign::kNone && out.bits < 2)
    keys_.wrong(*t.get("sign"), path + ".sign", "a single bit has no sign", "needed: bits = 2 or more");
  out.unit = out_.keep(keys_.text(t, path, "unit").value_or(""));
  out.what = out_.keep(keys_.text(t, path, "what").value_or(std::string(out.name)));
  out.names = out_.keep(keys_.text(t, path, "names").value_or(""));
  out.envelope = flag(keys_, t, path, "envelope");
  if (t.get("name") != nullptr && message.field_index(out.name) >= 0)
    keys_.wrong(*t.get("name"), path + ".name", "is there twice", "needed: a name of its own");
  by_kind(t, path, out);
  number(t, path, message, out);
  robot_side(t, path, out);
  const std::string flag_name = keys_.text(t, path, "only_if").value_or("");
  if (!flag_name.empty() && message.field_index(flag_name) < 0)
    keys_.wrong(*t.get("only_if"), path + ".only_if", "is no field before this one",
                spelling_hint(flag_name, names_of(message.fields, [](const Field& f) { return f.name; })));
  out.only_if = out_.keep(flag_name);
  return out;
}

// Of protobuf alone, and needed there; they ascend, as encoders write them.
void PacketReader::number(const toml::table& t, const std::string& path, const Message& message, Field& out) {
  constexpr std::int64_t kLargest = (1 << 29) - 1;
  const bool protobuf = out_.format.framing == Framing::kProtobuf;
  if (t.get("number") == nullptr) {
    if (protobuf) keys_.missing(t, path, "number", "its number in the protobuf message");
    return;
  }
  if (!protobuf)
    return keys_.wrong(*t.get("number"), path + ".number", "is of no meaning here",
                       "allowed: with framing = \"protobuf\"");
  out.tag = static_cast<int>(whole_number(keys_, t, path, "number", 1, kLargest).value_or(0));
  if (!message.fields.empty() && out.tag <= message.fields.back().tag)
    keys_.wrong(*t.get("number"), path + ".number", "does not ascend",
                fmt::format("needed: more than {}", message.fields.back().tag));
  const bool whole = out.kind == FieldKind::kInteger && out.sign == Sign::kNone && out.bits % 8 == 0;
  if (!whole && out.kind != FieldKind::kFloat32)
    keys_.wrong(t, path, "is no field of a protobuf message",
                "needed: kind = \"float32\", or \"integer\" without sign, of whole bytes");
}

void PacketReader::by_kind(const toml::table& t, const std::string& path, Field& out) {
  const auto bits_must_be = [&](bool right, const char* allowed) {
    if (!right && t.get("bits") != nullptr)
      keys_.wrong(*t.get("bits"), path + ".bits", "does not go with this kind", allowed);
  };
  switch (out.kind) {
    case FieldKind::kConst:
      if (t.get("is") == nullptr) keys_.missing(t, path, "is", "the content");
      out.constant =
          static_cast<std::uint64_t>(whole_number(keys_, t, path, "is", 0, largest_of(out.bits)).value_or(0));
      out.cause = static_cast<ConstCause>(keys_.word(t, path, "cause", kCauseWords, 0).value_or(0));
      break;
    case FieldKind::kType:
      bits_must_be(out.bits <= 32, "allowed: 1 to 32");
      out.constant = static_cast<std::uint64_t>(whole_number(keys_, t, path, "from_bit", 0, 31).value_or(0));
      break;
    case FieldKind::kLength:
      out.constant =
          static_cast<std::uint64_t>(whole_number(keys_, t, path, "not_counted", 0, 65535).value_or(0));
      break;
    case FieldKind::kFloat32:
      bits_must_be(out.bits == 32, "allowed: 32");
      limits(t, path, false, out);
      break;
    case FieldKind::kRanged32:
      bits_must_be(out.bits <= 32, "allowed: 1 to 32");
      limits(t, path, true, out);
      break;
    case FieldKind::kScaled: {
      bits_must_be(out.bits <= 32, "allowed: 1 to 32");
      limits(t, path, true, out);
      if (t.get("rule") == nullptr) keys_.missing(t, path, "rule", "\"nearest\", \"even-steps\", …");
      const std::string rule = keys_.text(t, path, "rule").value_or("");
      out.scale = find_scale_rule(rule);
      if (out.scale == nullptr && !rule.empty())
        keys_.wrong(*t.get("rule"), path + ".rule", "is no rule of rounding",
                    spelling_hint(rule, names_of(scale_rules(), [](const ScaleRule* r) { return r->name; })));
      if (out.scale != nullptr && out.scale->none_at_lowest && out.sign != Sign::kTwosComplement)
        keys_.wrong(*t.get("rule"), path + ".rule", "has a lowest count without a number",
                    "needed: sign = \"twos-complement\"");
      break;
    }
    case FieldKind::kChecksum:
      sum(t, path, out);
      break;
    case FieldKind::kInteger:
      limits(t, path, false, out);
      break;
    case FieldKind::kReserved:
      break;
  }
}

void PacketReader::limits(const toml::table& t, const std::string& path, bool needed, Field& out) {
  constexpr double kAny = std::numeric_limits<double>::max();
  for (const std::string_view key : {"lo", "hi"}) {
    const toml::node* other = t.get(key == "lo" ? "hi" : "lo");
    if (t.get(key) == nullptr && (needed || other != nullptr)) keys_.missing(t, path, key, "a number");
  }
  out.lo = keys_.number(t, path, "lo", -kAny, kAny, false, "allowed: a number").value_or(0.0);
  out.hi = keys_.number(t, path, "hi", -kAny, kAny, false, "allowed: a number").value_or(0.0);
  const bool both = t.get("lo") != nullptr && t.get("hi") != nullptr;
  if (both && !(out.lo < out.hi))
    keys_.wrong(*t.get("hi"), path + ".hi", "is not above lo", fmt::format("needed: more than {}", out.lo));
}

void PacketReader::sum(const toml::table& t, const std::string& path, Field& out) {
  if (t.get("sum") == nullptr) keys_.missing(t, path, "sum", "\"sum8\", \"xor8\", \"crc32\", …");
  const std::string name = keys_.text(t, path, "sum").value_or("");
  ChecksumRule rule;
  for (const ChecksumKind* kind : kChecksumKinds) {
    if (kind->name == name) rule.kind = kind;
  }
  rule.from = static_cast<int>(whole_number(keys_, t, path, "from", 0, 65535).value_or(0));
  rule.until = static_cast<int>(whole_number(keys_, t, path, "until", -65535, 65535).value_or(0));
  if (rule.kind == nullptr) {
    if (!name.empty())
      keys_.wrong(
          *t.get("sum"), path + ".sum", "is no sum that is known here",
          spelling_hint(name, names_of(kChecksumKinds, [](const ChecksumKind* k) { return k->name; })));
    return;
  }
  if (rule.kind->bits != out.bits && t.get("bits") != nullptr)
    keys_.wrong(*t.get("bits"), path + ".bits", "does not go with this sum",
                fmt::format("allowed: {}", rule.kind->bits));
  out.check = out_.keep(rule);
}

void PacketReader::robot_side(const toml::table& t, const std::string& path, Field& out) {
  out.role = static_cast<FieldRole>(keys_.word(t, path, "role", kFieldRoleWords, 0).value_or(0));
  const std::string means = keys_.text(t, path, "means").value_or("");
  out.means = find_meaning(means);
  if (!means.empty() && out.means == nullptr)
    keys_.wrong(*t.get("means"), path + ".means", "is nothing that a robot has",
                spelling_hint(means, names_of(meanings(), [](const Meaning& m) { return m.word; })));
  constexpr double kAny = 1e12;
  out.times = keys_.number(t, path, "times", -kAny, kAny, false, "allowed: a number but 0").value_or(1.0);
  if (out.times == 0.0)
    keys_.wrong(*t.get("times"), path + ".times", "would make every number 0", "allowed: a number but 0");
  if (t.get("times") != nullptr && out.means == nullptr && means.empty())
    keys_.wrong(*t.get("times"), path + ".times", "is of no meaning here", "allowed: with means");
}

}  // namespace omnihil

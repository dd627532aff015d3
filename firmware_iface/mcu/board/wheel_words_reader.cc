#include "firmware_iface/mcu/board/wheel_words_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <bitset>

#include "firmware_iface/robot_io.h"

namespace omnihil::mcu {
namespace {

constexpr std::int64_t kMs_ns = 1'000'000, kLongest_ms = 86'400'000;  // a day
constexpr const char* kSources = "one of value, per_rad_s, counter, checksum";

// The frame that is read, and which of its bits have been given away.
struct FrameAtWork {
  BoardKeys& keys;
  const WordFrame& frame;
  int motors;
  std::bitset<8 * BusFrame::kCapacity> taken = {};
};

const toml::table* table_of(const toml::table& t, const std::string& path, std::string_view key,
                            BoardKeys& keys) {
  const toml::table* found = t.get(key)->as_table();
  if (found == nullptr) keys.wrong(t, path, key, "not a table", fmt::format("{} = {{ … }}", key));
  return found;
}

std::optional<std::uint32_t> number_of(const toml::table& t, const std::string& path, std::string_view key,
                                       BoardKeys& keys, double most) {
  const auto value = keys.whole(t, path, key, 0, static_cast<std::int64_t>(most));
  return value ? std::optional(static_cast<std::uint32_t>(*value)) : std::nullopt;
}

WordCounter read_counter(const toml::table& t, const std::string& path, BoardKeys& keys,
                         const WordField& field) {
  keys.only(t, path, {"first", "last", "step"});
  const double most = range_of(field).upper;
  WordCounter counter;
  counter.first = number_of(t, path, "first", keys, most).value_or(0);
  counter.last = number_of(t, path, "last", keys, most).value_or(static_cast<std::uint32_t>(most));
  counter.step = number_of(t, path, "step", keys, most).value_or(1);
  if (counter.last <= counter.first && counter.first <= most) {
    keys.wrong(t, path, "last", "not behind first", fmt::format("{} to {}", counter.first + 1, most));
    counter.last = counter.first;
  }
  if (counter.step == 0) keys.wrong(t, path, "step", "it would never count", "1 or more");
  return counter;
}

void read_over(const toml::table& t, const std::string& path, BoardKeys& keys, const WordFrame& frame,
               const WordField& field, WordChecksum& rule) {
  const std::size_t end = field.at + bytes_of(field.type);
  rule.over_first = field.at > 0 ? 0 : end;  // all before it, or all behind it where it stands first
  rule.over_last = (field.at > 0 ? field.at : frame.bytes) - 1u;
  const std::string allowed =
      fmt::format("[first byte, last byte] of 0 to {}, without {} to {}", frame.bytes - 1, field.at, end - 1);
  if (const toml::node* node = t.get("over")) {
    const toml::array* pair = node->as_array();
    const auto byte = [pair](std::size_t i) { return pair->get(i)->value_exact<std::int64_t>(); };
    if (pair == nullptr || pair->size() != 2 || !byte(0) || !byte(1) || *byte(0) < 0 ||
        *byte(1) >= frame.bytes || *byte(0) > *byte(1))
      return keys.wrong(t, path, "over", "no range of bytes", allowed);
    rule.over_first = static_cast<std::size_t>(*byte(0));
    rule.over_last = static_cast<std::size_t>(*byte(1));
  }
  const bool itself = rule.over_first < end && rule.over_last >= field.at;
  if (itself || rule.over_first > rule.over_last)
    keys.wrong(t, path, "over", itself ? "it covers itself" : "nothing is covered", allowed);
}

WordChecksum read_checksum(const toml::table& t, const std::string& path, BoardKeys& keys,
                           const WordFrame& frame, const WordField& field) {
  keys.only(t, path, {"kind", "polynomial", "start", "reflected", "xor_out", "over"});
  const double most = range_of(field).upper;
  WordChecksum rule;
  const std::string kind = keys.text(t, path, "kind").value_or("");
  std::string kinds = "sum, xor, crc";
  for (const ChecksumKind* named : kChecksumKinds) {
    kinds += fmt::format(", {}", named->name);
    if (named->name == kind) rule.named = named;
  }
  const bool crc = kind == "crc";
  if (rule.named != nullptr) {
    rule.sum = WordSum::kNamed;
    if (rule.named->bits != static_cast<int>(field.width()))
      keys.wrong(t, path, "kind",
                 fmt::format("it has {} bits, the field {}", rule.named->bits, field.width()),
                 fmt::format("a field of {} bits", rule.named->bits));
    for (const std::string_view key : {"start", "xor_out"})
      if (t.contains(key)) keys.wrong(t, path, key, fmt::format("{} has its own", kind), "kind = \"crc\"");
  } else if (kind == "sum" || kind == "xor" || crc) {
    rule.sum = crc ? WordSum::kCrc : kind == "sum" ? WordSum::kSum : WordSum::kXor;
  } else {
    keys.wrong(t, path, "kind", t.contains("kind") ? "unknown" : "missing", kinds);
  }
  for (const std::string_view key : {"polynomial", "reflected"})
    if (t.contains(key) && !crc) keys.wrong(t, path, key, "not of a CRC", "kind = \"crc\"");
  if (crc && !t.contains("polynomial"))
    keys.missing(t, path, "polynomial", "without its highest bit, such as 0x1021");
  rule.crc = {.bits = static_cast<int>(field.width()),
              .polynomial = number_of(t, path, "polynomial", keys, most).value_or(0),
              .start = number_of(t, path, "start", keys, most).value_or(0),
              .reflected = keys.flag(t, path, "reflected").value_or(false),
              .xor_out = number_of(t, path, "xor_out", keys, most).value_or(0)};
  read_over(t, path, keys, frame, field, rule);
  return rule;
}

// Where it stands: its type, its bytes, its bits of them.
void read_place(const toml::table& t, const std::string& path, FrameAtWork& work, WordField& field) {
  BoardKeys& keys = work.keys;
  const auto type =  // in the order of WordType
      keys.word(t, path, "type", {"u8", "i8", "u16", "i16", "u32", "i32", "f32"}, true);
  field.type = static_cast<WordType>(type.value_or(0));
  if (!t.contains("at")) keys.missing(t, path, "at", "the field's first byte, from 0");
  const auto bytes = static_cast<std::int64_t>(bytes_of(field.type));
  const auto at = keys.whole(t, path, "at", 0, work.frame.bytes - bytes);
  field.at = static_cast<std::size_t>(at.value_or(0));
  field.big_endian = keys.flag(t, path, "big_endian").value_or(false);
  for (const std::string_view key : {"shift", "bits"})
    if (field.type == WordType::kF32 && t.contains(key))
      keys.wrong(t, path, key, "of an f32", "a whole number");
  field.shift = static_cast<unsigned>(keys.whole(t, path, "shift", 0, 8 * bytes - 1).value_or(0));
  const unsigned left = 8 * static_cast<unsigned>(bytes) - field.shift;
  field.bits = static_cast<unsigned>(keys.whole(t, path, "bits", 1, left).value_or(left));
  if (!at) return;
  for (unsigned bit = field.shift; bit < field.shift + field.bits; ++bit) {
    const std::size_t byte = field.big_endian ? bytes_of(field.type) - 1 - bit / 8 : bit / 8;
    const std::size_t place = 8 * (field.at + byte) + bit % 8;
    if (place >= work.taken.size()) return;
    if (work.taken[place])
      return keys.wrong(t, path, "at", fmt::format("another field has byte {}", field.at + byte),
                        "bits that no other field has");
    work.taken[place] = true;
  }
}

void read_number(const toml::table& t, const std::string& path, FrameAtWork& work, WordField& field) {
  BoardKeys& keys = work.keys;
  // A number that stays has to fit its place; a speed ends at the place's bounds.
  WordRange range{-1e10, 1e10};
  if (field.source == WordSource::kStays && field.type != WordType::kF32) range = range_of(field);
  field.value = keys.number(t, path, field.source == WordSource::kSpeed ? "per_rad_s" : "value", range.lower,
                            range.upper)
                    .value_or(0.0);
}

WordField read_field(const toml::table& t, const std::string& path, FrameAtWork& work) {
  BoardKeys& keys = work.keys;
  keys.only(
      t, path,
      {"at", "type", "big_endian", "shift", "bits", "value", "per_rad_s", "wheel", "counter", "checksum"});
  WordField field;
  read_place(t, path, work, field);
  std::string_view source;
  for (const std::string_view key : {"value", "per_rad_s", "counter", "checksum"}) {
    if (!t.contains(key)) continue;
    if (!source.empty()) keys.wrong(t, path, key, fmt::format("beside {}", source), kSources);
    source = key;
  }
  if (source.empty()) keys.wrong(t, path, "at", "it says nothing", kSources);
  if ((source == "counter" || source == "checksum") && !is_unsigned(field.type)) {
    keys.wrong(t, path, "type", fmt::format("of a {}", source), "u8, u16, u32");
  } else if (source == "counter") {
    field.source = WordSource::kCounter;
    if (const auto* inner = table_of(t, path, source, keys))
      field.counter = read_counter(*inner, path + ".counter", keys, field);
  } else if (source == "checksum") {
    field.source = WordSource::kChecksum;
    if (const auto* inner = table_of(t, path, source, keys))
      field.checksum = read_checksum(*inner, path + ".checksum", keys, work.frame, field);
  } else {
    field.source = source == "per_rad_s" ? WordSource::kSpeed : WordSource::kStays;
    read_number(t, path, work, field);
  }
  if (work.frame.each_wheel && t.contains("wheel"))
    keys.wrong(t, path, "wheel", "in a frame for each wheel", "each = \"board\"");
  field.wheel = static_cast<int>(keys.whole(t, path, "wheel", 0, work.motors - 1).value_or(0));
  return field;
}

void read_times(const toml::table& t, const std::string& path, BoardKeys& keys, std::int64_t period_ns,
                WordFrame& frame) {
  const auto time_ns = [&](std::string_view key, std::int64_t least_ms, std::int64_t otherwise_ns) {
    const auto ms = keys.whole(t, path, key, least_ms, kLongest_ms);
    if (ms && *ms * kMs_ns % period_ns != 0)
      keys.wrong(t, path, key, "no multiple of period_ms",
                 fmt::format("{} ms times a number", period_ns / kMs_ns));
    return ms ? *ms * kMs_ns : otherwise_ns;
  };
  frame.every_ns = time_ns("every_ms", 1, 0);
  frame.from_ns = time_ns("from_ms", 0, 0);
  frame.until_ns = time_ns("until_ms", 1, WordFrame::kForever_ns);
  if (frame.until_ns <= frame.from_ns)
    keys.wrong(t, path, "until_ms", "not after from_ms", fmt::format("more than {}", frame.from_ns / kMs_ns));
}

WordFrame read_frame(const toml::table& t, const std::string& path, BoardKeys& keys, bool serial, int motors,
                     std::int64_t period_ns) {
  keys.only(t, path, {"each", "id", "extended", "bytes", "every_ms", "from_ms", "until_ms", "field"});
  WordFrame frame;
  frame.each_wheel = keys.word(t, path, "each", {"wheel", "board"}).value_or(0) == 0;
  frame.extended = keys.flag(t, path, "extended").value_or(false);
  constexpr std::int64_t kLastStandard = 0x7FF, kLastExtended = 0x1FFFFFFF;
  const std::int64_t last = (frame.extended ? kLastExtended : kLastStandard) - (kWheels - 1);
  if (!serial && !t.contains("id")) keys.missing(t, path, "id", "of the robot's first wheel");
  if (serial && t.contains("id")) keys.wrong(t, path, "id", "on a serial port", "frames without one");
  frame.id = static_cast<std::uint32_t>(keys.whole(t, path, "id", 0, last).value_or(0));
  const std::int64_t most = serial ? static_cast<std::int64_t>(BusFrame::kCapacity) : 8;
  if (!t.contains("bytes")) keys.missing(t, path, "bytes", fmt::format("1 to {}", most));
  frame.bytes = static_cast<std::uint8_t>(keys.whole(t, path, "bytes", 1, most).value_or(most));
  read_times(t, path, keys, period_ns, frame);
  FrameAtWork work{keys, frame, motors};
  for (const auto& [field, at] : keys.tables(t, path, "field"))
    frame.fields.push_back(read_field(*field, at, work));
  return frame;
}

}  // namespace

WheelWords read_wheel_words(const toml::table& t, const std::string& path, BoardKeys& keys, bool serial,
                            int motors) {
  WheelWords words;
  if (!t.contains("period_ms")) keys.missing(t, path, "period_ms", "between what the main board says");
  words.period_ns = keys.whole(t, path, "period_ms", 1, 1000).value_or(1) * kMs_ns;
  for (const auto& [frame, at] : keys.tables(t, path, "frame"))
    words.frames.push_back(read_frame(*frame, at, keys, serial, motors, words.period_ns));
  return words;
}

}  // namespace omnihil::mcu

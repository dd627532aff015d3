// PX4's ULog. Source: docs.px4.io, "ULog File Format": header of 16 bytes, then messages of size (16 bits), type (a
// letter) and payload; F: a format with its fields, A: a subscription, D: data. Padding at the end of a message may be
// left out.
#include <fmt/format.h>

#include <charconv>
#include <map>
#include <set>

#include "hil/logs/log_bytes.h"
#include "hil/logs/log_formats.h"
#include "hil/logs/topic_series.h"
#include "hil/text/text_file.h"

namespace omnihil {
namespace {

struct UlogField {
  std::string type, name;
  std::size_t count = 1;
  bool is_list = false;
};
using UlogFormats = std::map<std::string, std::vector<UlogField>, std::less<>>;
constexpr int kMostNested = 8;

// "float[3] gyro" -> {"float", "gyro", 3, true}
UlogField field_of(std::string_view text) {
  UlogField out;
  const std::size_t blank = text.find(' ');
  if (blank == std::string_view::npos) return out;
  std::string_view type = text.substr(0, blank);
  out.name = text.substr(blank + 1);
  const std::size_t bracket = type.find('[');
  if (bracket != std::string_view::npos) {
    const std::string_view number = type.substr(bracket + 1);
    std::from_chars(number.data(), number.data() + number.size(), out.count);
    type = type.substr(0, bracket);
    out.is_list = true;
  }
  out.type = type;
  return out;
}

// "motor:uint64_t timestamp;float duty;"
void add_format(std::string_view text, UlogFormats& formats) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return;
  std::vector<UlogField>& fields = formats[std::string(text.substr(0, colon))];
  fields.clear();
  text.remove_prefix(colon + 1);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(';'), text.size());
    UlogField field = field_of(text.substr(0, end));
    if (!field.name.empty()) fields.push_back(std::move(field));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

std::size_t size_of_type(std::string_view type) {
  if (type == "int8_t" || type == "uint8_t" || type == "bool" || type == "char") return 1;
  if (type == "int16_t" || type == "uint16_t") return 2;
  if (type == "int32_t" || type == "uint32_t" || type == "float") return 4;
  if (type == "int64_t" || type == "uint64_t" || type == "double") return 8;
  return 0;  // another format
}

double value_of(std::string_view type, LogBytes& in) {
  if (type == "int8_t") return in.number<std::int8_t>();
  if (type == "uint8_t" || type == "bool") return in.number<std::uint8_t>();
  if (type == "int16_t") return in.number<std::int16_t>();
  if (type == "uint16_t") return in.number<std::uint16_t>();
  if (type == "int32_t") return in.number<std::int32_t>();
  if (type == "uint32_t") return in.number<std::uint32_t>();
  if (type == "float") return in.number<float>();
  if (type == "double") return in.number<double>();
  if (type == "int64_t") return static_cast<double>(in.number<std::int64_t>());
  return static_cast<double>(in.number<std::uint64_t>());
}

class UlogMessage {
 public:
  UlogMessage(const UlogFormats& formats, LogBytes& in) : formats_(formats), in_(in) {}

  std::vector<std::pair<std::string, double>> values;
  std::int64_t time_ns = -1;
  std::string unknown_type;

  // False: a type that no format names, or deeper than any real log.
  bool read(std::string_view format, const std::string& prefix, int depth) {
    const auto fields = formats_.find(format);
    if (fields == formats_.end() || depth > kMostNested) {
      unknown_type = format;
      return false;
    }
    for (const UlogField& field : fields->second) {
      const std::size_t size = size_of_type(field.type);
      if (field.name.starts_with("_padding")) {
        if (in_.left() < size * field.count) return true;  // at the end of a message it is not stored
        in_.skip(size * field.count);
        continue;
      }
      if (field.type == "char") {
        in_.skip(field.count);
        continue;
      }
      for (std::size_t i = 0; i < field.count; ++i) {
        const std::string name =
            field.is_list ? fmt::format("{}{}[{}]", prefix, field.name, i) : prefix + field.name;
        if (size == 0) {
          if (!read(field.type, name + ".", depth + 1)) return false;
        } else if (depth == 0 && field.name == "timestamp") {
          time_ns = ns_of_us(in_.number<std::uint64_t>());
        } else {
          values.emplace_back(name, value_of(field.type, in_));
        }
      }
    }
    return true;
  }

 private:
  const UlogFormats& formats_;
  LogBytes& in_;
};

}  // namespace

LogTable read_ulog(const std::string& path) {
  std::string error;
  const std::string bytes = read_text_file(path, error);
  if (!error.empty()) throw BadLog(path + ": " + error);
  LogBytes in(bytes, path);
  in.skip(16);  // magic, version, start time
  UlogFormats formats;
  std::map<std::uint16_t, std::pair<std::string, std::string>> subscribed;  // id -> format, name
  std::set<std::string> unknown;
  TopicSeries topics;
  std::size_t dropouts = 0, untimed = 0, broken = 0;
  bool cut = false;
  while (!in.at_end()) {
    if (in.left() < 3) {
      cut = true;
      break;
    }
    const auto size = in.number<std::uint16_t>();
    const auto type = in.number<char>();
    if (in.left() < size) {
      cut = true;
      break;
    }
    const std::string_view payload = in.text(size);
    LogBytes message(payload, path, in.at() - size);
    if (type == 'B' && payload.size() >= 16) {
      // Incompatible flags: of byte 0 the lowest bit says that data were appended, which are messages like the others.
      for (std::size_t i = 0; i < 8; ++i) {
        const auto flags = static_cast<unsigned char>(payload[8 + i]);
        if ((i == 0 ? flags & ~1u : flags) != 0)
          throw BadLog(fmt::format(
              "{}: incompatible flags of byte {} are {:#x}; allowed: appended data alone", path, i, flags));
      }
    } else if (type == 'F') {
      add_format(payload, formats);
    } else if (type == 'A') {
      const auto multi = message.number<std::uint8_t>();
      const auto id = message.number<std::uint16_t>();
      const std::string name(message.text(message.left()));
      subscribed[id] = {name, multi == 0 ? name : fmt::format("{}_{}", name, multi)};
    } else if (type == 'O') {
      ++dropouts;
    } else if (type == 'D') {
      const auto id = message.number<std::uint16_t>();
      const auto to = subscribed.find(id);
      if (to == subscribed.end()) {
        ++broken;
        continue;
      }
      UlogMessage reader(formats, message);
      if (!reader.read(to->second.first, to->second.second + ".", 0)) {
        unknown.insert(reader.unknown_type);
      } else if (reader.time_ns < 0) {
        ++untimed;
      } else {
        for (const auto& [name, value] : reader.values) topics.add(name, reader.time_ns, value);
      }
    }
  }
  LogTable log = topics.table(LogFormat::kUlog);
  if (cut) log.notes.push_back(path + ": ends within a message, which is left out");
  if (dropouts > 0) log.notes.push_back(fmt::format("{}: the logger dropped data {} times", path, dropouts));
  if (broken > 0)
    log.notes.push_back(fmt::format("{}: {} messages that nobody subscribed to left out", path, broken));
  if (untimed > 0)
    log.notes.push_back(fmt::format("{}: {} messages without a timestamp left out", path, untimed));
  for (const std::string& name : unknown)
    log.notes.push_back(fmt::format("{}: messages with the unknown type {} left out", path, name));
  if (log.series.empty())
    throw BadLog(path + ": has no numbers; allowed: subscribed messages with a timestamp");
  return log;
}

}  // namespace omnihil

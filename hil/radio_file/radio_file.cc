#include "hil/radio_file/radio_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "hil/radio_file/radio_rows.h"
#include "hil/radio_file/radio_tables.h"
#include "hil/text/text_file.h"
#include "hil/text/toml_keys.h"
#include "protocols/codec.h"
#include "protocols/dongles/table_dongle.h"
#include "protocols/plain_packet.h"
#include "protocols/protobuf_list.h"
#include "protocols/table_words.h"

namespace omnihil {
namespace {

constexpr std::size_t kLongestPacket = 255;   // of a plain dongle's frame
constexpr std::size_t kLongestStuffed = 253;  // COBS with one code

class FileReader {
 public:
  FileReader(const ModelDocument& document, std::vector<ModelProblem>& problems, RadioTables& out)
      : keys_(document, problems), table_(document.table), problems_(problems), out_(out) {}

  void read() {
    static constexpr std::string_view kKeys[] = {"format",  "id",      "title", "source", "notes", "robots",
                                                 "framing", "carrier", "air",   "list",   "packet"};
    keys_.only(table_, "", kKeys);
    static constexpr std::string_view kFormat[] = {kRadioFileFormat};
    if (table_.get("format") == nullptr)
      keys_.missing(table_, "", "format", fmt::format("\"{}\"", kRadioFileFormat));
    keys_.word(table_, "", "format", kFormat, 0);
    RadioFormat& format = out_.format;
    format.id = needed("id", "a short name");
    format.title = needed("title", "a line for lists");
    format.source = out_.keep(keys_.text(table_, "", "source").value_or("its own file"));
    format.notes = out_.keep(keys_.text(table_, "", "notes").value_or("None.\n"));
    format.framing = static_cast<Framing>(keys_.word(table_, "", "framing", kFramingWords, 0).value_or(0));
    carrier();
    air();
    list();
    packets();
    if (!problems_.empty()) return;
    format.messages = out_.messages;
    sizes();
    if (!problems_.empty()) return;
    if (format.framing != Framing::kProtobuf) told_apart();
    format.dongle = make_table_dongle;
    robots();
  }

 private:
  std::string_view needed(std::string_view key, const char* allowed) {
    if (table_.get(key) == nullptr) keys_.missing(table_, "", key, allowed);
    return out_.keep(keys_.text(table_, "", key).value_or(""));
  }

  const toml::table* part(std::string_view name) {
    const toml::node* node = table_.get(name);
    if (node == nullptr) return nullptr;
    if (!node->is_table())
      keys_.wrong(*node, std::string(name), fmt::format("is {}", kind_of(*node)),
                  fmt::format("needed: [{}]", name));
    return node->as_table();
  }

  void carrier() {
    const toml::table* t = part("carrier");
    if (t == nullptr) return;
    static constexpr std::string_view kKeys[] = {"kind", "baud", "bits_per_byte"};
    keys_.only(*t, "carrier", kKeys);
    Carrier& carrier = out_.format.carrier;
    carrier.kind =
        static_cast<Carrier::Kind>(keys_.word(*t, "carrier", "kind", kCarrierWords, 0).value_or(0));
    const bool uart = carrier.kind == Carrier::Kind::kUart;
    if (uart && t->get("baud") == nullptr) keys_.missing(*t, "carrier", "baud", "the rate of the line");
    if (!uart && t->get("baud") != nullptr)
      keys_.wrong(*t->get("baud"), "carrier.baud", "is of no meaning here", "allowed: with kind = \"uart\"");
    carrier.baud = static_cast<int>(whole(*t, "carrier", "baud", 50, 100'000'000).value_or(0));
    carrier.bits_per_byte = static_cast<int>(whole(*t, "carrier", "bits_per_byte", 7, 13).value_or(10));
  }

  void air() {
    const toml::table* t = part("air");
    if (t == nullptr) return;
    static constexpr std::string_view kKeys[] = {"to_robot_us", "to_host_us"};
    keys_.only(*t, "air", kKeys);
    const auto time_ns = [&](std::string_view key) {
      const std::string allowed = "allowed: 0 to 1000000 us";
      return std::llround(1e3 * keys_.number(*t, "air", key, 0.0, 1e6, false, allowed).value_or(0.0));
    };
    out_.format.to_robot_ns = time_ns("to_robot_us");
    out_.format.to_host_ns = time_ns("to_host_us");
  }

  void list() {
    const toml::table* t = part("list");
    const bool is_list = out_.format.framing == Framing::kList;
    const bool protobuf = out_.format.framing == Framing::kProtobuf;
    if (t == nullptr) {
      if (is_list) keys_.missing(table_, "", "list", "[list] with begin, end and most");
      if (protobuf) keys_.missing(table_, "", "list", "[list] with most");
      return;
    }
    if (protobuf) {
      static constexpr std::string_view kMost[] = {"most"};
      keys_.only(*t, "list", kMost);
      out_.list.most = static_cast<int>(whole(*t, "list", "most", 1, 255).value_or(1));
      out_.format.list = &out_.list;
      return;
    }
    if (!is_list)
      return keys_.wrong(*t, "list", "is of no meaning here",
                         "allowed: with framing = \"list\" or \"protobuf\"");
    static constexpr std::string_view kKeys[] = {"begin", "end", "most"};
    keys_.only(*t, "list", kKeys);
    const toml::node* begin = t->get("begin");
    const bool bytes =
        begin != nullptr && begin->is_array() &&
        std::all_of(begin->as_array()->begin(), begin->as_array()->end(), [](const toml::node& byte) {
          return byte.is_integer() && *byte.value<std::int64_t>() >= 0 && *byte.value<std::int64_t>() <= 255;
        });
    if (begin == nullptr) return keys_.missing(*t, "list", "begin", "the bytes that begin a frame");
    if (!bytes) return keys_.wrong(*begin, "list.begin", "is no list of bytes", "allowed: [0xAA, 0x55]");
    for (const toml::node& byte : *begin->as_array())
      out_.list_begin.push_back(static_cast<std::uint8_t>(*byte.value<std::int64_t>()));
    if (t->get("end") == nullptr) keys_.missing(*t, "list", "end", "the byte that ends a frame");
    out_.list.end = static_cast<std::uint8_t>(whole(*t, "list", "end", 0, 255).value_or(0));
    out_.list.most = static_cast<int>(whole(*t, "list", "most", 1, 255).value_or(255));
    out_.list.begin = out_.list_begin;
    out_.format.list = &out_.list;
  }

  void packets() {
    const toml::node* node = table_.get("packet");
    if (node == nullptr) return keys_.missing(table_, "", "packet", "at least one [[packet]]");
    if (!node->is_array_of_tables())
      return keys_.wrong(*node, "packet", fmt::format("is {}", kind_of(*node)),
                         "needed: tables that start with [[packet]]");
    PacketReader reader(keys_, out_);
    for (const toml::node& entry : *node->as_array()) reader.read(*entry.as_table());
  }

  std::optional<std::int64_t> whole(const toml::table& t, const std::string& path, std::string_view key,
                                    std::int64_t lo, std::int64_t hi) {
    return whole_number(keys_, t, path, key, lo, hi);
  }

  const toml::node& packet_node(std::size_t m) { return *table_.get("packet")->as_array()->get(m); }

  // The longest frame; packets of a list that go to robots have one length.
  void sizes() {
    RadioFormat& format = out_.format;
    std::size_t longest = 0;
    for (std::size_t m = 0; m < out_.messages.size(); ++m) {
      const auto size = static_cast<std::size_t>(out_.messages[m].size_bytes);
      longest = std::max(longest, size);
      if (format.framing == Framing::kCobsZero && size > kLongestStuffed)
        keys_.wrong(packet_node(m), fmt::format("packet[{}]", m), fmt::format("has {} bytes", size),
                    fmt::format("allowed with framing = \"cobs\": {}", kLongestStuffed));
    }
    if (format.framing == Framing::kProtobuf) return protobuf_sizes();
    for (std::size_t m = 0; m < out_.messages.size(); ++m) {
      if (!out_.messages[m].text_tail) continue;
      const bool alone = format.framing == Framing::kNone && !sums_up(out_.messages[m]);
      if (!alone)
        keys_.wrong(packet_node(m), fmt::format("packet[{}].text", m), "is of no meaning here",
                    "allowed: with framing = \"none\" and without checksum");
      longest = std::max(longest, kLongestPacket);
    }
    std::size_t frame = longest;
    if (format.framing == Framing::kCobsZero) frame += 2;
    if (format.list != nullptr)
      frame = out_.list_begin.size() + 2 + longest * static_cast<std::size_t>(out_.list.most);
    format.max_frame_bytes = static_cast<int>(frame);
  }

  static bool sums_up(const Message& message) {
    return std::ranges::any_of(message.fields, [](const Field& f) { return f.kind == FieldKind::kChecksum; });
  }

  // Each packet's length stands in one byte, and so does that of a frame.
  void protobuf_sizes() {
    int longest = 0;
    for (std::size_t m = 0; m < out_.messages.size(); ++m) {
      const int size = most_protobuf_bytes(out_.messages[m]);
      longest = std::max(longest, size);
      if (size > kLongestProtobuf)
        keys_.wrong(packet_node(m), fmt::format("packet[{}]", m), fmt::format("has up to {} bytes", size),
                    fmt::format("allowed with framing = \"protobuf\": {}", kLongestProtobuf));
      if (out_.messages[m].bit_order != BitOrder::kLsbFirst)
        keys_.wrong(packet_node(m), fmt::format("packet[{}].bit_order", m), "is not that of protobuf",
                    "needed: \"lsb first\"");
    }
    out_.format.max_frame_bytes = protobuf_frame_bytes(longest, out_.list.most);
  }

  // No two packets of one length have the same type.
  void told_apart() {
    for (std::size_t b = 0; b < out_.messages.size(); ++b) {
      for (std::size_t a = 0; a < b; ++a) {
        if (out_.messages[a].name == out_.messages[b].name)
          keys_.wrong(packet_node(b), fmt::format("packet[{}].name", b),
                      fmt::format("{} is there twice", out_.messages[a].name), "needed: a name of its own");
        if (out_.messages[a].size_bytes != out_.messages[b].size_bytes ||
            !same_types(out_.messages[a], out_.messages[b]))
          continue;
        keys_.wrong(packet_node(b), fmt::format("packet[{}]", b),
                    fmt::format("cannot be told from packet {}", out_.messages[a].name),
                    "needed: another length, or a field of kind \"type\" with another content");
      }
    }
  }

  static bool same_types(const Message& a, const Message& b) {
    const auto types = [](const Message& message) {
      std::vector<std::array<std::uint64_t, 3>> rows;
      for (const Field& field : message.fields) {
        if (field.kind != FieldKind::kType) continue;
        rows.push_back({static_cast<std::uint64_t>(field.bit), static_cast<std::uint64_t>(field.bits),
                        required_raw(field, message, 0)});
      }
      return rows;
    };
    return types(a) == types(b);
  }

  void robots() {
    const toml::node* node = table_.get("robots");
    if (node == nullptr) {
      for (std::size_t m = 0; m < out_.messages.size(); ++m) {
        const auto size = static_cast<std::size_t>(out_.messages[m].size_bytes);
        if (size <= kLongestPacket) continue;
        keys_.wrong(packet_node(m), fmt::format("packet[{}]", m), fmt::format("has {} bytes", size),
                    fmt::format("allowed without `robots`: {}", kLongestPacket));
      }
      return;
    }
    const std::string id = keys_.text(table_, "", "robots").value_or("");
    std::vector<std::string_view> known;
    for (const RadioFormat* each : radio_formats()) {
      if (each->own_codec.empty() && each->has_dongle()) known.push_back(each->id);
    }
    const auto like = std::ranges::find(radio_formats(), id, &RadioFormat::id);
    if (like == radio_formats().end() || !(*like)->own_codec.empty() || !(*like)->has_dongle())
      return keys_.wrong(*node, "robots", "is no built-in format with tables alone",
                         spelling_hint(id, known));
    const std::string difference = first_difference(out_.format, **like);
    if (!difference.empty())
      return keys_.wrong(*node, "robots", fmt::format("its packets are others: {}", difference),
                         "without this key the fields' `means` say what they are to a robot");
    out_.format.serves_as = *like;
    out_.format.encode_command = (*like)->encode_command;
    out_.format.command_drives = (*like)->command_drives;
  }

  TomlKeys keys_;
  const toml::table& table_;
  std::vector<ModelProblem>& problems_;
  RadioTables& out_;
};

}  // namespace

RadioFile read_radio_file(std::string_view text, const std::string& file) {
  RadioFile out;
  const std::optional<ModelDocument> document = parse_document(text, file, out.problems);
  if (!document) return out;
  // Never freed: sessions, values and messages point into it.
  static std::deque<std::unique_ptr<RadioTables>> kept;
  auto tables = std::make_unique<RadioTables>();
  FileReader(*document, out.problems, *tables).read();
  std::ranges::stable_sort(out.problems, {}, &ModelProblem::line);
  if (!out.problems.empty()) return out;
  out.format = &kept.emplace_back(std::move(tables))->format;
  return out;
}

RadioFile load_radio_file(const std::filesystem::path& path) {
  std::string error;
  const std::string text = read_text_file(path, error);
  if (error.empty()) return read_radio_file(text, path.string());
  RadioFile out;
  ModelProblem& problem = out.problems.emplace_back();
  problem.file = path.string();
  problem.what = error;
  return out;
}

}  // namespace omnihil

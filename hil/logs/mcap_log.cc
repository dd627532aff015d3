// MCAP. Source: mcap.dev/spec, version 0: magic, then records of opcode (8 bits), length (64 bits) and content; chunks
// hold records, as they are or packed by zstd or lz4 (frames).
#include <fmt/format.h>
#include <lz4frame.h>
#include <zstd.h>

#include <map>
#include <memory>

#include "hil/logs/bag_topics.h"
#include "hil/logs/log_bytes.h"
#include "hil/logs/log_formats.h"
#include "hil/text/text_file.h"

namespace omnihil {
namespace {

// Bytes of one chunk: writers make chunks of a megabyte or so.
constexpr std::uint64_t kMostUnpacked = std::uint64_t{1} << 28;

std::string unpacked_lz4(std::string_view packed, std::size_t size, const std::string& path) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION)) != 0) throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, size_t (*)(LZ4F_dctx*)> context(made, LZ4F_freeDecompressionContext);
  std::string out(size, '\0');
  std::size_t written = 0;
  while (written < size && !packed.empty()) {
    std::size_t room = size - written, taken = packed.size();
    const std::size_t left =
        LZ4F_decompress(context.get(), out.data() + written, &room, packed.data(), &taken, nullptr);
    if (LZ4F_isError(left) != 0 || (room == 0 && taken == 0)) break;
    written += room;
    packed.remove_prefix(taken);
  }
  if (written != size)
    throw BadLog(
        fmt::format("{}: a chunk of lz4 gives {} bytes; allowed: {}, as it says", path, written, size));
  return out;
}

std::string unpacked(std::string_view kind, std::string_view packed, std::uint64_t size,
                     const std::string& path) {
  if (size > kMostUnpacked)
    throw BadLog(fmt::format("{}: a chunk of {} bytes; allowed: up to {}", path, size, kMostUnpacked));
  if (kind == "lz4") return unpacked_lz4(packed, size, path);
  if (kind != "zstd")
    throw BadLog(fmt::format("{}: a chunk is packed by \"{}\"; allowed: zstd, lz4, or as it is", path, kind));
  std::string out(size, '\0');
  const std::size_t written = ZSTD_decompress(out.data(), out.size(), packed.data(), packed.size());
  if (ZSTD_isError(written) != 0 || written != size)
    throw BadLog(fmt::format("{}: a chunk of zstd cannot be unpacked: {}", path,
                             ZSTD_isError(written) != 0 ? ZSTD_getErrorName(written) : "other length"));
  return out;
}

class McapReader {
 public:
  explicit McapReader(const std::string& path) : path_(path), topics_(path) {}

  // False: the file ends within a record.
  bool read_records(std::string_view bytes, std::size_t origin, int depth) {
    LogBytes in(bytes, path_, origin);
    while (in.left() >= 9) {
      const auto op = in.number<std::uint8_t>();
      const auto size = in.number<std::uint64_t>();
      if (in.left() < size) return false;
      const std::string_view content = in.text(size);
      if (op == kDataEnd || op == kFooter) return true;  // what follows repeats what was there
      read_record(op, content, origin + in.at() - size, depth);
    }
    return in.at_end();
  }
  LogTable table() const { return topics_.table(LogFormat::kMcap); }

 private:
  enum Opcode : std::uint8_t {
    kFooter = 2,
    kSchema = 3,
    kChannel = 4,
    kMessage = 5,
    kChunk = 6,
    kDataEnd = 15
  };

  void read_record(std::uint8_t op, std::string_view content, std::size_t origin, int depth) {
    LogBytes in(content, path_, origin);
    if (op == kSchema) {
      const auto id = in.number<std::uint16_t>();
      const std::string name(in.text32()), encoding(in.text32());
      schemas_[id] = {name, encoding, std::string(in.text32())};
    } else if (op == kChannel) {
      const auto id = in.number<std::uint16_t>(), schema = in.number<std::uint16_t>();
      const std::string topic(in.text32()), encoding(in.text32());
      const Schema& s = schemas_[schema];
      // Another language for definitions than ROS's own is as good as none.
      const bool foreign = encoding == "cdr" && s.encoding != "ros2msg";
      topics_.define(id, topic, foreign ? "cdr with definitions in " + s.encoding : encoding, s.name, s.text);
    } else if (op == kMessage) {
      const auto channel = in.number<std::uint16_t>();
      in.skip(4);  // sequence
      const auto log_time = static_cast<std::int64_t>(in.number<std::uint64_t>());
      in.skip(8);  // publish time
      topics_.add(channel, log_time, in.text(in.left()));
    } else if (op == kChunk && depth == 0) {
      in.skip(16);  // first and last time
      const auto size = in.number<std::uint64_t>();
      in.skip(4);  // checksum
      const std::string_view kind = in.text32();
      const std::string_view packed = in.text(in.number<std::uint64_t>());
      if (kind.empty()) {
        read_records(packed, origin, depth + 1);
      } else {
        read_records(unpacked(kind, packed, size, path_), 0, depth + 1);
      }
    }
  }

  struct Schema {
    std::string name, encoding, text;
  };
  std::string path_;
  std::map<std::uint16_t, Schema> schemas_;
  BagTopics topics_;
};

}  // namespace

LogTable read_mcap_log(const std::string& path) {
  std::string error;
  const std::string bytes = read_text_file(path, error);
  if (!error.empty()) throw BadLog(path + ": " + error);
  constexpr std::size_t kMagic = 8;
  McapReader reader(path);
  const bool whole = reader.read_records(std::string_view(bytes).substr(kMagic), kMagic, 0);
  LogTable log = reader.table();
  if (!whole) log.notes.push_back(path + ": ends within a record, which is left out");
  return log;
}

}  // namespace omnihil

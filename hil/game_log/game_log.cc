#include "hil/game_log/game_log.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

namespace omnihil {
namespace {

constexpr std::string_view kMagic = "SSL_LOG_FILE";
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kMostMessage = 1'000'000;  // messages come by UDP: below 65 536 bytes
constexpr const char* kCut = "the log is cut or damaged here: the rest is left out";

std::uint64_t big_endian(const unsigned char* bytes, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = value << 8 | bytes[i];
  return value;
}

std::unique_ptr<gzFile_s, int (*)(gzFile_s*)> opened_log(const std::filesystem::path& path) {
  errno = 0;
  std::unique_ptr<gzFile_s, int (*)(gzFile_s*)> file(::gzopen(path.c_str(), "rb"), &::gzclose);
  if (file != nullptr) ::gzbuffer(file.get(), 1 << 17);
  return file;
}

}  // namespace

bool is_game_log(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path)) return false;
  const auto file = opened_log(path);
  std::array<char, kMagic.size()> begin{};
  return file != nullptr &&
         ::gzread(file.get(), begin.data(), begin.size()) == static_cast<int>(begin.size()) &&
         std::string_view(begin.data(), begin.size()) == kMagic;
}

GameLogReader::GameLogReader(const std::filesystem::path& path)
    : file_(opened_log(path)), notes_(path.string(), "record ") {
  if (file_ == nullptr) throw std::system_error(errno, std::generic_category(), path.string());
  std::array<unsigned char, kMagic.size() + 4> head{};
  if (!read(head.data(), head.size()) || !std::equal(kMagic.begin(), kMagic.end(), head.begin()))
    throw BadCapture(path.string() +
                     ": found no SSL_LOG_FILE at its beginning, allowed: a game log, packed by gzip or not");
  const std::uint64_t version = big_endian(head.data() + kMagic.size(), 4);
  if (version != kVersion)
    throw BadCapture(path.string() + ": version: found " + std::to_string(version) + ", allowed: 1");
}

bool GameLogReader::next(GameLogRecord& record) {
  std::array<unsigned char, 16> head{};
  const int got = ::gzread(file_.get(), head.data(), head.size());
  int fault = Z_OK;
  ::gzerror(file_.get(), &fault);
  if (got == 0 && fault == Z_OK) return false;
  ++records_;
  if (got != static_cast<int>(head.size())) {
    notes_.count(kCut, records_);
    return false;
  }
  record.received_ns = static_cast<std::int64_t>(big_endian(head.data(), 8));
  record.kind = static_cast<GameLogKind>(static_cast<std::int32_t>(big_endian(head.data() + 8, 4)));
  if (record.kind == GameLogKind::kIndex2021) return false;  // is the last
  const std::uint64_t length = big_endian(head.data() + 12, 4);
  if (length > kMostMessage) {
    notes_.count(fmt::format("length: found {}, allowed: 0 to {}; the rest is left out",
                             static_cast<std::int32_t>(length), kMostMessage),
                 records_);
    return false;
  }
  record.bytes.resize(length);
  if (read(record.bytes.data(), length)) return true;
  notes_.count(kCut, records_);
  return false;
}

bool GameLogReader::read(void* to, std::size_t count) {
  return count == 0 || ::gzread(file_.get(), to, static_cast<unsigned>(count)) == static_cast<int>(count);
}

}  // namespace omnihil

#include "hil/firmware/card_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "hil/wire/descriptor.h"
#include "hil/wire/wire_url.h"

namespace omnihil {
namespace {
namespace fs = std::filesystem;
// A card of high capacity says its size in these (CSD version 2).
constexpr std::uintmax_t kUnitBytes = 512 * 1024;
constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 35;  // 32 GiB: SDHC's most

std::string reason() { return std::strerror(errno); }

// The file as it lies on the disk, read where the card is read.
mcu::CardImage mapped(const Descriptor& file, std::size_t bytes) {
  void* at = ::mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE, file.get(), 0);
  if (at == MAP_FAILED) return {};
  std::shared_ptr<const void> owner(at, [bytes](const void* p) { ::munmap(const_cast<void*>(p), bytes); });
  return {owner, {static_cast<const std::uint8_t*>(at), bytes}};
}

bool write_all(int fd, const std::uint8_t* bytes, std::size_t count, std::uint64_t at) {
  while (count > 0) {
    const ssize_t done = ::pwrite(fd, bytes, count, static_cast<off_t>(at));
    if (done <= 0) return false;
    bytes += done;
    count -= static_cast<std::size_t>(done);
    at += static_cast<std::uint64_t>(done);
  }
  return true;
}

// Empty: done.
std::string replace_file(const std::string& path, const mcu::CardBlocks& changed) {
  const std::string making = path + fmt::format(".{}", ::getpid());
  std::error_code error;
  fs::copy_file(path, making, fs::copy_options::overwrite_existing, error);
  bool done = !error;
  std::string why = error ? error.message() : "";
  if (done) {
    const Descriptor file(::open(making.c_str(), O_WRONLY | O_CLOEXEC));
    done = static_cast<bool>(file);
    for (auto at = changed.begin(); done && at != changed.end(); ++at)
      done = write_all(file.get(), at->second.data(), at->second.size(),
                       std::uint64_t{at->first} * mcu::kCardBlockBytes);
    done = done && ::fsync(file.get()) == 0 && ::rename(making.c_str(), path.c_str()) == 0;
    if (!done) why = reason();
  }
  if (!done) fs::remove(making, error);
  return done ? "" : fmt::format("{}: the card's changes are not saved: {}", path, why);
}
}  // namespace

mcu::CardImage CardFiles::open(const mcu::DeviceEntry& entry, int board) {
  const std::string named =
      with_number(with_number(entry.image, "{id}", robot_id_), "{board}", static_cast<std::uint32_t>(board));
  const std::string path = (fs::path(board_file_).parent_path() / named).lexically_normal().string();
  const auto fail = [&](const std::string& what) {
    throw std::invalid_argument(
        fmt::format("{}: device {}: image = '{}' {}", board_file_, entry.name, named, what));
  };
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file) fail(fmt::format("cannot be read: {}", reason()));
  struct stat is {};
  if (::fstat(file.get(), &is) != 0 || !S_ISREG(is.st_mode)) fail("is no regular file");
  const auto bytes = static_cast<std::uintmax_t>(is.st_size);
  if (bytes == 0 || bytes % kUnitBytes != 0 || bytes > kMostBytes)
    fail(fmt::format("has {} bytes; allowed: a multiple of 512 KiB, up to 32 GiB", bytes));
  const mcu::CardImage image = mapped(file, bytes);
  if (image.bytes.empty()) fail(fmt::format("cannot be mapped: {}", reason()));
  if (entry.writable && writers_ != nullptr) {
    if (::access(path.c_str(), W_OK) != 0) fail(fmt::format("cannot be written: {}", reason()));
    const std::pair<std::uint32_t, int> mine{robot_id_, board};
    if (writers_->emplace(path, mine).first->second != mine)
      fail(
          "is written by another board; allowed: a file of its own for each, {id} is the robot's number, "
          "{board} the board's");
    writable_.push_back({path, entry.name, board});
  }
  return image;
}

std::vector<std::string> CardFiles::save(const mcu::McuFirmware& firmware) const {
  std::vector<std::string> problems;
  for (const Open& card : writable_) {
    const mcu::Device* device = firmware.board(card.board).device(card.device);
    const mcu::CardBlocks* changed = device != nullptr ? device->changed_blocks() : nullptr;
    if (changed == nullptr || changed->empty()) continue;
    if (std::string problem = replace_file(card.path, *changed); !problem.empty())
      problems.push_back(std::move(problem));
  }
  return problems;
}

}  // namespace omnihil

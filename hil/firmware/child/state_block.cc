#include "hil/firmware/child/state_block.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <new>

namespace omnihil {
namespace {

constexpr std::uint8_t kFill = 0xA5;
constexpr std::size_t kAlignment = 16;
constexpr std::size_t kWallPages = 16;  // 64 kB: an index far out hits it, too

std::size_t page_bytes() { return static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)); }

bool filled(const std::uint8_t* from, const std::uint8_t* to) {
  return std::all_of(from, to, [](std::uint8_t byte) { return byte == kFill; });
}

}  // namespace

StateBlock::StateBlock(std::size_t bytes) : bytes_(bytes) {
  const std::size_t page = page_bytes(), wall = kWallPages * page;
  const std::size_t aligned = (bytes + kAlignment - 1) / kAlignment * kAlignment;
  const std::size_t inside = (aligned + page - 1) / page * page;
  map_bytes_ = inside + 2 * wall;
  void* map = ::mmap(nullptr, map_bytes_, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (map == MAP_FAILED) throw std::bad_alloc();
  map_ = static_cast<std::uint8_t*>(map);
  if (::mprotect(map_ + wall, inside, PROT_READ | PROT_WRITE) != 0) throw std::bad_alloc();
  std::memset(map_ + wall, kFill, inside);
  state_ = map_ + wall + inside - aligned;
  std::memset(state_, 0, bytes_);
}

StateBlock::~StateBlock() { ::munmap(map_, map_bytes_); }

bool StateBlock::intact() const {
  const std::size_t wall = kWallPages * page_bytes();
  return filled(map_ + wall, state_) && filled(state_ + bytes_, map_ + map_bytes_ - wall);
}

std::optional<std::int64_t> StateBlock::offset_of(const void* address) const {
  const auto* at = static_cast<const std::uint8_t*>(address);
  if (at < map_ || at >= map_ + map_bytes_) return std::nullopt;
  return at - state_;
}

}  // namespace omnihil

#include "hil/firmware/child/own_memory.h"

#include <dlfcn.h>
#include <link.h>
#include <sys/uio.h>
#include <unistd.h>

#include <cstring>

#include "firmware_iface/firmware_memory.h"

namespace omnihil {
namespace {

constexpr std::uint64_t kMost = 60'000;  // of an answer: what a datagram of the wire holds

// Where it is in this process; null: outside of the state block.
std::uint8_t* place_of(const MemoryPiece& piece, void* library, StateBlock* block) {
  if (piece.space == MemorySpace::kState) {
    const bool inside =
        block != nullptr && piece.address <= block->bytes() && piece.bytes <= block->bytes() - piece.address;
    return inside ? static_cast<std::uint8_t*>(block->data()) + piece.address : nullptr;
  }
  const link_map* map = nullptr;
  if (::dlinfo(library, RTLD_DI_LINKMAP, &map) != 0 || map == nullptr) return nullptr;
  return reinterpret_cast<std::uint8_t*>(map->l_addr + piece.address);
}

// By the kernel, which says no where a plain access would be a crash.
bool copy(void* to, const void* from, std::size_t bytes) {
  const iovec local{to, bytes}, remote{const_cast<void*>(from), bytes};
  return ::process_vm_readv(::getpid(), &local, 1, &remote, 1, 0) == static_cast<ssize_t>(bytes);
}

bool put(void* to, const void* from, std::size_t bytes) {
  const iovec local{const_cast<void*>(from), bytes}, remote{to, bytes};
  return ::process_vm_writev(::getpid(), &local, 1, &remote, 1, 0) == static_cast<ssize_t>(bytes);
}

}  // namespace

std::vector<std::uint8_t> peek(std::span<const std::uint8_t> pieces, void* library, StateBlock* block) {
  std::vector<std::uint8_t> answer{1};
  for (; pieces.size() >= sizeof(MemoryPiece); pieces = pieces.subspan(sizeof(MemoryPiece))) {
    MemoryPiece piece;
    std::memcpy(&piece, pieces.data(), sizeof piece);
    const std::uint8_t* from = place_of(piece, library, block);
    const std::size_t at = answer.size();
    if (from == nullptr || piece.bytes > kMost || at + piece.bytes > kMost) return {0};
    answer.resize(at + piece.bytes);
    if (!copy(answer.data() + at, from, piece.bytes)) return {0};
  }
  return answer;
}

std::uint8_t poke(std::span<const std::uint8_t> piece_and_bytes, void* library, StateBlock* block) {
  MemoryPiece piece;
  if (piece_and_bytes.size() < sizeof piece) return 0;
  std::memcpy(&piece, piece_and_bytes.data(), sizeof piece);
  piece_and_bytes = piece_and_bytes.subspan(sizeof piece);
  std::uint8_t* to = place_of(piece, library, block);
  if (to == nullptr || piece.bytes != piece_and_bytes.size()) return 0;
  return put(to, piece_and_bytes.data(), piece.bytes) ? 1 : 0;
}

}  // namespace omnihil

// A firmware's state block with walls around it: whoever writes behind it (or far before it) is caught at
// that instruction, whoever writes into the few bytes between is found after the call.
//
//   StateBlock block(api.state_bytes);
//   api.init(block.data(), &config);
//   if (!block.intact()) …
//   block.offset_of(fault_address);    // how far from the block's begin, if it is near
//
//   [wall page] [filled bytes] [state, 16-byte aligned, ends at the wall but for up to 15 bytes] [wall page]
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>

namespace omnihil {

class StateBlock {
 public:
  explicit StateBlock(std::size_t bytes);  // zeroed; throws std::bad_alloc
  ~StateBlock();
  StateBlock(const StateBlock&) = delete;
  StateBlock& operator=(const StateBlock&) = delete;

  void* data() const { return state_; }
  std::size_t bytes() const { return bytes_; }
  bool intact() const;  // the bytes between state and walls are untouched
  // Of an address within the walls, counted from the state's begin.
  std::optional<std::int64_t> offset_of(const void* address) const;

 private:
  std::uint8_t* map_ = nullptr;
  std::size_t map_bytes_ = 0;
  std::uint8_t* state_ = nullptr;
  std::size_t bytes_ = 0;
};

}  // namespace omnihil

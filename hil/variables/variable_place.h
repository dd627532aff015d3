// A variable, or a part of one, by its name: where it lies and what its bytes mean.
//
//   VariableNames names(info, {.boards = 1});
//   std::string problem;
//   if (const auto place = names.find("wheel[2].integral", problem)) …     // else: why not, with near names
//
// Names: a variable ("ticks", "motor::gain", "tick::calls" of a function's own), then "[2]" and ".member".
// "main.c:state" where several files have one of the name. "ticks@1": on the robot's second board. "block(my_state).x":
// bytes read as a struct. A host library's state block is "state": by itself the struct of the library that has its
// size, "state(my_state)" where several have.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware_iface/firmware_memory.h"
#include "hil/variables/debug_info.h"

namespace omnihil {

struct VariablePlace {
  std::string name;
  MemoryPiece piece;
  int type = -1;
  unsigned bit_offset = 0, bits = 0;   // of a bit-field, from the piece's lowest bit
  std::vector<std::uint8_t> constant;  // its bytes, where it has no place
  bool writable = false;
};

struct VariableSpace {  // what of a firmware the names may mean
  std::uint32_t boards = 1;
  std::uint64_t state_bytes = 0;  // 0: no state block
};

class VariableNames {
 public:
  VariableNames(std::shared_ptr<const DebugInfo> info, VariableSpace space);

  // Whatever the name says, a struct or array included.
  std::optional<VariablePlace> find(std::string_view name, std::string& problem) const;
  // A single value; a struct is a problem that names its members.
  std::optional<VariablePlace> find_value(std::string_view name, std::string& problem) const;
  // All single values of it, in their order, `most` of them.
  std::vector<VariablePlace> values_of(const VariablePlace& place, std::size_t most) const;
  const DebugInfo& info() const { return *info_; }
  // The struct that a library's state block is; empty: it cannot be told.
  std::optional<int> state_type() const;

 private:
  std::optional<VariablePlace> base(std::string_view name, std::string& problem) const;
  std::optional<VariablePlace> state_block(std::string& problem) const;
  bool read_as(std::string_view wanted, VariablePlace& place, std::string& problem) const;
  bool step(std::string_view& rest, VariablePlace& place, std::string& problem) const;
  bool into_member(std::string_view member, VariablePlace& place) const;
  std::vector<std::string> member_names(int type, int depth) const;
  std::string members_text(int type, std::string_view wanted = {}) const;
  std::string unknown(std::string_view name) const;

  std::shared_ptr<const DebugInfo> info_;
  VariableSpace space_;
};

// What a library's table (omnihil_firmware_api) says its state block has, where that stands in the file; 0: it does not.
std::uint64_t state_bytes_of(const DebugInfo& info);

}  // namespace omnihil

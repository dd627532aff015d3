// Memory the core reads, writes and runs from without asking anybody: flash, RAM, core-coupled RAM and their
// aliases.
//
//   Memory memory;
//   memory.add("flash", 0x08000000, 1 << 20, kFlash);
//   memory.alias("flash", 0x00000000);
//
// Each region carries a slot for the decoded form of each of its halfwords, made when code first runs from
// it. Everything that changes bytes goes through here (or through the core's fast path, which calls
// invalidate()).
#pragma once
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <vector>

#include "firmware_iface/mcu/core/op.h"

namespace omnihil::mcu {

enum MemoryKind : std::uint8_t { kFlash, kRam, kDataRam };  // kDataRam: no code can run from it

struct MemoryBlock {
  std::string name;
  MemoryKind kind = kRam;
  std::vector<std::uint8_t> bytes;
  std::uint32_t code_begin = 0, code_size = 0;  // where decoded code lies, as offsets
};

// The decoded code of a region: zeroes at first, which is kUndecoded, in pages that the host gives when they
// are used.
class OpTable {
 public:
  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }
  Op* data() const { return ops_.get(); }
  Op& operator[](std::size_t i) const { return ops_.get()[i]; }
  void make(std::size_t size) {
    ops_.reset(static_cast<Op*>(std::calloc(size, sizeof(Op))));
    if (!ops_) throw std::bad_alloc();
    size_ = size;
  }
  void clear() {
    ops_.reset();
    size_ = 0;
  }

 private:
  struct Free {
    void operator()(Op* ops) const { std::free(ops); }
  };
  std::unique_ptr<Op, Free> ops_;
  std::size_t size_ = 0;
};
static_assert(kUndecoded == 0);

struct MemoryRegion {
  std::uint32_t base = 0, size = 0;
  MemoryBlock* block = nullptr;
  bool is_alias = false;
  OpTable ops;  // empty until code runs from here; two more at the end that lead out

  std::uint8_t* data() const { return block->bytes.data(); }
  bool writable() const { return block->kind != kFlash; }
  bool executable() const { return block->kind != kDataRam; }
};

class Memory {
 public:
  // Filled with 0xFF for flash, 0 otherwise. Sizes are multiples of 4.
  void add(std::string name, std::uint32_t base, std::uint32_t size, MemoryKind kind);
  void alias(const std::string& name, std::uint32_t base);
  // The alias at 0, if there is one, shows the memory at `base` from now on. Not while code runs.
  void map_at_zero(std::uint32_t base);
  MemoryRegion* find(std::uint32_t address);
  const std::vector<std::unique_ptr<MemoryRegion>>& regions() const { return regions_; }

  // Host access, across regions byte by byte; false where no memory is.
  bool read(std::uint32_t address, std::span<std::uint8_t> bytes);
  bool write(std::uint32_t address, std::span<const std::uint8_t> bytes);
  void clear_ram();
  // The bytes [begin, begin + size) of the block have changed: what was decoded from them is forgotten.
  void invalidate(MemoryBlock& block, std::uint32_t begin, std::uint32_t size);
  void forget_code();
  // Goes up whenever code, or flash that it may read constants from, is another than before.
  std::uint64_t code_changes() const { return code_changes_; }

 private:
  std::uint64_t code_changes_ = 0;
  std::vector<std::unique_ptr<MemoryBlock>> blocks_;
  std::vector<std::unique_ptr<MemoryRegion>> regions_;
};

}  // namespace omnihil::mcu

#include "firmware_iface/mcu/core/memory.h"

#include <algorithm>
#include <cassert>
#include <cstring>

namespace omnihil::mcu {
namespace {

// An IT instruction decodes up to four instructions behind it: a change reaches back this far.
constexpr std::uint32_t kReachBack = 18;

}  // namespace

void Memory::add(std::string name, std::uint32_t base, std::uint32_t size, MemoryKind kind) {
  assert(size % 4 == 0 && base % 4 == 0);
  auto block = std::make_unique<MemoryBlock>();
  block->name = std::move(name);
  block->kind = kind;
  block->bytes.assign(size, kind == kFlash ? 0xFF : 0);
  auto region = std::make_unique<MemoryRegion>();
  region->base = base;
  region->size = size;
  region->block = block.get();
  blocks_.push_back(std::move(block));
  regions_.push_back(std::move(region));
}

void Memory::alias(const std::string& name, std::uint32_t base) {
  for (const auto& block : blocks_) {
    if (block->name != name) continue;
    auto region = std::make_unique<MemoryRegion>();
    region->base = base;
    region->size = static_cast<std::uint32_t>(block->bytes.size());
    region->block = block.get();
    region->is_alias = true;
    regions_.push_back(std::move(region));
    return;
  }
  assert(!"alias of a memory that is not there");
}

MemoryRegion* Memory::find(std::uint32_t address) {
  for (const auto& region : regions_) {
    if (address - region->base < region->size) return region.get();
  }
  return nullptr;
}

bool Memory::read(std::uint32_t address, std::span<std::uint8_t> bytes) {
  const MemoryRegion* whole = find(address);
  if (whole && bytes.size() <= whole->size - (address - whole->base)) {  // most are
    std::memcpy(bytes.data(), whole->data() + (address - whole->base), bytes.size());
    return true;
  }
  while (!bytes.empty()) {
    const MemoryRegion* region = find(address);
    if (!region) return false;
    const std::uint32_t at = address - region->base;
    const std::size_t part = std::min<std::size_t>(bytes.size(), region->size - at);
    std::copy_n(region->data() + at, part, bytes.begin());
    bytes = bytes.subspan(part);
    address += static_cast<std::uint32_t>(part);
  }
  return true;
}

bool Memory::write(std::uint32_t address, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const MemoryRegion* region = find(address);
    if (!region) return false;
    const std::uint32_t at = address - region->base;
    const std::size_t part = std::min<std::size_t>(bytes.size(), region->size - at);
    std::copy_n(bytes.begin(), part, region->data() + at);
    if (!region->writable()) ++code_changes_;
    invalidate(*region->block, at, static_cast<std::uint32_t>(part));
    bytes = bytes.subspan(part);
    address += static_cast<std::uint32_t>(part);
  }
  return true;
}

void Memory::map_at_zero(std::uint32_t base) {
  const MemoryRegion* target = find(base);
  if (!target || target->base == 0) return;
  ++code_changes_;
  for (const auto& region : regions_) {
    if (region->base != 0 || !region->is_alias) continue;
    region->block = target->block;
    region->size = target->size;
    region->ops.clear();
  }
}

void Memory::clear_ram() {
  for (const auto& block : blocks_) {
    if (block->kind != kFlash) std::fill(block->bytes.begin(), block->bytes.end(), std::uint8_t{0});
  }
  forget_code();
}

void Memory::invalidate(MemoryBlock& block, std::uint32_t begin, std::uint32_t size) {
  if (begin + size <= block.code_begin || begin >= block.code_begin + block.code_size) return;
  ++code_changes_;
  const std::uint32_t first = (begin - std::min(begin, kReachBack)) / 2, last = (begin + size - 1) / 2;
  for (const auto& region : regions_) {
    if (region->block != &block || region->ops.empty()) continue;
    for (std::uint32_t i = first; i <= last && i < region->size / 2; ++i) {
      region->ops[i].entry = kUndecoded;  // its store may be the one that runs
      region->ops[i].it = 0;
    }
  }
}

void Memory::forget_code() {
  ++code_changes_;
  for (const auto& region : regions_) region->ops.clear();
  for (const auto& block : blocks_) block->code_begin = block->code_size = 0;
}

}  // namespace omnihil::mcu

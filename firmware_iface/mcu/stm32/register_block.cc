#include "firmware_iface/mcu/stm32/register_block.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace omnihil::mcu {
namespace {
std::uint32_t lanes_of(std::uint32_t offset, unsigned bytes) {
  const std::uint32_t all = bytes >= 4 ? 0xFFFFFFFFu : (1u << (8 * bytes)) - 1u;
  return all << (8 * (offset & 3u));
}
}  // namespace

RegisterBlock::RegisterBlock(std::string name, System& system, std::span<const RegisterInfo> registers)
    : Peripheral(std::move(name)), system_(system), registers_(registers) {
  std::size_t last = 0;
  for (const RegisterInfo& r : registers) last = std::max<std::size_t>(last, r.offset);
  // A word for every offset of a block of the usual size: variants of one block look at registers that not
  // all have.
  constexpr std::size_t kUsualBytes = 0x400;
  values_.assign(std::max(last / 4 + 1, kUsualBytes / 4), 0);
  rows_.assign(last / 4 + 1, nullptr);
  for (const RegisterInfo& r : registers) {
    rows_[r.offset / 4u] = &r;
    values_[r.offset / 4u] = r.reset;
  }
}

void RegisterBlock::reset() {
  for (const RegisterInfo& r : registers_) value(r.offset) = r.reset;
}

const RegisterInfo* RegisterBlock::info(std::uint32_t offset) const {
  const std::uint32_t word = offset >> 2;
  return word < rows_.size() ? rows_[word] : nullptr;
}

[[gnu::noinline]] void RegisterBlock::report(std::uint32_t offset, const char* what) {
  system_.report_unmodelled(name(), fmt::format("register at offset 0x{:03X} {}", offset & ~3u, what));
}

[[gnu::noinline]] void RegisterBlock::report_no_effect(const RegisterInfo& r, std::uint32_t bits) {
  system_.report_unmodelled(name(), fmt::format("{}: bits 0x{:08X} have no effect", r.name, bits));
}

std::uint32_t RegisterBlock::read(std::uint32_t offset, unsigned bytes) {
  if (info(offset) == nullptr) [[unlikely]] {
    report(offset, "read");
    return 0;
  }
  const Cycles before = upcoming();
  const std::uint32_t word = load(offset & ~3u);
  if (upcoming() != before) system_.event_moved(next_event_field(), before);
  if (bytes == 4) [[likely]]
    return word;
  return (word & lanes_of(offset, bytes)) >> (8 * (offset & 3u));
}

void RegisterBlock::write(std::uint32_t offset, unsigned bytes, std::uint32_t value) {
  const RegisterInfo* r = info(offset);
  if (r == nullptr || bytes != 4 || (value & r->no_effect) != 0) [[unlikely]] {
    write_checked(offset, bytes, value);
    return;
  }
  const Cycles* field = next_event_field();
  if (field == &kNever) return store(offset, value, 0xFFFFFFFFu);
  const Cycles before = field != nullptr ? *field : next_event();
  store(offset, value, 0xFFFFFFFFu);
  if (upcoming() != before) system_.event_moved(field, before);
}

[[gnu::noinline]] void RegisterBlock::write_checked(std::uint32_t offset, unsigned bytes,
                                                    std::uint32_t value) {
  const RegisterInfo* r = info(offset);
  if (r == nullptr) {
    report(offset, "written");
    return;
  }
  const std::uint32_t lanes = lanes_of(offset, bytes), placed = value << (8 * (offset & 3u)) & lanes;
  if ((placed & r->no_effect & ~this->value(offset)) != 0) report_no_effect(*r, placed & r->no_effect);
  const Cycles before = upcoming();
  store(offset & ~3u, placed, lanes);
  if (upcoming() != before) system_.event_moved(next_event_field(), before);
}

void RegisterBlock::keep(std::uint32_t offset, std::uint32_t value, std::uint32_t lanes) {
  const RegisterInfo* r = info(offset);
  const std::uint32_t mask = lanes & (r != nullptr ? r->writable : 0u);
  this->value(offset) = (this->value(offset) & ~mask) | (value & mask);
}

}  // namespace omnihil::mcu

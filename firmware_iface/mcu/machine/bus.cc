// The machine's bus: what an address reaches that is not plain memory.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "firmware_iface/mcu/machine/machine.h"

namespace omnihil::mcu {
namespace {

constexpr std::uint32_t kSystemControl = 0xE000E000, kDebug = 0xE000EDF0, kSysTickBlock = 0xE000E010;

bool in(std::uint32_t address, std::uint32_t base, std::uint32_t size) { return address - base < size; }
bool is_private(std::uint32_t address) { return in(address, 0xE0000000, 0x100000); }
bool may_be_peripheral(std::uint32_t address) {
  return in(address, 0x40000000, 0x20000000) || in(address, 0x1FFF0000, 0x10000) || is_private(address);
}
std::uint32_t part(std::uint32_t word, std::uint32_t address, unsigned bytes) {
  word >>= 8 * (address & 3);
  return bytes == 4 ? word : word & ((1u << (8 * bytes)) - 1);
}

}  // namespace

inline const Machine::Slot* Machine::slot_at(std::uint32_t address) {
  const Slot* recent = recent_slots_[address >> 10 & 255];  // blocks begin 1 KiB apart, most of them
  return recent != nullptr && in(address, recent->base, recent->size) ? recent : find_slot(address);
}

const Machine::Slot* Machine::find_slot(std::uint32_t address) {
  const auto after =
      std::upper_bound(slots_.begin(), slots_.end(), address,
                       [](std::uint32_t value, const Slot& slot) { return value < slot.base; });
  if (after == slots_.begin()) return nullptr;
  const auto slot = after - 1;
  if (!in(address, slot->base, slot->size)) return nullptr;
  recent_slots_[address >> 10 & 255] = &*slot;
  return &*slot;
}

bool Machine::bit_band(std::uint32_t address, std::uint32_t& target, unsigned& bit) const {
  const bool ram = in(address, 0x22000000, 0x02000000), peripheral = in(address, 0x42000000, 0x02000000);
  const bool has_it = config_.variant.arch != Arch::kV6M && !config_.variant.fpv5;  // M3 and M4 alone
  if (!has_it || (!ram && !peripheral)) return false;
  const std::uint32_t offset = address & 0x01FFFFFF, byte = offset >> 5;
  target = (address & 0xE0000000u) + (byte & ~3u);
  bit = (offset >> 2 & 7) + 8 * (byte & 3);
  return true;
}

bool Machine::read(std::uint32_t address, unsigned bytes, std::uint32_t& value) {
  if (in(address, kSysTickBlock, 16) && cpu_.reg.privileged()) {  // what a wait polls: at once
    const std::uint32_t offset = (address - kSysTickBlock) & ~3u;
    if (cpu_.watching()) was_polled(systick_.stable_until(offset, now()));
    value = part(systick_.read(offset, now()), address, bytes);
    return true;
  }
  const Slot* slot = slot_at(address);
  if (slot == nullptr) return read_elsewhere(address, bytes, value);
  const std::uint32_t offset = address - slot->base;
  if (cpu_.watching()) was_polled(slot->peripheral->stable_until(offset));
  value = slot->peripheral->read(offset, bytes);
  return true;
}

// Of SysTick alone: what waits poll between the events of others. Its reads do nothing while it is steady.
std::int64_t Machine::steady_until(std::uint32_t address, unsigned bytes, std::uint32_t& value) {
  if (!in(address, kSysTickBlock, 16) || !cpu_.reg.privileged()) return 0;
  const std::uint32_t offset = (address - kSysTickBlock) & ~3u;
  const Cycles until = systick_.stable_until(offset, now());
  if (until <= now()) return 0;
  value = part(systick_.read(offset, now()), address, bytes);
  return until == kNever ? INT64_MAX : static_cast<std::int64_t>(until) * kSubcycles;
}

// By the loop that is being watched, what it read being steady until then.
void Machine::was_polled(Cycles steady_until) {
  if (steady_until <= now()) return cpu_.spoil_fast_forward();
  if (steady_until != kNever) cpu_.limit_fast_forward(static_cast<std::int64_t>(steady_until) * kSubcycles);
}

bool Machine::read_elsewhere(std::uint32_t address, unsigned bytes, std::uint32_t& value) {
  std::uint32_t target = 0;
  unsigned bit = 0;
  if (bit_band(address, target, bit)) {
    std::uint32_t word = 0;
    std::uint8_t raw[4];
    if (memory_.read(target, raw)) {
      word = raw[bit / 8] >> (bit & 7);
    } else {
      if (!read(target, 4, word)) return false;
      word >>= bit;
    }
    value = word & 1;
    return true;
  }
  cpu_.spoil_fast_forward();
  return read_unknown(address, bytes, value);
}

bool Machine::report_unknown(std::uint32_t address, const char* done) {
  const auto [name, base] =
      config_.block_name ? config_.block_name(address) : std::pair(std::string_view{}, 0u);
  if (name.empty() && !may_be_peripheral(address)) return false;
  const std::uint32_t word = address & ~3u;
  report_unmodelled(name.empty() ? "bus" : name,
                    name.empty() ? fmt::format("0x{:08x} {}", word, done)
                                 : fmt::format("0x{:08x} (offset 0x{:02x}) {}", word, word - base, done));
  return true;
}

bool Machine::read_unknown(std::uint32_t address, unsigned bytes, std::uint32_t& value) {
  if (is_private(address)) {
    if (!cpu_.reg.privileged()) return false;
    const std::uint32_t word_address = address & ~3u;
    const bool system = in(address, kSystemControl, 0x1000) && !in(address, kDebug, 16);
    value =
        part(system ? read_system(word_address - kSystemControl) : read_debug(word_address), address, bytes);
    return true;
  }
  if (!report_unknown(address, "read")) return false;
  const auto stored = unknown_.find(address & ~3u);
  value = stored == unknown_.end() ? 0 : part(stored->second, address, bytes);
  return true;
}

bool Machine::write(std::uint32_t address, unsigned bytes, std::uint32_t value) {
  const Slot* slot = slot_at(address);
  if (slot == nullptr) return write_elsewhere(address, bytes, value);
  slot->peripheral->write(address - slot->base, bytes, value);
  return true;
}

bool Machine::write_elsewhere(std::uint32_t address, unsigned bytes, std::uint32_t value) {
  std::uint32_t target = 0;
  unsigned bit = 0;
  if (bit_band(address, target, bit)) {
    const std::uint32_t mask = 1u << bit, set = (value & 1) << bit;
    std::uint8_t raw;
    if (memory_.read(target + bit / 8, {&raw, 1})) {
      raw = static_cast<std::uint8_t>((raw & ~(1u << (bit & 7))) | (value & 1) << (bit & 7));
      return memory_.write(target + bit / 8, {&raw, 1});
    }
    std::uint32_t word = 0;
    return read(target, 4, word) && write(target, 4, (word & ~mask) | set);
  }
  return write_unknown(address, bytes, value);
}

bool Machine::write_unknown(std::uint32_t address, unsigned bytes, std::uint32_t value) {
  if (memory_.find(address)) {  // flash; an alias at 0 was a null pointer's, and told so
    if (flash_writes_ && address >= 4096) {
      flash_writes_->flash_write(address, bytes, value);
    } else if (address >= 4096) {
      report_unmodelled("flash", fmt::format("store to 0x{:08x} without a flash controller", address));
    }
    return true;
  }
  if (is_private(address)) {
    if (!cpu_.reg.privileged()) return false;
    if (in(address, kSystemControl, 0x1000) && !in(address, kDebug, 16)) {
      if (!write_system(address - kSystemControl, bytes, value)) {
        report_unmodelled("system control", fmt::format("0x{:08x} written", address));
      }
    } else if (!write_trace(address, bytes, value)) {
      write_debug(address, value);
    }
    return true;
  }
  if (!report_unknown(address, "written")) return false;
  std::uint32_t& word = unknown_[address & ~3u];
  const unsigned shift = 8 * (address & 3);
  const std::uint32_t mask = (bytes == 4 ? ~0u : (1u << (8 * bytes)) - 1) << shift;
  word = (word & ~mask) | (value << shift & mask);
  return true;
}

bool Machine::peek_word(std::uint32_t address, std::uint32_t& word) {
  if (const Slot* slot = slot_at(address)) {
    word = slot->peripheral->peek(address - slot->base);
  } else if (in(address, kSysTickBlock, 16)) {
    SysTick copy = systick_;  // reading clears COUNTFLAG
    word = copy.read(address - kSysTickBlock, now());
  } else if (is_private(address)) {
    const auto told = report_.unmodelled;  // a debugger's look is no use of the image
    const bool system = in(address, kSystemControl, 0x1000) && !in(address, kDebug, 16);
    const auto index = unmodelled_index_;
    word = system ? read_system(address - kSystemControl) : read_debug(address);
    report_.unmodelled = told;
    unmodelled_index_ = index;
  } else {
    const auto stored = unknown_.find(address);
    word = stored == unknown_.end() ? 0 : stored->second;
    return stored != unknown_.end() || may_be_peripheral(address);
  }
  return true;
}

bool Machine::peek(std::uint32_t address, std::span<std::uint8_t> bytes) {
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const std::uint32_t at = address + static_cast<std::uint32_t>(i);
    if (memory_.read(at, bytes.subspan(i, 1))) continue;
    std::uint32_t word = 0;
    if (!peek_word(at & ~3u, word)) return false;
    bytes[i] = static_cast<std::uint8_t>(word >> 8 * (at & 3));
  }
  return true;
}

bool Machine::poke(std::uint32_t address, std::span<const std::uint8_t> bytes) {
  if (memory_.write(address, bytes)) return true;
  while (!bytes.empty()) {
    const unsigned whole = address % 4 == 0 && bytes.size() >= 4   ? 4
                           : address % 2 == 0 && bytes.size() >= 2 ? 2
                                                                   : 1;
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data(), whole);
    const bool there = is_private(address) || slot_at(address) != nullptr || may_be_peripheral(address);
    if (!there || !write(address, whole, value)) return false;
    address += whole;
    bytes = bytes.subspan(whole);
  }
  return true;
}

bool Machine::read_word(std::uint32_t address, std::uint32_t& value) {
  std::uint8_t raw[4];
  if (!memory_.read(address, raw)) return false;
  std::memcpy(&value, raw, 4);
  return true;
}

bool Machine::write_words(std::uint32_t address, std::span<const std::uint32_t> words) {
  const MemoryRegion* region = memory_.find(address);
  if (region && region->writable() && words.size_bytes() <= region->base + region->size - address) {
    return memory_.write(address, {reinterpret_cast<const std::uint8_t*>(words.data()), words.size_bytes()});
  }
  for (const std::uint32_t word : words) {
    region = memory_.find(address);
    if (!region || !region->writable()) return false;
    std::uint8_t raw[4];
    std::memcpy(raw, &word, 4);
    if (!memory_.write(address, raw)) return false;
    address += 4;
  }
  return true;
}

std::uint32_t Machine::bus_read(std::uint32_t address, unsigned bytes) {
  std::uint32_t value = 0;
  const Slot* slot = recent_slots_[address >> 10 & 255];  // no memory is where a block is
  if (slot != nullptr && in(address, slot->base, slot->size)) {
    read(address, bytes, value);
    return value;
  }
  const MemoryRegion* region = memory_.find(address);
  std::uint8_t raw[4] = {};
  if (region != nullptr && memory_.read(address, {raw, bytes})) {
    std::memcpy(&value, raw, 4);
  } else if (is_private(address) || !read(address, bytes, value)) {
    report_unmodelled("bus", fmt::format("0x{:08x} read by DMA: nothing is there", address));
  }
  return value;
}

void Machine::bus_write(std::uint32_t address, unsigned bytes, std::uint32_t value) {
  const MemoryRegion* region = memory_.find(address);
  if (region && region->writable()) {
    std::uint8_t raw[4];
    std::memcpy(raw, &value, 4);
    cpu_.spoil_fast_forward();
    const std::uint32_t at = address - region->base;
    if (bytes > region->size - at) {
      memory_.write(address, {raw, bytes});
    } else {  // most are
      std::memcpy(region->data() + at, raw, bytes);
      memory_.invalidate(*region->block, at, bytes);
    }
  } else if (is_private(address) || region || !write(address, bytes, value)) {
    report_unmodelled("bus", fmt::format("0x{:08x} written by DMA: nothing is there", address));
  }
}

void Machine::program_flash(std::uint32_t address, std::span<const std::uint8_t> bytes) {
  cpu_.spoil_fast_forward();
  memory_.write(address, bytes);
}

}  // namespace omnihil::mcu

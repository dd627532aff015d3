// A machine without a core: time that a test sets, registers that it pokes, events run in order.
//
//   FakeSystem system;
//   ChipContext context(system);
//   Timer timer(…, context);
//   system.attach(0x40010000, 0x400, timer);
//   system.run_for(168);                       // events of everything attached, in time
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/peripheral.h"

namespace omnihil::mcu {

class FakeSystem final : public System {
 public:
  Cycles now() const override { return now_; }
  std::int64_t to_ns(Cycles at) const override {
    return base_ns_ + static_cast<std::int64_t>(
                          std::llround((static_cast<double>(at) - static_cast<double>(base_)) * 1e9 / hz_));
  }
  Cycles from_ns(std::int64_t at_ns) const override {
    if (at_ns <= base_ns_) return base_;
    return base_ + static_cast<Cycles>(std::ceil(static_cast<double>(at_ns - base_ns_) * hz_ / 1e9 - 1e-6));
  }
  double core_hz() const override { return hz_; }
  void set_core_hz(double hz) override {
    base_ns_ = to_ns(now_);
    base_ = now_;
    hz_ = hz;
    for (auto& at : blocks_) at.block->clock_changed();
  }
  void set_irq(int irq, bool high) override {
    if (high && !irq_high[irq]) ++irq_rises[irq];
    irq_high[irq] = high;
  }
  void reschedule() override {}
  void request_reset(std::string_view by) override { resets.emplace_back(by); }
  std::string_view reset_cause() const override { return cause; }
  void map_at_zero(std::uint32_t base) override { at_zero = base; }
  void program_flash(std::uint32_t address, std::span<const std::uint8_t> bytes) override {
    for (std::size_t i = 0; i < bytes.size(); ++i) memory[address + static_cast<std::uint32_t>(i)] = bytes[i];
  }
  std::uint32_t bus_read(std::uint32_t address, unsigned bytes) override {
    if (Block* b = find(address)) return b->block->read(address - b->base, bytes);
    std::uint32_t v = 0;
    for (unsigned i = 0; i < bytes; ++i) v |= static_cast<std::uint32_t>(memory[address + i]) << (8 * i);
    return v;
  }
  void bus_write(std::uint32_t address, unsigned bytes, std::uint32_t value) override {
    if (Block* b = find(address)) return b->block->write(address - b->base, bytes, value);
    for (unsigned i = 0; i < bytes; ++i) memory[address + i] = static_cast<std::uint8_t>(value >> (8 * i));
  }
  void report_unmodelled(std::string_view peripheral, std::string_view what) override {
    ++unmodelled[std::string(peripheral) + ": " + std::string(what)];
  }

  void attach(std::uint32_t base, std::uint32_t size, Peripheral& block) {
    blocks_.push_back({base, size, &block});
  }
  std::uint32_t read(std::uint32_t address) { return bus_read(address, 4); }
  void write(std::uint32_t address, std::uint32_t value) { bus_write(address, 4, value); }
  void run_until(Cycles end) {
    for (;;) {
      Cycles next = kNever;
      for (const auto& at : blocks_) next = std::min(next, at.block->next_event());
      if (next > end) break;
      now_ = std::max(now_, next);
      for (auto& at : blocks_) {
        if (at.block->next_event() <= now_) at.block->run_events();
      }
      ++events;
    }
    now_ = end;
  }
  void run_for(Cycles cycles) { run_until(now_ + cycles); }
  void run_for_ns(std::int64_t ns) { run_until(from_ns(to_ns(now_) + ns)); }

  std::map<int, bool> irq_high;
  std::map<int, int> irq_rises;
  std::map<std::string, int> unmodelled;
  std::vector<std::string> resets;
  std::uint32_t at_zero = 0;  // what was asked to be shown there
  std::string cause = "power-on";
  std::map<std::uint32_t, std::uint8_t> memory;
  std::uint64_t events = 0;

 private:
  struct Block {
    std::uint32_t base, size;
    Peripheral* block;
  };
  Block* find(std::uint32_t address) {
    for (Block& b : blocks_) {
      if (address >= b.base && address - b.base < b.size) return &b;
    }
    return nullptr;
  }
  std::vector<Block> blocks_;
  Cycles now_ = 0, base_ = 0;
  std::int64_t base_ns_ = 0;
  double hz_ = 16e6;
};

}  // namespace omnihil::mcu

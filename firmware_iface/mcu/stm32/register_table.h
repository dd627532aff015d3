// A register table with repeated groups, made at start-up: names live as long as the table.
//
//   static const RegisterTable table = [] {
//     RegisterTable t;
//     t.add(0x00, "ISR");
//     t.add(0x08, "CCR1");
//     return t;
//   }();
#pragma once
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/stm32/register_block.h"

namespace omnihil::mcu {

class RegisterTable {
 public:
  void add(std::uint32_t offset, std::string name, std::uint32_t reset = 0,
           std::uint32_t writable = 0xFFFFFFFFu, std::uint32_t no_effect = 0) {
    names_.push_back(std::move(name));
    rows_.push_back({static_cast<std::uint16_t>(offset), names_.back(), reset, writable, no_effect});
  }
  std::span<const RegisterInfo> rows() const { return rows_; }

  RegisterTable() = default;
  RegisterTable(RegisterTable&&) = default;

 private:
  std::deque<std::string> names_;  // a deque: its elements stay where they are
  std::vector<RegisterInfo> rows_;
};

}  // namespace omnihil::mcu

// What a program writes to a terminal in its own RAM (SEGGER RTT, up-channel 0), read as a debug probe does.
//
//   RttConsole rtt(machine);
//   rtt.pump([&](std::string_view said) { … });     // between two runs of the board
//
// The control block is found by its first 16 bytes, "SEGGER RTT", wherever in RAM the program has put it, and looked for anew
// when it is no longer there (a reset). Its layout: identifier, numbers of up- and down-channels, then 24 bytes a channel: name,
// buffer, size, the program's offset, the reader's, flags. Reading moves the reader's offset, which the program sees: it has room
// again, as with a probe. Cannot: other channels, input.
#pragma once
#include <cstdint>
#include <functional>
#include <string_view>

#include "firmware_iface/mcu/machine/machine.h"

namespace omnihil {

class RttConsole {
 public:
  explicit RttConsole(mcu::Machine& machine) : machine_(machine) {}
  void pump(const std::function<void(std::string_view)>& say);
  bool found() const { return block_ != 0; }

 private:
  bool look_for();
  bool is_there() const;
  std::uint32_t word(std::uint32_t address) const;

  mcu::Machine& machine_;
  std::uint32_t block_ = 0;  // 0: not found
  int pause_ = 0;            // pumps until it is looked for again
};

}  // namespace omnihil

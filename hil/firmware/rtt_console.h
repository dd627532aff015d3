// A terminal in a program's own RAM (SEGGER RTT, up- and down-channel 0), read and written as a debug probe does.
//
//   RttConsole rtt(machine);
//   rtt.pump([&](std::string_view said) { … });     // between two runs of the board
//   if (rtt.room() >= line.size()) rtt.put(line);   // bytes for it to read
//
// The control block is found by its first 16 bytes, "SEGGER RTT", wherever in RAM the program has put it, and looked for anew
// when it is no longer there (a reset). Its layout: identifier, numbers of up- and down-channels, then 24 bytes a channel: name,
// buffer, size, the program's offset, the reader's, flags. Reading moves the reader's offset, which the program sees: it has room
// again, as with a probe; writing moves the writer's of the first channel behind those that go up. Cannot: other channels.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>

#include "firmware_iface/mcu/machine/machine.h"

namespace omnihil {

class RttConsole {
 public:
  explicit RttConsole(mcu::Machine& machine) : machine_(machine) {}
  void pump(const std::function<void(std::string_view)>& say);
  std::size_t room() const;                       // that its down-channel has now; 0 where there is none
  void put(std::span<const std::uint8_t> bytes);  // at most room()
  bool found() const { return block_ != 0; }

 private:
  bool look_for();
  bool is_there() const;
  // A channel's ring; size 0: none, or nothing that could be one.
  struct Ring {
    std::uint32_t channel = 0, buffer = 0, size = 0, written = 0, read = 0;
  };
  Ring ring(std::uint32_t channel) const;
  Ring down() const;
  std::uint32_t word(std::uint32_t address) const;
  void set_word(std::uint32_t address, std::uint32_t value);

  mcu::Machine& machine_;
  std::uint32_t block_ = 0;  // 0: not found
  int pause_ = 0;            // pumps until it is looked for again
};

}  // namespace omnihil

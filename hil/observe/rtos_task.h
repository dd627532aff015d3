// Which task of an RTOS runs: told from the pointer that its kernel keeps, read out of the image's memory.
//
//   RunningTask task(image, machine);
//   if (task.known()) task.name(task.now());      // "control"
//
// FreeRTOS: pxCurrentTCB, where the image has that symbol; the name stands in the task's control block behind two list items,
// priority and stack (its usual layout, without MPU). A name that is not printable is the block's address. Other kernels, and several
// cores, are not known.
#pragma once
#include <cstdint>
#include <string>

#include "firmware_iface/mcu/machine/elf_image.h"
#include "firmware_iface/mcu/machine/machine.h"

namespace omnihil {

class RunningTask {
 public:
  RunningTask(const mcu::ElfImage& image, mcu::Machine& machine);
  bool known() const { return pointer_ != 0; }
  std::uint32_t now() const;  // its block; 0: none runs yet
  std::string name(std::uint32_t task) const;

 private:
  mcu::Machine& machine_;
  std::uint32_t pointer_ = 0;
};

}  // namespace omnihil

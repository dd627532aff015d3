#include "hil/observe/rtos_task.h"

#include <fmt/format.h>

#include <cstring>

namespace omnihil {
namespace {

// tskTaskControlBlock of FreeRTOS 8 to 11: top of stack (4 bytes), two list items of five words, priority, stack, name.
constexpr std::uint32_t kName = 4 + 20 + 20 + 4 + 4;
constexpr std::uint32_t kLongest = 16;  // configMAX_TASK_NAME_LEN as delivered

}  // namespace

RunningTask::RunningTask(const mcu::ElfImage& image, mcu::Machine& machine)
    : machine_(machine), pointer_(image.address_of("pxCurrentTCB").value_or(0)) {}

std::uint32_t RunningTask::now() const {
  std::uint8_t raw[4] = {};
  std::uint32_t task = 0;
  if (pointer_ != 0 && machine_.memory().read(pointer_, raw)) std::memcpy(&task, raw, sizeof task);
  return task;
}

std::string RunningTask::name(std::uint32_t task) const {
  std::string name;
  std::uint8_t byte = 0;
  while (name.size() < kLongest &&
         machine_.memory().read(task + kName + static_cast<std::uint32_t>(name.size()), {&byte, 1}) &&
         byte > ' ' && byte < 127)
    name += static_cast<char>(byte);
  const bool whole = byte == 0 || byte == ' ' || name.size() == kLongest;
  return name.empty() || !whole ? fmt::format("task 0x{:08x}", task) : name;
}

}  // namespace omnihil

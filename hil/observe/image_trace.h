// A trace of what an image does, for Perfetto (ui.perfetto.dev) and chrome://tracing: interrupts with their nesting,
// functions by symbol, stack depth, the control period as it comes.
//
//   auto trace = std::make_shared<ImageTrace>(TraceOptions{.last_s = 0.5});
//   FirmwareChoice choice{.file = "fw.elf", .board = "mine.toml", .observer = trace};
//   …
//   write(trace->text());
//
// Chrome's trace event format: a process per robot, a thread per board, B and E events that nest; counters "stack" (bytes
// below the image's initial stack pointer) and "control period" (us, between two begins of the control timer's interrupt).
// Instants are those of virtual time. With last_s only that much is kept, up to the end. Of an RTOS that is known
// (rtos_task.h) each task is a thread with a stack counter of its own; an interrupt stands in the thread that it interrupts.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hil/observe/trace_observer.h"

namespace omnihil {

class ImageTrace final : public TraceObserver {
 public:
  explicit ImageTrace(TraceOptions options);  // its filter is of functions; interrupts are always there
  ~ImageTrace() override;
  void begins(mcu::McuFirmware& firmware, const mcu::ElfImage& image, std::uint32_t robot_id) override;
  void ends(mcu::McuFirmware& firmware) override;

  std::string text() const override;
  std::size_t events() const override;
  bool dropped() const override;
  void clear() override;

 private:
  class Board;
  TraceOptions options_;
  std::vector<std::unique_ptr<Board>> boards_;
};

}  // namespace omnihil

// A trace of what an image does, for Perfetto (ui.perfetto.dev) and chrome://tracing: interrupts with their nesting,
// functions by symbol, stack depth, the control period as it comes.
//
//   auto trace = std::make_shared<ImageTrace>(ImageTraceOptions{.last_s = 0.5});
//   FirmwareChoice choice{.file = "fw.elf", .board = "mine.toml", .observer = trace};
//   …
//   write(trace->json());
//
// Chrome's trace event format: a process per robot, a thread per board, B and E events that nest; counters "stack" (bytes
// below the image's initial stack pointer) and "control period" (us, between two begins of the control timer's interrupt).
// Instants are those of virtual time. With last_s only that much is kept, up to the end or to freeze(). Cannot: tasks of
// an RTOS as threads of their own.
#pragma once
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hil/firmware/image_observer.h"

namespace omnihil {

struct ImageTraceOptions {
  double last_s = 0.0;      // 0: all
  std::string filter = {};  // functions whose name has this in it; empty: all. Interrupts are always there
  std::size_t most = 5'000'000;  // events; older ones go first
};

class ImageTrace final : public ImageObserver {
 public:
  explicit ImageTrace(ImageTraceOptions options);
  ~ImageTrace() override;
  void begins(mcu::McuFirmware& firmware, const mcu::ElfImage& image, std::uint32_t robot_id) override;
  void ends(mcu::McuFirmware& firmware) override;

  std::string json() const;
  std::size_t events() const;
  void clear();  // what is over; before the next run

 private:
  class Board;
  ImageTraceOptions options_;
  std::vector<std::unique_ptr<Board>> boards_;
};

}  // namespace omnihil

// A trace of what an image's board does outside of its core, as signals over time (VCD): pins, timers' outputs, bridges, encoders,
// buses, interrupts.
//
//   auto trace = std::make_shared<WaveTrace>(TraceOptions{.last_s = 0.5, .filter = "USART2,wheel0"});
//   FirmwareChoice choice{.file = "fw.elf", .board = "mine.toml", .observer = trace};
//   …
//   write(trace->text());                          // for GTKWave, PulseView, sigrok-cli
//
// A module per robot, within it one per board where it has several. Interrupts: IRQ54, SysTick and so on are high from their first
// instruction to their last, those that preempt them included. What a filter leaves out is not worked out. The core runs at its
// usual speed.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "hil/observe/trace_observer.h"
#include "hil/observe/wave_log.h"

namespace omnihil {

class WaveTrace final : public TraceObserver {
 public:
  explicit WaveTrace(TraceOptions options);
  ~WaveTrace() override;
  void begins(mcu::McuFirmware& firmware, const mcu::ElfImage& image, std::uint32_t robot_id) override;
  void ends(mcu::McuFirmware& firmware) override;

  std::string text() const override;
  std::size_t events() const override { return log_.events().size(); }
  bool dropped() const override { return log_.dropped(); }
  void clear() override;

 private:
  class Board;
  WaveLog log_;
  std::vector<std::unique_ptr<Board>> boards_;
};

}  // namespace omnihil

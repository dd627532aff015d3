// What timers make of their pins, and bridges of that: edges, duties.
//
//   PwmWaves waves(board, log, "robot0");          // before it runs; both stay until it has run
//
// TIM1_CH1, TIM1_CH1N: the pin's level edge by edge, dead time of a pair included; high-impedance where it is off. TIM1_CH1_duty:
// the share of the period for which it is high. wheel0_duty: what the motor's bridge gives (-1 to 1), wheel0_driven: else it coasts;
// of three phases wheel0_a to _c. Edges are events of their own for the emulated timer: it has many more of them, and the image
// runs the same.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "firmware_iface/mcu/board/board.h"
#include "firmware_iface/mcu/stm32/timer/timer.h"
#include "hil/observe/wave_log.h"

namespace omnihil {

class PwmWaves {
 public:
  PwmWaves(mcu::McuBoard& board, WaveLog& log, const std::string& scope);
  ~PwmWaves();
  void finish();  // what was under way is over

 private:
  class OfTimer;
  std::vector<std::unique_ptr<OfTimer>> timers_;
};

}  // namespace omnihil

// The encoders of a board's motors: both lines edge by edge, and the count.
//
//   EncoderWaves waves(board, log, "robot0");      // before it runs
//   waves.finish(at_ns);                           // up to the end
//
// wheel0_A, wheel0_B: the quadrature lines that the timer counts, in the order in which it counts upwards (A first), with
// edges at their instants on the shaft as it turns between two looks at the plant (world_state.h). wheel0_counts: the count at
// each look.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "firmware_iface/mcu/board/board.h"
#include "hil/observe/wave_log.h"

namespace omnihil {

class EncoderWaves {
 public:
  EncoderWaves(mcu::McuBoard& board, WaveLog& log, const std::string& scope);
  void finish(std::int64_t at_ns) { draw(at_ns); }

 private:
  struct Encoder {
    int wheel;
    double sign;
    int a, b, counts;
    std::int64_t drawn = 0;
  };
  std::int64_t count(const Encoder& encoder, const mcu::WorldState& world, std::int64_t at_ns) const;
  void show(Encoder& encoder, std::int64_t count, std::int64_t at_ns);
  void draw(std::int64_t to_ns);

  mcu::McuBoard& board_;
  WaveLog& log_;
  std::vector<Encoder> encoders_;
  std::int64_t drawn_ns_ = 0;
};

}  // namespace omnihil

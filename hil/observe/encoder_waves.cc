#include "hil/observe/encoder_waves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace omnihil {

namespace {
// Of one shaft between two looks: 4096 counts at 4,900 turns a second in 0.5 ms. More is no shaft.
constexpr std::int64_t kMostEdges = 10'000;
}  // namespace

EncoderWaves::EncoderWaves(mcu::McuBoard& board, WaveLog& log, const std::string& scope)
    : board_(board), log_(log) {
  for (const mcu::MotorEntry& motor : board.spec().motors) {
    if (motor.encoder_timer.empty() && motor.encoder_pins.empty()) continue;
    const std::string name = fmt::format("wheel{}_", motor.wheel);
    Encoder encoder{motor.wheel, motor.encoder_sign,
                    log.add(scope, name + "A", WaveKind::kLevel, 1, {0, false}, true),
                    log.add(scope, name + "B", WaveKind::kLevel, 1, {0, false}, true),
                    log.add(scope, name + "counts", WaveKind::kInteger, 32, {0, false}, true)};
    if (encoder.a >= 0 || encoder.b >= 0 || encoder.counts >= 0) encoders_.push_back(encoder);
  }
  if (encoders_.empty()) return;
  board.watch_world([this](const mcu::WorldState& next) {
    const std::int64_t at_ns = std::max(board_.now_ns(), drawn_ns_);
    draw(at_ns);
    for (Encoder& encoder : encoders_) {
      const std::int64_t now = count(encoder, next, at_ns);
      show(encoder, now, at_ns);
      log_.put(encoder.counts, at_ns, static_cast<std::uint64_t>(now));
    }
  });
}

// As the board's timer is told.
std::int64_t EncoderWaves::count(const Encoder& encoder, const mcu::WorldState& world,
                                 std::int64_t at_ns) const {
  const std::int64_t counts = world.encoder_counts(encoder.wheel, at_ns);
  return encoder.sign < 0 ? -counts : counts;
}

// Upwards A leads: 00, 10, 11, 01.
void EncoderWaves::show(Encoder& encoder, std::int64_t count, std::int64_t at_ns) {
  encoder.drawn = count;
  const std::int64_t phase = count & 3;
  log_.put(encoder.a, at_ns, phase == 1 || phase == 2 ? 1 : 0);
  log_.put(encoder.b, at_ns, phase == 2 || phase == 3 ? 1 : 0);
}

// The world that has held since the last time, edge by edge: each is where the shaft reaches it.
void EncoderWaves::draw(std::int64_t to_ns) {
  const mcu::WorldState& world = board_.world();
  const std::int64_t from_ns = std::exchange(drawn_ns_, to_ns);
  if (to_ns <= from_ns) return;
  for (Encoder& encoder : encoders_) {
    const std::int64_t begin = encoder.drawn, end = count(encoder, world, to_ns), way = end > begin ? 1 : -1;
    const std::int64_t edges = std::abs(end - begin);
    if (edges == 0 || edges > kMostEdges || (encoder.a < 0 && encoder.b < 0)) continue;
    std::int64_t at_ns = from_ns;
    for (std::int64_t c = begin + way; c != end + way; c += way) {
      // The first instant at which the count is c or beyond, by halving.
      std::int64_t before_ns = at_ns, there_ns = to_ns;
      while (before_ns < there_ns) {
        const std::int64_t middle_ns = before_ns + (there_ns - before_ns) / 2;
        if ((count(encoder, world, middle_ns) - c) * way >= 0) {
          there_ns = middle_ns;
        } else {
          before_ns = middle_ns + 1;
        }
      }
      at_ns = there_ns;
      show(encoder, c, at_ns);
    }
  }
}

}  // namespace omnihil

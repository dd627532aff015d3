#include "firmware_iface/mcu/stm32/math/cordic.h"

#include <algorithm>
#include <cmath>

namespace omnihil::mcu {
namespace {
enum : std::uint16_t { kCsr = 0x00, kWdata = 0x04, kRdata = 0x08 };
constexpr RegisterInfo kRegisters[] = {
    {kCsr, "CSR", 0x50, 0x007F07FF}, {kWdata, "WDATA", 0, 0}, {kRdata, "RDATA", 0, 0}};
constexpr unsigned kIen = 16, kDmaRead = 17, kDmaWrite = 18, kTwoResults = 19, kTwoArguments = 20,
                   kHalfResults = 21, kHalfArguments = 22, kReady = 31;
constexpr double kPi = 3.141592653589793, kOne = 2147483648.0;

// Turns (x, y) by z until z is used up (rotation), or until y is gone (vectoring). Hyperbolic: iterations 4 and 13 twice.
struct Turner {
  bool hyperbolic, vectoring;
  double x, y, z;
  void run(unsigned iterations) {
    double gain = 1.0;
    unsigned shift = hyperbolic ? 1 : 0;
    bool again = false;
    for (unsigned i = 0; i < iterations; ++i) {
      const double step = std::ldexp(1.0, -static_cast<int>(shift));
      const bool up = vectoring ? y < 0.0 : z >= 0.0;
      const double d = up ? step : -step, old_x = x;
      x -= (hyperbolic ? -d : d) * y;
      y += d * old_x;
      z -= (up ? 1.0 : -1.0) * (hyperbolic ? std::atanh(step) : std::atan(step));
      gain *= std::sqrt(hyperbolic ? 1.0 - step * step : 1.0 + step * step);
      again = hyperbolic && (shift == 4 || shift == 13) && !again;
      if (!again) ++shift;
    }
    x /= gain;
    y /= gain;
  }
};

CordicPair circle(unsigned iterations, double turns, double modulus) {
  // Half a turn is taken off where the iterations, which reach 99.9 degrees, do not suffice.
  double half = 1.0;
  if (turns > 0.5) turns -= 1.0, half = -1.0;
  if (turns < -0.5) turns += 1.0, half = -1.0;
  Turner t{false, false, half * modulus, 0.0, turns * kPi};
  t.run(iterations);
  return {t.x, t.y};
}

CordicPair polar(unsigned iterations, double x, double y) {  // turns, modulus
  double half = 0.0;
  if (x < 0.0) {
    half = y >= 0.0 ? 1.0 : -1.0;
    x = -x;
    y = -y;
  }
  Turner t{false, true, x, y, 0.0};
  t.run(iterations);
  return {half + t.z / kPi, t.x};
}

std::int64_t fixed(double value) {
  constexpr double kUnit = 2048.0;  // 2^-20 of one: where the unit's own words end
  const double cut = std::floor(value * kOne / kUnit + 0.5) * kUnit;
  return static_cast<std::int64_t>(std::clamp(cut, -kOne, kOne - 1.0));
}
}  // namespace

CordicPair cordic_function(unsigned function, unsigned scale, unsigned iterations, double first,
                           double second) {
  const double up = std::ldexp(1.0, static_cast<int>(scale)), down = 1.0 / up;
  switch (function) {
    case 0:  // cosine
      return circle(iterations, first, second);
    case 1: {  // sine
      const CordicPair p = circle(iterations, first, second);
      return {p.second, p.first};
    }
    case 2:  // phase
      return polar(iterations, first, second);
    case 3: {  // modulus
      const CordicPair p = polar(iterations, first, second);
      return {p.second, p.first};
    }
    case 4: {  // arctangent
      Turner t{false, true, 1.0, first * up, 0.0};
      t.run(iterations);
      return {t.z / kPi * down, 0.0};
    }
    case 5:    // hyperbolic cosine
    case 6: {  // and sine
      Turner t{true, false, 1.0, 0.0, first * up};
      t.run(iterations);
      return function == 5 ? CordicPair{t.x * down, t.y * down} : CordicPair{t.y * down, t.x * down};
    }
    case 7: {  // its inverse tangent
      Turner t{true, true, 1.0, first * up, 0.0};
      t.run(iterations);
      return {t.z * down, 0.0};
    }
    case 8: {  // natural logarithm: ln x = 2 atanh((x - 1) / (x + 1))
      Turner t{true, true, first * up + 1.0, first * up - 1.0, 0.0};
      t.run(iterations);
      return {t.z * down, 0.0};  // half of it once more: 2^-(n+1) ln x
    }
    case 9: {  // square root: x = (x + 1/4)^2 - (x - 1/4)^2
      Turner t{true, true, first * up + 0.25, first * up - 0.25, 0.0};
      t.run(iterations);
      return {t.x * down, 0.0};
    }
    default:
      return {};
  }
}

Cordic::Cordic(ChipContext& context, int irq)
    : RegisterBlock("CORDIC", context.system, kRegisters),
      context_(context),
      irq_(context.irqs, irq),
      dma_read_(context.dma.line("CORDIC_RD")),
      dma_write_(context.dma.line("CORDIC_WR")) {
  next_event_is(done_);
}

void Cordic::reset() {
  RegisterBlock::reset();
  arguments_ = {0, 0x7FFFFFFF};
  results_ = {};
  written_ = read_ = 0;
  pending_ = ready_ = false;
  done_ = kNever;
  update();
}

void Cordic::begin() {
  const std::uint32_t csr = value(kCsr);
  const unsigned function = field(csr, 0, 4), precision = std::max(1u, field(csr, 4, 4));
  if (function > 9) system().report_unmodelled(name(), "CSR: a function that is reserved");
  const auto number = [](std::uint32_t word) { return static_cast<std::int32_t>(word) / kOne; };
  const CordicPair pair = cordic_function(function, field(csr, 8, 3), 4 * precision, number(arguments_[0]),
                                          number(arguments_[1]));
  results_ = {static_cast<std::uint32_t>(fixed(pair.first)), static_cast<std::uint32_t>(fixed(pair.second))};
  read_ = 0;
  ready_ = pending_ = false;
  const ClockRatio clock = context_.clocks.bus(Bus::kAhb);
  done_ = now() + Cycles{precision} * clock.div / clock.mul;
  update();
}

void Cordic::run_events() {
  if (done_ > now()) return;
  done_ = kNever;
  ready_ = true;
  update();
}

void Cordic::update() {
  const std::uint32_t csr = value(kCsr);
  irq_.set(ready_ && bit(csr, kIen));
  context_.dma.set(dma_read_, ready_ && bit(csr, kDmaRead));
  context_.dma.set(dma_write_, !ready_ && done_ == kNever && bit(csr, kDmaWrite));
}

std::uint32_t Cordic::shown(std::uint32_t offset) {
  const std::uint32_t csr = value(kCsr);
  if (offset == kCsr) return csr | (ready_ ? 1u << kReady : 0u);
  if (offset != kRdata) return 0;
  if (bit(csr, kHalfResults)) return (results_[1] & 0xFFFF0000u) | results_[0] >> 16;
  return results_[read_];
}

std::uint32_t Cordic::load(std::uint32_t offset) {
  if (offset != kRdata) return shown(offset);
  if (done_ != kNever) {  // the bus waits
    done_ = kNever;
    ready_ = true;
  }
  const std::uint32_t data = shown(offset);
  const bool more = bit(value(kCsr), kTwoResults) && !bit(value(kCsr), kHalfResults) && read_ == 0;
  if (more) {
    read_ = 1;
  } else {
    read_ = 0;
    ready_ = false;
    if (pending_) begin();
  }
  update();
  return data;
}

void Cordic::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  if (offset == kCsr) {
    keep(offset, written, lanes);
    return update();
  }
  if (offset != kWdata) return;
  const std::uint32_t csr = value(kCsr);
  if (bit(csr, kHalfArguments)) {
    arguments_ = {written << 16, written & 0xFFFF0000u};
  } else if (bit(csr, kTwoArguments)) {
    arguments_[written_] = written;
    written_ ^= 1u;
    if (written_ != 0) return;
  } else {
    arguments_[0] = written;
  }
  // The next arguments wait until the results are read.
  if (ready_) {
    pending_ = true;
  } else {
    begin();
  }
}

}  // namespace omnihil::mcu

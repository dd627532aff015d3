#include "avr/bridge.h"

namespace omnihil_avr {
namespace {

enum class Way { kNone, kFast, kPhaseCorrect };
struct Mode {
  Way way = Way::kNone;
  unsigned top = 0;
};

bool bit(std::uint8_t value, unsigned n) { return (value >> n & 1u) != 0; }
unsigned word(const std::uint8_t* data, std::uint16_t at) { return data[at] | data[at + 1] << 8; }
bool is_output(const PinAddress& pin, const std::uint8_t* data) { return bit(data[pin.ddr()], pin.bit); }
bool level(const PinAddress& pin, const std::uint8_t* data) { return bit(data[pin.port()], pin.bit); }

// Table 15-8.
Mode mode_of_8(const BridgeWires& w, const std::uint8_t* data) {
  switch ((data[w.tccra] & 3u) | (data[w.tccrb] >> 1 & 4u)) {
    case 1:
      return {Way::kPhaseCorrect, 0xFF};
    case 3:
      return {Way::kFast, 0xFF};
    case 5:
      return {Way::kPhaseCorrect, data[w.ocra]};
    case 7:
      return {Way::kFast, data[w.ocra]};
    default:
      return {};
  }
}

// Table 16-4.
Mode mode_of_16(const BridgeWires& w, const std::uint8_t* data) {
  const unsigned n = (data[w.tccra] & 3u) | (data[w.tccrb] >> 1 & 0xCu);
  switch (n) {
    case 1:
    case 2:
    case 3:
      return {Way::kPhaseCorrect, (0x80u << n) - 1};
    case 5:
    case 6:
    case 7:
      return {Way::kFast, (0x80u << (n - 4)) - 1};
    case 8:
    case 10:
      return {Way::kPhaseCorrect, word(data, w.icr)};
    case 9:
    case 11:
      return {Way::kPhaseCorrect, word(data, w.ocra)};
    case 14:
      return {Way::kFast, word(data, w.icr)};
    case 15:
      return {Way::kFast, word(data, w.ocra)};
    default:
      return {};
  }
}

}  // namespace

BridgeState bridge_state(const BridgeWires& w, const std::uint8_t* data) {
  if (w.has_enable && !(is_output(w.enable, data) && level(w.enable, data))) return {};
  if (!is_output(w.pwm, data)) return {};
  const unsigned com = data[w.tccra] >> w.com_shift & 3u;
  double high = level(w.pwm, data) ? 1.0 : 0.0;
  if (com >= 2) {
    const Mode mode = w.bits == 16 ? mode_of_16(w, data) : mode_of_8(w, data);
    const unsigned ocr = w.bits == 16 ? word(data, w.ocr) : data[w.ocr];
    const bool runs = (data[w.tccrb] & 7u) != 0;
    if (mode.way == Way::kNone || mode.top == 0 || !runs) return {};
    const bool fast = mode.way == Way::kFast;
    high = static_cast<double>(ocr + fast) / static_cast<double>(mode.top + fast);
    high = high > 1.0 ? 1.0 : high;
    if (com == 3) high = 1.0 - high;
  } else if (com == 1) {
    return {};  // toggles: no PWM
  }
  if (w.inverted) high = 1.0 - high;
  if (!w.has_direction) return {true, 2.0 * high - 1.0};
  const bool forward = (is_output(w.direction, data) && level(w.direction, data)) == w.forward_is_high;
  return {true, forward ? high : -high};
}

}  // namespace omnihil_avr

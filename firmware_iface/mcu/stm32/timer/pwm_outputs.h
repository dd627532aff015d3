// What a timer makes of its output pins, for whom they switch.
//
//   outputs.on_output([&](std::int64_t now_ns) { outputs.pin(0, false); });     // duty changes, at their instant
//
// Pins are worked out once and kept while pins_version() stays. Channels from 0; complement: the pin of the lower switch,
// where there is one.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <string_view>
#include <utility>
#include <vector>

namespace omnihil::mcu {

// What a timer makes of one pin.
struct TimerPin {
  enum class Drive : std::uint8_t { kOff, kSteady, kPwm };
  Drive drive = Drive::kOff;  // kOff: high-impedance, or the channel is not enabled
  double high_ratio = 0.0;    // share of the period for which the pin is high
  bool operator==(const TimerPin&) const = default;
};

class PwmOutputs {
 public:
  virtual ~PwmOutputs() = default;
  void on_output(std::function<void(std::int64_t now_ns)> listener) {
    listeners_.push_back(std::move(listener));
  }
  // While this number stays, a pin that is kPwm stays what it is, and any that is said to.
  std::uint32_t pins_version() const { return pins_version_; }
  bool pin_stays(unsigned channel, bool complement) const {  // of one that was asked for since
    return (pins_known_ >> (2 * channel + (complement ? 1 : 0)) & 1u) != 0;
  }
  TimerPin pin(unsigned channel, bool complement) const {
    const unsigned i = 2 * channel + (complement ? 1 : 0);
    return (pins_known_ >> i & 1u) != 0 ? pins_[i] : find_pin(channel, complement);
  }
  // Of a pin that is driven: its level at this instant, as if there were no dead time.
  virtual bool level(unsigned channel, bool complement) const = 0;
  // Brings what level() tells to this instant.
  virtual void look() {}
  virtual unsigned channels() const = 0;
  virtual std::string_view channel_letters() const {
    return {};
  }                                          // that name them; empty: numbers from 1 on do
  virtual unsigned complements() const = 0;  // channels, from 0 on, that have one
  virtual double period_s() const = 0;
  // Control periods that began before the one before them was seen: updates that found their flag still set.
  virtual std::uint64_t updates_lost() const = 0;

 protected:
  static constexpr unsigned kMostChannels = 4;
  // What pin() gives; keeps it in pins_ where it stays.
  virtual TimerPin find_pin(unsigned channel, bool complement) const = 0;
  void forget_pins(std::uint32_t channels = ~0u) {
    for (unsigned c = 0; c < kMostChannels; ++c) {
      if ((channels >> c & 1u) != 0) pins_known_ &= ~(3u << 2 * c);
    }
    ++pins_version_;
  }
  mutable std::array<TimerPin, 2 * kMostChannels> pins_{};  // while they are known: main, complement
  mutable std::uint32_t pins_known_ = 0;
  std::uint32_t pins_version_ = 0;
  std::vector<std::function<void(std::int64_t)>> listeners_;
};

}  // namespace omnihil::mcu

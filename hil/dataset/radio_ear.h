// What a robot tells of itself in the frames that it sends: the way back of hil/loop/radio_front.h.
//
//   RadioEar ear(*find_radio_format("roboteam-rem-v8"), robot_id);
//   ear.hear(frame, now_ns);                            // of its radio_transmit
//   ear.told(now_ns).omega_wheel_rad_s[0];              // the newest that a host has by now; not finite: none
//
// Each frame is decoded by itself, as it is on the air, and is at the host after its format's own time there. Cannot: lose any;
// hear of a dongle that passes on something else than the robot's frames.
#pragma once
#include <cstdint>
#include <deque>
#include <span>

#include "protocols/telemetry.h"

namespace omnihil {

class RadioEar {
 public:
  RadioEar(const RadioFormat& format, int robot_id) : format_(format), robot_id_(robot_id) {}

  // now_ns never falls.
  void hear(std::span<const std::uint8_t> frame, std::int64_t now_ns);
  const TelemetryReading& told(std::int64_t now_ns);

 private:
  struct OnTheWay {
    std::int64_t due_ns;
    TelemetryReading told;
  };

  const RadioFormat& format_;
  int robot_id_;
  std::deque<OnTheWay> on_the_way_;
  TelemetryReading told_;
};

}  // namespace omnihil

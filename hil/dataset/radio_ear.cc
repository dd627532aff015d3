#include "hil/dataset/radio_ear.h"

#include <cmath>

#include "hil/recording/stream_frames.h"

namespace omnihil {

void RadioEar::hear(std::span<const std::uint8_t> frame, std::int64_t now_ns) {
  FrameCutter cutter(format_);  // a frame of the air ends where it ends, its padding with it
  cutter.push(frame);
  cutter.finish();
  while (const auto cut = cutter.next()) {
    if (!cut->understood) continue;
    const auto told = telemetry_of(format_, format_.decode(cut->bytes).values);
    if (told && (told->robot_id < 0 || told->robot_id == robot_id_))
      on_the_way_.push_back({now_ns + format_.to_host_ns, *told});
  }
}

const TelemetryReading& RadioEar::told(std::int64_t now_ns) {
  const auto take = [](double& into, double from) {
    if (std::isfinite(from)) into = from;
  };
  for (; !on_the_way_.empty() && on_the_way_.front().due_ns <= now_ns; on_the_way_.pop_front()) {
    const TelemetryReading& t = on_the_way_.front().told;
    for (std::size_t w = 0; w < kWheels; ++w) {
      take(told_.omega_wheel_rad_s[w], t.omega_wheel_rad_s[w]);
      take(told_.motor_current_A[w], t.motor_current_A[w]);
    }
    take(told_.battery_V, t.battery_V);
    take(told_.yaw_rad, t.yaw_rad);
    take(told_.omega_body_rad_s, t.omega_body_rad_s);
  }
  return told_;
}

}  // namespace omnihil

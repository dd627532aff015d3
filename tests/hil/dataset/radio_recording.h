// A session of one robot that is driven by radio, recorded: what of it is a dataset of commands.
//
//   const Recording recording = radio_recording(one_radio_robot(), make_reference_firmware, 12.0);
#pragma once
#include <string>
#include <vector>

#include "hil/recording/recording_memory.h"
#include "tests/hil/recording/real_run.h"

namespace omnihil {

inline SessionSetup one_radio_robot() {
  return real::setup({"ulaval-hermes", "omni_default", Physics::kPlanar}, {3});
}

// Steps of the body's velocity, a packet every 20 ms.
inline Recording radio_recording(const SessionSetup& setup, const Session::FirmwareMaker& firmware,
                                 double duration_s) {
  const RadioFormat& format = *find_radio_format(setup.radio_format);
  const auto host = [&](int n) -> real::Bytes {
    constexpr double kSteps[][3] = {{0, 0, 0},   {0.8, 0, 0},   {0.8, 0.5, 0},
                                    {0, 0.5, 2}, {-0.6, 0, -2}, {0, 0, 0}};
    if (n % 20 != 0) return {};
    const double* v = kSteps[(n / 700) % 6];
    return real::frame(format, "SPEED_MOVE_ADVANCE",
                       {{"robot", 3}, {"vx", v[0]}, {"vy", v[1]}, {"vtheta", v[2]}});
  };
  return real::record(setup, static_cast<int>(1000.0 * duration_s), 1, firmware, host);
}

}  // namespace omnihil

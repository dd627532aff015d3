// Two robots of roboteam-rem-v8 that are driven for a while, worn or as the model says, and what explains their difference:
// for tests of explanations.
#pragma once
#include <random>

#include "hil/check/explain_candidates.h"
#include "hil/check/explain_difference.h"
#include "tests/hil/recording/real_run.h"

namespace omnihil::driven {

inline const RadioFormat& rem() { return *find_radio_format("roboteam-rem-v8"); }

// Two robots that change speed and direction every 0.6 s, with telemetry asked for.
inline Recording drive(const SessionSetup& setup, int milliseconds) {
  constexpr double kRho_m_s[] = {1.2, 0.4, 1.6, 0.2, 1.4, 0.8},
                   kTheta_rad[] = {0.0, 1.1, -2.0, 2.6, -0.7, 1.8};
  RecordingHeader header = recording_header(setup, "abc1234");
  header.sample_every = 10;
  Session session(session_config(setup), make_reference_firmware);
  RecordingMemory memory(header);
  session.set_observer(&memory);
  std::vector<std::uint8_t> host, out;
  for (int n = 0; n < milliseconds; ++n) {
    host.clear();
    const auto phase = static_cast<std::size_t>(n / 600) % std::size(kRho_m_s);
    for (const int id : setup.robot_ids) {
      if (n % 16 != 0) break;
      const auto turn = (phase + static_cast<std::size_t>(id)) % std::size(kTheta_rad);
      const real::Bytes command = real::frame(rem(), "REM_RobotCommand",
                                              {{"toRobotId", id},
                                               {"toColor", 1},
                                               {"fromPC", 1},
                                               {"sendStateInfo", 1},
                                               {"rho", kRho_m_s[phase]},
                                               {"theta", kTheta_rad[turn]}});
      host.insert(host.end(), command.begin(), command.end());
    }
    session.step(host, out);
  }
  return memory.take(session.now_ns());
}

inline SessionSetup robot() { return real::setup(real::kRem); }

// The planted robot: a constant of its motor's file, by the text that a user would change.
inline SessionSetup with_torque_constant(double factor) {
  SessionSetup setup = robot();
  for (const ExplainCandidate& candidate : explain_candidates(setup.model)) {
    if (candidate.name == "motor.torque_constant_Nm_per_A")
      setup.model = *candidate.model(factor * candidate.value);
  }
  return setup;
}

inline void add_noise(Recording& recording, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto& columns = recording.header.columns;
  for (RecordedChunk& chunk : recording.chunks) {
    for (std::size_t i = 0; i < chunk.sample.size(); ++i) {
      if (columns[i].starts_with("motor_current_A")) chunk.sample[i] += 0.05 * normal(random);
      if (columns[i] == "gyro_z_rad_s") chunk.sample[i] += 0.02 * normal(random);
      if (columns[i].starts_with("accel_")) chunk.sample[i] += 0.3 * normal(random);
    }
  }
}

// As a robot on a field is checked: by the nominal model, with another seed.
inline DifferenceExplained explained(const Recording& recording) {
  ReplayOptions options;
  options.model = robot().model;
  options.seed = 77;
  return explain_difference(recording, rem(), options);
}

}  // namespace omnihil::driven

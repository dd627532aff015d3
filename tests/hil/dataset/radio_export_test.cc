// A recording as a dataset of commands and reported speeds: what was said is in it, and a plain controller explains it.
#include "hil/dataset/radio_export.h"

#include <cmath>
#include <stdexcept>

#include "hil/dataset/dataset_reader.h"
#include "identify/predict/predictor.h"
#include "tests/hil/recording/real_run.h"
#include "tests/identify/dataset_folder.h"

namespace omnihil {
namespace {

SessionSetup one_robot() {
  SessionSetup setup = real::setup({"ulaval-hermes", "omni_default", Physics::kPlanar}, {3});
  return setup;
}
ModelFile model() { return *read_bundle(one_robot().model).model; }

// Steps of the body's velocity, twelve seconds, a packet every 20 ms.
const Recording& driven() {
  static const Recording recording = [] {
    const SessionSetup setup = one_robot();
    RecordingHeader header = recording_header(setup, "abc1234");
    header.sample_every = 1;
    Session session(session_config(setup), make_reference_firmware);
    header.firmware = session.firmware(0).name();
    RecordingMemory memory(header);
    session.set_observer(&memory);
    const RadioFormat& format = *find_radio_format(setup.radio_format);
    std::vector<std::uint8_t> out;
    const double steps[][3] = {{0, 0, 0}, {0.8, 0, 0}, {0.8, 0.5, 0}, {0, 0.5, 2}, {-0.6, 0, -2}, {0, 0, 0}};
    for (int n = 0; n < 12000; ++n) {
      const double* v = steps[(n / 700) % 6];
      session.step(n % 20 == 0 ? real::frame(format, "SPEED_MOVE_ADVANCE",
                                             {{"robot", 3}, {"vx", v[0]}, {"vy", v[1]}, {"vtheta", v[2]}})
                               : std::vector<std::uint8_t>{},
                   out);
    }
    return memory.take(session.now_ns());
  }();
  return recording;
}

TEST(HeardCommands, AreWhatTheHostSentWhenItSentIt) {
  const std::vector<HeardCommand> heard = heard_commands(driven(), *find_radio_format("ulaval-hermes"));
  ASSERT_EQ(heard.size(), 600u);
  EXPECT_EQ(heard[0].robot_id, 3);
  EXPECT_EQ(heard[50].command.mode, static_cast<std::uint32_t>(OMNIHIL_MODE_BODY_VELOCITY));
  EXPECT_NEAR(heard[50].command.v_forward_m_s, 0.8, 1e-6);
  EXPECT_NEAR(1e-9 * static_cast<double>(heard[50].now_ns), 1.0, 0.003);
}

TEST(RadioDataset, APlainControllerExplainsTheReferenceFirmware) {
  const DatasetExport made = make_radio_dataset(
      driven(), model(), heard_commands(driven(), *find_radio_format("ulaval-hermes")), {});
  EXPECT_TRUE(made.notes.empty());
  DatasetFolder folder;
  for (const DatasetFile& file : made.files) folder.write(file.name, file.text);
  const DatasetReading reading = read_dataset(folder.path());
  for (const ModelProblem& p : reading.problems) ADD_FAILURE() << p.text();
  ASSERT_TRUE(reading.dataset);
  const auto predictor = make_predictor(*reading.dataset, *reading.nominal, {});
  const Prediction y = predictor->predict(*reading.nominal, 0);
  for (std::size_t s = 0; s < y.values.size(); ++s) {
    const ComparedSignal& c = predictor->compared(0)[s];
    if (!c.name.starts_with("wheel_speed")) continue;
    double error = 0.0, size = 0.0;
    for (std::size_t k = 0; k < c.measured.size(); ++k) {
      if (!std::isfinite(c.measured[k])) continue;
      error += std::pow(c.measured[k] - y.values[s][k], 2);
      size += std::pow(c.measured[k], 2);
    }
    EXPECT_LT(std::sqrt(error / size), 0.05) << c.name;  // its acceleration feed-forward differs by direction
  }
}

TEST(RadioDataset, WhatItCannotTellIsCountedOrRefused) {
  std::vector<HeardCommand> commands = heard_commands(driven(), *find_radio_format("ulaval-hermes"));
  for (std::size_t n = 0; n < 7; ++n) commands[n].command.flags |= OMNIHIL_COMMAND_YAW_TARGET;
  const DatasetExport made = make_radio_dataset(driven(), model(), commands, {});
  ASSERT_EQ(made.notes.size(), 1u);
  EXPECT_NE(made.notes[0].find("7 commands are left out"), std::string::npos) << made.notes[0];
  for (HeardCommand& c : commands) c.command.flags |= OMNIHIL_COMMAND_FIELD_FRAME;
  EXPECT_THROW(make_radio_dataset(driven(), model(), commands, {}), std::invalid_argument);
}

}  // namespace
}  // namespace omnihil

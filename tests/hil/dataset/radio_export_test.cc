// A recording as a dataset of commands and reported speeds: what was said is in it, and a plain controller explains it.
#include "hil/dataset/radio_export.h"

#include <cmath>
#include <stdexcept>

#include "hil/dataset/dataset_reader.h"
#include "identify/predict/predictor.h"
#include "tests/hil/dataset/radio_recording.h"
#include "tests/identify/dataset_folder.h"

namespace omnihil {
namespace {

ModelFile model() { return *read_bundle(one_radio_robot().model).model; }

const Recording& driven() {
  static const Recording recording = radio_recording(one_radio_robot(), make_reference_firmware, 12.0);
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

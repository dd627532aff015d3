// A robot whose firmware is an image, with a payload that its model does not know: found through the image in the loop; and
// nothing found where nothing is hidden. Wheel speeds alone, of a model of which nothing is uncertain: fewer simulations.
#include <algorithm>
#include <filesystem>
#include <functional>
#include <random>
#include <regex>
#include <sstream>

#include "hil/dataset/radio_export.h"
#include "hil/firmware/image_firmware.h"
#include "identify/select/diagnosis.h"
#include "tests/hil/dataset/radio_recording.h"
#include "tests/identify/dataset_folder.h"

namespace omnihil {
namespace {

const std::string kImage = OMNIHIL_BUILD_DIR "/images/omni_reference_f405.elf";
const std::string kBoard = OMNIHIL_SOURCE_DIR "/boards/omni_reference_f405.toml";
constexpr int kDuration_ms = 3000;
constexpr double kSigma_rad_s = 0.2;  // of the wheel speeds

// Steps of the velocity that nobody has chosen, of each robot others, and stops; a packet for each every 20 ms.
Recording driven(const SessionSetup& setup) {
  RecordingHeader header = recording_header(setup, "abc1234");
  header.sample_every = 5;
  Session session(session_config(setup), image_firmware(kImage, kBoard));
  header.firmware = session.firmware(0).name();
  RecordingMemory memory(header);
  session.set_observer(&memory);
  const RadioFormat& format = *find_radio_format(setup.radio_format);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  std::vector<std::array<double, 3>> v(setup.robot_ids.size());
  std::vector<int> next(setup.robot_ids.size(), 300);
  std::vector<std::uint8_t> host, out;
  for (int n = 0; n < kDuration_ms; ++n) {
    host.clear();
    for (std::size_t i = 0; i < v.size(); ++i) {
      if (n == next[i]) {
        for (std::size_t a = 0; a < 3; ++a) v[i][a] = (a < 2 ? 1.0 : 4.0) * any(random);
        next[i] += 300 + static_cast<int>(150.0 * (1.0 + any(random)));
        if (any(random) > 0.6) v[i].fill(0.0);
      }
      if (n % 20 != static_cast<int>(7 * i)) continue;
      const real::Bytes packet =
          real::frame(format, "SPEED_MOVE_ADVANCE",
                      {{"robot", setup.robot_ids[i]}, {"vx", v[i][0]}, {"vy", v[i][1]}, {"vtheta", v[i][2]}});
      host.insert(host.end(), packet.begin(), packet.end());
    }
    session.step(host, out);
  }
  return memory.take(session.now_ns());
}

// Sensors have noise.
std::string with_noise(const std::string& csv, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, kSigma_rad_s);
  std::vector<std::string> columns;
  std::string out, line, cell;
  std::istringstream lines(csv);
  for (bool head = true; std::getline(lines, line); head = false) {
    std::istringstream cells(line + ",");
    for (std::size_t c = 0; std::getline(cells, cell, ','); ++c) {
      if (head) columns.push_back(cell);
      if (!head && !cell.empty() && columns[c].starts_with("wheel_"))
        cell = std::to_string(std::stod(cell) + noise(random));
      out += (c > 0 ? "," : "") + cell;
    }
    out += '\n';
  }
  return out;
}

std::string of_lines(const std::string& text, const std::function<std::string(const std::string&)>& made) {
  std::string out, line;
  std::istringstream lines(text);
  while (std::getline(lines, line)) out += made(line);
  return out;
}

// What its owner has measured is known exactly: tolerances are left out.
std::string known(const std::string& model) {
  return of_lines(model, [](const std::string& line) {
    return std::regex_replace(line, std::regex("\\{ value = ([^,]+),.*"), "$1") + "\n";
  });
}

// Wheel speeds with their noise stated, no camera; the boards start within milliseconds.
std::string speeds_alone(const std::string& dataset) {
  return "boot_s = 0.05\n" + of_lines(dataset, [](const std::string& line) {
           if (line.starts_with("vision_")) return std::string();
           const std::regex wheel("column = \"(wheel_.)\"");
           return std::regex_replace(line, wheel,
                                     "column = \"$1\", sigma = " + std::to_string(kSigma_rad_s)) +
                  "\n";
         });
}

// Two robots with the image, one to fit, one to judge by; both with `hidden` in them.
Diagnosis diagnosed(const std::string& hidden) {
  SessionSetup setup = one_radio_robot();
  setup.robot_ids = {3, 4};
  const ModelFile plain = *read_bundle(setup.model).model;
  setup.model.robot_text += hidden;
  const Recording recording = driven(setup);
  const DatasetExport made = make_radio_dataset(
      recording, plain, heard_commands(recording, *find_radio_format(setup.radio_format)), {});
  DatasetFolder folder;
  unsigned seed = 1;
  for (const DatasetFile& file : made.files) {
    folder.write(file.name, file.name == "model.toml"     ? known(file.text)
                            : file.name == "dataset.toml" ? speeds_alone(file.text)
                            : file.name.ends_with(".csv") ? with_noise(file.text, seed++)
                                                          : file.text);
  }
  const DatasetReading reading = read_dataset(folder.path(), "", {.file = kImage, .board = kBoard});
  EXPECT_TRUE(reading.dataset) << all_text(reading.problems);
  if (!reading.dataset) return {};
  return diagnose(*reading.dataset, *reading.nominal,
                  {.jobs = 2, .max_effects = 1, .progress = {}, .stop = {}});
}

struct SlowImageDiagnosis : testing::Test {
  void SetUp() override {
    if (!std::filesystem::exists(kImage)) GTEST_SKIP() << "no arm-none-eabi-gcc: the image was not built";
  }
};

// Alone, or in a set that the data are said not to part.
TEST_F(SlowImageDiagnosis, AHiddenPayloadIsNamed) {
  const Diagnosis d = diagnosed("\n[effects.payload]\nmass_kg = 0.6\n");
  ASSERT_EQ(d.effects.size(), 1u) << d.unknown.sentence;
  std::vector<std::string> named = d.effects;
  for (const ConfoundedSet& set : d.confounded)
    named.insert(named.end(), set.members.begin(), set.members.end());
  EXPECT_NE(std::find(named.begin(), named.end(), "payload"), named.end()) << d.effects[0];
}

TEST_F(SlowImageDiagnosis, NothingIsNamedWhereNothingIsHidden) {
  const Diagnosis d = diagnosed("");
  EXPECT_EQ(d.effects, std::vector<std::string>{});
  EXPECT_EQ(d.verdict, Verdict::kAdequate) << d.unknown.sentence;
}

}  // namespace
}  // namespace omnihil

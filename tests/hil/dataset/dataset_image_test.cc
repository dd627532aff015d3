// A robot under radio commands whose firmware is an image on an emulated board: predicted as by the same firmware as a library,
// but for what the board's time explains; and refused, with file and field, where it cannot serve.
#include "hil/dataset/dataset_image.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "hil/dataset/booted_image.h"
#include "hil/dataset/firmware_meter.h"
#include "hil/dataset/radio_export.h"
#include "hil/firmware/image_firmware.h"
#include "hil/firmware/open_firmware.h"
#include "hil/loop/session_checks.h"
#include "identify/predict/predictor.h"
#include "identify/record/parallel.h"
#include "tests/hil/dataset/radio_recording.h"
#include "tests/hil/dataset/telling_firmware.h"
#include "tests/identify/dataset_folder.h"

namespace omnihil {
namespace {

const std::string kImages = OMNIHIL_BUILD_DIR "/images/";
const std::string kImage = kImages + "omni_reference_f405.elf";
const std::string kBoard = OMNIHIL_SOURCE_DIR "/boards/omni_reference_f405.toml";
const std::string kLibrary = OMNIHIL_BUILD_DIR "/firmware_iface/libomnihil_reference_firmware.so";

const Recording& driven() {
  static const Recording recording = radio_recording(one_radio_robot(), image_firmware(kImage, kBoard), 12.0);
  return recording;
}

// The library without what it says of itself, which is filtered: of an image the shafts' own speeds are compared.
class Untold final : public Firmware {
 public:
  explicit Untold(std::unique_ptr<Firmware> of) : of_(std::move(of)) {}
  std::string_view name() const override { return of_->name(); }
  std::string_view radio_format() const override { return of_->radio_format(); }
  std::int64_t control_period_ns() const override { return of_->control_period_ns(); }
  void command(const RobotCommand& c, std::int64_t now_ns) override { of_->command(c, now_ns); }
  void radio_receive(std::span<const std::uint8_t>, std::int64_t) override {}
  std::size_t radio_transmit(std::span<std::uint8_t>) override { return 0; }
  bool set_gains(const RobotGains&) override { return false; }
  RobotGains gains() const override { return {}; }
  RobotDrive tick(const RobotSensors& s) override { return of_->tick(s); }
  RobotFeedback feedback() const override { return {}; }

 private:
  std::unique_ptr<Firmware> of_;
};
class UntoldSource final : public FirmwareSource {
 public:
  explicit UntoldSource(std::shared_ptr<const FirmwareSource> of) : of_(std::move(of)) {}
  std::unique_ptr<Firmware> fresh() const override { return std::make_unique<Untold>(of_->fresh()); }
  double counts_per_rotor_turn() const override { return of_->counts_per_rotor_turn(); }

 private:
  std::shared_ptr<const FirmwareSource> of_;
};

// An image that drives as the library does and tells its speeds by radio.
class TellingSource final : public FirmwareSource {
 public:
  TellingSource(std::shared_ptr<const FirmwareSource> of, const RobotConfig& config, const Telling& how)
      : of_(std::move(of)), config_(config), how_(how) {}
  std::unique_ptr<Firmware> fresh() const override {
    auto boards = std::make_unique<TellingFirmware>(std::make_unique<Untold>(of_->fresh()), how_, config_);
    return std::make_unique<BootedImage>(std::move(boards), &telling_format(), config_, 0.0);
  }
  double counts_per_rotor_turn() const override { return of_->counts_per_rotor_turn(); }

 private:
  std::shared_ptr<const FirmwareSource> of_;
  RobotConfig config_;
  Telling how_;
};

struct DatasetImage : testing::Test {
  void SetUp() override {
    if (!std::filesystem::exists(kImage)) GTEST_SKIP() << "no arm-none-eabi-gcc: the image was not built";
    const DatasetExport made =
        make_radio_dataset(driven(), *read_bundle(one_radio_robot().model).model,
                           heard_commands(driven(), *find_radio_format("ulaval-hermes")), {});
    for (const DatasetFile& file : made.files) {
      folder.write(file.name, file.text);
      if (file.name == "dataset.toml") text = file.text;
    }
  }
  DatasetReading read(const OtherFirmware& firmware) { return read_dataset(folder.path(), "", firmware); }
  std::string refusal(const OtherFirmware& firmware) {
    const DatasetReading reading = read(firmware);
    EXPECT_FALSE(reading.dataset);
    return all_text(reading.problems);
  }
  DatasetFolder folder;
  std::string text;
};

double rms(const std::vector<double>& values) {
  double square = 0.0;
  for (const double v : values) square += v * v;
  return std::sqrt(square / static_cast<double>(values.size()));
}

// The image hears a packet later than the library, which has it at the tick: its bytes come one after the other, and it reads
// them in its next control interrupt; that has computed the duties within half a period (reference_image_test.cc). So its
// speeds are the library's, late by no more than that and never early; all of it is within the hundredth that host build and
// image differ by in a session (the same test).
TEST_F(DatasetImage, PredictsWhatTheSameFirmwareAsALibraryDoesButForTheBoardsTime) {
  constexpr double kByte_s = 10.0 / 1e6, kPeriod_s = 1e-3;  // 8N1 at 1 Mbaud; 1 kHz
  const double latest_s = 21 * kByte_s + 1.5 * kPeriod_s;
  DatasetReading image = read({.file = kImage, .board = kBoard}), library = read({.file = kLibrary});
  ASSERT_TRUE(image.dataset) << all_text(image.problems);
  ASSERT_TRUE(library.dataset) << all_text(library.problems);
  library.dataset->firmware = std::make_shared<UntoldSource>(library.dataset->firmware);
  const auto by_image = make_predictor(*image.dataset, *image.nominal, {});
  const auto by_library = make_predictor(*library.dataset, *library.nominal, {});
  const Prediction late = by_image->predict(*image.nominal, 0);
  const Prediction prompt = by_library->predict(*library.nominal, 0);
  ASSERT_TRUE(late.finite && prompt.finite);
  for (std::size_t s = 0; s < 4; ++s) {
    const ComparedSignal& c = by_image->compared(0)[s];
    ASSERT_TRUE(c.name.starts_with("wheel_speed")) << c.name;
    const std::vector<double>&t = c.time_s, &a = late.values[s], &b = prompt.values[s];
    std::vector<double> off;
    double along = 0.0, square = 0.0;  // late = prompt - lag * its slope, least squares
    for (std::size_t k = 1; k + 1 < t.size(); ++k) {
      const double slope = (b[k + 1] - b[k - 1]) / (t[k + 1] - t[k - 1]);
      off.push_back(a[k] - b[k]);
      along -= off.back() * slope;
      square += slope * slope;
    }
    EXPECT_GT(along / square, 0.0) << c.name;
    EXPECT_LT(along / square, latest_s) << c.name;
    EXPECT_LT(rms(off), 0.01 * rms(b)) << c.name;
  }
}

// What the library says of its speeds is low-passed (wheel_tuning.h); of an image the model has to say so.
TEST_F(DatasetImage, TheModelsFilterMakesOfTheShaftsSpeedsWhatTelemetryTells) {
  std::ofstream(folder.path() + "/model.toml", std::ios::app)
      << reference_controller_text(*read_bundle(one_radio_robot().model).model->robot);
  const DatasetReading image = read({.file = kImage, .board = kBoard}), library = read({.file = kLibrary});
  ASSERT_TRUE(image.dataset && library.dataset) << all_text(image.problems) << all_text(library.problems);
  ASSERT_GT(image.nominal->file.parameters.value_or("controller.report_filter_s", 0.0), 0.002);
  const Prediction a = make_predictor(*image.dataset, *image.nominal, {})->predict(*image.nominal, 0);
  const Prediction b = make_predictor(*library.dataset, *library.nominal, {})->predict(*library.nominal, 0);
  for (std::size_t s = 0; s < 4; ++s) {
    std::vector<double> off;
    for (std::size_t k = 0; k < a.values[s].size(); ++k) off.push_back(a.values[s][k] - b.values[s][k]);
    EXPECT_LT(rms(off), 0.01 * rms(b.values[s]));
  }
}

// Told at each tick, in steps: the shafts' own but for half a step and the way to the host, two ticks and the one that the row
// comes before. Filtered by the image: as by the model's filter of the same time, and not as the shafts.
TEST_F(DatasetImage, WheelSpeedsOfARecordArePredictedAsTheImageTellsThem) {
  constexpr double kLate_s = 1e-9 * kToHost_ns + 1e-3, kFilter_s = 0.05;
  std::ofstream(folder.path() + "/model.toml", std::ios::app)
      << reference_controller_text(*read_bundle(one_radio_robot().model).model->robot);
  DatasetReading reading = read({.file = kLibrary});
  ASSERT_TRUE(reading.dataset) << all_text(reading.problems);
  const std::shared_ptr<const FirmwareSource> library = reading.dataset->firmware;
  const RobotConfig config = robot_config(*reading.nominal->file.robot, 0);
  const auto predicted = [&](const Telling& how, double model_filter_s) {
    reading.dataset->firmware = std::make_shared<TellingSource>(library, config, how);
    const std::pair<std::string, double> known[] = {{"controller.report_filter_s", model_filter_s}};
    return make_predictor(*reading.dataset, *reading.nominal, {})
        ->predict(with_known(*reading.nominal, known), 0);
  };
  const auto off = [](const Prediction& a, const Prediction& b, double late_s, const std::vector<double>& t) {
    double largest = 0.0;
    for (std::size_t s = 0; s < 4; ++s) {
      std::vector<double> d;
      for (std::size_t k = 1; k + 1 < t.size(); ++k) {
        const double slope = (b.values[s][k + 1] - b.values[s][k - 1]) / (t[k + 1] - t[k - 1]);
        d.push_back(a.values[s][k] - (b.values[s][k] - late_s * slope));
      }
      largest = std::max(largest, rms(d) / rms(b.values[s]));
    }
    return largest;
  };
  const auto of = make_predictor(*reading.dataset, *reading.nominal, {});
  const std::vector<double> t = of->compared(0)[0].time_s;
  const Prediction shafts = predicted({.every = 0}, 0.0), low_passed = predicted({.every = 0}, kFilter_s);
  const Prediction told = predicted({.every = 1, .counted = false}, 0.3);
  const Prediction filtered = predicted({.every = 1, .filter_s = kFilter_s, .counted = false}, 0.3);
  ASSERT_TRUE(shafts.finite && told.finite && filtered.finite);
  EXPECT_LT(off(told, shafts, kLate_s, t), 0.01);
  EXPECT_LT(off(filtered, low_passed, kLate_s, t), 0.01);
  EXPECT_GT(off(filtered, shafts, 0.0, t), 0.05);
  for (const double v : told.values[0]) EXPECT_NEAR(std::remainder(v, kToldStep_rad_s), 0.0, 1e-9);
}

// rms of measured less predicted wheel speeds, over that of the measured, the largest of the wheels'.
double largest_share_off(const DatasetReading& reading) {
  const auto predictor = make_predictor(*reading.dataset, *reading.nominal, {});
  const Prediction y = predictor->predict(*reading.nominal, 0);
  EXPECT_TRUE(y.finite);
  double largest = 0.0;
  for (std::size_t s = 0; s < 4; ++s) {
    const ComparedSignal& c = predictor->compared(0)[s];
    EXPECT_TRUE(c.name.starts_with("wheel_speed")) << c.name;
    std::vector<double> off, size;
    for (std::size_t k = 0; k < c.measured.size(); ++k) {
      if (!std::isfinite(c.measured[k])) continue;
      off.push_back(c.measured[k] - y.values[s][k]);
      size.push_back(c.measured[k]);
    }
    largest = std::max(largest, rms(off) / rms(size));
  }
  return largest;
}

TEST_F(DatasetImage, TheRecordThatTheImageMadeIsPredicted) {
  const DatasetReading reading = read({.file = kImage, .board = kBoard});
  ASSERT_TRUE(reading.dataset) << all_text(reading.problems);
  EXPECT_LT(largest_share_off(reading), 0.01);
}

// A chip per wheel, each a process of simavr: four times as long as the robot drives. Its image has encoders of 1024 counts,
// which the exported model says.
TEST(SlowDatasetAvrImage, TheRecordThatTheImageMadeIsPredicted) {
  const std::string image = kImages + "omni_reference_avr.elf",
                    board = OMNIHIL_SOURCE_DIR "/boards/omni_reference_avr.toml";
  if (!std::filesystem::exists(image) || !std::filesystem::exists(OMNIHIL_BUILD_DIR "/tools/omnihil-avr"))
    GTEST_SKIP() << "no avr-gcc or no simavr";
  const SessionSetup setup = real::setup({"ulaval-hermes", "omni_1024", Physics::kPlanar}, {3});
  const Recording recording =
      radio_recording(setup, open_firmware({.file = image, .board = board}, session_config(setup)), 1.6);
  const DatasetExport made =
      make_radio_dataset(recording, *read_bundle(setup.model).model,
                         heard_commands(recording, *find_radio_format("ulaval-hermes")), {});
  DatasetFolder folder;
  for (const DatasetFile& file : made.files)
    folder.write(file.name, (file.name == "dataset.toml" ? "boot_s = 0.05\n" : "") + file.text);
  const DatasetReading reading = read_dataset(folder.path(), "", {.file = image, .board = board});
  ASSERT_TRUE(reading.dataset) << all_text(reading.problems);
  EXPECT_LT(largest_share_off(reading), 0.01);
}

TEST_F(DatasetImage, APredictionIsTheSameBitsWhicheverRanBeforeOrBesideIt) {
  const DatasetReading reading = read({.file = kImage, .board = kBoard});
  ASSERT_TRUE(reading.dataset) << all_text(reading.problems);
  const std::pair<std::string, double> heavy[] = {{"robot.mass_kg", 4.0}};
  const Candidate other = with_known(*reading.nominal, heavy);
  // each by a predictor of its own: none gives what it has kept
  const auto predicted = [&](const Candidate& model) {
    return make_predictor(*reading.dataset, *reading.nominal, {})->predict(model, 1);
  };
  const Prediction first = predicted(*reading.nominal);
  std::vector<Prediction> beside(4);
  parallel_for(2, 4, [&](int k) {
    beside[static_cast<std::size_t>(k)] = predicted(k % 2 == 0 ? *reading.nominal : other);
  });
  for (std::size_t s = 0; s < 4; ++s) {  // speeds, of which no row is missing
    EXPECT_EQ(beside[0].values[s], first.values[s]);
    EXPECT_EQ(beside[2].values[s], first.values[s]);
    EXPECT_EQ(beside[1].values[s], beside[3].values[s]);
    EXPECT_NE(beside[1].values[s], first.values[s]);
  }
}

TEST_F(DatasetImage, EverySimulationIsCountedAndChangesNothing) {
  DatasetReading reading = read({.file = kImage, .board = kBoard});
  ASSERT_TRUE(reading.dataset) << all_text(reading.problems);
  const Prediction bare =
      make_predictor(*reading.dataset, *reading.nominal, {})->predict(*reading.nominal, 1);
  const FirmwareMeter meter(*reading.dataset);
  const auto predictor = make_predictor(*reading.dataset, *reading.nominal, {});
  const Prediction y = predictor->predict(*reading.nominal, 1);
  predictor->predict(*reading.nominal, 1);  // kept: not simulated again
  EXPECT_EQ(meter.seen().simulations, 1);
  make_predictor(*reading.dataset, *reading.nominal, {})->predict(*reading.nominal, 1);
  const FirmwareUse seen = meter.seen();
  EXPECT_EQ(seen.simulations, 2);
  EXPECT_EQ(seen.failed, 0);
  EXPECT_NEAR(seen.simulated_s, 2.0 * reading.dataset->runs[1].duration_s(),
              2e-3);  // boards tick every 0.5 ms
  EXPECT_GT(seen.wall_s, 0.0);
  EXPECT_EQ(y.values[0], bare.values[0]);
}

TEST_F(DatasetImage, ComesFromTheDatasetsOwnKeysToo) {
  std::filesystem::copy(kImage, folder.path() + "/fw.elf");
  std::filesystem::copy(kBoard, folder.path() + "/board.toml");
  folder.write("dataset.toml", "firmware = \"fw.elf\"\nboard = \"board.toml\"\nboot_s = 0.1\n" + text);
  const DatasetReading reading = read({});
  ASSERT_TRUE(reading.dataset) << all_text(reading.problems);
  EXPECT_NE(reading.dataset->notes[0].find("image on omni reference"), std::string::npos)
      << reading.dataset->notes[0];
  EXPECT_TRUE(read({.file = kImage}).dataset);    // on the dataset's own board
  EXPECT_TRUE(read({.file = kLibrary}).dataset);  // which is none of a library
}

TEST_F(DatasetImage, WithoutItsBoardIsRefused) {
  const std::string said = refusal({.file = kImage});
  EXPECT_NE(said.find("dataset.toml"), std::string::npos) << said;
  EXPECT_NE(said.find("board = \"\": is missing: the firmware is a microcontroller image"), std::string::npos)
      << said;
  const std::string nowhere = refusal({.file = kImage, .board = "nowhere.toml"});
  EXPECT_NE(nowhere.find("board = \"nowhere.toml\": board nowhere.toml: "), std::string::npos) << nowhere;
}

TEST_F(DatasetImage, ABoardWithoutAnImageHasNothingToDo) {
  EXPECT_NE(refusal({.board = kBoard}).find("has nothing to do"), std::string::npos);
  EXPECT_NE(refusal({.file = kLibrary, .board = kBoard}).find("the firmware is no microcontroller image"),
            std::string::npos);
}

TEST_F(DatasetImage, AnImageThatFaultsIsRefusedWithItsFault) {
  for (const char* image : {"faults.elf", "faults_stays.elf"}) {
    const std::string said = refusal({.file = kImages + image, .board = kBoard});
    EXPECT_NE(said.find(std::string("firmware = \"") + kImages + image), std::string::npos) << said;
    EXPECT_NE(said.find("read_nowhere"), std::string::npos) << said;
  }
}

TEST_F(DatasetImage, AnImageThatNeverDrivesIsRefused) {
  const std::string said = refusal({.file = kImages + "loops.elf", .board = kBoard});
  EXPECT_NE(said.find("loops.elf\": asks nothing of the bridges when it is commanded to drive"),
            std::string::npos)
      << said;
}

TEST_F(DatasetImage, ABoardOfAnotherRadioFormatIsRefused) {
  const std::string was = "radio = \"ulaval-hermes\"";
  ASSERT_NE(text.find(was), std::string::npos) << text;  // of the recording
  folder.write("dataset.toml", text.replace(text.find(was), was.size(), "radio = \"roboteam-rem-v8\""));
  const std::string said = refusal({.file = kImage, .board = kBoard});
  EXPECT_NE(said.find("dataset.toml:5:"), std::string::npos) << said;
  EXPECT_NE(said.find("radio = \"roboteam-rem-v8\": board " + kBoard +
                      " decodes another format: [radio] format = \"ulaval-hermes\""),
            std::string::npos)
      << said;
}

TEST_F(DatasetImage, ThreePhaseBoardsAreRefused) {
  const std::string said = refusal(
      {.file = kImages + "polling_wheel.elf", .board = OMNIHIL_SOURCE_DIR "/boards/ateam_wheel_f031.toml"});
  EXPECT_NE(said.find("three-phase bridges"), std::string::npos) << said;
}

}  // namespace
}  // namespace omnihil

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <bit>
#include <csignal>
#include <ctime>
#include <limits>

#include "hil/recording/recording_memory.h"
#include "hil/recording/recording_reader.h"
#include "hil/text/recording_text.h"
#include "tests/hil/recording/fake_run.h"

namespace omnihil {
namespace {

std::filesystem::path write_run(const fake::TempFolder& folder, const RecordingHeader& header,
                                int milliseconds, bool finish = true) {
  std::error_code error;
  const auto path = folder / "run.omnirec";
  const auto writer = RecordingWriter::open(path, header, error);
  EXPECT_FALSE(error) << error.message();
  fake::run(*writer, header.robot_ids, milliseconds);
  if (finish) {
    writer->finish(
        {.now_ns = 1'000'000LL * milliseconds, .wall_s = 0.25, .counters = {{"host packets good", 2}}});
  }
  return path;
}

std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }

TEST(RecordingRoundTrip, HeaderComesBackWhole) {
  const fake::TempFolder folder;
  const RecordingHeader wrote = fake::header();
  const RecordingHeader read = load_recording(write_run(folder, wrote, 1)).header;
  EXPECT_EQ(read.commit, wrote.commit);
  EXPECT_EQ(read.robot_model, wrote.robot_model);
  EXPECT_EQ(read.robot_model_text, wrote.robot_model_text);
  ASSERT_EQ(read.included_models.size(), 1U);
  EXPECT_EQ(read.included_models[0].name, wrote.included_models[0].name);
  EXPECT_EQ(read.included_models[0].text, wrote.included_models[0].text);
  EXPECT_EQ(read.radio_format, wrote.radio_format);
  EXPECT_EQ(read.firmware, wrote.firmware);
  EXPECT_EQ(read.robot_ids, wrote.robot_ids);
  EXPECT_EQ(read.team, wrote.team);
  EXPECT_EQ(read.plant.physics, wrote.plant.physics);
  EXPECT_EQ(read.plant.integrator, wrote.plant.integrator);
  EXPECT_EQ(read.plant.mechanical_step_ns, wrote.plant.mechanical_step_ns);
  EXPECT_EQ(read.plant.electrical_step_ns, wrote.plant.electrical_step_ns);
  EXPECT_EQ(read.plant.seed, wrote.plant.seed);
  EXPECT_EQ(read.step_ns, wrote.step_ns);
  EXPECT_EQ(read.epoch_ms, wrote.epoch_ms);
  EXPECT_EQ(read.seed, wrote.seed);
  EXPECT_EQ(read.started, wrote.started);
  EXPECT_EQ(read.sample_every, wrote.sample_every);
  ASSERT_EQ(read.columns.size(), sample_columns().size());
  EXPECT_EQ(read.columns.back(), sample_columns().back().name);
  EXPECT_EQ(read.units.back(), sample_columns().back().unit);
}

TEST(RecordingRoundTrip, EveryChunkComesBackBitForBit) {
  const fake::TempFolder folder;
  const RecordingHeader header = fake::header();
  RecordingMemory memory(header);
  fake::run(memory, header.robot_ids, 50);
  const Recording wrote = memory.take(50'000'000);
  const Recording read = load_recording(write_run(folder, header, 50));
  ASSERT_EQ(read.chunks.size(), wrote.chunks.size());
  ASSERT_EQ(wrote.chunks.size(), 2U + 1U + 1U + 2U * 50U);
  for (std::size_t i = 0; i < wrote.chunks.size(); ++i) {
    EXPECT_EQ(read.chunks[i].kind, wrote.chunks[i].kind);
    EXPECT_EQ(read.chunks[i].now_ns, wrote.chunks[i].now_ns);
    EXPECT_EQ(read.chunks[i].bytes, wrote.chunks[i].bytes);
    EXPECT_EQ(read.chunks[i].robot_id, wrote.chunks[i].robot_id);
    ASSERT_EQ(read.chunks[i].sample.size(), wrote.chunks[i].sample.size());
    for (std::size_t k = 0; k < wrote.chunks[i].sample.size(); ++k) {
      ASSERT_EQ(bits(read.chunks[i].sample[k]), bits(wrote.chunks[i].sample[k]))
          << sample_columns()[k].name << " of chunk " << i;
    }
  }
  EXPECT_TRUE(read.complete);
  EXPECT_EQ(read.end_ns, 50'000'000);
  EXPECT_EQ(read.end.wall_s, 0.25);
  ASSERT_EQ(read.end.counters.size(), 1U);
  EXPECT_EQ(read.end.counters[0].first, "host packets good");
  EXPECT_EQ(read.end.counters[0].second, 2U);
}

// With blanks at its ends, a comment's sign, or nothing.
TEST(RecordingRoundTrip, LinesOfConsolesComeBackToTheLetter) {
  const fake::TempFolder folder;
  std::error_code error;
  const RecordingHeader header = fake::header();
  const std::vector<std::string> lines{"boot", "", " 3.7 V  ", "# {\"end\":{}}"};
  {
    const auto writer = RecordingWriter::open(folder / "said.omnirec", header, error);
    for (const std::string& line : lines)
      writer->console_line(1'000'000, header.robot_ids.back(), 2, "USART2", line);
    writer->finish({.now_ns = 1'000'000, .wall_s = 0.0, .counters = {}});
  }
  const Recording read = load_recording(folder / "said.omnirec");
  ASSERT_EQ(read.chunks.size(), lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_EQ(read.chunks[i].kind, RecordedChunk::Kind::kConsole);
    EXPECT_EQ(read.chunks[i].robot_id, header.robot_ids.back());
    EXPECT_EQ(read.chunks[i].board, 2);
    EXPECT_EQ(read.chunks[i].port, "USART2");
    EXPECT_EQ(read.chunks[i].text, lines[i]);
  }
}

TEST(RecordingRoundTrip, NumbersAtTheEdgesOfDoubleComeBackBitForBit) {
  using Limits = std::numeric_limits<double>;
  for (const double number : {0.0, -0.0, 0.1, 1.0 / 3.0, Limits::max(), Limits::lowest(), Limits::min(),
                              Limits::denorm_min(), Limits::epsilon(), 9007199254740993.0, 1e23}) {
    std::string text;
    append_number(text, number);
    double back = 1.0;
    EXPECT_TRUE(parse_number(text, back)) << text;
    EXPECT_EQ(bits(back), bits(number)) << text;
  }
}

TEST(RecordingRoundTrip, HexComesBackForEveryByte) {
  std::vector<std::uint8_t> all(256);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint8_t>(i);
  std::vector<std::uint8_t> back;
  ASSERT_TRUE(parse_hex(to_hex(all), back));
  EXPECT_EQ(back, all);
}

TEST(SampleColumns, HaveNamesOfTheirOwnAndUnits) {
  std::vector<std::string> names;
  for (const SampleColumn& column : sample_columns()) {
    EXPECT_FALSE(column.unit.empty()) << column.name;
    EXPECT_EQ(std::count(names.begin(), names.end(), column.name), 0) << column.name;
    names.push_back(column.name);
  }
}

TEST(RecordingWriter, KeepsTheFirstAndEveryNthTickOfEachRobot) {
  const fake::TempFolder folder;
  const Recording read = load_recording(write_run(folder, fake::header({0, 3}, 10), 95));
  std::vector<std::int64_t> times_ms[4];
  for (const RecordedChunk& chunk : read.chunks) {
    if (chunk.kind == RecordedChunk::Kind::kSample)
      times_ms[chunk.robot_id].push_back(chunk.now_ns / 1'000'000);
  }
  EXPECT_EQ(times_ms[0], (std::vector<std::int64_t>{0, 10, 20, 30, 40, 50, 60, 70, 80, 90}));
  EXPECT_EQ(times_ms[3], times_ms[0]);
  EXPECT_EQ(read.header.sample_every, 10);
}

TEST(RecordingWriter, PutsEachSimulatedSecondOnDiskBeforeTheNextIsOver) {
  const fake::TempFolder folder;
  std::error_code error;
  const RecordingHeader header = fake::header({0}, 100);  // few lines: the buffer alone would not be full
  const auto writer = RecordingWriter::open(folder / "run.omnirec", header, error);
  ASSERT_TRUE(writer);
  fake::run(*writer, header.robot_ids, 3000);
  // As a killed process leaves it: nothing more is flushed.
  const Recording read = load_recording(folder / "run.omnirec");
  EXPECT_GE(read.end_ns, 2'000'000'000 - 1);
  EXPECT_FALSE(read.complete);
}

// Files of this process may not grow beyond `bytes` while this lives: what a full disk looks like to a
// writer.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : old_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit{bytes, old_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, old_handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit old_{};
  void (*old_handler_)(int);
};

TEST(RecordingWriter, FullDiskIsReportedOnceAndTheRunGoesOn) {
  const fake::TempFolder folder;
  std::error_code error;
  std::vector<std::string> reports;
  const RecordingHeader header = fake::header();
  {
    const FileSizeLimit limit(1'000'000);
    const auto writer = RecordingWriter::open(folder / "run.omnirec", header, error,
                                              [&](const std::string& text) { reports.push_back(text); });
    ASSERT_TRUE(writer);
    fake::run(*writer, header.robot_ids, 5000);  // some 8 MB
    writer->finish({.now_ns = 5'000'000'000, .wall_s = 1.0, .counters = {}});
    EXPECT_EQ(writer->error(), std::errc::file_too_large);
  }
  ASSERT_EQ(reports.size(), 1U);
  EXPECT_NE(reports[0].find("run.omnirec"), std::string::npos) << reports[0];
  const Recording read = load_recording(folder / "run.omnirec");  // readable up to where it was full
  EXPECT_TRUE(read.last_line_cut);
  EXPECT_FALSE(read.complete);
  EXPECT_GT(read.chunks.size(), 100U);
}

TEST(RecordingWriter, FullDiskAtTheFirstLineIsAnErrorOfOpening) {
  std::error_code error;
  EXPECT_FALSE(RecordingWriter::open("/dev/full", fake::header(), error));
  EXPECT_EQ(error, std::errc::no_space_on_device);
}

TEST(RecordingWriter, SaysWhenTheRunStarted) {
  const fake::TempFolder folder;
  RecordingHeader header = fake::header();
  header.started.clear();
  const std::string started = load_recording(write_run(folder, header, 1)).header.started;
  std::tm parts{};
  const char* end = ::strptime(started.c_str(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  ASSERT_NE(end, nullptr) << started;
  EXPECT_EQ(*end, '\0') << started;
}

TEST(RecordingWriter, NamesThePathThatCannotBeOpened) {
  std::error_code error;
  EXPECT_FALSE(RecordingWriter::open("/nonexistent/folder/run.omnirec", fake::header(), error));
  EXPECT_EQ(error, std::errc::no_such_file_or_directory);
}

}  // namespace
}  // namespace omnihil

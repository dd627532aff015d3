// Game logs that python3-protobuf wrote, whole, cut and damaged.
#include <gtest/gtest.h>

#include "hil/game_log/vision_csv.h"
#include "tests/hil/capture/peers.h"
#include "tests/tools/cli.h"

namespace omnihil {
namespace {

constexpr const char* kHead = "time_s,received_s,camera,frame,object,id,x_m,y_m,yaw_rad,confidence\n";

class GameLog : public testing::Test {
 protected:
  // Writes the log and keeps the rows that it says are in it.
  void write(const std::string& name) {
    const peers::Said said = peers::run("/usr/bin/python3 '" OMNIHIL_SOURCE_DIR
                                        "/tests/hil/game_log/game_log_writer.py' '" OMNIHIL_SOURCE_DIR "' '" +
                                        folder_.path().string() + "' '" + (folder_ / name).string() + "'");
    if (said.text.find("No module named") != std::string::npos ||
        said.text.find("FileNotFoundError: [Errno 2] No such file or directory: 'protoc'") !=
            std::string::npos)
      GTEST_SKIP() << said.text;
    ASSERT_EQ(said.exit_code, 0) << said.text;
    rows_ = said.text;
  }
  VisionCsv read(const std::string& bytes, std::vector<std::string>& notes) {
    fake::write_text(folder_ / "damaged.log", bytes);
    GameLogReader log(folder_ / "damaged.log");
    VisionCsv csv = vision_csv(log);
    notes = log.notes();
    return csv;
  }

  fake::TempFolder folder_;
  std::string rows_;
};

TEST_F(GameLog, EveryDetectionIsARowPackedOrNot) {
  for (const char* name : {"game.log.gz", "game.log"}) {
    write(name);
    if (IsSkipped()) return;
    ASSERT_TRUE(is_game_log(folder_ / name));
    GameLogReader log(folder_ / name);
    const VisionCsv csv = vision_csv(log);
    EXPECT_EQ(csv.text, kHead + rows_);
    EXPECT_EQ(csv.frames, 41U);
    EXPECT_EQ(csv.balls, 41U);
    EXPECT_EQ(
        csv.robots,
        2U * 39 + 40);  // 0, 1, 2 of each team, 13 times, and the one without an id; none more in 2010's
    EXPECT_EQ(csv.other_records, 160U);  // referee, blank, tracker, unknown
    EXPECT_TRUE(log.notes().empty());
  }
}

TEST_F(GameLog, IsATableByTheProgram) {
  if (!std::filesystem::exists(OMNIHIL_PROGRAM)) GTEST_SKIP() << "the program omnihil is not built";
  write("game.log.gz");
  if (IsSkipped()) return;
  const std::string convert =
      "convert" + shell(folder_ / "game.log.gz") + "--out" + shell(folder_ / "game.csv") + "--to ";
  const Ran ran = run_omnihil(convert + "csv");
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  EXPECT_TRUE(ran.says("41 frames of vision, 118 robots, 41 balls; 160 other records")) << ran.text;
  EXPECT_EQ(fake::read_text(folder_ / "game.csv"), kHead + rows_);
  EXPECT_EQ(run_omnihil(convert + "csv").exit_code, 2);  // never overwritten
  const Ran other = run_omnihil(convert + "pcap");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_TRUE(other.says("--to: found pcap, allowed for a game log: csv")) << other.text;
}

TEST_F(GameLog, WhatIsCutIsReadUpToThere) {
  write("game.log");
  if (IsSkipped()) return;
  const std::string whole = fake::read_text(folder_ / "game.log");
  std::vector<std::string> notes;
  const std::size_t index = 16 + 31;
  EXPECT_EQ(read(whole.substr(0, whole.size() - index), notes).text, kHead + rows_);
  EXPECT_TRUE(notes.empty());
  const VisionCsv cut = read(whole.substr(0, whole.size() - index - 1), notes);
  EXPECT_EQ(cut.frames, 40U);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("damaged.log:record 201: the log is cut or damaged here"), std::string::npos)
      << notes[0];
  // Packed and cut: what was unpacked before the cut is there.
  write("game.log.gz");
  const std::string packed = fake::read_text(folder_ / "game.log.gz");
  EXPECT_GT(read(packed.substr(0, packed.size() * 3 / 4), notes).frames, 0U);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("the log is cut or damaged here"), std::string::npos) << notes[0];
}

TEST_F(GameLog, WhatIsNoneIsRefused) {
  const auto refusal = [&](const std::string& bytes) {
    std::vector<std::string> notes;
    try {
      read(bytes, notes);
    } catch (const BadCapture& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refusal("SSL_LOG_FILX").find("found no SSL_LOG_FILE"), std::string::npos);
  EXPECT_NE(refusal("").find("found no SSL_LOG_FILE"), std::string::npos);
  EXPECT_NE(refusal(std::string("SSL_LOG_FILE\0\0\0\2", 16)).find("version: found 2, allowed: 1"),
            std::string::npos);
  std::vector<std::string> notes;
  EXPECT_EQ(read(std::string("SSL_LOG_FILE\0\0\0\1", 16), notes).text, kHead);
  read(std::string("SSL_LOG_FILE\0\0\0\1", 16) + std::string("\0\0\0\0\0\0\0\0\0\0\0\4\xff\xff\xff\xff", 16) +
           "xxxx",
       notes);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("record 1: length: found -1, allowed: 0 to 1000000"), std::string::npos)
      << notes[0];
}

TEST_F(GameLog, DamageDoesNoHarm) {
  for (const char* name : {"game.log", "game.log.gz"}) {
    write(name);
    if (IsSkipped()) return;
    const std::string golden = fake::read_text(folder_ / name);
    std::mt19937 random(8);
    std::size_t was_read = 0;
    std::vector<std::string> notes;
    for (int i = 0; i < 400; ++i) {
      std::string damaged = golden.substr(0, i % 3 == 0 ? random() % golden.size() : golden.size());
      for (unsigned k = random() % 4; k > 0 && !damaged.empty(); --k)
        damaged[random() % damaged.size()] = static_cast<char>(random() % 256);
      try {
        const VisionCsv csv = read(damaged, notes);
        was_read += csv.frames > 0 ? 1 : 0;
        EXPECT_LE(csv.frames, 201U);
      } catch (const BadCapture&) {
      }
    }
    EXPECT_GT(was_read, 100U);
  }
}

}  // namespace
}  // namespace omnihil

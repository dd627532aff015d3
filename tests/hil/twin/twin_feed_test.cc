// What a twin gets to see of a stream of bytes, and what it takes from a card.
#include "hil/twin/twin_feed.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "hil/text/hashed_file.h"
#include "hil/twin/twin_runner.h"
#include "tests/hil/recording/fake_run.h"

namespace omnihil {
namespace {

struct Fed {
  std::vector<double> time_s, vx;  // rows with a new command
  std::size_t pieces = 0;
};

// Commands to robots 0 and 1 every 20 ms, v = 0.1 n m/s to robot 0; what the feed makes of it when it is asked every `ask_ms`.
Fed fed(int ask_ms) {
  const RadioFormat& format = *find_radio_format("ulaval-hermes");
  TwinFeed feed(format, {.robot_ids = {0, 1}, .robot = 0});
  Fed out;
  double last_s = -1.0;
  for (int ms = 0; ms < 3000; ++ms) {
    const std::int64_t now_ns = ms * 1'000'000LL;
    for (int id = 0; ms % 20 == 0 && id < 2; ++id) {
      RobotCommand command{};
      command.mode = OMNIHIL_MODE_BODY_VELOCITY;
      command.v_forward_m_s = id == 0 ? 0.1 * (ms / 20 % 10) : 7.0;
      std::vector<std::uint8_t> bytes;
      EXPECT_TRUE(format.encode_command(command, {.robot_id = id, .team = Team::kBlue}, bytes));
      feed.host_bytes(now_ns, bytes);
    }
    if (ms % ask_ms != 0) continue;
    while (const std::optional<Run> piece = feed.next(now_ns)) {
      ++out.pieces;
      const std::vector<double>& vx = *piece->signal("command_vx");
      for (std::size_t k = 0; k < vx.size(); ++k) {
        if (piece->time_s[k] <= last_s) {  // the row that the piece before ended with
          EXPECT_EQ(k, 0u);
          EXPECT_EQ(piece->time_s[k], last_s);
          continue;
        }
        out.time_s.push_back(piece->time_s[k]);
        out.vx.push_back(vx[k]);
      }
      last_s = piece->time_s.back();
    }
  }
  return out;
}

TEST(TwinFeed, GivesOneRobotsCommandsInPiecesThatHangTogether) {
  const Fed all = fed(1);
  EXPECT_GE(all.pieces, 5u);  // 2.9 s less what is told late, in pieces of half a second
  ASSERT_GT(all.time_s.size(), 100u);
  // The dongle says a command more than once; of the commands themselves none is missing, and none is the other robot's.
  int next = 0;
  for (std::size_t n = 0; n < all.vx.size(); ++n) {
    if (std::abs(all.vx[n] - 0.1 * (next % 10)) > 1e-3) ++next;
    ASSERT_NEAR(all.vx[n], 0.1 * (next % 10), 1e-3) << n;
    ASSERT_NEAR(all.time_s[n], 0.02 * next, 0.025) << n;  // a command's period, and the dongle's steps
  }
  EXPECT_GE(next, 110);  // of 150 less what is told late and the last piece
}

TEST(TwinFeed, GivesTheSameRowsWheneverItIsAsked) {
  const Fed often = fed(1), seldom = fed(700);
  ASSERT_GT(seldom.time_s.size(), 50u);
  for (std::size_t n = 0; n < seldom.time_s.size(); ++n) {
    EXPECT_EQ(seldom.time_s[n], often.time_s[n]);
    EXPECT_EQ(seldom.vx[n], often.vx[n]);
  }
}

TEST(TwinCard, TakesTheLargestErrorOfUnseenRunsOfThisVeryModel) {
  const fake::TempFolder folder;
  std::ofstream(folder / "model.toml") << "rig = \"robot\"\n";
  const std::string sha = hash_file((folder / "model.toml").string()).sha256;
  std::ofstream(folder / "model.card.json")
      << R"({"format":"omnihil-card/1","name":"model","title":"","rig":"robot","sentence":"","date":"2026-01-01",)"
      << R"("files":[{"name":"model.toml","sha256":")" << sha
      << R"("}],"effects":[],"data":[{"name":"bench","errors":{)"
      << R"("fit":{"gyro_z":{"rmse":9.0}},"holdout":{"gyro_z":{"rmse":0.02}},"extrapolation":{"gyro_z":{"rmse":0.03}}}}]})";
  EXPECT_EQ(card_errors(folder / "model.toml"), (std::map<std::string, double>{{"gyro_z", 0.03}}));
  std::ofstream(folder / "model.toml") << "rig = \"robot\"  # edited since\n";
  EXPECT_TRUE(card_errors(folder / "model.toml").empty());
}

}  // namespace
}  // namespace omnihil

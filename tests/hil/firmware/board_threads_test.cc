// Boards of one bench on several threads: the same bits as on one, down to the bytes to the host, the consoles and the reports.
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "hil/firmware/image_firmware.h"
#include "hil/loop/model_store.h"
#include "hil/recording/session_setup.h"
#include "tests/hil/firmware/image_suite.h"

namespace omnihil {
namespace {

std::string image(const char* name) { return OMNIHIL_BUILD_DIR "/images/" + std::string(name) + ".elf"; }
std::string board(const char* name) { return OMNIHIL_SOURCE_DIR "/boards/" + std::string(name) + ".toml"; }

struct Bench {
  std::string robot = "omni_default", image_file, board_file;
  std::vector<int> robots;
  int duration_ms = 0;
  Physics physics = Physics::kPlanar;
};

// All that can be seen from outside.
struct Seen {
  std::string hash;
  std::vector<std::string> lines;
  bool operator==(const Seen&) const = default;
};
void PrintTo(const Seen& seen, std::ostream* out) { *out << seen.hash << ' ' << seen.lines.size(); }

// Boards of one robot wait for each other in the middle of a period, as only boards on several threads can.
struct Meeting {
  std::atomic<int> here{0}, left_alone{0};
  std::mutex lock;
  std::set<std::thread::id> threads;
  void wait_for(int boards) {
    {
      const std::lock_guard held(lock);
      threads.insert(std::this_thread::get_id());
    }
    ++here;
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (here < boards) {
      if (std::chrono::steady_clock::now() < patience) continue;
      ++left_alone;
      return;
    }
  }
};

Seen run(const Bench& bench, int threads, Meeting* meeting = nullptr) {
  SessionSetup setup;
  setup.model = load_robot_model(bench.robot, {OMNIHIL_SOURCE_DIR "/models"}).bundle;
  setup.radio_format = "ulaval-hermes";
  setup.robot_ids = bench.robots;
  setup.plant.physics = bench.physics;
  SessionConfig config = session_config(setup);
  config.threads = threads;
  Seen seen;
  ImageListeners listeners;
  listeners.on_line = [&](std::uint32_t robot, int of, const std::string& port, const std::string& line) {
    seen.lines.push_back(std::to_string(robot) + "." + std::to_string(of) + " " + port + " " + line);
  };
  listeners.on_board = [&](const MadeBoard& made) {
    if (meeting == nullptr) return;
    made.mcu.at(7'100'000, [meeting, boards = made.boards] { meeting->wait_for(boards); });
  };
  Session session(config, image_firmware(bench.image_file, bench.board_file, {}, listeners));
  Hashed hash;
  session.set_observer(&hash);
  RobotCommand ahead{};
  ahead.mode = OMNIHIL_MODE_BODY_VELOCITY;
  ahead.v_forward_m_s = 0.6;
  ahead.omega_body_rad_s = 0.5;
  std::vector<std::uint8_t> packet, out;
  for (int step = 0; step < bench.duration_ms; ++step) {
    packet.clear();
    for (const int id : bench.robots) {
      if (step % 10 == 0) find_radio_format("ulaval-hermes")->encode_command(ahead, {.robot_id = id}, packet);
    }
    session.step(packet, out);
  }
  for (int i = 0; i < session.robot_count(); ++i) {
    for (const std::string& line : session.firmware(i).report()) seen.lines.push_back(line);
  }
  seen.hash = hash.hash.hex();
  return seen;
}

struct BoardThreads : testing::Test {
  void SetUp() override {
    if (!std::filesystem::exists(image("wheels"))) GTEST_SKIP() << "no arm-none-eabi-gcc: no images";
  }
  static void expect_the_same(const Bench& bench) {
    const Seen one = run(bench, 1);
    for (const int threads : {2, 5}) EXPECT_EQ(run(bench, threads), one) << threads;
  }
  // A board file of the test's own.
  std::string with(const std::string& text) {
    path_ =
        std::filesystem::temp_directory_path() / ("omnihil-threads-" + std::to_string(::getpid()) + ".toml");
    std::ofstream(path_) << text;
    return path_.string();
  }
  void TearDown() override {
    if (!path_.empty()) std::filesystem::remove(path_);
  }
  std::filesystem::path path_;
};

TEST_F(BoardThreads, RobotsThatHearTheRadioGiveTheSameBits) {
  expect_the_same({.image_file = image("omni_reference_f405"),
                   .board_file = board("omni_reference_f405"),
                   .robots = {0, 1, 2, 3, 4, 5},
                   .duration_ms = 300});
}

// Their bridges are set in every PWM period, from within the plant's step.
TEST_F(BoardThreads, ThreePhaseRobotsOfFourBoardsGiveTheSameBits) {
  expect_the_same({.robot = "ateam_2025",
                   .image_file = image("polling_wheel"),
                   .board_file = board("ateam_wheel_f031"),
                   .robots = {0, 2, 3},
                   .duration_ms = 80});
}

// In Simbody's systems of a few robots each, side by side; on one thread all are in one.
TEST_F(BoardThreads, SeveralSystemsOfSimbodyGiveTheSameBitsAsOne) {
  for (const Physics physics : {Physics::kSimbody, Physics::kSimbodyFree}) {
    expect_the_same({.robot = "ateam_2025",
                     .image_file = image("polling_wheel"),
                     .board_file = board("ateam_wheel_f031"),
                     .robots = {0, 1, 3, 4, 7},
                     .duration_ms = 30,
                     .physics = physics});
  }
}

constexpr const char* kTwoBoards =
    "format = \"omnihil-board/1\"\nname = \"two\"\nchip = \"stm32f405\"\nboards_per_robot = 2\n"
    "[[motor]]\nwheel = 0\npwm = \"TIM1.1\"\ndirection = \"PE0\"\n"
    "[[motor]]\nwheel = 1\npwm = \"TIM1.2\"\ndirection = \"PE1\"\n";

TEST_F(BoardThreads, BoardsOnOneBusAndTheirConsolesGiveTheSameBits) {
  const std::string file = with(std::string(kTwoBoards) +
                                "[[port]]\nof = \"CAN1\"\nas = \"bus:wheels\"\n"
                                "[[port]]\nof = \"semihosting\"\nconsole = true\n");
  const Bench bench{.image_file = image("ports"), .board_file = file, .robots = {0, 1, 4}, .duration_ms = 60};
  expect_the_same(bench);
  EXPECT_GT(run(bench, 2).lines.size(), 6u);  // they did say something
}

TEST_F(BoardThreads, BoardsOfOneRobotAreOnSeveralThreadsToo) {
  const std::string file = with(std::string(kTwoBoards) + "[[port]]\nof = \"semihosting\"\nconsole = true\n");
  const Bench bench{.image_file = image("wheels"), .board_file = file, .robots = {0}, .duration_ms = 200};
  expect_the_same(bench);
  Meeting meeting;
  run(bench, 2, &meeting);
  EXPECT_EQ(meeting.threads.size(), 2u);
  EXPECT_EQ(meeting.left_alone, 0);
}

}  // namespace
}  // namespace omnihil

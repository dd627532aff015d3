// A board on the desk, end to end: an emulated one in a process of its own at the other end of a pty.
#include "hil/firmware/remote_firmware.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include "hil/loop/reference_firmware.h"
#include "hil/recording/session_setup.h"
#include "tests/hil/one_robot.h"

namespace omnihil {
namespace {

// Runs as long as the object lives or the bench has its line open.
class EmulatedBoard {
 public:
  explicit EmulatedBoard(const std::string& faults) {
    pipe_ = ::popen(
        (std::string(OMNIHIL_BUILD_DIR "/tests/hil/firmware/board/emulated_board ") + faults).c_str(), "r");
    std::array<char, 64> line{};
    if (pipe_ != nullptr && std::fgets(line.data(), line.size(), pipe_) != nullptr) device_ = line.data();
    while (!device_.empty() && device_.back() == '\n') device_.pop_back();
  }
  ~EmulatedBoard() {
    if (pipe_ != nullptr) ::pclose(pipe_);
  }
  EmulatedBoard(const EmulatedBoard&) = delete;
  EmulatedBoard& operator=(const EmulatedBoard&) = delete;
  std::string url() const { return "serial:" + device_; }

 private:
  std::FILE* pipe_ = nullptr;
  std::string device_;
};

SessionConfig config_of_one_robot() {
  SessionSetup setup = test::one_robot("omni_default");
  return session_config(setup);
}

struct OneRobot {
  std::unique_ptr<Session> session;
  const RemoteFirmware* remote = nullptr;

  explicit OneRobot(const Session::FirmwareMaker& maker) {
    session = std::make_unique<Session>(config_of_one_robot(), maker);
    remote = dynamic_cast<const RemoteFirmware*>(&session->firmware(0));
  }
  // 1 m/s forward for so long; the true speed at the end.
  double drive_ms(int ms) {
    std::vector<std::uint8_t> sink;
    RobotCommand command{};
    command.mode = OMNIHIL_MODE_BODY_VELOCITY;
    command.v_forward_m_s = 1.0;
    for (int i = 0; i < ms; ++i) {
      if (i % 20 == 0) session->command(0, command);
      session->step({}, sink);
    }
    return session->plant().truth(0).v_forward_m_s;
  }
};

Session::FirmwareMaker lock_step(const EmulatedBoard& board) {
  return remote_firmware({.url = board.url(), .lock_step = true}, config_of_one_robot());
}

TEST(RemoteFirmwareTest, a_board_drives_the_robot_as_the_same_controller_does_here) {
  OneRobot here(reference_firmware_for(config_of_one_robot()));
  const double expected_m_s = here.drive_ms(1000);
  ASSERT_GT(expected_m_s, 0.9);
  const EmulatedBoard board("");
  OneRobot run(lock_step(board));
  EXPECT_EQ(run.remote->name(), "emulated board");
  EXPECT_NEAR(run.drive_ms(1000), expected_m_s, 0.005);
  const RemoteCounts& counts = run.remote->link().counts();
  EXPECT_EQ(counts.sensors_sent, 1000U);
  EXPECT_EQ(counts.drives, 1000U);
  EXPECT_EQ(run.remote->missed_control_periods(), 0U);
  EXPECT_EQ(run.remote->link().round_trip().count(), 1000U);
  EXPECT_EQ(run.remote->link().board_time().max_ns(), 12'000);
}

TEST(RemoteFirmwareTest, the_same_board_gives_the_same_run_to_the_last_bit) {
  std::array<double, 2> x_m{};
  for (double& x : x_m) {
    const EmulatedBoard board("");
    OneRobot run(lock_step(board));
    run.drive_ms(300);
    x = run.session->plant().truth(0).x_m;
  }
  EXPECT_EQ(x_m[0], x_m[1]);
}

TEST(RemoteFirmwareTest, corrupted_answers_are_counted_and_never_acted_on) {
  const EmulatedBoard board("--corrupt 60");
  OneRobot run(lock_step(board));
  EXPECT_GT(run.drive_ms(300), 0.5);
  const omnihil_remote_decoder& d = run.remote->link().decoder();
  // frame 1 is the answer to hello; answers 59, 119, ... were damaged
  EXPECT_EQ(d.bad_crc + d.bad_cobs, 300U / 60);
  EXPECT_EQ(run.remote->missed_control_periods(), 300U / 60);
  EXPECT_EQ(run.remote->timeouts(), 300U / 60);
  EXPECT_TRUE(run.remote->failure().empty());
}

TEST(RemoteFirmwareTest, a_cut_frame_costs_itself_and_the_one_that_it_runs_into) {
  const EmulatedBoard board("--cut 100");
  OneRobot run(lock_step(board));
  EXPECT_GT(run.drive_ms(250), 0.4);
  const omnihil_remote_decoder& d = run.remote->link().decoder();
  EXPECT_EQ(d.bad_crc + d.bad_cobs, 2U);
  EXPECT_EQ(run.remote->missed_control_periods(), 4U);
}

TEST(RemoteFirmwareTest, a_board_that_falls_silent_ends_with_coasting_wheels_and_a_reason) {
  const EmulatedBoard board("--silent-after 201");
  OneRobot run(lock_step(board));
  run.drive_ms(230);
  EXPECT_NE(run.remote->failure().find("fell silent"), std::string::npos) << run.remote->failure();
  EXPECT_EQ(run.remote->missed_control_periods(), 20U);
  EXPECT_EQ(run.remote->timeouts(), 1U);
  EXPECT_EQ(run.remote->link().counts().drives, 200U);
}

TEST(RemoteFirmwareTest, in_real_time_answers_serve_the_next_period_and_silence_lets_go) {
  const EmulatedBoard board("--silent-after 101");
  OneRobot run(remote_firmware({.url = board.url(), .lock_step = false}, config_of_one_robot()));
  std::vector<std::uint8_t> sink;
  // Paced by the board itself instead of a clock: the next step when the last answer is there.
  auto& link = const_cast<RemoteLink&>(run.remote->link());
  for (int i = 0; i < 100; ++i) {
    run.session->step({}, sink);
    for (int tries = 0; link.drive_answers() < link.sensors_number() && tries < 1000; ++tries) {
      link.wait(10'000'000);
      link.poll();
    }
  }
  EXPECT_EQ(link.counts().drives, 100U);
  EXPECT_EQ(run.remote->missed_control_periods(), 0U);
  EXPECT_EQ(run.remote->timeouts(), 0U);
  for (int tries = 0; run.remote->timeouts() == 0 && tries < 1000; ++tries) {
    link.wait(5'000'000);  // nothing comes: 50 ms of silence pass
    run.session->step({}, sink);
  }
  EXPECT_EQ(run.remote->timeouts(), 1U);
  EXPECT_TRUE(run.remote->failure().empty());
}

TEST(RemoteFirmwareTest, a_device_that_goes_away_is_a_failure_with_its_name) {
  const EmulatedBoard board("--exit-after 101");
  OneRobot run(lock_step(board));
  run.drive_ms(110);
  EXPECT_NE(run.remote->failure().find("is gone: /dev/pts/"), std::string::npos) << run.remote->failure();
  EXPECT_EQ(run.remote->link().counts().drives, 100U);
}

std::string refusal(const std::string& url, const SessionConfig& config) {
  try {
    Session session(config, remote_firmware({.url = url, .lock_step = true}, config));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "it was taken";
}

TEST(RemoteFirmwareTest, a_board_that_never_answers_is_said_before_anything_runs) {
  const EmulatedBoard board("--mute");
  const std::string why = refusal(board.url(), config_of_one_robot());
  EXPECT_NE(why.find("does not answer"), std::string::npos) << why;
}

TEST(RemoteFirmwareTest, bad_words_are_named) {
  const SessionConfig one = config_of_one_robot();
  EXPECT_NE(refusal("serial:", one).find("no device"), std::string::npos);
  EXPECT_NE(refusal("serial:/dev/ttyACM0,12", one).find("baud rate \"12\""), std::string::npos);
  EXPECT_NE(refusal("serial:/dev/no_such_port", one).find("/dev/no_such_port: look up"), std::string::npos);
  EXPECT_NE(refusal("serial:/dev/ttyACM0?bauds=9600", one).find("did you mean baud?"), std::string::npos);
  SessionConfig two = one;
  two.robots.push_back(two.robots[0]);
  two.robot_ids = {0, 1};
  EXPECT_NE(refusal("serial:/dev/ttyACM0", two).find("one board for 2 robots"), std::string::npos);
}

struct Outcome {
  int exit_code = -1;
  std::string text;
};
Outcome shell(const std::string& command) {
  Outcome outcome;
  std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return outcome;
  std::array<char, 4096> buffer{};
  for (std::size_t n; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    outcome.text.append(buffer.data(), n);
  }
  const int status = ::pclose(pipe);
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

TEST(RemoteFirmwareTest, serve_runs_with_a_board_in_real_time_and_tells_latency_and_loss) {
  const EmulatedBoard board("--skip 50");
  const std::string device = testing::TempDir() + "remote_dongle";
  const Outcome run = shell(OMNIHIL_PROGRAM " serve --robots 0 --physics planar --duration 1 --device " +
                            device + " --firmware " + board.url());
  EXPECT_EQ(run.exit_code, 0) << run.text;
  for (const char* words : {"1000 sensor frames sent", "round trip p50", "refused: checksum 0"}) {
    EXPECT_NE(run.text.find(words), std::string::npos) << run.text;
  }
}

TEST(RemoteFirmwareTest, a_scenario_passes_with_a_board_as_its_firmware) {
  const EmulatedBoard board("");
  const Outcome run = shell(OMNIHIL_PROGRAM " scenario run " OMNIHIL_SOURCE_DIR
                                            "/examples/scenarios/wheel/speed_step.toml --firmware " +
                            board.url());
  EXPECT_EQ(run.exit_code, 0) << run.text;
  EXPECT_NE(run.text.find("emulated board"), std::string::npos) << run.text;
}

// The port of a real board goes through libserialport, which takes no pty unless it is made to believe.
TEST(RemoteFirmwareTest, libserialport_opens_and_carries_the_line) {
  const EmulatedBoard board("");
  const std::string log = testing::TempDir() + "serial_preload.log";
  std::remove(log.c_str());
  const Outcome run =
      shell("OMNIHIL_PRELOAD_LOG=" + log +
            " LD_PRELOAD=" OMNIHIL_BUILD_DIR "/tests/hil/firmware/board/libserial_preload.so " OMNIHIL_PROGRAM
            " scenario run " OMNIHIL_SOURCE_DIR "/examples/scenarios/wheel/speed_step.toml --firmware " +
            board.url());
  EXPECT_EQ(run.exit_code, 0) << run.text;
  std::ifstream in(log);
  const std::string calls{std::istreambuf_iterator<char>(in), {}};
  EXPECT_NE(calls.find("modem lines"), std::string::npos) << "the port was not opened by libserialport";
}

}  // namespace
}  // namespace omnihil

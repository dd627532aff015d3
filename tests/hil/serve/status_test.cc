#include "hil/serve/status.h"

#include <gtest/gtest.h>

#include <string>

namespace omnihil {
namespace {

ServeStatus driving() {
  ServeStatus s;
  s.now_ns = 62'345'678'901;
  s.steps = 62'345;
  s.wall_ns = 62'400'000'000;
  s.host_present = true;
  s.real_time = true;
  s.late_p50_ns = 36'000;
  s.late_p99_ns = 198'000;
  s.late_max_ns = 7'400'000;
  for (int i = 0; i < 1240; ++i) s.from_host.count(PacketError::kNone);
  s.from_host.count(PacketError::kChecksum);
  s.from_host.count(PacketError::kChecksum);
  s.from_host.count(PacketError::kFraming);
  s.robot_id = 3;
  s.omega_wheel_rad_s = {-30.2, 30.2, 30.24, -30.26};
  s.x_m = 1.234;
  s.yaw_rad = 3.14159265358979 / 2;
  return s;
}

bool has(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

TEST(StatusLineTest, SaysTimePacketsLatenessWheelsAndPose) {
  const std::string line = status_line(driving(), 0);
  for (const char* words :
       {"1:02.3", "host here", "1240 ok", "3 refused (framing 1, checksum 2)", "p50 36 us", "p99 198 us",
        "#3 wheels -30.2 30.2 30.2 -30.3 rad/s", "1.23 0.00 m", "90 deg"}) {
    EXPECT_TRUE(has(line, words)) << words << " in: " << line;
  }
  EXPECT_FALSE(has(line, "OVERLOADED"));
}

TEST(StatusLineTest, IsPlainAsciiAndNeverWiderThanTheTerminal) {
  ServeStatus s = driving();
  s.x_m = -1e12;
  s.omega_wheel_rad_s.fill(-1e9);
  for (const std::size_t width : {1u, 20u, 80u, 300u}) {
    const std::string line = status_line(s, width);
    EXPECT_LE(line.size(), width);
    for (const char c : line) EXPECT_TRUE(c >= ' ' && c <= '~') << static_cast<int>(c);
  }
}

TEST(StatusLineTest, AnOverloadedComputerIsSaidInLineAndReport) {
  ServeStatus s = driving();
  s.slipped_ns = 12'300'000;
  s.slips = 2;
  EXPECT_TRUE(has(status_line(s, 0), "OVERLOADED: slipped 12.3 ms"));
  EXPECT_TRUE(has(final_report(s),
                  "could not keep up: simulated time slipped 12.3 ms against wall time, in 2 places"))
      << final_report(s);
}

TEST(FinalReportTest, CountsPacketsByCauseAndSaysHowLateTheLoopWas) {
  const std::string report = final_report(driving());
  for (const char* words :
       {"62.346 s of simulated time (62345 steps)", "1240 packets good, 3 refused (framing 1, checksum 2)",
        "p50 36 us, p99 198 us, max 7.4 ms", "simulated time kept up"}) {
    EXPECT_TRUE(has(report, words)) << words << " in:\n" << report;
  }
}

TEST(FinalReportTest, FreeRunningTimeHasARatioAndNoLateness) {
  ServeStatus s = driving();
  s.real_time = false;
  s.wall_ns = s.now_ns / 50;
  EXPECT_TRUE(has(final_report(s), "50.0 x real time")) << final_report(s);
  EXPECT_FALSE(has(final_report(s), "lateness"));
}

}  // namespace
}  // namespace omnihil

// What is found on computers made up for the purpose, and on this one.
#include "hil/doctor/doctor.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "hil/league/udp_port.h"
#include "hil/text/json_text.h"
#include "tests/hil/recording/fake_run.h"

namespace omnihil {
namespace {

class MadeUpComputer : public testing::Test {
 protected:
  void file(const std::string& path, const std::string& text) {
    std::filesystem::create_directories((root() + path).substr(0, (root() + path).rfind('/')));
    fake::write_text(root() + path, text);
  }
  std::string root() const { return folder_ / "root"; }
  fake::TempFolder folder_;
};

TEST_F(MadeUpComputer, CanIsMissingThenWithoutInterfaceThenThere) {
  EXPECT_EQ(look_at_can(root()).state, FindingState::kMissing);
  EXPECT_NE(look_at_can(root()).mend.find("modprobe"), std::string::npos);
  file("/proc/net/can/version", "rev 20170425\n");
  EXPECT_EQ(look_at_can(root()).state, FindingState::kLimited);
  EXPECT_NE(look_at_can(root()).mend.find("ip link add"), std::string::npos);
  file("/sys/class/net/eth0/type", "1\n");
  EXPECT_EQ(look_at_can(root()).state, FindingState::kLimited);
  file("/sys/class/net/vcan0/type", "280\n");
  const Finding there = look_at_can(root());
  EXPECT_EQ(there.state, FindingState::kOk);
  EXPECT_EQ(there.detail, "vcan0");
  EXPECT_TRUE(there.mend.empty());
}

TEST_F(MadeUpComputer, SerialPortsAreThoseOfBoards) {
  EXPECT_EQ(look_at_serial_ports(root()).state, FindingState::kOk);
  file("/dev/tty0", "");
  file("/dev/ttyACM1", "");
  file("/dev/ttyUSB0", "");
  EXPECT_EQ(look_at_serial_ports(root()).detail, "/dev/ttyACM1, /dev/ttyUSB0");
  if (::geteuid() == 0) GTEST_SKIP() << "root may open what nobody may";
  std::filesystem::permissions(root() + "/dev/ttyACM1", std::filesystem::perms::none);
  const Finding refused = look_at_serial_ports(root());
  EXPECT_EQ(refused.state, FindingState::kLimited);
  EXPECT_NE(refused.mend.find("dialout"), std::string::npos);
}

TEST_F(MadeUpComputer, CoresAreCounted) {
  EXPECT_EQ(look_at_cores(root()).state, FindingState::kLimited);
  file("/proc/cpuinfo", "processor\t: 0\nmodel name\t: x\n\nprocessor\t: 1\n");
  EXPECT_EQ(look_at_cores(root()).detail, "2");
}

TEST(Doctor, SeesAPortThatIsTaken) {
  std::string error;
  UdpPort taken = UdpPort::listen("127.0.0.1", 0, error);
  ASSERT_TRUE(taken.is_open()) << error;
  const Finding finding = look_at_league_ports({taken.port()});
  EXPECT_EQ(finding.state, FindingState::kLimited);
  EXPECT_NE(finding.detail.find(std::to_string(taken.port())), std::string::npos);
  const int port = taken.port();
  taken = UdpPort();
  EXPECT_EQ(look_at_league_ports({port}).state, FindingState::kOk);
}

TEST(Doctor, EveryFindingSaysWhatAndThoseThatFailSayHow) {
  const std::vector<Finding> all = examine({.root = {}, .league_ports = {}, .sleeps = 5});
  EXPECT_EQ(all.size(), 10U);
  for (const Finding& f : all) {
    EXPECT_FALSE(f.what.empty());
    EXPECT_FALSE(f.detail.empty()) << f.what;
    EXPECT_EQ(f.mend.empty(), f.state == FindingState::kOk) << f.what;
  }
  const auto json = json_of(findings_json(all));
  EXPECT_EQ(json["findings"].size(), all.size());
  EXPECT_EQ(json["findings"][0]["what"], "pseudo-terminals");
  EXPECT_NE(findings_text(all).find("waking up"), std::string::npos);
}

}  // namespace
}  // namespace omnihil

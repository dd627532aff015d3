// What is found on computers made up for the purpose, and on this one.
#include "hil/doctor/doctor.h"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <nlohmann/json.hpp>

#include "hil/league/udp_port.h"
#include "hil/text/json_text.h"
#include "hil/wire/descriptor.h"
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
  file("/sys/class/net/vcan0/flags", "0x40080\n");
  const Finding down = look_at_can(root());
  EXPECT_EQ(down.state, FindingState::kLimited);
  EXPECT_EQ(down.mend, "sudo ip link set vcan0 up");
  file("/sys/class/net/vcan0/flags", "0x400c1\n");
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

TEST_F(MadeUpComputer, WhoMayNotOpenABoardIsToldBeforeOneIsPluggedIn) {
  EXPECT_EQ(look_at_serial_ports(root(), true).state, FindingState::kOk);
  const Finding barred = look_at_serial_ports(root(), false);
  EXPECT_EQ(barred.state, FindingState::kLimited);
  EXPECT_NE(barred.mend.find("dialout"), std::string::npos);
  file("/dev/ttyACM0", "");  // its own rights count, whatever the group
  EXPECT_EQ(look_at_serial_ports(root(), false).state, FindingState::kOk);
  EXPECT_EQ(is_in_group("no-such-group"), ::geteuid() == 0);
}

TEST_F(MadeUpComputer, ClockSaysItsSource) {
  file("/sys/devices/system/clocksource/clocksource0/current_clocksource", "hpet\n");
  EXPECT_NE(look_at_clock(root()).detail.find("source hpet"), std::string::npos);
  EXPECT_NE(look_at_clock(root() + "/nowhere").detail.find("source unknown"), std::string::npos);
}

TEST_F(MadeUpComputer, WiresharkWantsAProgramThenADissector) {
  const std::vector<std::string> programs{root() + "/bin"}, plugins{root() + "/none", root() + "/plugins"};
  EXPECT_NE(look_at_wireshark(programs, plugins).mend.find("apt install"), std::string::npos);
  file("/bin/tshark", "");
  std::filesystem::permissions(root() + "/bin/tshark", std::filesystem::perms::owner_all);
  EXPECT_NE(look_at_wireshark(programs, plugins).mend.find("omnihil formats"), std::string::npos);
  file("/plugins/other.lua", "-- of somebody else\n");
  EXPECT_EQ(look_at_wireshark(programs, plugins).state, FindingState::kLimited);
  std::filesystem::copy_file(OMNIHIL_SOURCE_DIR "/docs/radio/ulaval-hermes.lua",
                             root() + "/plugins/ours.lua");
  const Finding there = look_at_wireshark(programs, plugins);
  EXPECT_EQ(there.state, FindingState::kOk);
  EXPECT_NE(there.detail.find("1 dissectors in " + plugins[1]), std::string::npos) << there.detail;
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

TEST(Doctor, VisionPortIsFreeOrSharedOrHeld) {
  const auto bound = [](int& port, bool shares) {
    Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    const int yes = shares ? 1 : 0;
    ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    sockaddr_in at{};
    at.sin_family = AF_INET;
    socklen_t size = sizeof at;
    EXPECT_EQ(::bind(socket.get(), reinterpret_cast<const sockaddr*>(&at), size), 0);
    ::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&at), &size);
    port = ntohs(at.sin_port);
    return socket;
  };
  int shared_port = 0, held_port = 0;
  Descriptor shared = bound(shared_port, true), held = bound(held_port, false);
  EXPECT_NE(look_at_vision_port(shared_port).detail.find("share"), std::string::npos);
  EXPECT_EQ(look_at_vision_port(shared_port).state, FindingState::kOk);
  EXPECT_EQ(look_at_vision_port(held_port).state, FindingState::kLimited);
  held = Descriptor();
  EXPECT_NE(look_at_vision_port(held_port).detail.find("is free"), std::string::npos);
}

TEST(Doctor, MulticastByAnAddressThatIsNotOursDoesNotComeBack) {
  // 203.0.113.0/24 is for documentation (RFC 5737).
  const Finding foreign = look_at_multicast_network("224.5.23.2", 10006, {{"nowhere0", "203.0.113.7"}});
  EXPECT_EQ(foreign.state, FindingState::kLimited);
  EXPECT_NE(foreign.detail.find("nowhere0"), std::string::npos);
  EXPECT_NE(foreign.mend.find("multicast on"), std::string::npos);
  EXPECT_EQ(look_at_multicast_network("224.5.23.2", 10006, {}).state, FindingState::kLimited);
  for (const NetworkInterface& each : multicast_interfaces()) EXPECT_NE(each.address.substr(0, 4), "127.");
}

TEST(Doctor, EveryFindingSaysWhatAndThoseThatFailSayHow) {
  const std::vector<Finding> all = examine({.root = {}, .league_ports = {}, .sleeps = 5});
  EXPECT_EQ(all.size(), 14U);
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

// The virtual dongle's port against hosts that come, go, flood, stall and play with line modes.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "hil/wire/pty_wire.h"

namespace omnihil {
namespace {
namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

class PtyTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "omnihil-pty-XXXXXX").string();
    ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    device_ = (folder_ / "dongle").string();
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::unique_ptr<PtyWire> make() {
    std::string problem;
    auto port = PtyWire::open(device_, problem);
    EXPECT_EQ(problem, "");
    return port;
  }
  int open_host(int flags = O_RDWR) { return ::open(device_.c_str(), flags | O_NOCTTY | O_NONBLOCK); }
  // Reads until `n` bytes are there: the kernel hands bytes over in its own time, so it is asked again.
  static Bytes read_all(PtyWire& port, std::size_t n, std::size_t limit = 4096) {
    Bytes bytes;
    for (int tries = 0; bytes.size() < n && tries < 1'000'000; ++tries) {
      EXPECT_FALSE(port.read(bytes, limit));
    }
    return bytes;
  }
  static void read_until_closed(PtyWire& port, Bytes& bytes) {
    for (int tries = 0; tries < 1'000'000; ++tries) {
      ASSERT_FALSE(port.read(bytes, 4096));
      if (port.take_peer_closed()) return;
    }
    FAIL() << "the close was never seen";
  }
  static Bytes host_read(int host, std::size_t n) {
    Bytes bytes(n);
    std::size_t got = 0;
    for (int tries = 0; got < n && tries < 1'000'000; ++tries) {
      const ssize_t r = ::read(host, bytes.data() + got, n - got);
      if (r > 0) got += static_cast<std::size_t>(r);
    }
    bytes.resize(got);
    return bytes;
  }
  static Bytes all_values(std::size_t n) {
    Bytes bytes(n);
    std::iota(bytes.begin(), bytes.end(), std::uint8_t{0});
    return bytes;
  }

  fs::path folder_;
  std::string device_;
};

TEST_F(PtyTest, EveryByteValuePassesBothWaysForAHostThatNeverTouchesTermios) {
  auto port = make();
  const int host = open_host();
  const Bytes sent = all_values(512);
  ASSERT_EQ(::write(host, sent.data(), sent.size()), 512);
  EXPECT_EQ(read_all(*port, 512), sent);
  std::error_code error;
  EXPECT_EQ(port->write(sent, error), 512u);
  EXPECT_EQ(host_read(host, 512), sent);
  ::close(host);
}

TEST_F(PtyTest, KnowsWhetherAHostHasThePortOpen) {
  auto port = make();
  Bytes bytes;
  ASSERT_FALSE(port->read(bytes, 100));
  EXPECT_FALSE(port->peer_present());
  const int host = open_host();
  ASSERT_FALSE(port->read(bytes, 100));
  EXPECT_TRUE(port->peer_present());
  EXPECT_FALSE(port->take_peer_closed());
  ::close(host);
  ASSERT_FALSE(port->read(bytes, 100));
  EXPECT_FALSE(port->peer_present());
  EXPECT_TRUE(port->take_peer_closed());
  EXPECT_FALSE(port->take_peer_closed());  // once
}

TEST_F(PtyTest, BytesWrittenRightBeforeACloseArriveBeforeTheCloseIsSeen) {
  auto port = make();
  const int host = open_host();
  const Bytes sent = all_values(3000);
  ASSERT_EQ(::write(host, sent.data(), sent.size()), 3000);
  ::close(host);
  Bytes got;
  while (!port->take_peer_closed()) ASSERT_FALSE(port->read(got, 64));
  EXPECT_EQ(got, sent);
}

TEST_F(PtyTest, ACloseAndReopenBetweenTwoReadsIsSeenBeforeTheNewHostsBytes) {
  auto port = make();
  int host = open_host();
  ASSERT_EQ(::write(host, "half", 4), 4);
  EXPECT_EQ(read_all(*port, 4).size(), 4u);
  ::close(host);
  host = open_host();
  ASSERT_EQ(::write(host, "new", 3), 3);
  Bytes bytes;
  ASSERT_FALSE(port->read(bytes, 100));
  EXPECT_TRUE(port->take_peer_closed());
  EXPECT_TRUE(bytes.empty());
  EXPECT_TRUE(port->peer_present());
  EXPECT_EQ(read_all(*port, 3), (Bytes{'n', 'e', 'w'}));
  EXPECT_FALSE(port->take_peer_closed());
  ::close(host);
}

TEST_F(PtyTest, ASecondHostLeavingDoesNotCloseThePortOfTheFirst) {
  auto port = make();
  Bytes bytes;
  const int first = open_host();
  ASSERT_FALSE(port->read(bytes, 100));
  const int second = open_host();
  ASSERT_FALSE(port->read(bytes, 100));
  ::close(second);
  ASSERT_FALSE(port->read(bytes, 100));
  EXPECT_FALSE(port->take_peer_closed());
  EXPECT_TRUE(port->peer_present());
  ::close(first);
  ASSERT_FALSE(port->read(bytes, 100));
  EXPECT_TRUE(port->take_peer_closed());
}

TEST_F(PtyTest, AHundredHostsInARowAreAllServed) {
  auto port = make();
  for (int i = 0; i < 100; ++i) {
    const int host = open_host();
    ASSERT_GE(host, 0) << i;
    const auto byte = static_cast<std::uint8_t>(i);
    ASSERT_EQ(::write(host, &byte, 1), 1);
    ::close(host);
    Bytes got;
    read_until_closed(*port, got);
    ASSERT_EQ(got, Bytes{byte});
  }
}

TEST_F(PtyTest, AFloodIsTakenInBoundedBitesAndNothingIsLost) {
  auto port = make();
  const int host = open_host();
  const Bytes flood = all_values(1 << 20);
  Bytes got;
  std::size_t written = 0;
  while (got.size() < flood.size()) {
    const ssize_t n = ::write(host, flood.data() + written, flood.size() - written);
    if (n > 0) written += static_cast<std::size_t>(n);
    const std::size_t before = got.size();
    ASSERT_FALSE(port->read(got, 1000));
    ASSERT_LE(got.size() - before, 1000u);
  }
  EXPECT_EQ(got, flood);
  ::close(host);
}

TEST_F(PtyTest, AHostThatDoesNotReadFillsTheKernelAndWriteThenTakesNothing) {
  auto port = make();
  const int host = open_host();
  Bytes bytes;
  ASSERT_FALSE(port->read(bytes, 10));
  const Bytes block(1000, 0x5a);
  std::error_code error;
  std::size_t taken = 0;
  int full = 0;
  for (int i = 0; i < 10'000 && full < 100; ++i) {
    const std::size_t n = port->write(block, error);
    ASSERT_FALSE(error);
    taken += n;
    full = n == 0 ? full + 1 : 0;
  }
  EXPECT_EQ(full, 100);
  EXPECT_EQ(host_read(host, taken), Bytes(taken, 0x5a));  // and nothing that was taken is lost
  ::close(host);
}

TEST_F(PtyTest, NothingIsWrittenWhileNoHostIsThereAndNothingStaleMeetsTheNextOne) {
  auto port = make();
  int host = open_host();
  Bytes bytes;
  ASSERT_FALSE(port->read(bytes, 10));
  std::error_code error;
  EXPECT_EQ(port->write(Bytes(2000, 1), error), 2000u);  // the host leaves without reading
  ::close(host);
  read_until_closed(*port, bytes);
  EXPECT_EQ(port->write(Bytes{1, 2, 3}, error), 0u);
  EXPECT_FALSE(error);
  host = open_host();
  ASSERT_FALSE(port->read(bytes, 10));
  EXPECT_EQ(port->write(Bytes{7}, error), 1u);
  EXPECT_EQ(host_read(host, 1), Bytes{7});
  ::close(host);
}

TEST_F(PtyTest, CookedModesOfOneHostAreGoneForTheNext) {
  auto port = make();
  int host = open_host();
  termios modes{};
  ASSERT_EQ(::tcgetattr(host, &modes), 0);
  modes.c_lflag |= ECHO | ICANON | ISIG;
  modes.c_oflag |= OPOST | ONLCR;
  modes.c_iflag |= ICRNL | IXON;
  ::cfsetspeed(&modes, B9600);
  ASSERT_EQ(::tcsetattr(host, TCSANOW, &modes), 0);
  ::close(host);
  Bytes bytes;
  read_until_closed(*port, bytes);
  host = open_host();
  const Bytes sent = all_values(256);  // holds \r, \n, ^C, ^D, ^Q, ^S
  ASSERT_EQ(::write(host, sent.data(), sent.size()), 256);
  EXPECT_EQ(read_all(*port, 256), sent);
  std::error_code error;
  EXPECT_EQ(port->write(sent, error), 256u);
  EXPECT_EQ(host_read(host, 256), sent);
  ::close(host);
}

TEST_F(PtyTest, AHostThatGoesCookedAndThenRawAgainHasARawPort) {
  auto port = make();
  const int host = open_host();
  termios modes{};
  ASSERT_EQ(::tcgetattr(host, &modes), 0);
  const termios raw = modes;
  modes.c_lflag |= ECHO | ICANON;
  modes.c_oflag |= OPOST | ONLCR;
  ASSERT_EQ(::tcsetattr(host, TCSANOW, &modes), 0);
  ASSERT_EQ(::tcsetattr(host, TCSANOW, &raw), 0);
  ::cfsetspeed(&modes, B115200);
  const Bytes sent = all_values(256);
  ASSERT_EQ(::write(host, sent.data(), sent.size()), 256);
  EXPECT_EQ(read_all(*port, 256), sent);
  std::error_code error;
  EXPECT_EQ(port->write(sent, error), 256u);
  EXPECT_EQ(host_read(host, 256), sent);
  Bytes echoed;
  ASSERT_FALSE(port->read(echoed, 4096));
  EXPECT_TRUE(echoed.empty());
  ::close(host);
}

TEST_F(PtyTest, AHostThatDiedHoldingThePortExclusivelyDoesNotLockOutTheNext) {
  auto port = make();
  int host = open_host();
  ASSERT_EQ(::ioctl(host, TIOCEXCL), 0);
  ::close(host);
  Bytes bytes;
  read_until_closed(*port, bytes);
  host = open_host();
  ASSERT_GE(host, 0);
  ASSERT_EQ(::write(host, "x", 1), 1);
  EXPECT_EQ(read_all(*port, 1), Bytes{'x'});
  ::close(host);
}

// Root may open a port that is held exclusively, so this runs in a child that is not root.
TEST_F(PtyTest, WithoutRootAPortLeftLockedIsReplacedByAFreshOneUnderTheSameName) {
  ASSERT_EQ(::chmod(folder_.c_str(), 0777), 0);
  const auto in_child = [this] {
    if (::geteuid() == 0 && (::setgid(65534) != 0 || ::setuid(65534) != 0)) return 10;
    auto port = make();
    if (!port) return 11;
    const std::string before = port->slave_path();
    int host = open_host();
    if (host < 0 || ::ioctl(host, TIOCEXCL) != 0) return 12;
    ::close(host);
    Bytes bytes;
    read_until_closed(*port, bytes);
    if (port->slave_path() == before || fs::read_symlink(device_) != port->slave_path()) return 13;
    host = open_host();
    if (host < 0 || ::write(host, "x", 1) != 1) return 14;
    return read_all(*port, 1) == Bytes{'x'} ? 0 : 15;
  };
  EXPECT_EXIT(std::_Exit(in_child()), ::testing::ExitedWithCode(0), "");
}

TEST_F(PtyTest, TheNameIsALinkThatGoesWhenTheTransportGoes) {
  auto port = make();
  EXPECT_EQ(fs::read_symlink(device_).string(), port->slave_path());
  port.reset();
  EXPECT_FALSE(fs::exists(fs::symlink_status(device_)));
}

TEST_F(PtyTest, AFileOfThatNameIsNeverTouched) {
  std::ofstream(device_) << "precious";
  std::string problem;
  EXPECT_EQ(PtyWire::open(device_, problem), nullptr);
  EXPECT_NE(problem.find(device_), std::string::npos) << problem;
  EXPECT_NE(problem.find("a file of that name is in the way"), std::string::npos) << problem;
  std::ifstream in(device_);
  std::string text;
  in >> text;
  EXPECT_EQ(text, "precious");
}

TEST_F(PtyTest, ALinkToSomethingAliveIsNeverTouched) {
  auto other = make();
  std::string problem;
  EXPECT_EQ(PtyWire::open(device_, problem), nullptr);
  EXPECT_NE(problem.find("which exists"), std::string::npos) << problem;
  EXPECT_EQ(fs::read_symlink(device_).string(), other->slave_path());
}

TEST_F(PtyTest, ALinkThatAKilledBenchLeftIsReplaced) {
  fs::create_symlink("/dev/pts/999999", device_);
  auto port = make();
  ASSERT_NE(port, nullptr);
  EXPECT_EQ(fs::read_symlink(device_).string(), port->slave_path());
}

TEST_F(PtyTest, AFolderThatDoesNotExistIsNamed) {
  std::string problem;
  const std::string path = (folder_ / "nowhere" / "dongle").string();
  EXPECT_EQ(PtyWire::open(path, problem), nullptr);
  EXPECT_NE(problem.find("nowhere does not exist"), std::string::npos) << problem;
}

TEST_F(PtyTest, ANameThatSomebodyElseTookMeanwhileIsLeftAlone) {
  auto port = make();
  fs::remove(device_);
  std::ofstream(device_) << "theirs";
  port.reset();
  EXPECT_TRUE(fs::is_regular_file(device_));
}

}  // namespace
}  // namespace omnihil

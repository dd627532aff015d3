// What passes a tap: every byte in its order, whatever the wires take at once; and what is recorded of it.
#include "hil/tap/tap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <random>

namespace omnihil {
namespace {

using Bytes = std::vector<std::uint8_t>;

// A wire in memory: bytes that will arrive, bytes that were written, how many it takes at once.
struct Line {
  std::deque<std::uint8_t> arrives;
  Bytes written;
  std::size_t takes = 1'000'000;
  bool present = true, closed = false;
  std::error_code error;
};

class MemoryWire : public ByteWire {
 public:
  MemoryWire(Line& line, std::string_view name) : line_(line), name_(name) {}
  std::string_view name() const override { return name_; }
  std::error_code read(Bytes& out, std::size_t limit) override {
    if (line_.error) return line_.error;
    for (std::size_t n = 0; n < limit && !line_.arrives.empty(); ++n) {
      out.push_back(line_.arrives.front());
      line_.arrives.pop_front();
    }
    return {};
  }
  std::size_t write(std::span<const std::uint8_t> bytes, std::error_code& error) override {
    error.clear();
    const std::size_t sent = std::min(bytes.size(), line_.takes);
    line_.written.insert(line_.written.end(), bytes.begin(),
                         bytes.begin() + static_cast<std::ptrdiff_t>(sent));
    return sent;
  }
  bool peer_present() const override { return line_.present; }
  bool take_peer_closed() override { return std::exchange(line_.closed, false); }

 private:
  Line& line_;
  std::string_view name_;
};

struct Recorder : SessionObserver {
  Bytes from_host, from_dongle;
  std::vector<std::int64_t> host_ns, dongle_ns, closed_ns;
  void host_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) override {
    from_host.insert(from_host.end(), bytes.begin(), bytes.end());
    host_ns.push_back(now_ns);
  }
  void dongle_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) override {
    from_dongle.insert(from_dongle.end(), bytes.begin(), bytes.end());
    dongle_ns.push_back(now_ns);
  }
  void host_closed(std::int64_t now_ns) override { closed_ns.push_back(now_ns); }
};

struct Bench {
  Line host, dongle;
  Recorder recorder;
  Tap tap{std::make_unique<MemoryWire>(host, "pty:./dongle"),
          std::make_unique<MemoryWire>(dongle, "/dev/ttyACM0"), &recorder, 1'000'000};
};

TEST(Tap, EveryByteArrivesInItsOrderWhateverIsTakenAtOnce) {
  std::mt19937_64 random(1);
  Bench b;
  Bytes from_host, from_dongle;
  for (int n = 0; n < 5000; ++n) {
    for (auto [line, all] : {std::pair(&b.host, &from_host), std::pair(&b.dongle, &from_dongle)}) {
      for (std::size_t k = random() % 40; k > 0; --k) {
        line->arrives.push_back(static_cast<std::uint8_t>(random()));
        all->push_back(line->arrives.back());
      }
      line->takes = random() % 60;
    }
    ASSERT_TRUE(b.tap.pass(1000 * n));
  }
  b.host.takes = b.dongle.takes = 1'000'000;
  for (int n = 0; n < 100; ++n) ASSERT_TRUE(b.tap.pass(5'000'000 + n));
  EXPECT_EQ(b.dongle.written, from_host);
  EXPECT_EQ(b.host.written, from_dongle);
  EXPECT_EQ(b.recorder.from_host, from_host);
  EXPECT_EQ(b.recorder.from_dongle, from_dongle);
  EXPECT_EQ(b.tap.counts().to_dongle, from_host.size());
  EXPECT_EQ(b.tap.counts().to_host, from_dongle.size());
}

TEST(Tap, AHostsBytesAreRecordedAtTheNextStepADonglesWhenTheyCame) {
  Bench b;
  b.host.arrives = {1};
  b.dongle.arrives = {2};
  ASSERT_TRUE(b.tap.pass(2'300'000));
  EXPECT_EQ(b.recorder.host_ns, std::vector<std::int64_t>{3'000'000});
  EXPECT_EQ(b.recorder.dongle_ns,
            std::vector<std::int64_t>{3'000'000});  // the recording's time never goes back
  b.dongle.arrives = {4};
  ASSERT_TRUE(b.tap.pass(3'300'000));
  EXPECT_EQ(b.recorder.dongle_ns.back(), 3'300'000);
}

TEST(Tap, ADongleThatTakesNothingStopsTheHostAtItsOwnPort) {
  Bench b;
  b.dongle.takes = 0;
  b.host.arrives.assign(200'000, 7);
  for (int n = 0; n < 100; ++n) ASSERT_TRUE(b.tap.pass(n));
  EXPECT_EQ(b.tap.counts().most_waiting, Tap::kMostWaiting);
  EXPECT_EQ(b.host.arrives.size(), 200'000u - Tap::kMostWaiting);
  b.dongle.takes = 1'000'000;
  for (int n = 0; n < 100; ++n) ASSERT_TRUE(b.tap.pass(100 + n));
  EXPECT_EQ(b.dongle.written.size(), 200'000u);
}

TEST(Tap, WithoutAHostADonglesBytesAreRecordedAndDropped) {
  Bench b;
  b.host.present = false;
  b.dongle.arrives = {1, 2, 3};
  ASSERT_TRUE(b.tap.pass(0));
  EXPECT_EQ(b.recorder.from_dongle, (Bytes{1, 2, 3}));
  EXPECT_EQ(b.tap.counts().without_host, 3u);
  b.host.present = true;
  ASSERT_TRUE(b.tap.pass(1));
  EXPECT_TRUE(b.host.written.empty());  // what is stale is not handed to the next host
}

TEST(Tap, AHostThatLeavesIsRecorded) {
  Bench b;
  b.host.closed = true;
  ASSERT_TRUE(b.tap.pass(1'500'000));
  EXPECT_EQ(b.recorder.closed_ns, std::vector<std::int64_t>{2'000'000});
  EXPECT_EQ(b.tap.counts().host_left, 1u);
}

TEST(Tap, ADongleThatGoesAwayIsNamed) {
  Bench b;
  b.dongle.error = std::make_error_code(std::errc::no_such_device);
  EXPECT_FALSE(b.tap.pass(0));
  EXPECT_EQ(b.tap.problem().find("/dev/ttyACM0: "), 0u) << b.tap.problem();
}

}  // namespace
}  // namespace omnihil

// The host port against a transport of the test's own: what is held back, what is dropped, in which order.
#include "hil/serve/serve_port.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <vector>

namespace omnihil {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr std::int64_t kMs = 1'000'000;

class FakeWire : public ByteWire {
 public:
  std::string_view name() const override { return "fake:"; }
  std::error_code read(Bytes& out, std::size_t limit) override {
    largest_bite = std::max(largest_bite, limit);
    for (; limit > 0 && !from_host.empty(); --limit) {
      out.push_back(from_host.front());
      from_host.pop_front();
    }
    if (leaves_when_empty && from_host.empty()) {
      leaves_when_empty = present = false;
      closed = true;
    }
    return {};
  }
  std::size_t write(std::span<const std::uint8_t> bytes, std::error_code& error) override {
    error.clear();
    const std::size_t n = std::min(bytes.size(), host_takes);
    host_takes -= n;
    to_host.insert(to_host.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n));
    return n;
  }
  bool peer_present() const override { return present; }
  bool take_peer_closed() override { return std::exchange(closed, false); }

  std::deque<std::uint8_t> from_host;
  Bytes to_host;
  std::size_t host_takes = 1'000'000;
  std::size_t largest_bite = 0;
  bool present = true;
  bool closed = false;
  bool leaves_when_empty = false;
};

Bytes take(HostPort& port, std::int64_t now_ns) {
  Bytes host;
  EXPECT_FALSE(port.receive(now_ns, host));
  return host;
}

TEST(HostPortTest, TakesNoMoreThanItsBiteFromAFloodPerStep) {
  FakeWire transport;
  transport.from_host.assign(10'000, 0x11);
  HostPort port(transport, {}, {.bite_bytes = 4096, .queue_bytes = 100});
  EXPECT_EQ(take(port, 0).size(), 4096u);
  EXPECT_EQ(take(port, kMs).size(), 4096u);
  EXPECT_EQ(take(port, 2 * kMs).size(), 10'000u - 2 * 4096u);
}

TEST(HostPortTest, AHostOnAUartIsAdmittedAtTheLinesRateAndLosesNothing) {
  FakeWire transport;
  transport.from_host.assign(3000, 0x22);
  HostPort port(transport, {115200, 10}, {.bite_bytes = 512, .queue_bytes = 100});
  std::size_t admitted = 0;
  for (int ms = 0; ms <= 100; ++ms) admitted += take(port, ms * kMs).size();
  EXPECT_EQ(admitted, 1152u);  // 0.1 s * 11520 bytes/s
  // The rest waits: what the line's buffer holds, and the others in the host's own port.
  EXPECT_LE(transport.from_host.size(), 3000u - 1152u);
  EXPECT_GE(transport.from_host.size(), 3000u - 1152u - 512u);
}

TEST(HostPortTest, AnswersLeaveAtTheLinesRate) {
  FakeWire transport;
  HostPort port(transport, {9600, 10}, {});
  take(port, 0);
  ASSERT_FALSE(port.send(0, Bytes(2000, 0x33)));
  for (int ms = 1; ms <= 1000; ++ms) ASSERT_FALSE(port.send(ms * kMs, {}));
  EXPECT_EQ(transport.to_host.size(), 960u);
}

TEST(HostPortTest, AHostThatDoesNotReadLosesWholeAnswersTheNewestFirst) {
  FakeWire transport;
  transport.host_takes = 0;
  HostPort port(transport, {}, {.bite_bytes = 64, .queue_bytes = 100});
  take(port, 0);
  for (std::uint8_t k = 0; k < 10; ++k) ASSERT_FALSE(port.send(k * kMs, Bytes(30, k)));
  EXPECT_EQ(port.counts().answers_dropped, 7u);  // 3 * 30 <= 100 < 4 * 30
  EXPECT_EQ(port.counts().bytes_dropped, 210u);
  transport.host_takes = 1000;
  ASSERT_FALSE(port.send(20 * kMs, {}));
  Bytes expected;
  for (std::uint8_t k = 0; k < 3; ++k) expected.insert(expected.end(), 30, k);
  EXPECT_EQ(transport.to_host, expected);
  ASSERT_FALSE(port.send(21 * kMs, Bytes(30, 99)));  // and there is room again
  EXPECT_EQ(port.counts().answers_dropped, 7u);
  EXPECT_EQ(port.counts().bytes_to_host, 120u);
}

TEST(HostPortTest, AHostThatReadsByDribletsGetsEveryByteInOrder) {
  FakeWire transport;
  HostPort port(transport, {}, {.bite_bytes = 64, .queue_bytes = 1000});
  take(port, 0);
  Bytes sent;
  for (int k = 0; k < 400; ++k) {
    const Bytes answer(5, static_cast<std::uint8_t>(k));
    transport.host_takes = k % 3 == 0 ? 16 : 0;
    ASSERT_FALSE(port.send(k * kMs, answer));
    sent.insert(sent.end(), answer.begin(), answer.end());
  }
  transport.host_takes = 10'000;
  ASSERT_FALSE(port.send(1000 * kMs, {}));
  EXPECT_EQ(transport.to_host, sent);
  EXPECT_EQ(port.counts().answers_dropped, 0u);
}

TEST(HostPortTest, ACloseComesAfterEveryByteThatIsStillOnTheLine) {
  FakeWire transport;
  transport.from_host.assign(100, 0x44);
  transport.leaves_when_empty = true;
  HostPort port(transport, {115200, 10}, {.bite_bytes = 512, .queue_bytes = 100});
  std::size_t admitted = 0;
  int ms = 0;
  do {
    admitted += take(port, ms * kMs).size();
    ++ms;
    ASSERT_LT(ms, 100);
  } while (!port.take_host_closed());
  EXPECT_EQ(admitted, 100u);
  EXPECT_EQ(ms, 10);  // 100 bytes need 8.68 ms: seen at the 9 ms step, the tenth
  EXPECT_FALSE(port.take_host_closed());
}

TEST(HostPortTest, WhatTheLastHostLeftUnreadIsNotGivenToTheNext) {
  FakeWire transport;
  transport.host_takes = 0;
  HostPort port(transport, {}, {});
  take(port, 0);
  ASSERT_FALSE(port.send(0, Bytes(50, 1)));
  transport.closed = true;
  transport.present = false;
  take(port, kMs);
  EXPECT_TRUE(port.take_host_closed());
  EXPECT_EQ(port.counts().bytes_left_behind, 50u);
  ASSERT_FALSE(port.send(kMs, Bytes(20, 2)));
  EXPECT_EQ(port.counts().bytes_without_host, 20u);
  transport.present = true;
  transport.host_takes = 1000;
  take(port, 2 * kMs);
  ASSERT_FALSE(port.send(2 * kMs, Bytes(3, 3)));
  EXPECT_EQ(transport.to_host, Bytes(3, 3));
  EXPECT_EQ(port.counts().hosts, 2u);
}

TEST(CarrierPaceTest, OnlyAUartHasAPace) {
  EXPECT_EQ(carrier_pace({Carrier::Kind::kUart, 115200, 10}).baud, 115200);
  EXPECT_EQ(carrier_pace({Carrier::Kind::kUsbCdc, 115200, 10}).baud, 0);
  EXPECT_EQ(carrier_pace({Carrier::Kind::kUdp, 0, 10}).baud, 0);
}

}  // namespace
}  // namespace omnihil

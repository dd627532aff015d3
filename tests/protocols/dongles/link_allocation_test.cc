// Once warm, a link allocates nothing: not for commands, not for answers, not for garbage.
#include "tests/count_allocations.h"
#include "tests/protocols/dongles/links_harness.h"

namespace omnihil {
namespace {

struct CountingSink final : RadioSink {
  std::uint64_t deliveries = 0;
  void deliver(const Delivery&, std::int64_t) override { ++deliveries; }
};

void run(RadioLink& link, const Bytes& bytes, RadioSink& sink, Bytes& out, std::int64_t from_ms,
         std::int64_t to_ms) {
  const RobotFeedback feedback{};
  const RobotGains gains{};
  for (std::int64_t t_ms = from_ms; t_ms < to_ms; ++t_ms) {
    if (t_ms % 20 == 0) link.host_bytes(bytes, t_ms * kMs);
    link.poll(t_ms * kMs, sink);
    for (int id = 0; id < 4; ++id) link.robot_feedback(id, feedback, gains, t_ms * kMs);
    out.clear();
    link.take_host_bytes(t_ms * kMs, out);
  }
}

// Every format there is, by the command a host sends; the handshake stands in the warm-up.
TEST(LinkAllocationTest, WarmLinkOfAnyFormatAllocatesNothing) {
  for (const RadioFormat* format : radio_formats()) {
    if (!format->has_dongle()) continue;
    Bench bench(*format,
                {.robot_ids = format->names_robots() ? std::vector<int>{0, 1, 2, 3} : std::vector<int>{1}});
    RobotCommand command{};
    command.mode = OMNIHIL_MODE_BODY_VELOCITY;
    command.flags = OMNIHIL_COMMAND_YAW_TARGET;
    Bytes bytes;
    if (!format->encode_command(command, {.robot_id = 1}, bytes)) {
      command.flags = 0;
      ASSERT_TRUE(format->encode_command(command, {.robot_id = 1}, bytes)) << format->id;
    }
    CountingSink sink;
    Bytes out;
    out.reserve(1 << 16);
    run(*bench.link, bytes, sink, out, 0, 2000);
    const std::uint64_t warm = sink.deliveries;
    const std::uint64_t before = allocations;
    run(*bench.link, bytes, sink, out, 2000, 4000);
    EXPECT_EQ(allocations - before, 0u) << format->id;
    EXPECT_GT(sink.deliveries, warm) << format->id;
  }
}

TEST(LinkAllocationTest, WarmLinkAllocatesNothing) {
  const Bytes garbage(50, 0xA5);
  for (const char* id : {"ulaval-hermes", "roboteam-rem-v8", "roboteam-rem-v5"}) {
    Bench bench(id, {.robot_ids = {0, 1, 2, 3}});
    Bytes bytes;
    if (bench.format.id == "ulaval-hermes") {
      bytes = bench.encode("SPEED_MOVE", {{"robot", 1}}) + bench.encode("GET_BATTERIE", {{"robot", 2}}) +
              garbage + Bytes{0};
    } else {
      bytes = bench.encode("REM_RobotCommand", {{"toRobotId", 1}}) +
              bench.encode("REM_RobotGetPIDGains", {{"toRobotId", 2}}) +
              bench.encode("REM_RobotAssuredPacket", {{"toRobotId", 3}}) + garbage;
    }
    CountingSink sink;
    Bytes out;
    out.reserve(1 << 16);
    run(*bench.link, bytes, sink, out, 0, 2000);
    const std::uint64_t warm = sink.deliveries;
    const std::uint64_t before = allocations;
    ASSERT_GT(before, 0u);  // the counter counts
    run(*bench.link, bytes, sink, out, 2000, 4000);
    EXPECT_EQ(allocations - before, 0u) << id;
    EXPECT_GT(sink.deliveries, warm) << id;
  }
}

}  // namespace
}  // namespace omnihil

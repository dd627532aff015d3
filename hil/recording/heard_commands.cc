#include "hil/recording/heard_commands.h"

#include <memory>

#include "hil/recording/command_values.h"

namespace omnihil {
namespace {

class Listener : public RadioSink {
 public:
  explicit Listener(std::vector<HeardCommand>& heard) : heard_(heard) {}
  void deliver(const Delivery& delivery, std::int64_t now_ns) override {
    if (delivery.kind == Delivery::Kind::kCommand)
      heard_.push_back({now_ns, delivery.robot_id, delivery.command});
  }

 private:
  std::vector<HeardCommand>& heard_;
};

}  // namespace

std::vector<HeardCommand> heard_commands(const Recording& recording, const RadioFormat& format) {
  if (!format.has_dongle()) return {};
  RadioLinkConfig config;
  config.robot_ids = recording.header.robot_ids;
  config.team = recording.header.team;
  const std::unique_ptr<RadioLink> link = format.make_link(config);
  std::vector<HeardCommand> heard;
  Listener listener(heard);
  std::vector<std::uint8_t> unread;
  const std::int64_t step_ns = recording.header.step_ns > 0 ? recording.header.step_ns : 1'000'000;
  std::int64_t now_ns = 0;
  const auto until = [&](std::int64_t end_ns) {
    for (; now_ns < end_ns; now_ns += step_ns) {
      link->poll(now_ns, listener);
      for (const int id : config.robot_ids) link->robot_feedback(id, RobotFeedback{}, RobotGains{}, now_ns);
      link->take_host_bytes(now_ns, unread);
      unread.clear();
    }
  };
  for (const RecordedChunk& chunk : recording.chunks) {
    if (chunk.kind == RecordedChunk::Kind::kHostBytes) {
      until(chunk.now_ns);
      link->host_bytes(chunk.bytes, chunk.now_ns);
    } else if (chunk.kind == RecordedChunk::Kind::kCommand) {
      until(chunk.now_ns);
      heard.push_back({chunk.now_ns, chunk.robot_id, command_of(chunk.sample)});
    }
  }
  until(now_ns + 100 * step_ns);  // what the last bytes are followed by
  return heard;
}

}  // namespace omnihil

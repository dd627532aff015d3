#include "hil/recording/heard_commands.h"

#include <utility>

#include "hil/recording/command_values.h"

namespace omnihil {

class CommandListener::Sink : public RadioSink {
 public:
  void deliver(const Delivery& delivery, std::int64_t now_ns) override {
    if (delivery.kind == Delivery::Kind::kCommand)
      heard.push_back({now_ns, delivery.robot_id, delivery.command});
  }
  std::vector<HeardCommand> heard;
};

CommandListener::CommandListener(const RadioFormat& format, const std::vector<int>& robot_ids, Team team,
                                 std::int64_t step_ns)
    : sink_(std::make_unique<Sink>()), ids_(robot_ids), step_ns_(step_ns > 0 ? step_ns : 1'000'000) {
  if (!format.has_dongle()) return;
  RadioLinkConfig config;
  config.robot_ids = robot_ids;
  config.team = team;
  link_ = format.make_link(config);
}

CommandListener::~CommandListener() = default;

void CommandListener::until(std::int64_t end_ns) {
  if (!link_) return;
  for (; now_ns_ < end_ns; now_ns_ += step_ns_) {
    link_->poll(now_ns_, *sink_);
    for (const int id : ids_) link_->robot_feedback(id, RobotFeedback{}, RobotGains{}, now_ns_);
    link_->take_host_bytes(now_ns_, unread_);
    unread_.clear();
  }
}

void CommandListener::host_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) {
  until(now_ns);
  if (link_) link_->host_bytes(bytes, now_ns);
}

std::vector<HeardCommand> CommandListener::take() { return std::exchange(sink_->heard, {}); }

std::vector<HeardCommand> heard_commands(const Recording& recording, const RadioFormat& format) {
  if (!format.has_dongle()) return {};
  const std::int64_t step_ns = recording.header.step_ns > 0 ? recording.header.step_ns : 1'000'000;
  CommandListener listener(format, recording.header.robot_ids, recording.header.team, step_ns);
  std::vector<HeardCommand> heard;
  const auto take = [&] {
    for (HeardCommand& c : listener.take()) heard.push_back(std::move(c));
  };
  std::int64_t last_ns = 0;
  for (const RecordedChunk& chunk : recording.chunks) {
    if (chunk.kind == RecordedChunk::Kind::kHostBytes) {
      listener.host_bytes(chunk.now_ns, chunk.bytes);
    } else if (chunk.kind == RecordedChunk::Kind::kCommand) {
      listener.until(chunk.now_ns);
      take();
      heard.push_back({chunk.now_ns, chunk.robot_id, command_of(chunk.sample)});
    } else {
      continue;
    }
    last_ns = chunk.now_ns;
  }
  listener.until((last_ns + step_ns - 1) / step_ns * step_ns +
                 100 * step_ns);  // what the last bytes are followed by
  take();
  return heard;
}

}  // namespace omnihil

// What a host commanded in a recording: its bytes through the team's dongle, without robots or a loss on the air.
//
//   for (const HeardCommand& c : heard_commands(recording, format)) use(c.now_ns, c.robot_id, c.command);
//
// While they come, byte by byte: CommandListener.
// In the order of their times. Commands past the radio (a scenario's) are among them. Robots answer with silence's
// feedback, so that formats with a handshake have theirs.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "hil/recording/recording.h"
#include "protocols/radio_format.h"

namespace omnihil {

struct HeardCommand {
  std::int64_t now_ns = 0;
  int robot_id = 0;
  RobotCommand command{};
};

class CommandListener {
 public:
  // Formats without a dongle: nothing is ever heard.
  CommandListener(const RadioFormat& format, const std::vector<int>& robot_ids, Team team,
                  std::int64_t step_ns);
  ~CommandListener();
  void host_bytes(std::int64_t now_ns,
                  std::span<const std::uint8_t> bytes);  // the dongle lives up to there before
  void until(std::int64_t now_ns);
  std::vector<HeardCommand> take();  // since the last time

 private:
  class Sink;
  std::unique_ptr<RadioLink> link_;
  std::unique_ptr<Sink> sink_;
  std::vector<int> ids_;
  std::int64_t step_ns_, now_ns_ = 0;
  std::vector<std::uint8_t> unread_;
};

std::vector<HeardCommand> heard_commands(const Recording& recording, const RadioFormat& format);

}  // namespace omnihil

// A team's dongle and the radio ends of its robots: bytes of the AI host in, commands for robots out;
// feedback of robots in, bytes for the AI host out. Pure: a function of bytes and the times they came,
// so a recording replays to the same bytes.
//
// Call order, once per loop step at virtual time now_ns:
//
//   link.host_bytes(bytes, now_ns);            // what the host wrote since the last step, if anything
//   link.poll(now_ns, sink);                   // -> sink.deliver(...) for each frame that reached a robot
//   link.robot_frame(robot, frame, now_ns);    // a frame the firmware itself sent (radio_transmit)
//   link.robot_feedback(robot, fb, gains, now_ns); // state for the telemetry the link writes for the robot
//   link.take_host_bytes(now_ns, out);         // bytes that have left the dongle towards the host by now
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "firmware_iface/robot_io.h"
#include "protocols/packet_error.h"
#include "protocols/radio_air.h"

namespace omnihil {

enum class Team : std::uint8_t { kYellow, kBlue };

struct RadioLinkConfig {
  std::vector<int> robot_ids;  // robots that exist, ascending
  Team team = Team::kYellow;
  // True: frames are handed to the firmware as bytes and the firmware answers with frames.
  // False: the link decodes commands and writes telemetry from RobotFeedback itself.
  bool firmware_decodes = false;
  std::uint64_t epoch_ms = 0;   // Unix time at virtual time 0, for formats that stamp their packets
  RadioAir* air = nullptr;      // what is lost on the way; not owned; null: nothing
  double wheel_radius_m = 0.0;  // for formats that carry rim speeds instead of wheel speeds
};

// One thing that reached one robot. Exactly one of the three is meant, by `kind`.
struct Delivery {
  enum class Kind : std::uint8_t { kCommand, kFrame, kGains } kind = Kind::kCommand;
  int robot_id = 0;
  RobotCommand command{};
  RobotGains gains{};
  std::span<const std::uint8_t> frame;  // valid during the call only
  std::string_view message;             // name of the packet it came from
};

class RadioSink {
 public:
  virtual ~RadioSink() = default;
  virtual void deliver(const Delivery& delivery, std::int64_t now_ns) = 0;
};

class RadioLink {
 public:
  virtual ~RadioLink() = default;
  virtual void host_bytes(std::span<const std::uint8_t> bytes, std::int64_t now_ns) = 0;
  virtual void poll(std::int64_t now_ns, RadioSink& sink) = 0;
  virtual void robot_frame(int robot_id, std::span<const std::uint8_t> frame, std::int64_t now_ns) = 0;
  virtual void robot_feedback(int robot_id, const RobotFeedback& feedback, const RobotGains& gains,
                              std::int64_t now_ns) = 0;
  virtual void take_host_bytes(std::int64_t now_ns, std::vector<std::uint8_t>& out) = 0;
  // The host closed its port: a half-received frame is dropped (and counted), queues for it are emptied.
  virtual void host_closed(std::int64_t now_ns) = 0;
  virtual const PacketCounts& from_host() const = 0;    // packets the host sent
  virtual const PacketCounts& from_robots() const = 0;  // packets robots sent, as the dongle saw them
};

}  // namespace omnihil

// Feeds a recorded host's bytes through the loop again, at the virtual times at which they came.
//
//   Recording recording = load_recording("drive.omnirec");
//   Session session(session_config(session_setup(recording.header)), make_firmware);
//   RecordingMemory answer(recording.header);
//   replay(recording, session, &answer);              // as fast as it goes, no clock is read
//   Recording again = answer.take(session.now_ns());
//
// The loop is a pure function of its configuration and of the (time, bytes) sequence, so the same program
// gives the same bytes and the same samples, whatever the computer is doing beside it.
#pragma once
#include <string>
#include <vector>

#include "hil/recording/recording.h"

namespace omnihil {

// One observer that hands everything on to several, in order.
class ObserverList : public SessionObserver {
 public:
  explicit ObserverList(std::vector<SessionObserver*> observers) : observers_(std::move(observers)) {}
  void add(SessionObserver* observer) { observers_.push_back(observer); }
  void host_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) override;
  void dongle_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) override;
  void delivery(std::int64_t now_ns, const Delivery& delivery) override;
  void robot_tick(std::int64_t now_ns, const RobotSample& sample) override;
  void host_closed(std::int64_t now_ns) override;
  void command(std::int64_t now_ns, int robot_id, const RobotCommand& command) override;
  void placed(std::int64_t now_ns, int robot_id, double x_m, double y_m, double yaw_rad) override;
  void field_input(std::int64_t now_ns, FieldInput kind, int robot_id,
                   std::span<const double> values) override;
  void opponents_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) override;
  void world(std::int64_t now_ns, const World& world) override;

 private:
  std::vector<SessionObserver*> observers_;  // not owned
};

// What stands in the way of a replay, one line each: host bytes at a time that is no loop step, or bytes
// and a close at one time in an order that the loop does not make.
std::vector<std::string> replay_problems(const Recording& recording);

// Runs from the session's start to the recording's end. The session must be fresh and have the header's step.
// Throws BadRecording for replay_problems(), and what Session::step throws.
void replay(const Recording& recording, Session& session, SessionObserver* observer);

}  // namespace omnihil

// A dongle that does no more than pass frames on, and the radio ends of its robots: for formats whose stick
// is a serial port with a radio behind it.
//
//   host -> SizedStream -> (after to_robot_ns) robot -> answer -> (after to_host_ns) host
//
//   static constexpr PlainDongle kDongle{.to_robot_ns = 500'000, .to_host_ns = 500'000, .kicks_once = true};
//   RadioFormat format{.dongle = plain_dongle<kDongle>, …};
//
// A frame goes to the robot that its table's fields of role kRobot, kTeam, kAllRobots name, or to the only robot
// there is where they name none; packets of role
// kCommand and kSingleCommand become commands, those of role kKill let the wheels run free.
// Cannot: frames that share one air packet, retries; two frames on the air do not wait for each
// other. Write a dongle of its own for those (hermes_dongle.cc, rem_dongle.cc).
#pragma once
#include "protocols/dongles/sized_stream.h"
#include "protocols/radio_format.h"

namespace omnihil {

struct PlainDongle {
  // As in sized_stream.h; frames have at most 255 bytes. Null: by tables and framing (table_frames.h).
  std::optional<std::size_t> (*frame_bytes)(std::span<const std::uint8_t> front) = nullptr;
  std::string_view silent_line{};  // a frame that hosts write before the others: taken, and nothing happens
  // What the only robot writes back to that line. Null: nothing.
  void (*line_answer)(int id, std::vector<std::uint8_t>& out) = nullptr;
  std::int64_t half_frame_ns = 0;  // how long a half frame waits for its rest; 0: for ever
  std::int64_t to_robot_ns = 0;    // last byte from the host until the robot has it
  std::int64_t to_host_ns = 0;     // the robot has a frame until its answer is at the host
  // What a packet asks of robot `id`. Null: by the meaning of its fields (meaning.h), and so the answer.
  RobotCommand (*to_command)(const Values& values, int id) = nullptr;
  bool kicks_once = false;  // a kick acts when the packet before asked for none; one that stays does not
  // The robots that a packet is for, where roles of fields do not say it: their number, and their ids. Null: roles.
  std::size_t (*robots)(const Values& values, std::span<int, 16> ids) = nullptr;
  bool to_everybody =
      false;  // hosts write to every robot that there may be: one that is not there is no fault
  // A frame that lists packets gives each robot its turn, this long after the one before, and is answered after
  // the last by one frame that lists the answers.
  std::int64_t turn_ns = 0;
  std::int64_t answer_gap_ns = 0;  // answers reach the host at least this far apart
  // What the dongle itself answers to a packet for it. Null: nothing.
  bool (*dongle_answer)(const Values& to_dongle, Values& out) = nullptr;
  // Fills `out`, its message included, with what robot `id` answers to a packet. False: nothing. Null: robots
  // never answer.
  bool (*answer)(const Values& to_robot, int id, const RobotFeedback& feedback, Values& out) = nullptr;
  // Puts into each answer what the robot remembers of earlier packets, and remembers this one. `kept` begins as 0.
  void (*remember)(const Values& to_robot, std::uint32_t& kept, Values& answer) = nullptr;
  // What each robot says by itself, this often; 0: nothing. `tell` fills `out`, its message included.
  std::int64_t tell_every_ns = 0;
  void (*tell)(int id, const RobotFeedback& feedback, Values& out) = nullptr;
};

// `format` outlives the link.
std::unique_ptr<RadioLink> make_plain_dongle(const RadioFormat& format, const RadioLinkConfig& config,
                                             const PlainDongle& plain);

// The same as RadioFormat::dongle has it.
template <const PlainDongle& kPlain>
std::unique_ptr<RadioLink> plain_dongle(const RadioFormat& format, const RadioLinkConfig& config) {
  return make_plain_dongle(format, config, kPlain);
}

}  // namespace omnihil

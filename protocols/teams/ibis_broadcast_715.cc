// ibis-ssl Orion, 2026: one datagram with the commands of eleven robots to all of them, and each one's 128 bytes back.
//
//   to all        eleven times: robot · the 64 bytes of ibis-robot-command-v2
//   from a robot  the 128 bytes of its feedback
//
// Source: ibis-ssl/Orion_CM4 28c3ca0 (forward_ai_cmd_v2.cpp, doc/control_packet.md, doc/feedback_packet.md).
#include <array>

#include "protocols/dongles/plain_dongle.h"
#include "protocols/ibis_robot.h"
#include "protocols/teams/ibis_rows.h"

namespace omnihil {
namespace {

constexpr std::size_t kSlots = 11, kSlotBytes = 65;
constexpr std::uint8_t kNobody = 0xFF;  // choice: the last byte of no robot's address
constexpr std::array kFirstBytes{
    with_role(FieldRole::kRobot,
              number("robot_id", 8, "", "the robot: the last byte of its address less 100")),
    // The robot does not look at it; a feedback cut short would be a command without it.
    enveloped(constant("header", 8, 0, "always 0 by their host")),
};
constexpr std::array<Field, 0> kNothing{};
using Tables = ibis::Tables<kFirstBytes, kNothing>;

bool encode_command(const RobotCommand& command, const CommandTo& to, std::vector<std::uint8_t>& out) {
  if (to.robot_id < 0 || to.robot_id >= kNobody) return false;
  if (!ibis::encode_command(Tables::kMessages, command, out, to.robot_id)) return false;
  for (std::size_t slot = 1; slot < kSlots; ++slot) {
    out.push_back(kNobody);
    out.insert(out.end(), kSlotBytes - 1, 0);
  }
  return true;
}

// Inside a robot as with ibis-robot-command-v2: its CM4 looks every millisecond, then 72 bytes at 1 Mbaud; back 128.
constexpr PlainDongle kDongle{
    .frame_bytes = [](std::span<const std::uint8_t>) -> std::optional<std::size_t> { return kSlotBytes; },
    .half_frame_ns = 5'000'000,
    .to_robot_ns = 1'000'000 + 72 * 10'000,
    .to_host_ns = 128 * 10'000,
    .to_command = [](const Values& values, int) { return ibis::to_command(values); },
    .to_everybody = true,
    .answer = [](const Values& to_robot, int, const RobotFeedback& feedback,
                 Values& out) { return ibis::answer(Tables::kMessages, to_robot, feedback, out); },
};

constinit const RadioFormat kFormat{
    .id = "ibis-broadcast-715",
    .title = "ibis-ssl Orion: commands of eleven robots in one datagram (2026)",
    .source = "https://github.com/ibis-ssl/Orion_CM4 at 28c3ca0",
    .notes =
        "- A datagram of 715 bytes to all robots, broadcast or multicast, port 12345: eleven times the "
        "robot's number "
        "and the 64 bytes of `ibis-robot-command-v2`, whose page has the rules of their numbers. The tables "
        "below are "
        "one of the eleven; `encode` makes one of them per object, and eleven follow each other.\n"
        "- A robot searches all eleven for its number and takes the last that has it. Places that nobody has "
        "are not "
        "counted as faults; the host's own sources of 2026 are not public, so what it writes there is not "
        "known. Our own "
        "hosts (`play`, `acquire`) write robot 255 and zeros: no robot has that number.\n"
        "- `serve --device 'udp:12345?listen=1'` takes the datagrams for all its robots. Each answers with "
        "its feedback "
        "of 128 bytes, in reality to multicast 224.5.20.(100 + robot), port 50100 + robot, here to whoever "
        "sends, in the "
        "order of the places. The feedback names no robot: where it must be told apart, serve one robot per "
        "wire.\n"
        "- The robot hands on what its check_counter marks as new, looking every millisecond, and stops "
        "0.5 s after the last. Here each is handed on.\n",
    .carrier = {.kind = Carrier::Kind::kUdp},
    .max_frame_bytes = 128,
    .messages = Tables::kMessages,
    .encode_command = encode_command,
    .command_drives = drives(OMNIHIL_MODE_BODY_VELOCITY) | drives(OMNIHIL_MODE_COAST),
    .dongle = plain_dongle<kDongle>,
};

}  // namespace

const RadioFormat& radio_format_ibis_broadcast_715() { return kFormat; }

}  // namespace omnihil

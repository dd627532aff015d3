// ER-Force's packets of 2025 on the serial port of their transceiver.
//
//   start-connection CR, answered by "robot_id N"; then both ways COBS(29 bytes · exclusive or of them) · 00
//
// Source: robotics-erlangen/radio-challenge-2026 8e02b3f.
#include <array>
#include <string>

#include "protocols/dongles/plain_dongle.h"
#include "protocols/erforce_robot.h"
#include "protocols/teams/erforce_rows.h"

namespace omnihil {

const RadioFormat& radio_format_erforce_proto2025();

namespace {

constexpr std::array<Field, 0> kNoLead{};
using Tables = erforce::Tables<kNoLead>;
constexpr int kFrameBytes = Tables::kBytes + 2;
constexpr std::int64_t kFrame_ns = kFrameBytes * 10 * 1'000'000'000LL / 921'600;

constexpr PlainDongle kDongle{
    .silent_line = "start-connection\r",
    .line_answer =
        [](int id, std::vector<std::uint8_t>& out) {
          const std::string line = "robot_id " + std::to_string(id) + "\n";
          out.insert(out.end(), line.begin(), line.end());
        },
    .to_robot_ns = kFrame_ns,
    .to_host_ns = kFrame_ns,
    .to_command = [](const Values& values, int) { return erforce::to_command(values); },
    .answer = [](const Values& to_robot, int, const RobotFeedback& feedback,
                 Values& out) { return erforce::answer(Tables::kMessages, to_robot, feedback, out); },
    .remember = erforce::remember,
};

constinit const RadioFormat kFormat{
    .id = "erforce-proto2025",
    .title = "ER-Force packets of 2025, serial",
    .source = "https://github.com/robotics-erlangen/radio-challenge-2026 at 8e02b3f",
    .notes =
        "- A frame is COBS(29 bytes and their exclusive or), then 00. `erforce-proto2025-bridge` has a byte "
        "more.\n"
        "- The host writes `start-connection` and a carriage return, the robot a line `robot_id N`; frames "
        "follow. No "
        "packet names a robot: one wire is one robot.\n"
        "- Numbers stand in even steps from the lower limit at the lowest count to the upper one at the "
        "highest. In "
        "fields with a sign 0 lies between two counts: it is sent as 0 and read as half a step. A robot that "
        "is told a spline of zeros creeps with 1.5 mm/s; halt stops it.\n"
        "- An exclusive or does not see two equal bytes: one flipped bit in a COBS code among zeros may put "
        "01 01 in "
        "their place and pass.\n"
        "- What lies beyond a limit is sent as the limit; angles come round (but measured_phi, which is "
        "cut).\n"
        "- Without has_detection the three fields of the detection are sent as 0 and read as NaN (`null` in "
        "JSON).\n"
        "- The team's decoder reads phi_jerk, 17 bits, wrong (400000 as -1566). Here it is the encoder's "
        "inverse.\n"
        "- Nothing in a packet says which way it goes. What is no command, no datagram and has something "
        "behind a "
        "halt is read as a robot's answer; an answer of a robot without power, place, torque and memory card "
        "reads as halt.\n"
        "- A path was transcribed from the sources; the team's own packets of it were not at hand.\n"
        "- Here a spline is the velocity at its time 0, a path the velocity at its beginning and the heading "
        "at its "
        "end. The bench acknowledges parts of datagrams and does not act on them. measured_pos stays 0; "
        "measured_vel "
        "is in the field frame (the sources do not say).\n"
        "- Over UDP the same 29 bytes travel alone, after an empty multicast datagram each second that "
        "robots answer "
        "with their id. That is not spoken here.\n",
    .carrier = {.kind = Carrier::Kind::kUart, .baud = 921'600},
    .framing = Framing::kCobsZero,
    .max_frame_bytes = kFrameBytes,
    .messages = Tables::kMessages,
    .encode_command =
        [](const RobotCommand& command, const CommandTo&, std::vector<std::uint8_t>& out) {
          return erforce::encode_command(radio_format_erforce_proto2025(), command, out);
        },
    .command_drives = drives(OMNIHIL_MODE_BODY_VELOCITY) | drives(OMNIHIL_MODE_COAST),
    .dongle = plain_dongle<kDongle>,
};

}  // namespace

const RadioFormat& radio_format_erforce_proto2025() { return kFormat; }

}  // namespace omnihil

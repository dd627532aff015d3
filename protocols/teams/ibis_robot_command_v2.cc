// ibis-ssl Orion: the 64-byte command that crane sends to a robot, and the 128 bytes that the robot sends back.
//
//   to a robot    header 00 · counter · vision, limits, powers · flags · mode · arguments · 00 … (big-endian)
//   from a robot  AB EA · sum · counter · state (little-endian)
//
// Source: ibis-ssl/crane cd015fe (crane_sender/robot_packet.h), ibis-ssl/G474_Orion_main c7c89ec
// (Core/Inc/robot_packet.h), ibis-ssl/Orion_CM4 28c3ca0 (robot_feedback_packet.py).
#include <array>

#include "protocols/dongles/plain_dongle.h"
#include "protocols/ibis_robot.h"
#include "protocols/teams/ibis_rows.h"

namespace omnihil {
namespace {

constexpr std::array kFirstByte{number("header", 8, "", "0")};
constexpr std::array<Field, 0> kNothing{};
using Tables = ibis::Tables<kFirstByte, kNothing>;

// CM4 to main board: 72 bytes at 1 Mbaud; its loop looks at the network every millisecond. Back: 128 bytes.
constexpr PlainDongle kDongle{
    .frame_bytes = [](std::span<const std::uint8_t>) -> std::optional<std::size_t> { return 64; },
    .half_frame_ns = 5'000'000,
    .to_robot_ns = 1'000'000 + 72 * 10'000,
    .to_host_ns = 128 * 10'000,
    .to_command = [](const Values& values, int) { return ibis::to_command(values); },
    .answer = [](const Values& to_robot, int, const RobotFeedback& feedback,
                 Values& out) { return ibis::answer(Tables::kMessages, to_robot, feedback, out); },
};

constinit const RadioFormat kFormat{
    .id = "ibis-robot-command-v2",
    .title = "ibis-ssl Orion: RobotCommandV2 and its feedback",
    .source =
        "https://github.com/ibis-ssl/crane at cd015fe, https://github.com/ibis-ssl/G474_Orion_main at "
        "c7c89ec, https://github.com/ibis-ssl/Orion_CM4 at 28c3ca0",
    .notes =
        "- A command is one UDP datagram of 64 bytes to the robot's own address: 192.168.20.(100 + id), port "
        "12345; in crane's simulation localhost, port 50100 + id. It carries no robot number, so one wire is "
        "one "
        "robot: `serve --robots 3 --device 'udp:50103?listen=1'`. The feedback is a datagram of 128 bytes, "
        "in "
        "reality to multicast 224.5.20.(100 + id), port 50100 + id; here to whoever sends commands.\n"
        "- Commands are big-endian, the feedback is little-endian.\n"
        "- No checksum in a command. In the feedback, the receiver's tools define the sum of bytes 3 to 127 "
        "and "
        "the main board writes 10: it is passed on and never checked.\n"
        "- Numbers of 16 bits stand around 7FFFh. 0 is 7FFFh; the largest content, FFFFh, is one step beyond "
        "the range and comes back as it was.\n"
        "- Mode 3 is Orion's of 2026 (speed and direction). In crane of 2024 it was a velocity with a "
        "trajectory; those bytes would be read as a speed here.\n"
        "- The robot's CM4 hands a command on when its check_counter changes, looking every millisecond; the "
        "robot stops 0.5 s after the last one. It answers each with one feedback.\n"
        "- The heading is always given as an angle; there is no yaw rate.\n",
    .carrier = {.kind = Carrier::Kind::kUdp},
    .max_frame_bytes = 128,
    .messages = Tables::kMessages,
    .encode_command =
        [](const RobotCommand& command, const CommandTo&, std::vector<std::uint8_t>& out) {
          return ibis::encode_command(Tables::kMessages, command, out);
        },
    .command_drives = drives(OMNIHIL_MODE_BODY_VELOCITY) | drives(OMNIHIL_MODE_COAST),
    .dongle = plain_dongle<kDongle>,
};

}  // namespace

const RadioFormat& radio_format_ibis_robot_command_v2() { return kFormat; }

}  // namespace omnihil

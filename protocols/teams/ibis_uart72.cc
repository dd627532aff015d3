// ibis-ssl Orion inside the robot: what its CM4 writes to the main board over the serial line, and what comes back.
//
//   to the board    FE · bytes 1 to 63 of the command · ball in the camera (7) · sum of bytes 0 to 70 (big-endian)
//   from the board  the 128 bytes of the feedback
//
// Source: ibis-ssl/Orion_CM4 28c3ca0 (doc/control_packet.md), ibis-ssl/G474_Orion_main c7c89ec (its checksum).
#include <array>

#include "protocols/dongles/plain_dongle.h"
#include "protocols/ibis_robot.h"
#include "protocols/teams/ibis_rows.h"

namespace omnihil {
namespace {

constexpr int kBytes = 72;
constexpr std::uint8_t kBegin = 0xFE;
constexpr ChecksumRule kSum{.kind = &kSum8, .until = -1};
constexpr std::array kFirstByte{enveloped(constant("begin", 8, kBegin, "begins each packet"))};
constexpr std::array kCamera{
    number("camera[0]", 16, "px", "ball in the camera, x"),
    number("camera[1]", 16, "px", "ball in the camera, y"),
    number("camera[2]", 16, "px", "ball in the camera, radius"),
    number("camera[3]", 8, "1/s", "pictures per second"),
    enveloped(checksum("sum", 8, "of all before it", &kSum)),
};
using Tables = ibis::Tables<kFirstByte, kCamera>;

// 1 Mbaud: 10 us a byte.
constexpr PlainDongle kDongle{
    .frame_bytes = [](std::span<const std::uint8_t> front) -> std::optional<std::size_t> {
      return front[0] == kBegin ? kBytes : 0;
    },
    .half_frame_ns = 5'000'000,
    .to_robot_ns = kBytes * 10'000,
    .to_host_ns = 128 * 10'000,
    .to_command = [](const Values& values, int) { return ibis::to_command(values); },
    .answer = [](const Values& to_robot, int, const RobotFeedback& feedback,
                 Values& out) { return ibis::answer(Tables::kMessages, to_robot, feedback, out); },
};

constinit const RadioFormat kFormat{
    .id = "ibis-uart72",
    .title = "ibis-ssl Orion, serial line from CM4 to main board",
    .source =
        "https://github.com/ibis-ssl/Orion_CM4 at 28c3ca0, https://github.com/ibis-ssl/G474_Orion_main at "
        "c7c89ec",
    .notes =
        "- The command of `ibis-robot-command-v2`, whose page has its rules, with FEh in place of its first "
        "byte, the "
        "ball in the robot's camera and a sum behind it. The feedback is the same.\n"
        "- The CM4's program can be tried alone: the bench is the main board, one wire is one robot.\n"
        "- The CM4 writes when check_counter changes, looking every millisecond. The robot stops 0.5 s after "
        "the "
        "last command of the host, 1 s after the last of the CM4; the board starts anew after 6 s.\n"
        "- FEh may stand inside a packet: after a lost byte the board finds back into step when a sum fits.\n"
        "- Packets of the tests were made from the team's document, one by its CM4 program, which was built "
        "and given a "
        "datagram of `ibis-broadcast-715`.\n",
    .carrier = {.kind = Carrier::Kind::kUart, .baud = 1'000'000},
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

const RadioFormat& radio_format_ibis_uart72() { return kFormat; }

}  // namespace omnihil

// ER-Force's packets of 2025 behind udp2serial, the team's bridge from a serial port to UDP.
//
//   both ways COBS(type 00 · 29 bytes · exclusive or of all) · 00; type 01 asks for the robot's id
//
// Source: robotics-erlangen/radio-challenge-2026 8e02b3f, udp2serial.
#include <array>

#include "protocols/dongles/plain_dongle.h"
#include "protocols/erforce_robot.h"
#include "protocols/teams/erforce_rows.h"

namespace omnihil {

const RadioFormat& radio_format_erforce_proto2025_bridge();

namespace {

using erforce::kLeadBit;
constexpr std::array kLead{
    enveloped(type_code_bits("kind", 8, kLeadBit, "0 a packet, 1 which robot is it?"))};
using Tables = erforce::Tables<kLead>;
constexpr int kFrameBytes = Tables::kBytes + 2;
constexpr std::int64_t kFrame_ns = kFrameBytes * 10 * 1'000'000'000LL / 921'600;

constexpr auto kQueryRows = in_order(kLead,
                                     std::array{erforce::zeros("rest[0]", 64), erforce::zeros("rest[1]", 64),
                                                erforce::zeros("rest[2]", 64), erforce::zeros("rest[3]", 40)},
                                     erforce::kCheck);
constexpr auto kMessages = [] {
  std::array<Message, Tables::kMessages.size() + 1> all{};
  std::copy(Tables::kMessages.begin(), Tables::kMessages.end(), all.begin());
  all.back() =
      Tables::row("robot_id_request", 1u << kLeadBit, Direction::kToDongle, kQueryRows, "Which robot is it?");
  return all;
}();
static_assert(all_tiled(kMessages));

constexpr PlainDongle kDongle{
    .to_robot_ns = kFrame_ns,
    .to_host_ns = kFrame_ns,
    .to_command = [](const Values& values, int) { return erforce::to_command(values); },
    .answer = [](const Values& to_robot, int, const RobotFeedback& feedback,
                 Values& out) { return erforce::answer(kMessages, to_robot, feedback, out); },
    .remember = erforce::remember,
};

constinit const RadioFormat kFormat{
    .id = "erforce-proto2025-bridge",
    .title = "ER-Force packets of 2025, udp2serial",
    .source = "https://github.com/robotics-erlangen/radio-challenge-2026 at 8e02b3f",
    .notes =
        "- The packets of `erforce-proto2025`, whose page has their rules, with a type byte before them; the "
        "exclusive or is of that byte too.\n"
        "- robot_id_request is taken; how it is answered is not in the sources, so it is not answered "
        "here.\n",
    .carrier = {.kind = Carrier::Kind::kUart, .baud = 921'600},
    .framing = Framing::kCobsZero,
    .max_frame_bytes = kFrameBytes,
    .messages = kMessages,
    .encode_command =
        [](const RobotCommand& command, const CommandTo&, std::vector<std::uint8_t>& out) {
          return erforce::encode_command(radio_format_erforce_proto2025_bridge(), command, out);
        },
    .command_drives = drives(OMNIHIL_MODE_BODY_VELOCITY) | drives(OMNIHIL_MODE_COAST),
    .dongle = plain_dongle<kDongle>,
};

}  // namespace

const RadioFormat& radio_format_erforce_proto2025_bridge() { return kFormat; }

}  // namespace omnihil

// UBC Thunderbots: what the robot's computer tells a motor board over SPI; the answers are thunderbots-spi-answers.
//
//   AA BB CC · sequence · opcode · four bytes (big-endian) · CRC-8/AUTOSAR of all before it
//
// Source: UBC-Thunderbots/MDv6_Firmware (Src/interface.c, frames of ten bytes), UBC-Thunderbots/Software 0139338.
#include "protocols/radio_format.h"
#include "protocols/teams/thunderbots_rows.h"

namespace omnihil {
namespace {

using namespace thunderbots;

constexpr Field rest(int bits) { return enveloped(reserved("rest", bits, "sent as 0")); }
template <std::size_t kCount>
constexpr auto command(const std::array<Field, kCount>& data) {
  return frame("opcode", "what it says", data);
}
constexpr Field enabled() { return number("motor_enabled", 8, "", "0 stops the motor"); }
constexpr auto kNoOp = command(std::array{rest(32)});
constexpr auto kSpeed =
    command(std::array{enabled(), word("motor_target_speed_rpm", "rpm", "speed wanted"), rest(8)});
constexpr auto kTorque = command(std::array{
    enabled(), word("motor_target_torque", "", "torque wanted, in counts of the controller"), rest(8)});
constexpr auto kResponse = command(std::array{
    number("response_type", 8, "", "what answers hold: the type of thunderbots-spi-answers"), rest(24)});
constexpr auto kGains = command(std::array{word("kp", "", "proportional gain, in counts of the controller"),
                                           word("ki", "", "integral gain, in counts of the controller")});
constexpr auto kKaKv = command(
    std::array{word("ka", "", "feed-forward of acceleration"), word("kv", "", "feed-forward of speed")});
constexpr auto kKs = command(std::array{word("ks", "", "feed-forward against friction"), rest(16)});

constexpr std::array kMessages{
    row("no_op", 0, kNoOp, "Asks for an answer alone."),
    row("set_target_speed", 1, kSpeed, "Speed of the motor."),
    row("set_target_torque", 2, kTorque, "Torque of the motor."),
    row("set_response_type", 3, kResponse, "What answers hold from now on."),
    row("set_pid_torque_kp_ki", 4, kGains, "Gains of the torque loop (q current)."),
    row("set_pid_flux_kp_ki", 5, kGains, "Gains of the flux loop (d current)."),
    row("set_pid_speed_kp_ki", 6, kGains, "Gains of the speed loop."),
    row("set_speed_feed_forward_ka_kv", 7, kKaKv, "Feed-forward of the speed loop."),
    row("set_speed_feed_forward_ks", 8, kKs, "Feed-forward of the speed loop."),
};
static_assert(all_tiled(kMessages));

constinit const RadioFormat kFormat{
    .id = "thunderbots-spi",
    .title = "UBC Thunderbots, SPI to a motor board",
    .source =
        "https://github.com/UBC-Thunderbots/MDv6_Firmware, https://github.com/UBC-Thunderbots/Software at "
        "0139338",
    .notes =
        "- A frame of ten bytes each way in one transfer, SPI mode 0, the robot's computer is the master; a "
        "board for "
        "each wheel, each with its chip select. `serve --motor-bus thunderbots-spi` plays the four boards.\n"
        "- An answer leaves with a later transfer than the one that asked: [its "
        "page](thunderbots-spi-answers.md).\n"
        "- A board takes a frame whose sequence is that of the frame before (sent again) or one more, and is "
        "silent about "
        "others. After its start it waits for 0 or 1.\n"
        "- Firmware of other months has frames of six bytes (opcode, data, CRC) or eight (one delimiter): "
        "not spoken.\n"
        "- The radio of these robots is protobuf over IPv6 multicast; it is not spoken either.\n",
    .carrier = {.kind = Carrier::Kind::kSpi},
    .max_frame_bytes = kBytes,
    .messages = kMessages,
};

}  // namespace

const RadioFormat& radio_format_thunderbots_spi() { return kFormat; }

}  // namespace omnihil

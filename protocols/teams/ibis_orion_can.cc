// ibis-ssl Orion's CAN buses: set-points of the main board, state of the motor boards, and the other boards' frames.
//
//   id · data (little-endian); motors 0 to 3 in the two lowest bits of the id
//
// Source: ibis-ssl/Orion_F303_BLDC 664a6b6, ibis-ssl/G474_Orion_main c7c89ec.
#include "protocols/radio_format.h"
#include "protocols/teams/can_rows.h"

namespace omnihil {
namespace {

using namespace can;

// A frame of a motor: its number and the rest of the id; and of an id of its own.
constexpr std::array kMotorId{
    number("motor", 2, "", "0 front right, 1 back right, 2 back left, 3 front left"),
    type_code("id", 9, "the rest of the id")};
constexpr std::array kOneId{type_code("id", 11, "the id")};

constexpr auto of_motor(Field first, Field second) {
  return in_order(kMotorId, head(8), std::array{first, second});
}
constexpr Field unused(std::string_view name) { return enveloped(reserved(name, 32, "sent as 0")); }
constexpr auto kSpeed = of_motor(float32("speed", "rev/s", "speed wanted, held to 80"), unused("unused"));
constexpr auto kState =
    of_motor(float32("speed", "rev/s", "measured"), float32("angle", "rad", "of the encoder"));
constexpr auto kBattery = of_motor(float32("battery", "V", "at the board"), unused("unused"));
constexpr auto kTemperature = of_motor(float32("motor_temperature", "deg C", "of the motor"),
                                       float32("fet_temperature", "deg C", "of the bridge"));
constexpr auto kCurrent = of_motor(float32("current", "A", "of the motor"), unused("unused"));
constexpr auto kConstant = of_motor(float32("speed_constant", "rev/s/V", "of the motor"), unused("unused"));
constexpr auto kDribbler =
    in_order(kOneId, head(8), std::array{float32("power", "", "of the dribbler"), unused("unused")});
constexpr auto kPower =
    in_order(kOneId, head(2),
             std::array{enveloped(constant("first", 8, 0, "0")),
                        named("0 RESET, 1 POWER_ON", number("order", 8, "", "what the boards do"))},
             rest<48>());
constexpr auto kKicker = in_order(
    kOneId, head(8),
    std::array{number("order", 8, "", "0 voltage, 1 charge, 2 straight or chip, 3 kick"),
               number("value", 8, "", "of orders 1 and 2"),
               number("free_ms", 8, "ms", "of order 3: the motor boards let the wheels run free as long"),
               enveloped(reserved("unused", 8, "sent as 0")), float32("voltage", "V", "of order 0")});
constexpr auto kReport =
    in_order(kOneId, head(8),
             std::array{number("error_id", 16, "", "of the board"), number("info", 16, "", "what it reports"),
                        float32("value", "", "its value")});
constexpr auto kCalibrate = in_order(kOneId, head(0), rest<64>());

constexpr std::array kMessages{
    row("set_speed", 0x100 >> 2, kSpeed, "To a motor; after 100 ms it is void.", MessageRole::kCommand),
    row("set_dribbler", 0x104, kDribbler, "To the dribbler.", MessageRole::kCommand),
    row("boards", 0x010, kPower, "To all boards.", MessageRole::kCommand),
    row("kicker", 0x110, kKicker, "To the kicker and power board, and to motor boards.",
        MessageRole::kCommand),
    row("calibrate", 0x310, kCalibrate, "Starts the encoders' calibration.", MessageRole::kCommand),
    row("report", 0x000, kReport, "An error, or an emergency stop.", MessageRole::kFeedback),
    row("motor_state", 0x200 >> 2, kState, "Every millisecond.", MessageRole::kFeedback),
    row("motor_battery", 0x210 >> 2, kBattery, "About every 16 ms.", MessageRole::kFeedback),
    row("motor_temperature", 0x220 >> 2, kTemperature, "About every 16 ms.", MessageRole::kFeedback),
    row("motor_current", 0x230 >> 2, kCurrent, "About every 16 ms.", MessageRole::kFeedback),
    row("motor_constant", 0x500 >> 2, kConstant, "About every 16 ms.", MessageRole::kFeedback),
};
static_assert(all_tiled(kMessages));

constinit const RadioFormat kFormat{
    .id = "ibis-orion-can",
    .title = "ibis-ssl Orion, CAN between its boards",
    .source =
        "https://github.com/ibis-ssl/Orion_F303_BLDC at 664a6b6, https://github.com/ibis-ssl/G474_Orion_main "
        "at c7c89ec",
    .notes =
        "- Classic CAN, 1 Mbit/s, 11-bit ids; two buses in the robot (right and left wheels), one here. "
        "`serve --motor-bus "
        "ibis-orion` plays the motor boards; `formats ibis-orion-can --dbc` is the DBC file.\n"
        "- Frames stand here as Linux has them in `struct can_frame`.\n"
        "- Frames of the power board, ball sensor and mouse (215h, 216h, 224h, 240h, 241h) are not spoken.\n",
    .carrier = {.kind = Carrier::Kind::kCan},
    .max_frame_bytes = kFrameBytes,
    .messages = kMessages,
};

}  // namespace

const RadioFormat& radio_format_ibis_orion_can() { return kFormat; }

}  // namespace omnihil

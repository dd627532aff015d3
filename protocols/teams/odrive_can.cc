// ODrive's CANSimple: a node per motor on a CAN bus.
//
//   id = node · 32 + command · data (little-endian)
//
// Source: ODrive documentation 0.6, "CAN Protocol".
#include "protocols/radio_format.h"
#include "protocols/scale_rules.h"
#include "protocols/teams/can_rows.h"

namespace omnihil {
namespace {

using namespace can;

constexpr std::array kId{type_code("command", 5, "what the frame is"),
                         number("node", 6, "", "of the motor; 63 is nobody's", 0, 62)};

// 8 bytes of data, 4, none.
template <std::size_t kCount>
constexpr auto frame(const std::array<Field, kCount>& data) {
  return in_order(kId, head(8), data);
}
constexpr auto four(Field field) { return in_order(kId, head(4), std::array{field}, rest<32>()); }
constexpr auto kNone = in_order(kId, head(0), rest<64>());
constexpr auto pair(Field first, Field second) { return frame(std::array{first, second}); }
constexpr Field count(std::string_view name, int bits, std::string_view what) {
  return number(name, bits, "", what);
}
constexpr std::string_view kStates = "1 IDLE, 8 CLOSED_LOOP_CONTROL";
// Feed-forwards of Set_Input_Pos: thousandths.
constexpr Field milli(std::string_view name, std::string_view unit, std::string_view what) {
  return scaled(name, 16, Sign::kTwosComplement, kTruncated, -32.768, 32.767, unit, what);
}

constexpr auto kHeartbeat =
    frame(std::array{count("Axis_Error", 32, "errors in force and the reason for the last disarming"),
                     named(kStates, count("Axis_State", 8, "what the axis does")),
                     count("Procedure_Result", 8, "0 success, 3 disarmed"),
                     flag("Trajectory_Done_Flag", "no trajectory is under way"),
                     enveloped(reserved("unused", 15, "not used"))});
constexpr auto kError = pair(count("Active_Errors", 32, "errors in force"),
                             count("Disarm_Reason", 32, "errors that disarmed the axis"));
constexpr auto kSetState = four(named(kStates, count("Axis_Requested_State", 32, "what the axis shall do")));
constexpr auto kEstimates =
    pair(float32("Pos_Estimate", "rev", "position"), float32("Vel_Estimate", "rev/s", "speed"));
constexpr auto kSetMode = pair(named("1 TORQUE_CONTROL, 2 VELOCITY_CONTROL, 3 POSITION_CONTROL",
                                     count("Control_Mode", 32, "what is controlled")),
                               named("1 PASSTHROUGH", count("Input_Mode", 32, "how inputs are taken")));
constexpr auto kSetPos =
    frame(std::array{float32("Input_Pos", "rev", "position wanted"), milli("Vel_FF", "rev/s", "speed on top"),
                     milli("Torque_FF", "Nm", "torque on top")});
constexpr auto kSetVel =
    pair(float32("Input_Vel", "rev/s", "speed wanted"), float32("Input_Torque_FF", "Nm", "torque on top"));
constexpr auto kSetTorque = four(float32("Input_Torque", "Nm", "torque wanted"));
constexpr auto kSetLimits = pair(float32("Velocity_Limit", "rev/s", "largest speed"),
                                 float32("Current_Limit", "A", "largest current"));
constexpr auto kIq =
    pair(float32("Iq_Setpoint", "A", "current wanted"), float32("Iq_Measured", "A", "current"));
constexpr auto kTemperature = pair(float32("FET_Temperature", "deg C", "of the bridges"),
                                   float32("Motor_Temperature", "deg C", "of the motor"));
constexpr auto kBus =
    pair(float32("Bus_Voltage", "V", "supply"), float32("Bus_Current", "A", "from the supply"));
constexpr auto kSetPosition = four(float32("Position", "rev", "what the position now is called"));
constexpr auto kPosGain = four(float32("Pos_Gain", "(rev/s)/rev", "gain of the position loop"));
constexpr auto kVelGains = pair(float32("Vel_Gain", "Nm/(rev/s)", "gain of the speed loop"),
                                float32("Vel_Integrator_Gain", "Nm/rev", "its integral"));
constexpr auto kTorques =
    pair(float32("Torque_Target", "Nm", "torque wanted"), float32("Torque_Estimate", "Nm", "torque"));
constexpr auto kPowers = pair(float32("Electrical_Power", "W", "from the supply"),
                              float32("Mechanical_Power", "W", "at the shaft"));

constexpr Message to_it(std::string_view name, std::uint32_t command, std::span<const Field> fields,
                        std::string_view what) {
  return row(name, command, fields, what, MessageRole::kCommand);
}
constexpr Message from_it(std::string_view name, std::uint32_t command, std::span<const Field> fields,
                          std::string_view what) {
  return row(name, command, fields, what, MessageRole::kFeedback);
}
constexpr std::array kMessages{
    from_it("Heartbeat", 0x01, kHeartbeat, "Every 100 ms."),
    to_it("Estop", 0x02, kNone, "Disarms the axis."),
    from_it("Get_Error", 0x03, kError, "When asked by a remote frame."),
    to_it("Set_Axis_State", 0x07, kSetState, "Arms or disarms the axis."),
    from_it("Get_Encoder_Estimates", 0x09, kEstimates, "Every 10 ms."),
    to_it("Set_Controller_Mode", 0x0B, kSetMode, "What the inputs mean."),
    to_it("Set_Input_Pos", 0x0C, kSetPos, "Position."),
    to_it("Set_Input_Vel", 0x0D, kSetVel, "Speed."),
    to_it("Set_Input_Torque", 0x0E, kSetTorque, "Torque."),
    to_it("Set_Limits", 0x0F, kSetLimits, "Limits of speed and current."),
    from_it("Get_Iq", 0x14, kIq, "When asked by a remote frame."),
    from_it("Get_Temperature", 0x15, kTemperature, "When asked by a remote frame."),
    to_it("Reboot", 0x16, kNone, "Starts the controller anew."),
    from_it("Get_Bus_Voltage_Current", 0x17, kBus, "When asked by a remote frame."),
    to_it("Clear_Errors", 0x18, kNone, "Forgets the errors."),
    to_it("Set_Absolute_Position", 0x19, kSetPosition, "Names the position of now."),
    to_it("Set_Pos_Gain", 0x1A, kPosGain, "Gain of the position loop."),
    to_it("Set_Vel_Gains", 0x1B, kVelGains, "Gains of the speed loop."),
    from_it("Get_Torques", 0x1C, kTorques, "When asked by a remote frame."),
    from_it("Get_Powers", 0x1D, kPowers, "When asked by a remote frame."),
};
static_assert(all_tiled(kMessages));

constinit const RadioFormat kFormat{
    .id = "odrive-can",
    .title = "ODrive CANSimple",
    .source = "https://docs.odriverobotics.com/v/0.6.10/guides/can-protocol.html",
    .notes =
        "- Classic CAN, 11-bit ids. `serve --motor-bus odrive` plays four nodes; `formats odrive-can --dbc` "
        "is the DBC file.\n"
        "- Frames stand here as Linux has them in `struct can_frame`; remote frames, which ask for an "
        "answer, are none of "
        "these packets.\n"
        "- Get_Version, trajectories, cogging and parameter access are not spoken.\n",
    .carrier = {.kind = Carrier::Kind::kCan},
    .max_frame_bytes = kFrameBytes,
    .messages = kMessages,
};

}  // namespace

const RadioFormat& radio_format_odrive_can() { return kFormat; }

}  // namespace omnihil

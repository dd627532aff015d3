// RoboTeam Twente REM, version 8: raw packets over the base station's USB serial port.
//
//   REM_RobotCommand to yellow robot 3 is 28 bytes: type 22h, header up to payloadSize at byte 10, body
//
// Source: RoboTeamTwente/roboteam_embedded_messages, packet table of commit 9cb3c21.
#include "protocols/dongles/rem_dongle.h"
#include "protocols/radio_format.h"
#include "protocols/rem_command.h"
#include "protocols/rem_packet.h"
#include "protocols/teams/rem_rows.h"

namespace omnihil {

namespace {

using rem::kPi;

constexpr auto kHeaderRows = rem::header_rows("packetType", 8, 48, "ms", "Unix time in milliseconds");
constexpr auto kHeader = in_order(kHeaderRows);

constexpr std::array kMotionRows{
    ranged("rho", 16, 0.0, 30.0, "m/s", "speed"),
    ranged("theta", 16, -kPi, kPi, "rad", "direction of the speed"),
    ranged("yaw", 16, -kPi, kPi, "rad", "heading"),
};
constexpr std::array kTurnRows{
    ranged("angularVelocity", 16, -10.0 * kPi, 10.0 * kPi, "rad/s", "yaw rate"),
    ranged("cameraYaw", 16, -kPi, kPi, "rad", "heading as the cameras see it"),
};

constexpr std::array kDribblerRows{
    flag("dribblerOn", "run the dribbler"),
    flag("dribblerOption1", "dribbler option 1"),
    flag("dribblerOption2", "dribbler option 2"),
    flag("dribblerOption3", "dribbler option 3"),
    flag("dribblerOption4", "dribbler option 4"),
    flag("dribblerOption5", "dribbler option 5"),
    flag("dribblerOption6", "dribbler option 6"),
    flag("sendStateInfo", "answer with REM_RobotStateInfo as well"),
};

constexpr auto kCommand =
    in_order(kHeaderRows, kMotionRows, kTurnRows,
             std::array{
                 ranged("acceleration_magnitude", 16, -15.0, 15.0, "m/s^2", "acceleration"),
                 ranged("acceleration_angle", 16, -kPi, kPi, "rad", "direction of the acceleration"),
                 ranged("kickChipPower", 8, 0.0, 8.0, "m/s", "speed of the ball"),
                 flag("doKick", "kick once the ball sensor sees the ball"),
                 flag("doChip", "chip once the ball sensor sees the ball"),
                 flag("kickAtYaw", "kick once the heading is reached"),
                 flag("doForce", "kick or chip whatever the ball sensor says"),
                 flag("useCameraYaw", "cameraYaw holds a measurement"),
                 flag("useYaw", "turn to yaw; 0: turn at angularVelocity"),
             },
             kDribblerRows,
             std::array{
                 flag("wheelsOff", "leave the wheels without power"),
                 flag("reboot", "restart the robot"),
             });

constexpr auto kTesting =
    in_order(kHeaderRows, kMotionRows, kTurnRows,
             std::array{
                 ranged("wheelSpeedRef1", 16, -1000.0, 1000.0, "rad/s", "speed of wheel 1 (right front)"),
                 ranged("wheelSpeedRef2", 16, -1000.0, 1000.0, "rad/s", "speed of wheel 2 (left front)"),
                 ranged("wheelSpeedRef3", 16, -1000.0, 1000.0, "rad/s", "speed of wheel 3 (left back)"),
                 ranged("wheelSpeedRef4", 16, -1000.0, 1000.0, "rad/s", "speed of wheel 4 (right back)"),
                 ranged("wheelPWM1", 16, -1.0, 1.0, "", "duty of wheel 1 (right front)"),
                 ranged("wheelPWM2", 16, -1.0, 1.0, "", "duty of wheel 2 (left front)"),
                 ranged("wheelPWM3", 16, -1.0, 1.0, "", "duty of wheel 3 (left back)"),
                 ranged("wheelPWM4", 16, -1.0, 1.0, "", "duty of wheel 4 (right back)"),
                 flag("useWheelSpeedRef", "drive the wheels at wheelSpeedRef1-4"),
                 flag("useWheelPWMRef", "drive the wheels with wheelPWM1-4"),
                 flag("doKick", "kick once the ball sensor sees the ball"),
                 flag("doChip", "chip once the ball sensor sees the ball"),
                 flag("kickAtAngle", "kick once the heading is reached"),
                 flag("doForce", "kick or chip whatever the ball sensor says"),
                 flag("wheelsOff", "leave the wheels without power"),
                 flag("feedback", "only answer, do not act"),
                 ranged("kickChipPower", 8, 0.0, 8.0, "m/s", "speed of the ball"),
                 flag("reboot", "restart the robot"),
                 flag("useCameraYaw", "cameraYaw holds a measurement"),
                 flag("useAbsoluteYaw", "turn to yaw; 0: turn at angularVelocity"),
                 reserved("unused", 5, "not used"),
             },
             kDribblerRows);

constexpr auto kFeedback =
    in_order(kHeaderRows, kMotionRows,
             std::array{
                 ranged("batteryLevel", 16, 15.0, 30.0, "V", "battery voltage"),
                 flag("XsensCalibrated", "the inertial sensor is calibrated"),
             },
             rem::kBallSensorRows,
             std::array{
                 flag("dribblerSeesBall", "the dribbler feels the ball"),
                 flag("kickerFault", "the kicker board reports a fault"),
                 flag("kickerOn", "the kicker board is on"),
                 flag("capacitorCharged", "the kicker's capacitor is charged"),
                 reserved("reserved1", 1, "not used"),
                 number("kickerVoltage", 10, "V", "voltage of the kicker's capacitor"),
                 reserved("filler", 54, "any content; makes the answer as long as the command"),
             });

constexpr Field state(std::string_view name, double limit, std::string_view unit, std::string_view what) {
  return ranged(name, 16, -limit, limit, unit, what);
}
constexpr auto kStateInfo = in_order(
    kHeaderRows,
    std::array{
        state("xsensAcc1", 100.0, "m/s^2", "acceleration along the sensor's first axis"),
        state("xsensAcc2", 100.0, "m/s^2", "acceleration along the sensor's second axis"),
        ranged("xsensYaw", 32, -50000.0, 50000.0, "rad", "heading from the inertial sensor"),
        state("rateOfTurn", 20.0, "rad/s", "yaw rate from the inertial sensor"),
        state("wheelSpeed1", 1000.0, "rad/s", "measured speed of wheel 1 (right front)"),
        state("wheelSpeed2", 1000.0, "rad/s", "measured speed of wheel 2 (left front)"),
        state("wheelSpeed3", 1000.0, "rad/s", "measured speed of wheel 3 (left back)"),
        state("wheelSpeed4", 1000.0, "rad/s", "measured speed of wheel 4 (right back)"),
        ranged("dribbleSpeed", 16, 0.0, 5000.0, "rad/s", "speed of the dribbler"),
        ranged("filteredDribbleSpeed", 16, 0.0, 5000.0, "rad/s", "the same, filtered"),
        ranged("dribblespeedBeforeGotBall", 16, 0.0, 5000.0, "rad/s", "the same, when the ball came in"),
        state("bodyXIntegral", 200.0, "", "integral term of the controller of body x"),
        state("bodyYIntegral", 200.0, "", "integral term of the controller of body y"),
        state("bodyWIntegral", 200.0, "", "integral term of the controller of the yaw rate"),
        state("bodyYawIntegral", 10.0, "", "integral term of the controller of the heading"),
        state("wheel1Integral", 1000.0, "", "integral term of the controller of wheel 1"),
        state("wheel2Integral", 1000.0, "", "integral term of the controller of wheel 2"),
        state("wheel3Integral", 1000.0, "", "integral term of the controller of wheel 3"),
        state("wheel4Integral", 1000.0, "", "integral term of the controller of wheel 4"),
        state("wheelSpeedRef1", 1000.0, "rad/s", "wanted speed of wheel 1"),
        state("wheelSpeedRef2", 1000.0, "rad/s", "wanted speed of wheel 2"),
        state("wheelSpeedRef3", 1000.0, "rad/s", "wanted speed of wheel 3"),
        state("wheelSpeedRef4", 1000.0, "rad/s", "wanted speed of wheel 4"),
        state("wheelController_1", 1.0, "", "output of the controller of wheel 1"),
        state("wheelController_2", 1.0, "", "output of the controller of wheel 2"),
        state("wheelController_3", 1.0, "", "output of the controller of wheel 3"),
        state("wheelController_4", 1.0, "", "output of the controller of wheel 4"),
        state("bodyController_u", 100.0, "", "output of the body controller, forward"),
        state("bodyController_v", 100.0, "", "output of the body controller, left"),
        state("bodyController_w", 100.0, "", "output of the body controller, yaw rate"),
        state("bodyController_yaw", 100.0, "", "output of the body controller, heading"),
        state("bodyControllerRef_u", 100.0, "m/s", "wanted velocity, forward"),
        state("bodyControllerRef_v", 100.0, "m/s", "wanted velocity, left"),
        state("bodyControllerRef_w", 100.0, "rad/s", "wanted yaw rate"),
        state("bodyControllerRef_yaw", 100.0, "rad", "wanted heading"),
        state("wheelSpeedDerivativeFiltered1", 1000.0, "rad/s^2", "acceleration of wheel 1, filtered"),
        state("wheelSpeedDerivativeFiltered2", 1000.0, "rad/s^2", "acceleration of wheel 2, filtered"),
        state("wheelSpeedDerivativeFiltered3", 1000.0, "rad/s^2", "acceleration of wheel 3, filtered"),
        state("wheelSpeedDerivativeFiltered4", 1000.0, "rad/s^2", "acceleration of wheel 4, filtered"),
        state("bodyXDerivativeFiltered", 100.0, "m/s^2", "acceleration of body x, filtered"),
        state("bodyYDerivativeFiltered", 100.0, "m/s^2", "acceleration of body y, filtered"),
        state("bodyZDerivativeFiltered", 100.0, "m/s^2", "acceleration of body z, filtered"),
        state("bodyYawDerivativeFiltered", 100.0, "rad/s", "derivative of the heading, filtered"),
    });

constexpr Field gain(std::string_view name, std::string_view what) {
  return ranged(name, 16, 0.0, 100.0, "", what);
}
constexpr std::array kGainRows{
    gain("PbodyX", "P, velocity x"),    gain("IbodyX", "I, velocity x"),
    gain("DbodyX", "D, velocity x"),    gain("DbodyX2", "second D, velocity x"),
    gain("PbodyY", "P, velocity y"),    gain("IbodyY", "I, velocity y"),
    gain("DbodyY", "D, velocity y"),    gain("DbodyY2", "second D, velocity y"),
    gain("PbodyW", "P, yaw rate"),      gain("IbodyW", "I, yaw rate"),
    gain("DbodyW", "D, yaw rate"),      gain("DbodyW2", "second D, yaw rate"),
    gain("PbodyYaw", "P, heading"),     gain("IbodyYaw", "I, heading"),
    gain("DbodyYaw", "D, heading"),     gain("DbodyYaw2", "second D, heading"),
    gain("Pwheels", "P, wheel speeds"), gain("Iwheels", "I, wheel speeds"),
    gain("Dwheels", "D, wheel speeds"),
};

constexpr std::string_view kSwitch = "switch for experiments";
constexpr Field spare(std::string_view name) {
  return ranged(name, 16, -1000.0, 100.0, "", "number for experiments; the range is not symmetric");
}
constexpr auto kSetGains =
    in_order(kHeaderRows, kGainRows,
             std::array{flag("boolean1", kSwitch), flag("boolean2", kSwitch), flag("boolean3", kSwitch),
                        flag("boolean4", kSwitch), flag("boolean5", kSwitch), flag("boolean6", kSwitch),
                        flag("boolean7", kSwitch), flag("boolean8", kSwitch), flag("boolean9", kSwitch),
                        flag("boolean10", kSwitch), flag("boolean11", kSwitch), flag("boolean12", kSwitch),
                        flag("boolean13", kSwitch), flag("boolean14", kSwitch), flag("boolean15", kSwitch),
                        flag("boolean16", kSwitch)},
             std::array{spare("unlabel1"), spare("unlabel2"), spare("unlabel3"), spare("unlabel4"),
                        spare("unlabel5"), spare("unlabel6"), spare("unlabel7"), spare("unlabel8")});

constexpr auto kBuzzer = in_order(kHeaderRows, rem::kBuzzerRows);
constexpr auto kConfiguration = in_order(kHeaderRows, rem::kBasestationConfigurationRows);
constexpr auto kGains = in_order(kHeaderRows, kGainRows);
constexpr auto kAssured = in_order(kHeaderRows, rem::kAssuredPacketRows);
constexpr auto kAck = in_order(kHeaderRows, rem::kAssuredAckRows);
constexpr auto kMusic = in_order(kHeaderRows, rem::kMusicRows);
constexpr auto kFiller = in_order(rem::filler_rows(8));

using rem::packet;
using enum Direction;
constexpr std::array kMessages{
    packet("REM_Packet", 0x21, 11, kBoth, kHeader, rem::kWhatPacket, MessageRole::kHeaderOnly),
    packet("REM_RobotCommand", 0x22, 28, kToRobot, kCommand, rem::kWhatCommand, MessageRole::kCommand),
    packet("REM_RobotCommandTesting", 0x24, 41, kToRobot, kTesting,
           "Wheel speeds or duties for experiments, or a body velocity.", MessageRole::kSingleCommand),
    packet("REM_RobotFeedback", 0x27, 28, kFromRobot, kFeedback, rem::kWhatFeedback, MessageRole::kFeedback),
    packet("REM_RobotStateInfo", 0x28, 99, kFromRobot, kStateInfo, rem::kWhatStateInfo,
           MessageRole::kStateInfo),
    packet("REM_RobotBuzzer", 0x2B, 15, kToRobot, kBuzzer, rem::kWhatBuzzer),
    rem::with_text(packet("REM_Log", 0x2D, 11, kFromRobot, kHeader, rem::kWhatLog, MessageRole::kText)),
    packet("REM_BasestationGetConfiguration", 0x2E, 11, kToDongle, kHeader, rem::kWhatGetConfiguration,
           MessageRole::kAskDongle),
    packet("REM_BasestationConfiguration", 0x30, 12, kBoth, kConfiguration, rem::kWhatConfiguration,
           MessageRole::kConfigureDongle),
    packet("REM_RobotGetPIDGains", 0x33, 11, kToRobot, kHeader, rem::kWhatGetGains, MessageRole::kGetGains),
    packet("REM_RobotPIDGains", 0x35, 49, kFromRobot, kGains, rem::kWhatGains, MessageRole::kGains),
    packet("REM_RobotSetPIDGains", 0x36, 67, kToRobot, kSetGains, rem::kWhatSetGains, MessageRole::kSetGains),
    packet("REM_RobotAssuredPacket", 0x39, 13, kToRobot, kAssured, rem::kWhatAssured, MessageRole::kAnnounce),
    packet("REM_RobotAssuredAck", 0x3A, 12, kFromRobot, kAck, rem::kWhatAck, MessageRole::kAcknowledge),
    packet("REM_RobotMusicCommand", 0x3C, 14, kToRobot, kMusic, rem::kWhatMusic),
    packet("REM_SX1280Filler", 0x3F, 6, kToRobot, kFiller, rem::kWhatFiller, MessageRole::kFiller),
    packet("REM_RobotKillCommand", 0x41, 11, kToRobot, kHeader, rem::kWhatKill, MessageRole::kKill),
};
static_assert(all_tiled(kMessages));

constinit const RadioFormat kFormat{
    .id = "roboteam-rem-v8",
    .title = "RoboTeam Twente REM, version 8",
    .source = "https://github.com/RoboTeamTwente/roboteam_embedded_messages, packet table of commit 9cb3c21",
    .notes = rem::kCommonNotes,
    .carrier = {.kind = Carrier::Kind::kUsbCdc},
    .max_frame_bytes = 255,
    .messages = kMessages,
    .encode_command =
        [](const RobotCommand& command, const CommandTo& to, std::vector<std::uint8_t>& out) {
          return rem::encode_command(kMessages, command, to, out);
        },
    .command_drives = drives(OMNIHIL_MODE_BODY_VELOCITY) | drives(OMNIHIL_MODE_WHEEL_SPEED) |
                      drives(OMNIHIL_MODE_WHEEL_DUTY) | drives(OMNIHIL_MODE_COAST),
    .dongle = make_rem_dongle,
};

}  // namespace

const RadioFormat& radio_format_roboteam_rem_v8() { return kFormat; }

}  // namespace omnihil

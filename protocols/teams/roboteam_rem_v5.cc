// RoboTeam Twente REM, version 5: raw packets over the base station's USB serial port.
//
//   REM_RobotCommand to yellow robot 3 is 22 bytes: type 22h, header up to payloadSize at byte 9, body
//
// Source: RoboTeamTwente/roboteam_embedded_messages at 27e6961; the public base station pins d80493a, which
// has the same tables.
#include "protocols/dongles/rem_dongle.h"
#include "protocols/radio_format.h"
#include "protocols/rem_command.h"
#include "protocols/rem_packet.h"
#include "protocols/teams/rem_rows.h"

namespace omnihil {

namespace {

using rem::kPi;

constexpr auto kHeaderRows = rem::header_rows("header", 5, 40, "10 ms", "Unix time in centiseconds");
constexpr auto kHeader = in_order(kHeaderRows);

constexpr std::array kMotionRows{
    ranged("rho", 16, 0.0, 8.0, "m/s", "speed"),
    ranged("theta", 16, -kPi, kPi, "rad", "direction of the speed"),
    ranged("angle", 16, -kPi, kPi, "rad", "heading"),
};

constexpr auto kCommand =
    in_order(kHeaderRows, kMotionRows,
             std::array{
                 ranged("angularVelocity", 16, -4.0 * kPi, 4.0 * kPi, "rad/s", "yaw rate"),
                 ranged("cameraAngle", 16, -kPi, kPi, "rad", "heading as the cameras see it"),
                 flag("useCameraAngle", "cameraAngle holds a measurement"),
                 flag("useAbsoluteAngle", "turn to angle; 0: turn at angularVelocity"),
                 ranged("dribbler", 3, 0.0, 1.0, "", "speed of the dribbler, part of its largest"),
                 flag("doKick", "kick once the ball sensor sees the ball"),
                 flag("doChip", "chip once the ball sensor sees the ball"),
                 flag("kickAtAngle", "kick once the heading is reached"),
                 ranged("kickChipPower", 4, 0.0, 6.5, "m/s", "speed of the ball"),
                 flag("doForce", "kick or chip whatever the ball sensor says"),
                 flag("feedback", "only answer, do not act"),
                 padding(2),
             });

constexpr auto kFeedback =
    in_order(kHeaderRows, kMotionRows,
             std::array{
                 number("batteryLevel", 4, "", "battery level"),
                 flag("XsensCalibrated", "the inertial sensor is calibrated"),
                 flag("capacitorCharged", "the kicker's capacitor is charged"),
             },
             rem::kBallSensorRows,
             std::array{
                 ranged("ballPos", 4, -0.5, 0.5, "", "where the ball is along the ball sensor"),
                 flag("dribblerSeesBall", "the dribbler feels the ball"),
                 reserved("reserved1", 3, "not used"),
                 number("wheelLocked", 4, "", "one bit per wheel: it is locked"),
                 number("wheelBraking", 4, "", "one bit per wheel: it slips"),
                 number("rssi", 8, "", "signal strength of the last packet"),
             });

constexpr Field state(std::string_view name, double limit, std::string_view unit, std::string_view what) {
  return ranged(name, 16, -limit, limit, unit, what);
}
constexpr auto kStateInfo = in_order(
    kHeaderRows,
    std::array{
        state("xsensAcc1", 156.96, "m/s^2", "acceleration along the sensor's first axis"),
        state("xsensAcc2", 156.96, "m/s^2", "acceleration along the sensor's second axis"),
        ranged("xsensYaw", 32, -50000.0, 50000.0, "rad", "heading from the inertial sensor"),
        state("rateOfTurn", 20.0, "rad/s", "yaw rate from the inertial sensor"),
        state("wheelSpeed1", 1000.0, "rad/s", "measured speed of wheel 1 (right front)"),
        state("wheelSpeed2", 1000.0, "rad/s", "measured speed of wheel 2 (left front)"),
        state("wheelSpeed3", 1000.0, "rad/s", "measured speed of wheel 3 (left back)"),
        state("wheelSpeed4", 1000.0, "rad/s", "measured speed of wheel 4 (right back)"),
        ranged("dribbleSpeed", 16, 0.0, 5000.0, "rad/s", "speed of the dribbler"),
        ranged("filteredDribbleSpeed", 16, 0.0, 5000.0, "rad/s", "the same, filtered"),
        ranged("dribblespeedBeforeGotBall", 16, 0.0, 5000.0, "rad/s", "the same, when the ball came in"),
        state("bodyXIntegral", 5000.0, "", "integral term of the controller of body x"),
        state("bodyYIntegral", 5000.0, "", "integral term of the controller of body y"),
        state("bodyWIntegral", 5000.0, "", "integral term of the controller of the yaw rate"),
        state("bodyYawIntegral", 5000.0, "", "integral term of the controller of the heading"),
        state("wheel1Integral", 5000.0, "", "integral term of the controller of wheel 1"),
        state("wheel2Integral", 5000.0, "", "integral term of the controller of wheel 2"),
        state("wheel3Integral", 5000.0, "", "integral term of the controller of wheel 3"),
        state("wheel4Integral", 5000.0, "", "integral term of the controller of wheel 4"),
    });

// P up to 40, I up to 20, D up to 10.
constexpr Field gain_p(std::string_view name, std::string_view what) {
  return ranged(name, 16, 0.0, 40.0, "", what);
}
constexpr Field gain_i(std::string_view name, std::string_view what) {
  return ranged(name, 16, 0.0, 20.0, "", what);
}
constexpr Field gain_d(std::string_view name, std::string_view what) {
  return ranged(name, 16, 0.0, 10.0, "", what);
}
constexpr auto kGains = in_order(kHeaderRows, std::array{
                                                  gain_p("PbodyX", "P, velocity x"),
                                                  gain_i("IbodyX", "I, velocity x"),
                                                  gain_d("DbodyX", "D, velocity x"),
                                                  gain_p("PbodyY", "P, velocity y"),
                                                  gain_i("IbodyY", "I, velocity y"),
                                                  gain_d("DbodyY", "D, velocity y"),
                                                  gain_p("PbodyW", "P, yaw rate"),
                                                  gain_i("IbodyW", "I, yaw rate"),
                                                  gain_d("DbodyW", "D, yaw rate"),
                                                  gain_p("PbodyYaw", "P, heading"),
                                                  gain_i("IbodyYaw", "I, heading"),
                                                  gain_d("DbodyYaw", "D, heading"),
                                                  gain_p("Pwheels", "P, wheel speeds"),
                                                  gain_i("Iwheels", "I, wheel speeds"),
                                                  gain_d("Dwheels", "D, wheel speeds"),
                                              });

constexpr auto kBuzzer = in_order(kHeaderRows, rem::kBuzzerRows);
constexpr auto kConfiguration = in_order(kHeaderRows, rem::kBasestationConfigurationRows);
constexpr auto kAssured = in_order(kHeaderRows, rem::kAssuredPacketRows);
constexpr auto kAck = in_order(kHeaderRows, rem::kAssuredAckRows);
constexpr auto kMusic = in_order(kHeaderRows, rem::kMusicRows);
constexpr auto kFiller = in_order(rem::filler_rows(5));

using rem::packet;
using enum Direction;
constexpr std::array kMessages{
    packet("REM_Packet", 0x21, 10, kBoth, kHeader, rem::kWhatPacket, MessageRole::kHeaderOnly),
    packet("REM_RobotCommand", 0x22, 22, kToRobot, kCommand, rem::kWhatCommand, MessageRole::kCommand),
    packet("REM_RobotFeedback", 0x24, 20, kFromRobot, kFeedback, rem::kWhatFeedback, MessageRole::kFeedback),
    packet("REM_RobotStateInfo", 0x27, 50, kFromRobot, kStateInfo, rem::kWhatStateInfo,
           MessageRole::kStateInfo),
    packet("REM_RobotBuzzer", 0x28, 14, kToRobot, kBuzzer, rem::kWhatBuzzer),
    rem::with_text(packet("REM_Log", 0x2B, 10, kFromRobot, kHeader, rem::kWhatLog, MessageRole::kText)),
    packet("REM_BasestationGetConfiguration", 0x2D, 10, kToDongle, kHeader, rem::kWhatGetConfiguration,
           MessageRole::kAskDongle),
    packet("REM_BasestationConfiguration", 0x2E, 11, kBoth, kConfiguration, rem::kWhatConfiguration,
           MessageRole::kConfigureDongle),
    packet("REM_RobotGetPIDGains", 0x30, 10, kToRobot, kHeader, rem::kWhatGetGains, MessageRole::kGetGains),
    packet("REM_RobotPIDGains", 0x33, 40, kFromRobot, kGains, rem::kWhatGains, MessageRole::kGains),
    packet("REM_RobotSetPIDGains", 0x35, 40, kToRobot, kGains, rem::kWhatSetGains, MessageRole::kSetGains),
    packet("REM_RobotAssuredPacket", 0x36, 12, kToRobot, kAssured, rem::kWhatAssured, MessageRole::kAnnounce),
    packet("REM_RobotAssuredAck", 0x39, 11, kFromRobot, kAck, rem::kWhatAck, MessageRole::kAcknowledge),
    packet("REM_RobotMusicCommand", 0x3A, 13, kToRobot, kMusic, rem::kWhatMusic),
    packet("REM_SX1280Filler", 0x3C, 6, kToRobot, kFiller, rem::kWhatFiller, MessageRole::kFiller),
    packet("REM_RobotKillCommand", 0x3F, 10, kToRobot, kHeader, rem::kWhatKill, MessageRole::kKill),
};
static_assert(all_tiled(kMessages));

constinit const RadioFormat kFormat{
    .id = "roboteam-rem-v5",
    .title = "RoboTeam Twente REM, version 5",
    .source = "https://github.com/RoboTeamTwente/roboteam_embedded_messages at 27e6961",
    .notes = rem::kCommonNotes,
    .carrier = {.kind = Carrier::Kind::kUsbCdc},
    .max_frame_bytes = 255,
    .messages = kMessages,
    .encode_command =
        [](const RobotCommand& command, const CommandTo& to, std::vector<std::uint8_t>& out) {
          return rem::encode_command(kMessages, command, to, out);
        },
    .command_drives = drives(OMNIHIL_MODE_BODY_VELOCITY),
    .dongle = make_rem_dongle,
};

}  // namespace

const RadioFormat& radio_format_roboteam_rem_v5() { return kFormat; }

}  // namespace omnihil

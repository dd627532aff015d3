// ER-Force's packets of 2025, alike behind each of their two serial framings, and what they mean to a robot.
// Each framing gives what stands in front of a packet, and takes its tables, kMessages of erforce Tables<kNoLead>.
//
// A packet is header and 28 bytes, fields without gaps from the lowest bit up. Neither header nor payload says which
// way it goes; a robot's answer is what is no command: halt has nothing but zeros behind it, the others their kind.
// Source: robotics-erlangen/radio-challenge-2026 8e02b3f, crate "connection".
#pragma once
#include <array>
#include <numbers>

#include "protocols/field_rows.h"
#include "protocols/scale_rules.h"

namespace omnihil::erforce {

inline constexpr double kPi = std::numbers::pi;
// Twenty times pi as the team has both, in float32.
inline constexpr double kFastestTurn_rad_s = 20.0F * static_cast<float>(kPi);
inline constexpr ChecksumRule kXorOfAll{.kind = &kXor8, .until = -1};

// Where the parts of a packet's kind stand in Message::type.
inline constexpr int kTrajectoryBit = 0, kDatagramBit = 4, kDatagramKindBit = 5, kZerosBit = 20,
                     kLeadBit = 24;
inline constexpr std::uint32_t kHalt = 0, kPath = 1, kGlobalSpline = 2, kLocalSpline = 3;
inline constexpr std::uint32_t kResponse = 1u << 16;  // no field has this bit
constexpr std::uint32_t datagram(std::uint32_t kind) { return 1u << kDatagramBit | kind << kDatagramKindBit; }

constexpr Field zeros(std::string_view name, int bits) {
  return enveloped(reserved(name, bits, "sent as 0"));
}
constexpr Field even(std::string_view name, int bits, double hi, std::string_view unit,
                     std::string_view what) {
  return scaled(name, bits, Sign::kTwosComplement, kEvenSteps, -hi, hi, unit, what);
}
constexpr Field up_to(std::string_view name, int bits, double hi, std::string_view unit,
                      std::string_view what) {
  return scaled(name, bits, Sign::kNone, kEvenSteps, 0.0, hi, unit, what);
}
constexpr Field angle(std::string_view name, int bits, std::string_view what) {
  return scaled(name, bits, Sign::kTwosComplement, kEvenStepsAround, -kPi, kPi, "rad", what);
}

inline constexpr std::array kHeader{
    number("counter", 6, "", "counts packets; the robot gives it back"),
    number("acknum", 1, "", "seqnum of the latest datagram part that came; 1 before the first"),
    enveloped(type_code_bits("datagram", 1, kDatagramBit, "1: a part of a datagram")),
};
inline constexpr std::array kBody{
    signed_number("time_offset", 8, "", "of the detection"),
    even("dribbler", 8, 1.0, "", "share of full speed; 0 is read as 0.004"),
    number("shot_power", 8, "", "strength of the kick; 0: none"),
    boolean("chip", "the kick is a chip"),
    boolean("charge", "charge the kicker"),
    boolean("force_kick", "kick without a look at the ball"),
    boolean("standby", "motors off"),
    boolean("eject_sdcard", "let go of the memory card"),
    boolean("has_detection", "the next three are of now"),
    only_if("has_detection", even("detection_pos_x", 11, 8.0, "m", "where vision sees the robot, x")),
    only_if("has_detection", even("detection_pos_y", 11, 8.0, "m", "where vision sees the robot, y")),
    only_if("has_detection", angle("detection_phi", 9, "its heading there")),
    number("unused", 7, "", "not used"),
    enveloped(
        type_code_bits("trajectory_type", 4, kTrajectoryBit, "0 halt, 1 path, 2 global, 3 local spline")),
};
constexpr Field halt_zeros(std::string_view name, int bits) {
  return enveloped(
      type_code_bits(name, bits, kZerosBit, "0 behind a halt; a robot's answer has something here"));
}
inline constexpr std::array kHaltRest{halt_zeros("rest[0]", 32), halt_zeros("rest[1]", 32),
                                      halt_zeros("rest[2]", 32), halt_zeros("rest[3]", 32),
                                      halt_zeros("rest[4]", 24)};
inline constexpr std::array kPathRest{
    even("trajectory.start_x", 11, 8.0, "m", "where it begins, x"),
    even("trajectory.start_y", 11, 8.0, "m", "where it begins, y"),
    angle("trajectory.start_phi", 9, "heading there"),
    even("trajectory.start_vel_x", 12, 6.0, "m/s", "velocity there, x"),
    even("trajectory.start_vel_y", 12, 6.0, "m/s", "velocity there, y"),
    angle("trajectory.end_phi", 9, "heading at its end"),
    even("trajectory.end_vel_x", 12, 6.0, "m/s", "velocity at its end, x"),
    even("trajectory.end_vel_y", 12, 6.0, "m/s", "velocity at its end, y"),
    angle("trajectory.alpha", 15, "direction of the acceleration"),
    up_to("trajectory.t", 15, 40.0, "s", "how long it takes"),
    up_to("trajectory.acc", 12, 15.0, "m/s^2", "acceleration"),
    up_to("trajectory.v_max", 12, 6.0, "m/s", "largest speed"),
    up_to("trajectory.slow_down_time", 9, 1.0, "s", "how long it brakes"),
    boolean("trajectory.fast_end", "it ends in motion"),
};
inline constexpr std::array kSplineRest{
    even("trajectory.x_pos", 11, 8.0, "m", "cubic in time: place"),
    even("trajectory.x_vel", 12, 6.0, "m/s", "velocity"),
    even("trajectory.x_acc", 13, 15.0, "m/s^2", "acceleration"),
    even("trajectory.x_jerk", 15, 100.0, "m/s^3", "jerk"),
    even("trajectory.y_pos", 11, 8.0, "m", "the same in y"),
    even("trajectory.y_vel", 12, 6.0, "m/s", "velocity"),
    even("trajectory.y_acc", 13, 15.0, "m/s^2", "acceleration"),
    even("trajectory.y_jerk", 15, 100.0, "m/s^3", "jerk"),
    angle("trajectory.phi_pos", 9, "the same of the heading"),
    even("trajectory.phi_vel", 10, kFastestTurn_rad_s, "rad/s", "yaw rate"),
    even("trajectory.phi_acc", 14, 15'000.0, "rad/s^2", "its acceleration"),
    even("trajectory.phi_jerk", 17, 400'000.0, "rad/s^3", "its jerk; the team's own decoder reads it wrong"),
};

// Names of one motor's state in a robot's answer.
struct MotorNames {
  std::string_view error, overheated, encoder_error, rest;
};
constexpr auto motor(const MotorNames& names) {
  return std::array{boolean(names.error, "it reports an error"), boolean(names.overheated, "it is too hot"),
                    boolean(names.encoder_error, "its encoder fails"), zeros(names.rest, 5)};
}
// Told from a command by these: an unknown kind of trajectory is refused here.
constexpr Field no_command(std::string_view name, int bits) {
  return enveloped(constant(name, bits, 0, "0"));
}
inline constexpr auto kResponseRows = in_order(
    std::array{up_to("battery", 8, 1.0, "", "share of a full battery"),
               up_to("packet_loss", 8, 1.0, "", "share of packets that did not come")},
    motor({"motor_status[0].error", "motor_status[0].overheated", "motor_status[0].encoder_error", "m0"}),
    motor({"motor_status[1].error", "motor_status[1].overheated", "motor_status[1].encoder_error", "m1"}),
    motor({"motor_status[2].error", "motor_status[2].overheated", "motor_status[2].encoder_error", "m2"}),
    motor({"motor_status[3].error", "motor_status[3].overheated", "motor_status[3].encoder_error", "m3"}),
    motor({"dribbler_status.error", "dribbler_status.overheated", "dribbler_status.encoder_error", "m4"}),
    std::array{
        boolean("kicker_status.error", "the kicker fails"),
        boolean("kicker_status.break_beam_error", "the light barrier fails"),
        zeros("kicker_rest", 6),
        boolean("imu_status.error", "the gyroscope fails"),
        zeros("imu_rest", 3),
        no_command("no_trajectory", 4),
        boolean("sd_status.error", "the memory card fails"),
        boolean("sd_status.mounted", "it can be written to"),
        boolean("sd_status.full", "it is full"),
        zeros("sd_rest", 5),
        even("load_torque[0]", 8, 10.0, "", "load of motor 1"),
        even("load_torque[1]", 8, 10.0, "", "load of motor 2"),
        even("load_torque[2]", 8, 10.0, "", "load of motor 3"),
        even("load_torque[3]", 8, 10.0, "", "load of motor 4"),
        even("dribbler_load_torque", 8, 10.0, "", "load of the dribbler"),
        even("measured_pos_x", 14, 8.0, "m", "place, x"),
        even("measured_pos_y", 14, 8.0, "m", "place, y"),
        even("measured_phi", 14, kPi, "rad", "heading; beyond its ends it is set to the end"),
        even("measured_vel_x", 15, 6.0, "m/s", "velocity, x"),
        even("measured_vel_y", 15, 6.0, "m/s", "velocity, y"),
        even("measured_omega", 14, kFastestTurn_rad_s, "rad/s", "yaw rate"),
        boolean("power_enabled", "the motors have power"),
        boolean("ball_detected", "it has the ball"),
        zeros("rest", 16),
    });

inline constexpr std::array kDatagramHead{
    number("seqnum", 1, "", "alternates from part to part, from 0"),
    enveloped(type_code_bits("type", 7, kDatagramKindBit, "what the datagram is")),
};
// 27 bytes: data[0] to data[26].
constexpr auto data_bytes() {
  constexpr std::string_view kNames[] = {
      "data[0]",  "data[1]",  "data[2]",  "data[3]",  "data[4]",  "data[5]",  "data[6]",
      "data[7]",  "data[8]",  "data[9]",  "data[10]", "data[11]", "data[12]", "data[13]",
      "data[14]", "data[15]", "data[16]", "data[17]", "data[18]", "data[19]", "data[20]",
      "data[21]", "data[22]", "data[23]", "data[24]", "data[25]", "data[26]"};
  std::array<Field, std::size(kNames)> fields{};
  for (std::size_t i = 0; i < fields.size(); ++i)
    fields[i] = number(kNames[i], 8, "", "the next 27 bytes of it");
  return fields;
}
inline constexpr std::array kCheck{enveloped(checksum("xor", 8, "of all before it", &kXorOfAll))};

// Rows and packets behind `kLead`, which stands before every packet (a type byte, or nothing).
template <const auto& kLead>
struct Tables {
  static constexpr auto kHaltRows = in_order(kLead, kHeader, kBody, kHaltRest, kCheck);
  static constexpr auto kPathRows = in_order(kLead, kHeader, kBody, kPathRest, kCheck);
  static constexpr auto kSplineRows = in_order(kLead, kHeader, kBody, kSplineRest, kCheck);
  static constexpr auto kResponses = in_order(kLead, kHeader, kResponseRows, kCheck);
  static constexpr auto kDatagrams = in_order(kLead, kHeader, kDatagramHead, data_bytes(), kCheck);
  static constexpr int kBytes = (kHaltRows.back().bit + 8) / 8;

  static constexpr Message row(std::string_view name, std::uint32_t type, Direction direction,
                               std::span<const Field> fields, std::string_view what,
                               MessageRole role = MessageRole::kNone) {
    return {name, type, kBytes, false, direction, BitOrder::kLsbFirst, fields, what, role};
  }
  static constexpr Message command(std::string_view name, std::uint32_t type, std::span<const Field> fields,
                                   std::string_view what) {
    return row(name, type, Direction::kToRobot, fields, what, MessageRole::kCommand);
  }
  static constexpr std::array kMessages{
      command("halt", kHalt, kHaltRows, "Stand still."),
      command("path", kPath, kPathRows, "Accelerate, drive, brake; in the field frame."),
      command("global_spline", kGlobalSpline, kSplineRows, "A cubic in time, field frame."),
      command("local_spline", kLocalSpline, kSplineRows, "A cubic in time, the robot's frame."),
      row("echo", datagram(0), Direction::kBoth, kDatagrams, "Give these bytes back (100), or they are."),
      row("read_robot_id", datagram(1), Direction::kBoth, kDatagrams, "Which robot is it? Back: data[0]."),
      row("read_board_ids", datagram(2), Direction::kBoth, kDatagrams, "Ids of its boards. Back: 84 bytes."),
      row("toggle_kick_calibration", datagram(3), Direction::kBoth, kDatagrams, "data[0]: on or off."),
      row("write_kick_calibration", datagram(4), Direction::kBoth, kDatagrams, "55 bytes of it."),
      row("response", kResponse, Direction::kFromRobot, kResponses, "A robot's answer.",
          MessageRole::kFeedback),
  };
  static_assert(all_tiled(kMessages));
};

}  // namespace omnihil::erforce

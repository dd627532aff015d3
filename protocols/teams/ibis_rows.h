// Rows of ibis' 64-byte command and of its 128-byte feedback, alike on the network and on the robot's serial line.
// Each carriage gives its first byte and what stands behind, and takes its tables, kMessages of ibis Tables<kFirstByte, kBehind>.
//
// Source: ibis-ssl/crane cd015fe, ibis-ssl/G474_Orion_main c7c89ec, ibis-ssl/Orion_CM4 28c3ca0.
#pragma once
#include <array>
#include <numbers>

#include "protocols/field_rows.h"
#include "protocols/scale_rules.h"

namespace omnihil::ibis {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kRange = 32.767;

constexpr Field word(std::string_view name, std::string_view unit, std::string_view what) {
  return scaled(name, 16, Sign::kNone, kAroundHalf, -kRange, kRange, unit, what);
}
constexpr Field angle(std::string_view name, std::string_view what) {
  return scaled(name, 16, Sign::kNone, kAroundHalf, -kPi, kPi, "rad", what);
}
constexpr Field power(std::string_view name, std::string_view what) {
  return scaled(name, 8, Sign::kNone, kTwentieths, 0.0, 12.75, "", what);
}

// Bytes 1 to 23, in both carriages.
inline constexpr std::array kHead{
    number("check_counter", 8, "", "counts up to 200 and begins again; the robot gives it back", 0, 200),
    word("vision_global_pos[0]", "m", "x on the field as vision sees it"),
    word("vision_global_pos[1]", "m", "y on the field as vision sees it"),
    angle("vision_global_theta", "heading as vision sees it"),
    angle("target_global_theta", "heading to hold"),
    power("kick_power", "strength of the kick, 0 to 1; 0: none"),
    power("dribble_power", "strength of the dribbler, 0 to 1"),
    word("acceleration_limit", "m/s^2", "largest acceleration"),
    word("linear_velocity_limit", "m/s", "largest speed"),
    word("angular_velocity_limit", "rad/s", "largest yaw rate"),
    number("latency_time_ms", 16, "ms", "age of what the host knows"),
    number("elapsed_time_ms_since_last_vision", 16, "ms", "since vision last saw the robot"),
    reserved("flags_6_7", 2, "not used"),
    flag("prioritize_accurate_acceleration", "keep the direction of the acceleration"),
    flag("prioritize_move", "moving comes before turning"),
    flag("stop_emergency", "stop now"),
    flag("lift_dribbler", "lift the dribbler"),
    flag("enable_chip", "the kick is a chip"),
    flag("is_vision_available", "the vision fields are of now"),
    type_code("control_mode", 8, "what the arguments mean"),
};
inline constexpr std::array kVelocity{
    word("mode_args.target_global_vel[0]", "m/s", "velocity wanted, field frame x"),
    word("mode_args.target_global_vel[1]", "m/s", "velocity wanted, field frame y"),
};

// What follows the arguments, up to byte 64: sent as 0.
constexpr Field rest(std::string_view name, int bits) { return enveloped(reserved(name, bits, "sent as 0")); }
inline constexpr std::array kRest24{rest("rest[0]", 64), rest("rest[1]", 64), rest("rest[2]", 64)};

constexpr Field tx(std::string_view name, std::string_view unit, std::string_view what) {
  return float32(name, unit, what);
}
inline constexpr auto kFeedback = in_order(std::array{
    type_code_bits("sync0", 8, 0, "begins each packet"),
    type_code_bits("sync1", 8, 8, "begins each packet"),
    number("checksum", 8, "",
           "sum of bytes 3 to 127 by the receiver's tools; the main board writes 10, so nobody may check it"),
    number("check_counter", 8, "", "that of the latest command"),
    float32("imu_yaw_deg", "deg", "heading by the gyroscope"),
    float32("battery_voltage_bldc_right", "V", "battery at the right motor board"),
    number("ball_detection[0]", 8, "", "ball sensor"),
    number("ball_detection[1]", 8, "", "ball sensor"),
    number("ball_detection[2]", 8, "", "ball sensor"),
    number("kick_state_div10", 8, "", "a tenth of the kicker's counter"),
    number("current_error_id", 16, "", "board that reports an error; 0: none"),
    number("current_error_info", 16, "", "what it reports"),
    float32("current_error_value", "", "its value"),
    number("motor_current_x10[0]", 8, "0.1 A", "current of motor 0"),
    number("motor_current_x10[1]", 8, "0.1 A", "current of motor 1"),
    number("motor_current_x10[2]", 8, "0.1 A", "current of motor 2"),
    number("motor_current_x10[3]", 8, "0.1 A", "current of motor 3"),
    number("ball_detection_extra", 8, "", "fourth ball sensor"),
    number("temp_motor[0]", 8, "deg C", "temperature of motor 0"),
    number("temp_motor[1]", 8, "deg C", "temperature of motor 1"),
    number("temp_motor[2]", 8, "deg C", "temperature of motor 2"),
    number("temp_motor[3]", 8, "deg C", "temperature of motor 3"),
    number("temp_fet", 8, "deg C", "temperature of the bridges"),
    number("temp_coil[0]", 8, "deg C", "temperature of the kicker's coil"),
    number("temp_coil[1]", 8, "deg C", "temperature of the chipper's coil"),
    float32("diff_angle_deg", "deg", "heading by the gyroscope less that of vision"),
    float32("capacitor_boost_voltage", "V", "kicker's capacitor"),
    float32("vision_based_position_x", "m", "place on the field, x"),
    float32("vision_based_position_y", "m", "place on the field, y"),
    float32("global_odom_speed_x", "m/s", "velocity by the wheels, field frame x"),
    float32("global_odom_speed_y", "m/s", "velocity by the wheels, field frame y"),
    number("camera_pos_x_div2", 8, "2 px", "ball in the camera, x / 2"),
    number("camera_pos_y", 8, "px", "ball in the camera, y"),
    number("camera_radius_div4", 8, "4 px", "ball in the camera, radius / 4"),
    number("camera_fps", 8, "1/s", "pictures of the camera per second"),
    tx("tx_value_array[0]", "m", "optical mouse, x"),
    tx("tx_value_array[1]", "m", "optical mouse, y"),
    tx("tx_value_array[2]", "m/s", "velocity by the mouse, field frame x"),
    tx("tx_value_array[3]", "m/s", "velocity by the mouse, field frame y"),
    tx("tx_value_array[4]", "m/s", "velocity the controller asks for, x"),
    tx("tx_value_array[5]", "m/s", "velocity the controller asks for, y"),
    tx("tx_value_array[6]", "rev/s", "motor 0"),
    tx("tx_value_array[7]", "rev/s", "motor 1"),
    tx("tx_value_array[8]", "rev/s", "motor 2"),
    tx("tx_value_array[9]", "rev/s", "motor 3"),
    tx("tx_value_array[10]", "m/s", "velocity by the wheels, forward"),
    tx("tx_value_array[11]", "m/s", "velocity by the wheels, left"),
    tx("tx_value_array[12]", "rad/s", "yaw rate by the wheels"),
    tx("tx_value_array[13]", "", "quality of the mouse's picture"),
    reserved("reserved", 64, "not used"),
});

enum Mode : std::uint32_t { kLocal = 0, kPlace = 1, kVelocityXy = 2, kVelocityPolar = 3, kState = 0xEAAB };

// Packets whose first byte is `kLead`, bytes 1 to 63 those of the command, and `kTail` behind them.
template <const auto& kLead, const auto& kTail>
struct Tables {
  static constexpr auto kLocalCamera =
      in_order(kLead, kHead,
               std::array{word("mode_args.ball_pos[0]", "m", "the ball in the robot's camera, x"),
                          word("mode_args.ball_pos[1]", "m", "the ball in the robot's camera, y"),
                          word("mode_args.ball_vel[0]", "m/s", "velocity of the ball, x"),
                          word("mode_args.ball_vel[1]", "m/s", "velocity of the ball, y")},
               kVelocity, kRest24, std::array{rest("rest[3]", 32)}, kTail);
  static constexpr auto kPosition =
      in_order(kLead, kHead,
               std::array{word("mode_args.target_global_pos[0]", "m", "place wanted on the field, x"),
                          word("mode_args.target_global_pos[1]", "m", "place wanted on the field, y"),
                          word("mode_args.terminal_velocity", "m/s", "speed wanted there")},
               kRest24, std::array{rest("rest[3]", 64), rest("rest[4]", 16)}, kTail);
  static constexpr auto kSimpleVelocity =
      in_order(kLead, kHead, kVelocity, kRest24, std::array{rest("rest[3]", 64), rest("rest[4]", 32)}, kTail);
  static constexpr auto kPolarVelocity =
      in_order(kLead, kHead,
               std::array{word("mode_args.target_global_velocity_r", "m/s", "speed wanted"),
                          word("mode_args.target_global_velocity_theta", "rad",
                               "its direction in the field frame; the range is 32.767, not pi")},
               kRest24, std::array{rest("rest[3]", 64), rest("rest[4]", 32)}, kTail);

  static constexpr Message command(std::string_view name, Mode mode, std::span<const Field> fields,
                                   std::string_view what) {
    const int bytes = (fields.back().bit + fields.back().bits) / 8;
    return {name,
            mode,
            bytes,
            false,
            Direction::kToRobot,
            BitOrder::kMsbFirst,
            fields,
            what,
            MessageRole::kCommand};
  }
  static constexpr std::array kMessages{
      command("LOCAL_CAMERA", kLocal, kLocalCamera, "Velocity, with the ball as the robot's camera sees it."),
      command("POSITION_TARGET", kPlace, kPosition, "Go to a place."),
      command("SIMPLE_VELOCITY_TARGET", kVelocityXy, kSimpleVelocity, "Velocity in the field frame."),
      command("POLAR_VELOCITY_TARGET", kVelocityPolar, kPolarVelocity,
              "Velocity in the field frame as speed and direction (Orion, 2026)."),
      Message{"FEEDBACK", kState, 128, false, Direction::kFromRobot, BitOrder::kLsbFirst, kFeedback,
              "The robot's answer to each command.", MessageRole::kFeedback},
  };
  static_assert(all_tiled(kMessages));
};

}  // namespace omnihil::ibis

// Every number the hidden robot knows, with its value in a robot that has nothing hidden in it.
#pragma once

// clang-format off
#define ROBOT_PARAMS(X)                                                                                  \
  X(step_s, 40e-6) X(sample_s, 1e-3) X(seed, 1)                                                            \
  /* drives, all alike */                                                                                \
  X(resistance_ohm, 0.464) X(inductance_H, 0.3e-3) X(flux_Vs, 0.0335) X(rotor_kgm2, 1.35e-5)                \
  X(viscous_Nms, 4e-6) X(dry_Nm, 2.7e-3) X(gear, 3) X(supply_V, 22.2) X(supply_drift_V, 0)                  \
  X(supply_drift_Hz, 0.05)                                                                               \
  /* body and wheels */                                                                                  \
  X(mass_kg, 2.4) X(yaw_kgm2, 0.012) X(height_m, 0.045) X(base_m, 0.0805) X(wheel_m, 0.027)                 \
  X(wheel_kgm2, 2.2e-5) X(angle_1, 55) X(angle_2, 135) X(angle_3, 225) X(angle_4, 305) X(angle_5, 0) X(angle_6, 0) X(wheels, 4)  \
  /* tyre: as a model file declares it */                                                                \
  X(grip, 0.75) X(grip_slip, 0.10) X(slide_slip, 0.4) X(slide_grip, 0.6) X(slip_floor_m_s, 0.5) X(roller_grip, 0.02)           \
  /* hidden on the floor */                                                                              \
  X(brush, 0) X(brush_m_s, 0) X(brush_grip, 0.6) X(roller_drag, 0) X(roller_ripple, 0)                      \
  X(rollers, 15) X(roller_phase, 0) X(rolling, 0) X(offset_x_m, 0) X(offset_y_m, 0) X(payload_kg, 0)        \
  X(tilt_rad, 0) X(tilt_towards, 0) X(radius_1, 1) X(radius_2, 1) X(radius_3, 1) X(radius_4, 1) X(radius_5, 1) X(radius_6, 1)  \
  X(flux_1, 1) X(flux_2, 1) X(flux_3, 1) X(flux_4, 1) X(flux_5, 1) X(flux_6, 1) X(dribbler_N, 0) X(late_vision_s, 0)   \
  X(nap, 0) X(nap_towards, 0) X(soft_spot, 0)                                                            \
  /* hidden in the drives */                                                                             \
  X(battery_ohm, 0) X(battery_rc_ohm, 0) X(battery_rc_s, 0.5) X(edge_V, 0) X(edge_A, 0.2) X(cog_Nm, 0)     \
  X(cog_order, 48) X(cog_phase, 0) X(cog2_Nm, 0) X(drag_Nm, 0) X(current_cap_A, 0) X(late_command_s, 0)    \
  X(loaded_ratio, 0) X(contact_ohm, 0) X(contact_s, 0.4)                                                 \
  /* broken: share of a motor's torque that reaches its wheel, friction added there, an encoder that tells nothing new */ \
  X(push_1, 1) X(push_2, 1) X(push_3, 1) X(push_4, 1) X(rub_1_Nm, 0) X(rub_2_Nm, 0) X(rub_3_Nm, 0)          \
  X(rub_4_Nm, 0) X(dead_1, 0) X(dead_2, 0) X(dead_3, 0) X(dead_4, 0)                                        \
  /* firmware: with radio = 1 rows ask for vx, vy, w instead of duties */                                \
  X(radio, 0) X(loop_kp, 0.03) X(loop_ki, 0.3) X(loop_ff, 0.0335) X(loop_filter_s, 0.003) X(late_radio_s, 0.02) \
  X(loop_accel_m_s2, 6) X(loop_alpha_rad_s2, 60) X(loop_wheel_m, 0.027) X(loop_base_m, 0.0805)               \
  X(loop_kick_V, 0) X(loop_kick_rad_s, 20) X(loop_bend, 0)                                                 \
  /* sensors */                                                                                          \
  X(encoder_cpr, 16384) X(current_noise_A, 0.05) X(bus_noise_V, 0.02) X(gyro_noise_rad_s, 0.01)            \
  X(accel_noise_m_s2, 0.15) X(vision_noise_m, 0.0008) X(vision_noise_rad, 0.004) X(vision_Hz, 60)
// clang-format on

typedef struct {
#define X(name, value) double name;
  ROBOT_PARAMS(X)
#undef X
} RobotParams;

// Columns of what is asked for and of a record. Camera cells between frames are NaN.
enum { BOT_ASKED = 7 };
enum {
  BOT_BUS,
  BOT_CURRENT,
  BOT_COUNTS = BOT_CURRENT + 6,
  BOT_GYRO = BOT_COUNTS + 6,
  BOT_AX,
  BOT_AY,
  BOT_CAM_X,
  BOT_CAM_Y,
  BOT_CAM_TURN,
  BOT_X,
  BOT_Y,
  BOT_TURN,
  BOT_SPEED,  // four, at the wheels, as the firmware measures them
  BOT_LAST_SPEED = BOT_SPEED + 3,
  BOT_COLUMNS
};

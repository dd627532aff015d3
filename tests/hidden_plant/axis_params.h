// Every number the hidden axis knows, with its value in a drive that has nothing hidden in it.
// The test of the diagnosis is generated from these; nothing here is shared with the program under test.
#pragma once

// clang-format off
#define AXIS_PARAMS(X)                                                                                   \
  /* how it is run */                                                                                    \
  X(step_s, 25e-6)            /* integration step */                                                     \
  X(sample_s, 1e-3)           /* time between rows of a record */                                        \
  X(command_kind, 0)          /* 0 duty, 1 position target of a servo, 2 speed target of a closed loop */  \
  X(seed, 1)                  /* of everything random within the plant */                                \
  /* drive */                                                                                            \
  X(resistance_ohm, 0.447) X(inductance_H, 0.243e-3) X(flux_Vs, 0.0295) X(pole_pairs, 8)                   \
  X(rotor_kgm2, 1.35e-5) X(load_kgm2, 6e-5) X(gear, 1) X(viscous_Nms, 5e-6) X(dry_Nm, 4e-3)                \
  X(supply_V, 24) X(supply_drift_V, 0) X(supply_drift_Hz, 0.05) X(pendulum_Nm, 0)                          \
  X(servo_duty_per_rad, 0) X(servo_duty_limit, 1) X(loop_kp, 0) X(loop_ki, 0)                              \
  /* friction */                                                                                         \
  X(dry_direction, 0) X(viscous_direction, 0) X(bristles, 0) X(bristle_Nm_per_rad, 3)                      \
  X(bristle_damping_Nms, 0.02) X(breakaway_ratio, 0) X(breakaway_rad_s, 5) X(loaded_ratio, 0)             \
  X(loaded_edge_Nm, 2e-3) X(gear_loss, 0) X(gear_edge_W, 0.03) X(drag_Nm, 0) X(drag_power, 2)              \
  /* angle */                                                                                            \
  X(cog_Nm, 0) X(cog_order, 48) X(cog_phase, 0) X(cog2_Nm, 0) X(cog2_order, 96) X(cog2_phase, 0)           \
  X(cog3_Nm, 0) X(cog3_order, 12) X(cog3_phase, 0) X(ripple, 0) X(ripple_order, 48) X(ripple_phase, 0)     \
  X(ripple2, 0) X(pendulum2_Nm, 0) X(pendulum2_phase, 0) X(unbalance_Nm, 0) X(unbalance_phase, 0)          \
  X(push_Nm, 0)                                                                                          \
  /* heat: winding, housing, magnet */                                                                    \
  X(copper_per_K, 0) X(magnet_per_K, 0) X(winding_K_per_W, 8.28) X(winding_J_per_K, 3.5)                   \
  X(housing_K_per_W, 1.57) X(housing_J_per_K, 50) X(magnet_share, 1) X(derating_A_per_K, 0)               \
  X(derating_from_K, 30) X(derating_full_A, 40)                                                          \
  /* winding, bridge, supply */                                                                          \
  X(knee_A, 0) X(back_emf_lost, 0) X(advance_rad, 0) X(edge_V, 0) X(edge_A, 0.2) X(coast_band, 0)          \
  X(battery_ohm, 0) X(battery_rc_ohm, 0) X(battery_rc_s, 0.5) X(battery_fall_V_per_As, 0)                  \
  X(current_cap_A, 0) X(current_cap_ohm, 12) X(duty_cap, 1) X(duty_steps, 0)                               \
  X(target_rate_rad_s, 0) X(late_command_s, 0) X(smooth_s, 0) X(most_duty_per_s, 0)                       \
  /* between rotor and output */                                                                         \
  X(play_rad, 0) X(shaft_Nm_per_rad, 0) X(shaft_damping_Nms, 0)                                           \
  /* sensors */                                                                                          \
  X(encoder_cpr, 4096) X(encoder_on_output, 0) X(encoder_swing_rad, 0) X(encoder_swing_phase, 0)           \
  X(lost_per_count, 0) X(late_sample_s, 0) X(sample_jitter_s, 0) X(hall_pulses, 0) X(hall_window_s, 0)     \
  X(speed_filter_s, 0) X(current_filter_s, 0)                                                              \
  X(current_noise_A, 0.03) X(bus_noise_V, 0.02) X(speed_noise_rad_s, 0.3) X(angle_noise_rad, 1e-3)         \
  /* what no list of effects has */                                                                      \
  X(seam_Nm, 0) X(seam_turns, 3.37) X(bump_Nm, 0) X(bump_angle, 1) X(run_in_ratio, 0) X(run_in_rad, 800)    \
  X(contact_ohm, 0) X(contact_s, 0.4) X(hum_V, 0) X(hum_Hz, 47) X(hub_Nm, 0) X(hub_rad, 1)                 \
  X(notch_Hz, 0) X(notch_width, 0.7) X(cable_Nm_per_rad, 0)
// clang-format on

typedef struct {
#define X(name, value) double name;
  AXIS_PARAMS(X)
#undef X
} AxisParams;

// Columns of a raw record, one row per sample instant.
enum {
  RAW_COMMAND,
  RAW_BUS,
  RAW_CURRENT,
  RAW_ANGLE,
  RAW_SPEED,
  RAW_OUT_ANGLE,
  RAW_OUT_SPEED,
  RAW_WINDING_K,
  RAW_COLUMNS
};
// Columns of what the sensors make of it.
enum { SEEN_COUNTS, SEEN_BUS, SEEN_CURRENT, SEEN_SPEED, SEEN_ANGLE, SEEN_COLUMNS };
// Energies of a whole run, for the balance.
enum { SUM_IN_J, SUM_LOST_J, SUM_STORED_J, SUM_COLUMNS };

/* The reference firmware on three-phase bridges: the same robot control, with the motor loop closed here.
 *
 *   const omnihil_firmware_api* api = omnihil_foc_firmware();        // or omnihil_six_step_firmware()
 *   api->init(state, &config);
 *   api->motor_init(state, &motors);
 *   api->tick(state, &sensors, &drive);                            // every 1 ms
 *   api->motor_tick(state, &motor_sensors, &motor_drive);          // every PWM period
 *
 * foc        tick() moves the reference as ever (motion_reference.h); motor_tick() runs current loops and a
 *            speed loop (foc_controller.h) per motor, by the angle sensor and the phase currents, speed from
 *            the encoder's counts at 1 kHz. Bandwidths: current 1 kHz (a twentieth of slower PWM), speed 12 Hz
 *            for the robot's mass on the wheels. WHEEL_DUTY: that voltage along q, no loop.
 * six_step   tick() closes the speed loop as ever; motor_tick() turns its duty into legs by the Hall sensors
 *            (six_step_controller.h), slow decay on both sides (complementary).
 * Without motor_init() (a robot without three-phase drives) both drive by duty, as the reference firmware.
 * Gains of the wheels: foc has p in A s/rad and i in A/rad at the rotor, no d.
 * Cannot: what the controllers cannot; find the zero of its angle sensor (it is aligned).
 */
#ifndef OMNIHIL_REFERENCE_PHASE_FIRMWARE_H
#define OMNIHIL_REFERENCE_PHASE_FIRMWARE_H
#include "firmware_iface/reference/foc_controller.h"
#include "firmware_iface/reference/reference_firmware.h"
#include "firmware_iface/reference/six_step_controller.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum phase_wheel_mode { PHASE_OFF = 0, PHASE_VOLTAGE = 1, PHASE_SPEED = 2 } phase_wheel_mode;

typedef struct phase_wheel {
  phase_wheel_mode mode; /* as the last tick() asked */
  float duty_ratio;      /* PHASE_VOLTAGE */
  float omega_ref_rad_s; /* PHASE_SPEED, rotor */
  foc_state foc;
  six_step_state six_step;
} phase_wheel;

typedef struct phase_state {
  reference_state base; /* first: its functions take a phase_state */
  omnihil_motor_config motors;
  uint32_t ready; /* motor_init() was called */
  float period_s;
  foc_motor motor;
  foc_gains gains;
  six_step_settings six_step;
  phase_wheel wheel[OMNIHIL_WHEELS];
} phase_state;

/* motor_init(): why the motors were refused; reference_firmware.h has those of init() */
enum { REFERENCE_MOTOR_NOT_POSITIVE = 16 /* a resistance, inductance, flux, inertia or frequency is <= 0 */ };

const omnihil_firmware_api* omnihil_foc_firmware(void);
const omnihil_firmware_api* omnihil_six_step_firmware(void);

#ifdef __cplusplus
}
#endif
#endif

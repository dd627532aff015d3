/* Four speed loops at 8 kHz on the board of the reference firmware, with its own wheel controller and tuning:
 * what a fast inner loop costs. Between two periods the core sleeps; with NEVER_SLEEPS it computes on in
 * main(). */
#include "firmware_iface/reference/board_stm32f405/board.h"
#include "firmware_iface/reference/board_stm32f405/robot_page.h"
#include "firmware_iface/reference/board_stm32f405/stm32f405.h"
#include "firmware_iface/reference/wheel_tuning.h"

enum { PERIOD_US = 125, PWM_STEPS = 8400 };
static const float kPeriod_s = PERIOD_US * 1e-6f;
static const float kOmegaRotor_rad_s = 60.0f;
static const float kShare = 0.1f; /* low-pass of the speed, 1.1 ms */
static const float kBus_V = 22.2f;

static wheel_tuning tuning;
static float omega_rotor_rad_s[OMNIHIL_WHEELS];
static int64_t last[OMNIHIL_WHEELS];
static wheel_loop loop[OMNIHIL_WHEELS];
volatile float background = 1.0f;

void board_tick(void) {
  int64_t counts[OMNIHIL_WHEELS];
  board_encoders_read(counts);
  for (uint32_t w = 0; w < OMNIHIL_WHEELS; ++w) {
    float raw_rad_s = (float)(int32_t)(counts[w] - last[w]) * (tuning.encoder.rad_per_count / kPeriod_s);
    last[w] = counts[w];
    omega_rotor_rad_s[w] += kShare * (raw_rad_s - omega_rotor_rad_s[w]);
    const wheel_loop_input input = {.omega_ref_rad_s = kOmegaRotor_rad_s,
                                    .omega_rad_s = omega_rotor_rad_s[w],
                                    .accel_rad_s2 = 0.0f,
                                    .torque_feedforward_Nm = 0.0f,
                                    .bus_V = kBus_V,
                                    .dt_s = kPeriod_s};
    float duty_ratio = wheel_loop_update(&loop[w], &tuning.gains, &tuning.motor, &input);
    STM32_GPIOE->BSRR = duty_ratio < 0.0f ? STM32_PIN_CLEAR(w) : STM32_PIN_SET(w);
    STM32_TIM1->CCR[w] = (uint32_t)((duty_ratio < 0.0f ? -duty_ratio : duty_ratio) * (float)PWM_STEPS + 0.5f);
  }
  board_watchdog_feed();
}

int main(void) {
  omnihil_robot_config config;
  board_clock_init();
  board_motors_init();
  if (robot_page_read(&config) == 0) {
    wheel_tuning_init(&tuning, &config, kPeriod_s);
    board_encoders_init();
    STM32_GPIOE->BSRR = 0xF0u; /* the bridges' enable pins */
    board_watchdog_start();
    board_tick_start(PERIOD_US);
  }
  for (;;) {
#ifdef NEVER_SLEEPS
    background = background * 0.999f + 0.001f * loop[0].duty_ratio;
#else
    __asm volatile("wfi");
#endif
  }
}

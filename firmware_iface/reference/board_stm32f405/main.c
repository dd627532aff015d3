/* The reference firmware on the board: the table's calls in the bench's order, once per control period, from
 * the timer's interrupt. Between two periods the core sleeps. */
#include "firmware_iface/reference/board_stm32f405/board.h"
#include "firmware_iface/reference/board_stm32f405/robot_page.h"

enum { STATE_BYTES = 8192, FRAME_BYTES = 64 };

static _Alignas(16) uint8_t state[STATE_BYTES];
static const omnihil_firmware_api* api;
static uint64_t now_us;

static void read_radio(void) {
  uint8_t bytes[64];
  for (;;) {
    size_t count = board_radio_take(bytes, sizeof bytes);
    if (count == 0) return;
    api->radio_receive(state, bytes, count, now_us);
  }
}

static void answer_radio(void) {
  uint8_t frame[FRAME_BYTES];
  for (;;) {
    size_t count = api->radio_transmit(state, frame, sizeof frame);
    if (count == 0 || !board_radio_send(frame, count)) return;
  }
}

void board_tick(void) {
  omnihil_sensors sensors = {.now_us = now_us};
  omnihil_drive drive;
  board_battery_start();
  board_encoders_read(sensors.encoder_counts);
  read_radio();
  sensors.bus_voltage_V = board_battery_V();
  api->tick(state, &sensors, &drive);
  board_motors_drive(&drive);
  answer_radio();
  now_us += api->control_period_us;
  board_watchdog_feed();
}

int main(void) {
  omnihil_robot_config config;
  board_clock_init();
  board_motors_init();
  api = omnihil_firmware_get(OMNIHIL_FIRMWARE_ABI);
  int good = robot_page_read(&config) == 0 && api != NULL && api->state_bytes <= sizeof state;
  config.robot_id = board_robot_id();
  if (good && api->init(state, &config) == 0) {
    board_encoders_init();
    board_battery_init();
    board_radio_init();
    board_watchdog_start();
    board_tick_start(api->control_period_us);
  }
  for (;;) __asm volatile("wfi"); /* a robot without a page stays here, its bridges off */
}

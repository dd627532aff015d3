/* One wheel of the reference firmware on its board: the control loop by interrupt every 2 ms; the main loop
 * takes the radio and makes the next plan, and sleeps otherwise. */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>
#include <avr/wdt.h>

#include "firmware_iface/reference/board_atmega328p/board.h"
#include "firmware_iface/reference/wheel_node.h"

static wheel_node node;

void board_control(void) {
  wheel_node_drive drive = wheel_node_control(&node, board_encoder_counts(), board_battery_V());
  board_bridge_drive(drive.on, drive.duty_ratio);
}

static void answer_radio(void) {
  uint8_t frame[HERMES_ANSWER_BYTES];
  uint8_t count = (uint8_t)hermes_radio_transmit(&node.radio, frame, sizeof frame);
  if (count > 0) board_radio_send(frame, count);
}

int main(void) {
  omnihil_robot_config config;
  MCUSR = 0;
  wdt_disable(); /* it stays on after a reset of its own */
  board_bridge_init();
  if (board_config(&config) == 0 && wheel_node_init(&node, &config, board_wheel()) == 0) {
    board_encoder_init();
    board_battery_init();
    board_radio_init();
    board_control_start();
  }
  set_sleep_mode(SLEEP_MODE_IDLE);
  sei();
  for (;;) {
    uint8_t byte;
    while (board_radio_take(&byte)) wheel_node_byte(&node, byte);
    if (node.plan_due) wheel_node_plan(&node);
    answer_radio();
    sleep_mode(); /* until any interrupt: at the latest the next control period */
  }
}

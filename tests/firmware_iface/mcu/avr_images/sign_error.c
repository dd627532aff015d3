/* Wheel 2 wired the wrong way round, motor and encoder alike: its loop is stable and drives it backwards. */
#include "firmware_iface/reference/board_atmega328p/board.h"

enum { WRONG = 2 };

void __real_board_bridge_drive(uint8_t on, float duty_ratio);
void __wrap_board_bridge_drive(uint8_t on, float duty_ratio);
int32_t __real_board_encoder_counts(void);
int32_t __wrap_board_encoder_counts(void);

void __wrap_board_bridge_drive(uint8_t on, float duty_ratio) {
  __real_board_bridge_drive(on, board_wheel() == WRONG ? -duty_ratio : duty_ratio);
}

int32_t __wrap_board_encoder_counts(void) {
  int32_t counts = __real_board_encoder_counts();
  return board_wheel() == WRONG ? -counts : counts;
}

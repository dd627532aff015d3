// What passes on the buses of a board, drawn as the levels of their lines and as the bytes that they mean.
//
//   watch_buses(board, log, "robot0");             // before it runs; the log outlives it
//
// USART2_TX, USART2_RX: levels of each frame at its baud rate, and the byte for as long as it is under way (…_byte). SPI1_SCK, _MOSI,
// _MISO: in the clock's mode, high bit first; the chip select is a pin. CAN1: the wire with stuff bits, check sum and the
// acknowledgement that it gets here always, identifier and data (CAN1_id, CAN1_data, the first eight bytes); of a frame of
// CAN FD these two alone. Frames that come at one instant are drawn one behind the other. Not drawn: I2C.
#pragma once
#include <string>

#include "firmware_iface/mcu/board/board.h"
#include "hil/observe/wave_log.h"

namespace omnihil {

void watch_buses(mcu::McuBoard& board, WaveLog& log, const std::string& scope);

}  // namespace omnihil

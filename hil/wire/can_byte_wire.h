// A board's bytes over CAN: the stream of frames cut into CAN frames, one id each way.
//
//   auto wire = make_can_byte_wire(std::move(can), false);       // classic, 8 bytes a frame
//   auto faster = make_can_byte_wire(std::move(can_fd), true);   // CAN FD with bit rate switch, 64 bytes a frame
//
// Bench to board 7E0h, board to bench 7E8h, 11-bit ids; other ids are left to others. A lost CAN frame
// damages the frame that it was part of; its checksum sees it. A CAN FD frame that is not full is padded with
// 00, which ends no frame that has not ended. At 1 Mbit/s classic CAN carries both frames of a period in
// about 1.4 ms: 500 Hz; CAN FD at 5 Mbit/s in 0.3 ms.
#pragma once
#include <memory>

#include "firmware_iface/motor_bus/frame_wire.h"
#include "hil/wire/byte_wire.h"

namespace omnihil {

inline constexpr std::uint32_t kCanToBoard = 0x7E0, kCanFromBoard = 0x7E8;

// Over any wire for CAN frames; `fd`: CAN FD.
std::unique_ptr<ByteWire> make_can_byte_wire(std::unique_ptr<FrameWire> can, bool fd);

}  // namespace omnihil

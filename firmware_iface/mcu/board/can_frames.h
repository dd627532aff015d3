// CAN frames of a chip as those of a bus, and back.
//
//   can.receive(can_frame_of(frame));
//   wire.write(bus_frame_of(sent));
#pragma once
#include <algorithm>

#include "firmware_iface/mcu/stm32/can.h"
#include "firmware_iface/motor_bus/bus_frame.h"

namespace omnihil::mcu {

inline CanFrame can_frame_of(const BusFrame& f) {
  CanFrame frame{.id = f.id,
                 .extended = f.extended,
                 .remote = f.remote,
                 .fd = f.fd,
                 .fast = f.bitrate_switch,
                 .bytes = f.size,
                 .data = {}};
  std::copy_n(f.data.begin(), frame.data.size(), frame.data.begin());
  return frame;
}

inline BusFrame bus_frame_of(const CanFrame& f) {
  BusFrame frame{.id = f.id,
                 .extended = f.extended,
                 .remote = f.remote,
                 .fd = f.fd,
                 .bitrate_switch = f.fast,
                 .size = f.bytes};
  std::copy(f.data.begin(), f.data.end(), frame.data.begin());
  return frame;
}

}  // namespace omnihil::mcu

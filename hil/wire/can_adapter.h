// A USB-CAN adapter's serial language, from the adapter's side. Pure: bytes in, frames and answers out.
//
//   std::unique_ptr<CanAdapter> adapter = make_slcan_adapter();
//   adapter->receive(bytes, frames, answer);      // what the host wrote; `answer` goes back to it
//   adapter->send(frame, answer);                 // a frame of the bus, as the host reads it
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "firmware_iface/motor_bus/bus_frame.h"

namespace omnihil {

class CanAdapter {
 public:
  virtual ~CanAdapter() = default;
  virtual void receive(std::span<const std::uint8_t> bytes, std::vector<BusFrame>& frames,
                       std::string& answer) = 0;
  virtual bool send(const BusFrame& frame, std::string& answer) = 0;  // false: closed, or cannot carry it
  virtual void host_closed() = 0;
  std::uint64_t bad_lines() const { return bad_lines_; }

 protected:
  std::uint64_t bad_lines_ = 0;
};

// Their wires: hil/wire/kinds. LAWICEL / CAN232 ASCII, as slcand, python-can "slcan" and most USB-CAN sticks speak it.
std::unique_ptr<CanAdapter> make_slcan_adapter();
// mjbots fdcanusb, as the moteus client library speaks it.
std::unique_ptr<CanAdapter> make_fdcanusb_adapter();

// Length codes of CAN FD: 0 to 8 as they are, then 12, 16, 20, 24, 32, 48, 64.
int can_fd_length(int code);         // code 0 .. 15
int can_fd_code(std::size_t bytes);  // the smallest code that holds them

// "0A1b" -> bytes; false: not hexadecimal, odd, or longer than `out` holds.
bool read_hex(std::string_view text, std::span<std::uint8_t> out, std::size_t& size);
bool read_hex_number(std::string_view text, std::uint32_t& value);

}  // namespace omnihil

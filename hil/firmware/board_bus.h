// CAN between the boards of one robot: [[port]] of = "CAN1", as = "bus:NAME" on each of them.
//
//   BoardBuses buses;                                // of the robot
//   buses.join("wheels", board0, can0);  buses.join("wheels", board1, can1);
//
// What one sends all others of the bus receive, one coupling period after its last bit has left: boards run one after the other
// for such a period each, and what arrives keeps the distances and the order in which it was sent. The same bits every time.
// Cannot: arbitration (frames that overlap all arrive), errors; whoever is alone on a bus is acknowledged by nobody.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "firmware_iface/mcu/board/board.h"
#include "firmware_iface/mcu/stm32/can.h"

namespace omnihil {

class BoardBuses {
 public:
  struct Counts {
    std::uint64_t out = 0, in = 0;
  };
  // Both outlive it. What passes at this end, counted.
  std::shared_ptr<const Counts> join(const std::string& name, mcu::McuBoard& board, mcu::CanPort& can);
  bool empty() const { return buses_.empty(); }
  std::size_t ends_of(const std::string& name) const;

 private:
  struct End {
    mcu::McuBoard* board;
    mcu::CanPort* can;
    std::shared_ptr<Counts> counts;
  };
  std::map<std::string, std::vector<End>> buses_;
};

}  // namespace omnihil

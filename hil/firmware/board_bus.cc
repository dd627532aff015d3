#include "hil/firmware/board_bus.h"

namespace omnihil {

std::shared_ptr<const BoardBuses::Counts> BoardBuses::join(const std::string& name, mcu::McuBoard& board,
                                                           mcu::CanPort& can) {
  std::vector<End>& ends = buses_[name];
  const auto counts = std::make_shared<Counts>();
  ends.push_back({&board, &can, counts});
  can.on_transmit([&ends, &board, &can, counts](const mcu::CanFrame& frame, mcu::Cycles end) {
    ++counts->out;
    const std::int64_t at_ns = board.machine().to_ns(end) + board.spec().coupling_ns;
    for (const End& other : ends) {
      if (other.can == &can) continue;
      other.board->at(at_ns, [to = other, frame] {
        ++to.counts->in;
        to.can->receive(frame);
      });
    }
  });
  return counts;
}

std::size_t BoardBuses::ends_of(const std::string& name) const {
  const auto at = buses_.find(name);
  return at == buses_.end() ? 0 : at->second.size();
}

}  // namespace omnihil

// What is done from outside at a place of the program.
#include <utility>

#include "firmware_iface/mcu/machine/machine.h"

namespace omnihil::mcu {

bool Machine::when_at(std::uint32_t address, std::function<void()> work) {
  constexpr std::uint8_t kBkpt[2] = {0xAB, 0xBE};  // BKPT #0xAB
  address &= ~1u;
  Visit& visit = visits_[address];
  if (visit.work.empty() && (!memory_.read(address, visit.original) || !memory_.write(address, kBkpt))) {
    visits_.erase(address);
    return false;
  }
  visit.work.push_back(std::move(work));
  return true;
}

// The instruction is back in its place and is what runs next.
bool Machine::visit() {
  const auto found = visits_.find(cpu_.reg.r[15]);
  if (found == visits_.end()) return false;
  const Visit visit = std::move(found->second);
  visits_.erase(found);
  memory_.write(cpu_.reg.r[15], visit.original);
  for (const auto& work : visit.work) work();
  return true;
}

}  // namespace omnihil::mcu

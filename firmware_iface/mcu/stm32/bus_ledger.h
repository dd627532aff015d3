// What a bus carried and nobody was there for, by cause: how much, and since when.
//
//   ledger.lost("byte", "sent with no device selected", now);
//   for (const BusLoss& loss : ledger.losses()) std::printf("%s\n", loss.what.c_str());
//
// It outlives resets of the chip: a board says at the end of a run what was lost in all of it.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "firmware_iface/mcu/peripheral.h"

namespace omnihil::mcu {

struct BusLoss {
  std::string unit, what;  // "byte", "sent with no device selected"
  std::uint64_t count = 0;
  Cycles first = 0;
};

class BusLedger {
 public:
  void lost(const char* unit, const std::string& what, Cycles at, std::uint64_t count = 1) {
    for (BusLoss& loss : losses_) {
      if (loss.what != what) continue;
      loss.count += count;
      return;
    }
    losses_.push_back({unit, what, count, at});
  }
  const std::vector<BusLoss>& losses() const { return losses_; }

 private:
  std::vector<BusLoss> losses_;
};

// A block of a chip at which a bus ends.
class BusEnd {
 public:
  virtual ~BusEnd() = default;
  const BusLedger& ledger() const { return ledger_; }

 protected:
  BusLedger ledger_;
};

}  // namespace omnihil::mcu

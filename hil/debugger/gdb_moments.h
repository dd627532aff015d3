// Earlier states of a bench under GDB, kept as processes: each is a copy of this one that the kernel makes when a board begins
// to run, asleep until GDB goes back. Only what differs from now costs memory.
//
//   if (std::optional<PastOrder> order = moments.keep(&unit, instructions)) …   // in a copy of the copy: never comes back
//   const std::vector<std::size_t> mine = moments.of(&unit);                    // oldest first
//   std::optional<PastReport> report = moments.ask(mine.back(), order, asked_to_end);
//
// A moment stays what it is: each order is carried out by a copy of it, in which all descriptors but those it is given lead
// nowhere, so that nothing is said twice to the outside. Copies end with this process. Cannot: be kept where the computer gives
// no more processes (there is then no way back, and nothing else changes).
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "firmware_iface/mcu/machine/debug_unit.h"
#include "hil/wire/descriptor.h"

namespace omnihil {

// What GDB has told, which goes along to wherever it is talked to.
struct GdbTalk {
  bool acks = true;
  std::uint64_t chosen = 0;
  std::vector<std::uint32_t> breakpoints;
  std::vector<mcu::AccessWatch> watches;
};

struct PastOrder {
  struct Plain {
    bool scan = false;        // look where a halt would be, and tell; else go there, where GDB is talked to
    bool last = false;        // what its run ends with is now
    std::uint64_t until = 0;  // instructions of the board since power-on
    std::uint64_t end = 0;    // with which its run ended
    std::uint64_t board = 0;  // its place among all
    std::uint32_t level = 0;  // nesting of exceptions: deeper ones are passed over by a step
    char resume = 0;          // once there: 's', 'c' go on at once; 0: stand
  } plain;
  std::string reply;  // what GDB hears on arrival
  GdbTalk talk;
};

struct PastReport {
  struct Plain {
    char what =
        0;  // 'f' what a scan has found; 's', 'c': GDB goes back so; 'e': forward to the end; 'd': it leaves
    char resume = 0;          // 'e': how it went on
    std::uint64_t at = 0;     // instructions where GDB stood
    std::uint32_t level = 0;  // there
    bool step_found = false, halt_found = false;
    std::uint64_t step_at = 0, halt_at = 0;  // the last ones
    mcu::Halt halt{};
  } plain;
  GdbTalk talk;
};

class GdbMoments {
 public:
  static constexpr std::size_t kMost = 16;  // a choice: some ticks of some boards

  GdbMoments() = default;
  ~GdbMoments() { forget(); }
  GdbMoments(const GdbMoments&) = delete;
  GdbMoments& operator=(const GdbMoments&) = delete;

  // Of a board that begins to run, having done so many instructions.
  std::optional<PastOrder> keep(const mcu::DebugUnit* of, std::uint64_t instructions);
  void forget();
  std::vector<std::size_t> of(const mcu::DebugUnit* unit) const;
  std::uint64_t begin(std::size_t moment) const { return kept_[moment].begin; }
  std::optional<PastReport> ask(std::size_t moment, const PastOrder& order,
                                const std::function<bool()>& asked_to_end);

  // In the copy that carries an order out.
  void mute_all_but(int fd) const;
  [[noreturn]] void report(const PastReport& report) const;

 private:
  struct Moment {
    const mcu::DebugUnit* unit;
    std::uint64_t begin;
    pid_t process;
    Descriptor wire;
  };
  void drop_oldest();
  std::optional<PastOrder> wait_for_orders(int fd);

  std::deque<Moment> kept_;
  int to_asker_ = -1;
};

}  // namespace omnihil

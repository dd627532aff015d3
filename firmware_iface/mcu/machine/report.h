// What a run of an image has shown besides what it did: things its author wants to know.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "firmware_iface/mcu/peripheral.h"

namespace omnihil::mcu {

struct Unmodelled {
  std::string peripheral, what;
  std::uint32_t pc;  // of the first time
  Cycles at;
  std::uint64_t count;
};

struct NullAccess {
  std::uint32_t pc, address;
  bool is_write;
  std::uint64_t count;
};

struct FaultRecord {
  int exception;
  std::uint32_t status, address, pc;
  Cycles at;  // the first time
  std::uint64_t count = 1;
  // `where`: the function of pc, if it is known.
  std::string text(const std::string& where = {}) const;
};

struct ResetRecord {
  std::string cause;
  Cycles at, last;  // the first and the last time by this cause
  std::uint64_t count = 1;
};

// One exception's share. Times are in cycles; `busy` leaves out what preempted it, `longest` does not.
struct InterruptLoad {
  std::uint64_t count = 0;
  Cycles busy = 0, longest = 0, longest_latency = 0;
};

struct MachineReport {
  std::vector<Unmodelled> unmodelled;     // in order of appearance
  std::vector<NullAccess> null_accesses;  // by program counter and address, the first kMost of them
  std::uint64_t null_access_count = 0, unaligned_count = 0;
  std::uint32_t first_unaligned_pc = 0;
  std::vector<FaultRecord> faults;  // the first kMost that differ in kind and place
  std::uint64_t fault_count = 0;
  std::vector<ResetRecord> resets;          // power-on, then each cause once
  std::map<int, InterruptLoad> exceptions;  // by exception number: 15 is SysTick, 16 + n is interrupt n
  Cycles thread_cycles = 0, sleep_cycles = 0;
  std::uint32_t main_stack_bytes = 0;  // high-water mark, from the image's initial stack pointer down
  std::uint32_t lowest_main_sp = 0, lowest_process_sp = 0;  // ~0: never used
  std::uint64_t instructions = 0;
  Cycles skipped_cycles = 0;  // of busy-waiting loops, fast-forwarded
  bool locked_up = false;
  std::uint32_t lock_up_pc = 0;

  static constexpr std::size_t kMost = 64;
};

}  // namespace omnihil::mcu

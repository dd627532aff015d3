#include "firmware_iface/mcu/board/boards_chip.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "firmware_iface/mcu/stm32/dma/dma_item.h"

namespace omnihil::mcu {
namespace {

constexpr int kInterrupts = 240;  // that the NVIC of the emulated core has
constexpr double kFastest_Hz = 1e6;

void flip(Machine& machine, std::uint32_t address, std::uint32_t bit) {
  std::uint8_t byte = 0;
  if (!machine.memory().read(address, {&byte, 1})) return;
  byte = static_cast<std::uint8_t>(byte ^ (1u << bit));
  machine.cpu().spoil_fast_forward();
  machine.memory().write(address, {&byte, 1});
}

// The line goes up and down again, then waits for its next time.
void storm(McuBoard& board, const ChipFault& fault, std::int64_t at_ns) {
  if (fault.until_ns > 0 && at_ns >= fault.until_ns) return;
  board.machine().set_irq(fault.irq, true);
  board.machine().set_irq(fault.irq, false);
  const std::int64_t next_ns =
      at_ns + std::max<std::int64_t>(1, static_cast<std::int64_t>(1e9 / fault.rate_Hz));
  board.at(next_ns, [&board, fault, next_ns] { storm(board, fault, next_ns); });
}

void fail_a_transfer(McuBoard& board) {
  for (const Chip::Mapped& block : board.chip().blocks()) {
    auto* dma = dynamic_cast<DmaErrors*>(block.peripheral);
    if (dma != nullptr && dma->fail_transfer()) return;
  }
}

void happen(McuBoard& board, const ChipFault& fault) {
  Machine& machine = board.machine();
  switch (fault.kind) {
    case ChipFaultKind::kRamBit:
    case ChipFaultKind::kFlashBit:
      return flip(machine, fault.address, fault.bit);
    case ChipFaultKind::kRegisterBit:
      machine.cpu().reg.r[fault.reg] ^= 1u << fault.bit;
      if (fault.reg == 13) machine.cpu().reg.r[13] &= ~3u;  // the stack pointer has no such bits
      return;
    case ChipFaultKind::kClockOff:
      machine.set_clock_error(fault.ratio);
      if (fault.until_ns > 0) board.at(fault.until_ns, [&machine] { machine.set_clock_error(1.0); });
      return;
    case ChipFaultKind::kBrownOutReset:
      return machine.request_reset("brown-out");
    case ChipFaultKind::kInterruptStorm:
      return storm(board, fault, fault.at_ns);
    case ChipFaultKind::kDmaError:
      return fail_a_transfer(board);
    case ChipFaultKind::kWatchdogLate: {
      double& lsi_hz = board.chip().context().clocks.lsi_hz;
      const double before = lsi_hz;
      lsi_hz *= fault.ratio;
      if (fault.until_ns > 0) board.at(fault.until_ns, [&lsi_hz, before] { lsi_hz = before; });
      return;
    }
  }
}

}  // namespace

std::string BoardsChip::problem(const ChipFault& fault) const {
  if (fault.board >= static_cast<std::uint32_t>(firmware_.boards()))
    return fmt::format("board {}: the robot has {}", fault.board, firmware_.boards());
  Memory& memory = firmware_.board(static_cast<int>(fault.board)).machine().memory();
  const bool ram = fault.kind == ChipFaultKind::kRamBit, flash = fault.kind == ChipFaultKind::kFlashBit;
  if (ram || flash) {
    const MemoryRegion* region = memory.find(fault.address);
    if (region == nullptr || region->writable() != ram)
      return fmt::format("address 0x{:08x} is no {}", fault.address, ram ? "RAM" : "flash");
    if (fault.bit > 7) return fmt::format("bit {} of a byte; allowed: 0 to 7", fault.bit);
  }
  if (fault.kind == ChipFaultKind::kRegisterBit && (fault.reg > 14 || fault.bit > 31))
    return fmt::format("bit {} of r{}; allowed: bits 0 to 31 of r0 to r14", fault.bit, fault.reg);
  if (fault.kind == ChipFaultKind::kInterruptStorm &&
      (fault.irq < 0 || fault.irq >= kInterrupts || !(fault.rate_Hz > 0.0 && fault.rate_Hz <= kFastest_Hz)))
    return fmt::format("interrupt {} at {:g} Hz; allowed: 0 to {}, above 0 to {:g} Hz", fault.irq,
                       fault.rate_Hz, kInterrupts - 1, kFastest_Hz);
  return {};
}

std::string BoardsChip::schedule(const ChipFault& fault) {
  if (std::string why = problem(fault); !why.empty()) return why;
  McuBoard& board = firmware_.board(static_cast<int>(fault.board));
  board.at(fault.at_ns, [&board, fault] { happen(board, fault); });
  return {};
}

std::vector<ChipMemoryRange> BoardsChip::ram_in_use() const {
  std::vector<ChipMemoryRange> ranges;
  Machine& machine = firmware_.board(0).machine();
  for (const ElfRange& range : image_.occupied) {
    const MemoryRegion* region = machine.memory().find(range.begin);
    if (region != nullptr && region->writable()) ranges.push_back({range.begin, range.bytes});
  }
  // The stack, as far as it has been used.
  const MachineReport report = machine.report();
  if (report.main_stack_bytes > 0) ranges.push_back({report.lowest_main_sp, report.main_stack_bytes});
  return ranges;
}

std::vector<ChipMemoryRange> BoardsChip::flash_in_use() const {
  std::vector<ChipMemoryRange> ranges;
  Machine& machine = firmware_.board(0).machine();
  for (const ElfSegment& segment : image_.segments) {
    const MemoryRegion* region = machine.memory().find(segment.address);
    if (region != nullptr && !region->writable())
      ranges.push_back({segment.address, static_cast<std::uint32_t>(segment.bytes.size())});
  }
  return ranges;
}

std::vector<int> BoardsChip::interrupts_in_use() const {
  std::vector<int> irqs;
  for (const auto& [exception, load] : firmware_.board(0).machine().report().exceptions) {
    if (exception >= 16) irqs.push_back(exception - 16);
  }
  return irqs;
}

}  // namespace omnihil::mcu

#include "firmware_iface/mcu/rp2040/boot_rom.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <vector>

#include "firmware_iface/mcu/rp2040/rom_floats.h"

namespace omnihil::mcu::rp2040 {
namespace {
// Calls, by the number of their BKPT. Floats follow from kFloats on, doubles behind them.
enum Call : unsigned {
  kBoot,
  kLookup,
  kPopcount,
  kReverse,
  kClz,
  kCtz,
  kMemset,
  kMemcpy,
  kConnectFlash,
  kExitXip,
  kErase,
  kProgram,
  kFlushCache,
  kEnterXip,
  kUsbBoot,
  kWaitForVector,
  kTrampoline,
  kTrampolineEnd,
  kCalls,
  kFloats = 32,
  kDoubles = kFloats + kRomFloats,
  kAllCalls = kDoubles + kRomFloats
};
struct Entry {
  char name[3];
  Call call;
};
// §2.8.3: both widths of memset and memcpy are one.
constexpr Entry kFunctions[] = {{"P3", kPopcount},      {"R3", kReverse},    {"L3", kClz},
                                {"T3", kCtz},           {"MS", kMemset},     {"S4", kMemset},
                                {"MC", kMemcpy},        {"C4", kMemcpy},     {"IF", kConnectFlash},
                                {"EX", kExitXip},       {"RE", kErase},      {"RP", kProgram},
                                {"FC", kFlushCache},    {"CX", kEnterXip},   {"UB", kUsbBoot},
                                {"WV", kWaitForVector}, {"DT", kTrampoline}, {"DE", kTrampolineEnd}};
// Places in the ROM; above the addresses that are taken for null pointers.
constexpr std::uint32_t kStubs = 0x1000, kStubBytes = 4, kFunctionTable = 0x1800, kDataTable = 0x1900,
                        kFloatTable = 0x1A04, kDoubleTable = 0x1B04, kTexts = 0x1C00, kPark = 0x1F00;
constexpr std::uint32_t kStackTop = 0x20042000, kVectors = kFlashBase + 0x100, kVtor = 0xE000ED08;
constexpr std::uint8_t kVersion = 3;  // of chips B2
constexpr char kText[] = "omnihil: the functions of an RP2040's boot ROM by code of its own";

std::uint32_t stub(unsigned call) { return kStubs + kStubBytes * call + 1; }
std::uint32_t code_of(const char* name) {
  return static_cast<std::uint8_t>(name[0]) | static_cast<std::uint32_t>(name[1]) << 8;
}

class Contents {
 public:
  void half(std::uint32_t at, std::uint32_t value) {
    bytes[at] = static_cast<std::uint8_t>(value);
    bytes[at + 1] = static_cast<std::uint8_t>(value >> 8);
  }
  void word(std::uint32_t at, std::uint32_t value) {
    half(at, value);
    half(at + 2, value >> 16);
  }
  std::vector<std::uint8_t> bytes = std::vector<std::uint8_t>(kRomBytes, 0);
};

std::vector<std::uint8_t> contents() {
  constexpr std::uint32_t kBreakpoint = 0xBE00, kReturn = 0x4770, kWaitForEvent = 0xBF20,
                          kBranchBack = 0xE7FD;
  Contents rom;
  rom.word(0x00, kStackTop);
  rom.word(0x04, stub(kBoot));
  rom.word(0x08, kPark + 1);  // NMI, hard fault
  rom.word(0x0C, kPark + 1);
  rom.bytes[0x10] = 'M', rom.bytes[0x11] = 'u', rom.bytes[0x12] = 1, rom.bytes[0x13] = kVersion;
  rom.half(0x14, kFunctionTable);
  rom.half(0x16, kDataTable);
  rom.half(0x18, stub(kLookup));
  for (unsigned call = 0; call < kAllCalls; ++call) {
    rom.half(kStubs + kStubBytes * call, kBreakpoint | call);
    rom.half(kStubs + kStubBytes * call + 2, kReturn);
  }
  rom.half(kPark, kWaitForEvent);
  rom.half(kPark + 2, kBranchBack);
  std::uint32_t at = kFunctionTable;
  for (const Entry& entry : kFunctions) {
    rom.half(at, code_of(entry.name));
    rom.half(at + 2, stub(entry.call));
    at += 4;
  }
  at = kDataTable;
  for (const auto& [name, where] :
       {std::pair{"CR", kTexts}, std::pair{"GR", kTexts + 0x80}, std::pair{"SF", kFloatTable},
        std::pair{"SD", kDoubleTable}, std::pair{"FS", stub(kFloats) - 1},
        std::pair{"FE", stub(kDoubles) - 1}, std::pair{"DS", stub(kDoubles) - 1},
        std::pair{"DE", stub(kAllCalls) - 1}}) {
    rom.half(at, code_of(name));
    rom.half(at + 2, where);
    at += 4;
  }
  for (unsigned i = 0; i < kRomFloats; ++i) {
    rom.word(kFloatTable + 4 * i, stub(kFloats + i));
    rom.word(kDoubleTable + 4 * i, stub(kDoubles + i));
  }
  rom.bytes[kFloatTable - 2] = rom.bytes[kDoubleTable - 2] = kRomFloats;  // their sizes
  std::memcpy(rom.bytes.data() + kTexts, kText, sizeof kText);
  return rom.bytes;
}

std::uint32_t reversed(std::uint32_t x) {
  std::uint32_t r = 0;
  for (unsigned i = 0; i < 32; ++i) r |= (x >> i & 1u) << (31 - i);
  return r;
}
}  // namespace

std::uint32_t boot_checksum(std::span<const std::uint8_t> bytes) {
  std::uint32_t crc = 0xFFFFFFFF;
  for (const std::uint8_t byte : bytes) {
    crc ^= static_cast<std::uint32_t>(byte) << 24;
    for (int i = 0; i < 8; ++i) crc = crc << 1 ^ ((crc >> 31) != 0 ? 0x04C11DB7u : 0u);
  }
  return crc;
}

void BootRom::install(Machine& machine) {
  machine.memory().write(0, contents());
  machine.set_rom_calls(kStubs, kStubBytes * kAllCalls,
                        [this, &machine](unsigned number) { return call(machine, number); });
}

void BootRom::park(Machine& machine) { machine.cpu().reg.r[15] = kPark; }

void BootRom::boot(Machine& machine) {
  std::array<std::uint8_t, 256> stage{};
  machine.memory().read(kFlashBase, stage);
  std::uint32_t found = 0;
  std::memcpy(&found, stage.data() + 252, 4);
  const std::uint32_t wanted = boot_checksum(std::span(stage).first(252));
  if (found != wanted) {
    machine.report_unmodelled("boot ROM", fmt::format("the first 256 bytes of flash end in 0x{:08x}, their "
                                                      "checksum is 0x{:08x}: the chip waits for USB",
                                                      found, wanted));
    return park(machine);
  }
  std::array<std::uint8_t, 4> vectors{}, word{};
  std::memcpy(vectors.data(), &kVectors, 4);
  machine.poke(kVtor, vectors);
  Registers& reg = machine.cpu().reg;
  machine.memory().read(kVectors, word);
  std::memcpy(&reg.r[13], word.data(), 4);
  machine.memory().read(kVectors + 4, word);
  std::memcpy(&reg.r[15], word.data(), 4);
  reg.r[13] &= ~3u;
  reg.r[15] &= ~1u;
}

// As the chip does it, in time: W25Q16JV data sheet §9.6, typical.
void BootRom::erase(Machine& machine, std::uint32_t offset, std::uint32_t bytes) {
  constexpr std::uint32_t kSector = 4096;
  constexpr double kSector_s = 45e-3;
  for (std::uint32_t at = 0; at < bytes; at += kSector) flash_->erase(offset + at, kSector);
  machine.spend(static_cast<Cycles>(kSector_s * (bytes + kSector - 1) / kSector * machine.core_hz()));
}

void BootRom::program(Machine& machine, std::uint32_t offset, std::uint32_t from, std::uint32_t bytes) {
  constexpr double kPage_s = 0.4e-3, kPageBytes = 256;
  for (std::uint32_t i = 0; i < bytes; ++i)
    flash_->program(offset + i, static_cast<std::uint8_t>(machine.bus_read(from + i, 1)));
  machine.spend(static_cast<Cycles>(kPage_s * bytes / kPageBytes * machine.core_hz()));
}

bool BootRom::call(Machine& machine, unsigned number) {
  Registers& reg = machine.cpu().reg;
  if (number == kBoot) {
    boot(machine);
    return true;
  }
  if (number >= kAllCalls || (number >= kCalls && number < kFloats)) return false;
  reg.r[15] = reg.r[14] & ~1u;
  if (number >= kFloats) {
    RomWords words{reg.r[0], reg.r[1], reg.r[2], reg.r[3]};
    const RomResult result =
        number < kDoubles ? rom_float(number - kFloats, words) : rom_double(number - kDoubles, words);
    if (result.order == 2) {
      for (unsigned i = 0; i < result.words; ++i) reg.r[i] = words[i];
    } else {  // N, Z, C, V of a compare
      reg.set_nzcv(result.order < 0 ? 8u << 28 : result.order == 0 ? 6u << 28 : 2u << 28);
    }
    machine.spend(result.cycles);
    return true;
  }
  constexpr unsigned kBitCycles = 20;  // about what they take
  switch (number) {
    case kLookup: {  // table, two letters
      std::uint32_t at = reg.r[0], found = 0;
      for (std::uint32_t code; (code = machine.bus_read(at, 2)) != 0; at += 4) {
        if (code == (reg.r[1] & 0xFFFFu)) found = machine.bus_read(at + 2, 2);
        if (found != 0) break;
      }
      reg.r[0] = found;
      machine.spend(4 * kBitCycles);
      return true;
    }
    case kPopcount:
      reg.r[0] = static_cast<std::uint32_t>(std::popcount(reg.r[0]));
      break;
    case kReverse:
      reg.r[0] = reversed(reg.r[0]);
      break;
    case kClz:
      reg.r[0] = static_cast<std::uint32_t>(std::countl_zero(reg.r[0]));
      break;
    case kCtz:
      reg.r[0] = static_cast<std::uint32_t>(std::countr_zero(reg.r[0]));
      break;
    case kMemset:
    case kMemcpy: {  // about a word in 2 cycles, 3 where it is copied
      const std::uint32_t to = reg.r[0], bytes = reg.r[2];
      for (std::uint32_t i = 0; i < bytes; ++i)
        machine.bus_write(to + i, 1,
                          number == kMemset ? reg.r[1] & 0xFFu : machine.bus_read(reg.r[1] + i, 1));
      machine.spend(bytes / 4 * (number == kMemset ? 2 : 3));
      break;
    }
    case kErase:
      erase(machine, reg.r[0], reg.r[1]);
      break;
    case kProgram:
      program(machine, reg.r[0], reg.r[1], reg.r[2]);
      break;
    case kUsbBoot:
      machine.report_unmodelled("boot ROM", "the image goes to the USB boot loader, which is not there");
      park(machine);
      return true;
    case kWaitForVector:
      park(machine);
      return true;
    default:  // flash's connection, cache, XIP: nothing to be done
      break;
  }
  machine.spend(kBitCycles);
  return true;
}

}  // namespace omnihil::mcu::rp2040

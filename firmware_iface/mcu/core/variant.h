// Which Cortex-M a core is: what its decoder accepts and what its exception model has.
//
//   Cpu cpu(kCortexM4F, memory, bus);
//
// Source: Armv6-M and Armv7-M Architecture Reference Manuals (DDI 0419E, DDI 0403E.e) and the cores'
// technical reference manuals for part numbers and priority bits as ST builds them. Not there: Armv8-M,
// security, caches, MPU.
#pragma once
#include <cstdint>
#include <string_view>

namespace omnihil::mcu {

enum class Arch : std::uint8_t { kV6M, kV7M, kV7EM };       // v7E-M: with the DSP instructions
enum class Fpu : std::uint8_t { kNone, kSingle, kDouble };  // what of the D registers can be computed with

struct Variant {
  std::string_view name;
  Arch arch;
  Fpu fpu;
  bool fpv5;  // VSEL, VMAXNM, VRINT, VCVT with a direction: Cortex-M7
  int priority_bits;
  std::uint32_t cpuid;
  int exception_entry_cycles;
  // Cortex-M0+: two stages of pipeline, a vector table that can be moved, an unprivileged mode.
  bool plus = false;
  // DDI 0484C table 3-1; else as of the M4 (op_codes.inc).
  constexpr int taken_branch_cycles() const { return plus ? 1 : 2; }
};

inline constexpr Variant kCortexM0{"cortex-m0", Arch::kV6M, Fpu::kNone, false, 2, 0x410CC200, 16};
inline constexpr Variant kCortexM0Plus{"cortex-m0+", Arch::kV6M, Fpu::kNone, false, 2, 0x410CC601, 15, true};
inline constexpr Variant kCortexM3{"cortex-m3", Arch::kV7M, Fpu::kNone, false, 4, 0x412FC231, 12};
inline constexpr Variant kCortexM4{"cortex-m4", Arch::kV7EM, Fpu::kNone, false, 4, 0x410FC241, 12};
inline constexpr Variant kCortexM4F{"cortex-m4f", Arch::kV7EM, Fpu::kSingle, false, 4, 0x410FC241, 12};
inline constexpr Variant kCortexM7Single{"cortex-m7-sp", Arch::kV7EM, Fpu::kSingle, true, 4, 0x411FC270, 12};
inline constexpr Variant kCortexM7{"cortex-m7", Arch::kV7EM, Fpu::kDouble, true, 4, 0x411FC270, 12};

}  // namespace omnihil::mcu

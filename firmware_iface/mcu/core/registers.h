// What the programmer sees of a Cortex-M: registers, flags, special registers (DDI 0403E.e, B1.4).
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace omnihil::mcu {

static_assert(std::endian::native == std::endian::little, "memory of the emulated core is used as it lies");

enum Control : std::uint32_t { kUnprivileged = 1, kUseProcessStack = 2, kFpContextActive = 4 };

// Flags lie as what they are worked out from: N is bit 31 of n, Z is z == 0; c and v are 0 or 1.
struct Flags {
  std::uint32_t n = 0, z = 1, c = 0, v = 0;
  bool operator==(const Flags&) const = default;
};
// By N, Z, C, V as four bits.
inline constexpr auto kFlags = [] {
  std::array<Flags, 16> all{};
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = {i >> 3 << 31, ~i & 4, i >> 1 & 1, i & 1};
  return all;
}();

struct Registers : Flags {
  std::uint32_t r[16] = {};  // r[13]: the stack pointer in use; r[15]: the next instruction, bit 0 clear
  std::uint32_t q = 0, ge = 0;
  std::uint32_t other_sp = 0;  // the stack pointer not in use
  std::uint32_t control = 0, primask = 0, basepri = 0, faultmask = 0;
  std::uint32_t ipsr = 0;       // the exception being handled, 0 in thread mode
  std::uint32_t exclusive = 0;  // the local monitor
  std::uint32_t event = 0;      // the event register of WFE
  std::uint32_t fpscr = 0;      // from here on all is 0 without an FPU
  std::uint32_t s[32] = {};

  bool operator==(const Registers& other) const;  // of all bytes at once: there are none between the members

  bool uses_psp() const { return (control & kUseProcessStack) && ipsr == 0; }
  bool privileged() const { return ipsr != 0 || !(control & kUnprivileged); }
  std::uint32_t msp() const { return uses_psp() ? other_sp : r[13]; }
  std::uint32_t psp() const { return uses_psp() ? r[13] : other_sp; }
  std::uint32_t apsr() const {
    return (n & 0x80000000u) | (z == 0 ? 0x40000000u : 0) | c << 29 | v << 28 | q << 27 | ge << 16;
  }
  void set_nzcv(std::uint32_t value) { static_cast<Flags&>(*this) = kFlags[value >> 28]; }
  void set_apsr(std::uint32_t value) {
    set_nzcv(value);
    q = value >> 27 & 1;
    ge = value >> 16 & 15;
  }
  float f32(unsigned i) const { return std::bit_cast<float>(s[i]); }
  void set_f32(unsigned i, float value) { s[i] = std::bit_cast<std::uint32_t>(value); }
  double f64(unsigned i) const {
    return std::bit_cast<double>(u64(i));
  }  // i: the S register its low half is in
  void set_f64(unsigned i, double value) { set_u64(i, std::bit_cast<std::uint64_t>(value)); }
  std::uint64_t u64(unsigned i) const { return static_cast<std::uint64_t>(s[i + 1]) << 32 | s[i]; }
  void set_u64(unsigned i, std::uint64_t value) {
    s[i] = static_cast<std::uint32_t>(value);
    s[i + 1] = static_cast<std::uint32_t>(value >> 32);
  }
};

static_assert(std::has_unique_object_representations_v<Registers>);
inline bool Registers::operator==(const Registers& other) const {
  return std::memcmp(this, &other, sizeof other) == 0;
}

// EPSR.IT as it lies in xPSR.
inline std::uint32_t it_to_xpsr(std::uint32_t it) { return (it & 3) << 25 | (it >> 2) << 10; }
inline std::uint8_t it_of_xpsr(std::uint32_t xpsr) {
  return static_cast<std::uint8_t>((xpsr >> 25 & 3) | (xpsr >> 8 & 0xFC));
}

}  // namespace omnihil::mcu

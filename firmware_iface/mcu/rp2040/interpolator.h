// One of the two interpolators of an RP2040's core.
//
//   Interpolator blend(0);
//   blend.write(0x00, 7);  blend.read(0x14, true);      // ACCUM0; POP_LANE0
//
// Law: RP2040 datasheet §2.3.1.6: each lane shifts, masks, extends its sign and adds its base; blend (of the first) and
// clamp (of the second). Offsets are those within one interpolator's registers.
#pragma once
#include <array>
#include <cstdint>

namespace omnihil::mcu::rp2040 {

class Interpolator {
 public:
  explicit Interpolator(unsigned number) : number_(number) {}
  std::uint32_t read(std::uint32_t offset, bool pops);
  void write(std::uint32_t offset, std::uint32_t value);

 private:
  struct Results {
    std::uint32_t lane[2], full;
  };
  struct Masked {
    std::uint32_t value;
    bool overflows;
  };
  Masked masked(unsigned lane) const;
  Results results() const;
  bool control(unsigned lane, unsigned at) const { return (control_[lane] >> at & 1u) != 0; }
  bool blends() const { return number_ == 0 && control(0, 21); }
  bool clamps() const { return number_ == 1 && control(0, 22); }

  unsigned number_;
  std::array<std::uint32_t, 2> accumulator_{}, control_{};
  std::array<std::uint32_t, 3> base_{};
};

}  // namespace omnihil::mcu::rp2040

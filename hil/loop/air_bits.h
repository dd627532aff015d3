// Bits that the air flips: each bit of a packet by itself, with the same chance.
//
//   AirBits bits(1e-4, 7);
//   if (bits.flip(packet)) …                     // some are wrong now
//
// What a format's own checks then let pass is not drawn but found out by decoding. Theory, for what is wrong in many bits:
// a CRC of n bits passes 2^-n of it, a sum or an exclusive or of bytes 2^-8, no checksum everything. Few flips are another
// matter: a CRC sees any run up to n bits, sum and exclusive or see any one bit (firmware_iface/checksum.h).
// Method: the distance to the next flip is geometric, so a clean packet costs one draw.
#pragma once
#include <cstdint>
#include <span>

namespace omnihil {

class AirBits {
 public:
  AirBits(double bit_error_rate, std::uint64_t seed) : rate_(bit_error_rate), seed_(seed) {}

  bool flip(std::span<std::uint8_t> packet);

 private:
  double rate_;
  std::uint64_t seed_;
  std::uint64_t drawn_ = 0;
};

}  // namespace omnihil

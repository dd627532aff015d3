#include "firmware_iface/mcu/stm32/stored_block.h"

namespace omnihil::mcu {
namespace {
constexpr const char* kReport = "used; the block is not modelled, its registers are kept only";
std::uint32_t mask_of(unsigned bytes) { return bytes >= 4 ? 0xFFFFFFFFu : (1u << (8 * bytes)) - 1u; }
}  // namespace

std::uint32_t StoredBlock::read(std::uint32_t offset, unsigned bytes) {
  system_.report_unmodelled(name(), kReport);
  return peek(offset & ~3u) >> (8 * (offset & 3u)) & mask_of(bytes);
}

std::uint32_t StoredBlock::peek(std::uint32_t offset) {
  if (offset / 4 >= words_.size()) return 0;
  std::uint32_t word = words_[offset / 4];
  for (const Fixed& f : fixed_) {
    if (f.offset == offset) word = (word | f.ones) & ~f.zeros;
  }
  return word;
}

void StoredBlock::write(std::uint32_t offset, unsigned bytes, std::uint32_t value) {
  system_.report_unmodelled(name(), kReport);
  if (offset / 4 >= words_.size()) return;
  const unsigned shift = 8 * (offset & 3u);
  std::uint32_t& word = words_[offset / 4];
  word = (word & ~(mask_of(bytes) << shift)) | (value & mask_of(bytes)) << shift;
}

std::uint32_t Signature::read(std::uint32_t offset, unsigned bytes) {
  std::uint32_t v = 0;
  for (unsigned i = 0; i < bytes && offset + i < bytes_.size(); ++i)
    v |= std::uint32_t{bytes_[offset + i]} << (8 * i);
  return v;
}

}  // namespace omnihil::mcu

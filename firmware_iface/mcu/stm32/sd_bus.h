// A memory card as its host controller sees it: commands with answers, blocks of bytes.
//
//   const SdAnswer answer = card.command(17, block, now_ns);
//   if (card.sends()) card.send(bytes);                       // the next of what it sends
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>

namespace omnihil::mcu {

// What a memory card holds at first, kept by whoever has read it.
struct CardImage {
  std::shared_ptr<const void> owner;
  std::span<const std::uint8_t> bytes;
};
inline constexpr std::size_t kCardBlockBytes = 512;
using CardBlock = std::array<std::uint8_t, kCardBlockBytes>;
using CardBlocks = std::map<std::uint32_t, CardBlock>;  // by number

struct SdAnswer {
  enum class Kind : std::uint8_t { kNone, kShort, kShortUnchecked, kLong };  // unchecked: without CRC (R3)
  Kind kind = Kind::kNone;
  unsigned index = 0x3F;  // what it says which command it answers
  std::array<std::uint32_t, 4> words =
      {};  // the first of them alone where it is short; bits 127 to 0 where long
};

class SdDevice {
 public:
  virtual ~SdDevice() = default;
  virtual SdAnswer command(unsigned index, std::uint32_t argument, std::int64_t now_ns) = 0;
  // It has more to send; from this instant on.
  virtual bool sends() const = 0;
  virtual std::int64_t ready_ns() const = 0;
  virtual void send(std::span<std::uint8_t> bytes) = 0;
  // It waits for a block; a block that has come whole is kept.
  virtual bool takes() const = 0;
  virtual void take(std::span<const std::uint8_t> block, std::int64_t now_ns) = 0;
  virtual std::int64_t busy_until_ns() const = 0;
};

}  // namespace omnihil::mcu

// One frame of a motor bus, and a queue of them. Little-endian numbers in and out of it.
//
//   BusFrame frame = can_frame(0x00D, 8);               // classic CAN, 11-bit id, 8 bytes
//   put_f32(frame, 0, 1.5F);  put_f32(frame, 4, 0.0F);
//   float turns_s = get_f32(frame, 0);
//
// On a UART bus `id` is the number of the line (one per motor) and the frame is one burst.
#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace omnihil {

struct BusFrame {
  static constexpr std::size_t kCapacity = 72;  // CAN FD has 64; the longest burst served 68
  std::uint32_t id = 0;
  bool extended = false;        // 29-bit id
  bool remote = false;          // remote transmission request: no data, asks for them
  bool fd = false;              // CAN FD
  bool bitrate_switch = false;  // data phase at the higher rate
  std::uint8_t size = 0;
  std::uint8_t pad = 0;  // what fills a CAN FD frame up to the next length there is
  std::array<std::uint8_t, kCapacity> data{};

  std::span<const std::uint8_t> bytes() const { return {data.data(), size}; }
};

inline BusFrame can_frame(std::uint32_t id, std::uint8_t size) {
  BusFrame frame;
  frame.id = id;
  frame.size = size;
  return frame;
}

template <class Unsigned>
constexpr Unsigned get_le(std::span<const std::uint8_t> data, std::size_t at) {
  Unsigned value = 0;
  for (std::size_t i = 0; i < sizeof(Unsigned); ++i) {
    value =
        static_cast<Unsigned>(value | static_cast<Unsigned>(static_cast<Unsigned>(data[at + i]) << 8 * i));
  }
  return value;
}
template <class Unsigned>
constexpr void put_le(std::span<std::uint8_t> data, std::size_t at, Unsigned value) {
  for (std::size_t i = 0; i < sizeof(Unsigned); ++i) {
    data[at + i] = static_cast<std::uint8_t>(value >> 8 * i);
  }
}
inline std::uint16_t get_u16(const BusFrame& f, std::size_t at) { return get_le<std::uint16_t>(f.data, at); }
inline std::uint32_t get_u32(const BusFrame& f, std::size_t at) { return get_le<std::uint32_t>(f.data, at); }
inline std::int16_t get_i16(const BusFrame& f, std::size_t at) {
  return static_cast<std::int16_t>(get_u16(f, at));
}
inline float get_f32(const BusFrame& f, std::size_t at) { return std::bit_cast<float>(get_u32(f, at)); }
inline void put_u16(BusFrame& f, std::size_t at, std::uint16_t value) {
  put_le(std::span(f.data), at, value);
}
inline void put_u32(BusFrame& f, std::size_t at, std::uint32_t value) {
  put_le(std::span(f.data), at, value);
}
inline void put_f32(BusFrame& f, std::size_t at, double value) {
  put_u32(f, at, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

// Where a number stands in a frame: said once, for the end that writes and the end that reads.
//
//   constexpr BusField<float> kSpeed{.at = 0};
//   kSpeed.put(frame, 1.5F);
//   float turns_s = kSpeed.get(frame);
template <class T>
struct BusField {
  std::size_t at = 0;
  using Raw = std::make_unsigned_t<std::conditional_t<std::is_same_v<T, float>, std::int32_t, T>>;

  constexpr T get(const BusFrame& f) const { return std::bit_cast<T>(get_le<Raw>(f.data, at)); }
  constexpr void put(BusFrame& f, T value) const { put_le(std::span(f.data), at, std::bit_cast<Raw>(value)); }
};

// Frames that wait to be sent; a full queue drops the newest and counts it.
class FrameQueue {
 public:
  void push(const BusFrame& frame) {
    if (count_ == frames_.size()) {
      ++dropped_;
      return;
    }
    frames_[(first_ + count_++) % frames_.size()] = frame;
  }
  bool pop(BusFrame& frame) {
    if (count_ == 0) return false;
    frame = frames_[first_];
    first_ = (first_ + 1) % frames_.size();
    --count_;
    return true;
  }
  std::uint64_t dropped() const { return dropped_; }

 private:
  std::array<BusFrame, 256> frames_{};
  std::size_t first_ = 0, count_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace omnihil

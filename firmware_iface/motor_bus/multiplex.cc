#include "firmware_iface/motor_bus/multiplex.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "firmware_iface/motor_bus/bus_frame.h"

namespace omnihil {
namespace {

constexpr std::uint8_t kWriteError = 0x30, kReadError = 0x31;
constexpr std::size_t kBytes[] = {1, 2, 4, 4};
constexpr std::int32_t kMost[] = {127, 32767, 2147483647};
constexpr std::uint32_t kMaxRegisters = 64;  // more than a frame has bytes

class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> data) : data_(data) {}
  bool done() const { return at_ >= data_.size(); }
  bool good() const { return good_; }
  std::uint8_t byte() { return take(1) ? data_[at_ - 1] : std::uint8_t{0}; }
  std::uint32_t varuint() {
    std::uint64_t value = 0;
    for (unsigned i = 0; i < 5; ++i) {
      const std::uint8_t next = byte();
      value |= static_cast<std::uint64_t>(next & 0x7FU) << 7 * i;
      if ((next & 0x80U) == 0) {
        good_ = good_ && value <= std::numeric_limits<std::uint32_t>::max();
        return static_cast<std::uint32_t>(value);
      }
    }
    good_ = false;
    return 0;
  }
  MultiplexValue value(MultiplexType type) {
    MultiplexValue v{.type = type};
    const std::size_t from = at_;
    if (!take(kBytes[static_cast<std::size_t>(type)])) return v;
    switch (type) {
      case MultiplexType::kInt8:
        v.integer = data_[from] < 0x80 ? data_[from] : data_[from] - 0x100;
        break;
      case MultiplexType::kInt16:
        v.integer = static_cast<std::int16_t>(get_le<std::uint16_t>(data_, from));
        break;
      case MultiplexType::kInt32:
        v.integer = static_cast<std::int32_t>(get_le<std::uint32_t>(data_, from));
        break;
      case MultiplexType::kFloat:
        v.real = std::bit_cast<float>(get_le<std::uint32_t>(data_, from));
        break;
    }
    return v;
  }

 private:
  bool take(std::size_t n) {
    good_ = good_ && at_ + n <= data_.size();
    if (good_) at_ += n;
    return good_;
  }
  std::span<const std::uint8_t> data_;
  std::size_t at_ = 0;
  bool good_ = true;
};

double of(MultiplexType type, const RegisterScale& scale) {
  return type == MultiplexType::kInt8    ? scale.int8
         : type == MultiplexType::kInt16 ? scale.int16
                                         : scale.int32;
}

}  // namespace

double MultiplexValue::scaled(const RegisterScale& scale) const {
  if (type == MultiplexType::kFloat) return real;
  if (integer < -kMost[static_cast<std::size_t>(type)]) return std::numeric_limits<double>::quiet_NaN();
  return integer * of(type, scale);
}

std::int64_t MultiplexValue::whole() const {
  if (type != MultiplexType::kFloat) return integer;
  return std::isfinite(real) ? std::llround(std::clamp(real, -2e9F, 2e9F)) : -1;
}

namespace {

// Subframes of writes and reads, or of replies; a reply carries values as a write does.
MultiplexStatus read_subframes(std::span<const std::uint8_t> data, bool replies,
                               std::vector<RegisterAccess>& out) {
  Reader reader(data);
  while (!reader.done()) {
    const std::uint8_t head = reader.byte();
    if (head == kMultiplexNop) continue;
    const unsigned kind = head >> 4;
    if (replies ? kind != 2 : kind > 1) return MultiplexStatus::kUnknownSubframe;
    const auto type = static_cast<MultiplexType>(head >> 2 & 3U);
    const std::uint32_t count = (head & 3U) != 0 ? head & 3U : reader.varuint();
    const std::uint32_t first = reader.varuint();
    if (!reader.good() || count > kMaxRegisters) return MultiplexStatus::kTruncated;
    for (std::uint32_t i = 0; i < count; ++i) {
      RegisterAccess access{.write = kind == 0, .reg = first + i, .value = {.type = type}};
      if (kind != 1) access.value = reader.value(type);
      out.push_back(access);
    }
    if (!reader.good()) return MultiplexStatus::kTruncated;
  }
  return MultiplexStatus::kOk;
}

}  // namespace

MultiplexStatus read_multiplex(std::span<const std::uint8_t> data, std::vector<RegisterAccess>& out) {
  return read_subframes(data, false, out);
}
MultiplexStatus read_multiplex_reply(std::span<const std::uint8_t> data, std::vector<RegisterAccess>& out) {
  return read_subframes(data, true, out);
}

std::size_t MultiplexReply::varuint_bytes(std::uint32_t value) {
  std::size_t n = 1;
  while (value >>= 7) ++n;
  return n;
}

void MultiplexReply::put_varuint(std::uint32_t value) {
  do {
    out_[size_++] = static_cast<std::uint8_t>((value & 0x7FU) | (value > 0x7FU ? 0x80U : 0U));
    value >>= 7;
  } while (value != 0);
}

// Makes room for one more value: in the last subframe, or in a new one. Counts above 3 stand in a byte of
// their own, so a subframe that grows past 3 moves up by one.
bool MultiplexReply::open_subframe(std::uint32_t reg, MultiplexType type) {
  const std::size_t bytes = kBytes[static_cast<std::size_t>(type)];
  const auto code = static_cast<std::uint8_t>(head_ | static_cast<unsigned>(type) << 2);
  if (open_ && reg == next_reg_ && type == type_) {
    const unsigned few = out_[subframe_at_] & 3U;
    const std::size_t extra = few == 3 ? 1 : 0;
    if (size_ + bytes + extra > out_.size()) return false;
    if (few == 3) {
      std::copy_backward(out_.begin() + static_cast<std::ptrdiff_t>(subframe_at_) + 1,
                         out_.begin() + static_cast<std::ptrdiff_t>(size_),
                         out_.begin() + static_cast<std::ptrdiff_t>(size_) + 1);
      ++size_;
      out_[subframe_at_] = code;
      out_[subframe_at_ + 1] = 4;
    } else {
      ++out_[few == 0 ? subframe_at_ + 1 : subframe_at_];
    }
  } else {
    if (size_ + 1 + varuint_bytes(reg) + bytes > out_.size()) return false;
    subframe_at_ = size_;
    out_[size_++] = static_cast<std::uint8_t>(code | 1U);
    put_varuint(reg);
  }
  open_ = true;
  type_ = type;
  next_reg_ = reg + 1;
  return true;
}

void MultiplexReply::put(MultiplexType type, std::uint32_t bits) {
  for (std::size_t i = 0; i < kBytes[static_cast<std::size_t>(type)]; ++i) {
    out_[size_++] = static_cast<std::uint8_t>(bits >> 8 * i);
  }
}

void MultiplexReply::add(std::uint32_t reg, MultiplexType type, double value, const RegisterScale& scale) {
  truncated_ = truncated_ || !open_subframe(reg, type);
  if (truncated_) return;
  if (type == MultiplexType::kFloat)
    return put(type, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
  const double most = kMost[static_cast<std::size_t>(type)];
  // Truncated toward zero and held to +- the largest, as the device does; the most negative one is "no
  // number".
  const double counts = std::isfinite(value) ? std::clamp(value / of(type, scale), -most, most) : -most - 1.0;
  put(type, static_cast<std::uint32_t>(static_cast<std::int32_t>(counts)));
}

void MultiplexReply::add_whole(std::uint32_t reg, MultiplexType type, std::int64_t value) {
  truncated_ = truncated_ || !open_subframe(reg, type);
  if (truncated_) return;
  if (type == MultiplexType::kFloat)
    return put(type, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
  put(type, static_cast<std::uint32_t>(value));
}

void MultiplexReply::add_error(bool write, std::uint32_t reg, std::uint32_t error) {
  open_ = false;
  truncated_ = truncated_ || size_ + 1 + varuint_bytes(reg) + varuint_bytes(error) > out_.size();
  if (truncated_) return;
  out_[size_++] = write ? kWriteError : kReadError;
  put_varuint(reg);
  put_varuint(error);
}

}  // namespace omnihil

// The mjlib "multiplex" register protocol: what stands in one CAN FD frame of a moteus.
//
//   01 00 0a            write 1 int8 from register 0:  [0] = 10
//   07 20 6000 2001 50ff write 3 int16 from register 020h
//   14 04 00            read 4 int16 from register 0  ->  24 04 00 xxxx xxxx xxxx xxxx
//   13 0d               read 3 int8 from register 00Dh ->  23 0d xx xx xx
//
// First byte: 0 write, 1 read, 2 reply in the high half; type (int8, int16, int32, float) in bits 2 and 3;
// the count in bits 0 and 1, or as a varuint after it where they are 0; then the first register as a varuint.
// 30h/31h is a write/read error (register, error), 50h nothing. Little-endian.
// Source: mjbots moteus docs/protocol/can.md. Streams (40h to 44h: the vendor's diagnostic console) are
// refused.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace omnihil {

inline constexpr std::uint8_t kMultiplexNop = 0x50;  // a subframe that says nothing

// How a register's unit is scaled in int8, int16 and int32; floats are SI or turns as they are.
struct RegisterScale {
  double int8, int16, int32;
};

enum class MultiplexType : std::uint8_t { kInt8, kInt16, kInt32, kFloat };

struct MultiplexValue {
  MultiplexType type = MultiplexType::kFloat;
  std::int32_t integer = 0;
  float real = 0;
  // In the register's unit; the most negative integer is NaN.
  double scaled(const RegisterScale& scale) const;
  std::int64_t whole() const;  // of registers that are no physical quantity
};

// One register that a frame touches.
struct RegisterAccess {
  bool write = false;
  std::uint32_t reg = 0;
  MultiplexValue value;  // of a write; of a read, the type that is asked for
};

enum class MultiplexStatus : std::uint8_t { kOk, kTruncated, kUnknownSubframe };

// Every access in order; on an error none of them may be used.
MultiplexStatus read_multiplex(std::span<const std::uint8_t> data, std::vector<RegisterAccess>& out);
// What a device answers: replies alone, each an access with its value. An error that it reports is kUnknownSubframe.
MultiplexStatus read_multiplex_reply(std::span<const std::uint8_t> data, std::vector<RegisterAccess>& out);

enum class MultiplexKind : std::uint8_t { kWrite = 0, kRead = 1, kReply = 2 };

// Builds a reply, or what a host writes: neighbouring registers of one type share a subframe. What no longer fits is left out.
class MultiplexReply {
 public:
  explicit MultiplexReply(std::span<std::uint8_t> out, MultiplexKind kind = MultiplexKind::kReply)
      : out_(out), head_(static_cast<std::uint8_t>(static_cast<unsigned>(kind) << 4)) {}
  void add(std::uint32_t reg, MultiplexType type, double value, const RegisterScale& scale);
  void add_whole(std::uint32_t reg, MultiplexType type, std::int64_t value);
  void add_error(bool write, std::uint32_t reg, std::uint32_t error);
  std::size_t size() const { return size_; }
  bool truncated() const { return truncated_; }

 private:
  bool open_subframe(std::uint32_t reg, MultiplexType type);
  void put(MultiplexType type, std::uint32_t bits);
  static std::size_t varuint_bytes(std::uint32_t value);
  void put_varuint(std::uint32_t value);

  std::span<std::uint8_t> out_;
  std::uint8_t head_;
  std::size_t size_ = 0, subframe_at_ = 0;
  std::uint32_t next_reg_ = 0;
  MultiplexType type_ = MultiplexType::kInt8;
  bool open_ = false, truncated_ = false;
};

}  // namespace omnihil

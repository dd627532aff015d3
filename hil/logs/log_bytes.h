// A walk over the bytes of a binary log, little-endian, that never leaves them.
//
//   LogBytes in(bytes, "run.ulg");
//   const auto size = in.number<std::uint16_t>();            // throws BadLog with the offset where the file ends too early
//   std::string_view name = in.text(size);
#pragma once
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "hil/logs/log_table.h"

namespace omnihil {

class LogBytes {
 public:
  LogBytes(std::string_view bytes, std::string name, std::size_t origin = 0)
      : bytes_(bytes), name_(std::move(name)), origin_(origin) {}

  std::size_t at() const { return at_; }
  std::size_t left() const { return bytes_.size() - at_; }
  bool at_end() const { return left() == 0; }

  std::string_view text(std::size_t size) {
    if (size > left())
      throw BadLog(name_ + ": byte " + std::to_string(origin_ + at_) + ": ends within a record; allowed: " +
                   std::to_string(size) + " more bytes, found " + std::to_string(left()));
    const std::string_view out = bytes_.substr(at_, size);
    at_ += size;
    return out;
  }
  void skip(std::size_t size) { text(size); }

  // A number of this type.
  template <typename T>
  T number() {
    T value;
    std::memcpy(&value, text(sizeof value).data(), sizeof value);
    return value;
  }
  // An unsigned number of `size` bytes, 1 to 8.
  std::uint64_t bytes_number(std::size_t size) {
    std::uint64_t value = 0;
    std::memcpy(&value, text(size).data(), size);
    return value;
  }
  // A length of four bytes, and so much text.
  std::string_view text32() { return text(number<std::uint32_t>()); }

 private:
  std::string_view bytes_;
  std::string name_;
  std::size_t origin_;  // of these bytes in the file, for messages
  std::size_t at_ = 0;
};

}  // namespace omnihil

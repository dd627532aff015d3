// SHA-256 of bytes that come piece by piece.
//
//   Sha256 hash;
//   hash.add(text);
//   hash.hex();                          // "9f86d0…", 64 digits, of what came so far
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace omnihil {

class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void add(std::span<const std::uint8_t> bytes);
  void add(std::string_view text);
  std::string hex() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

std::string sha256_of(std::string_view text);  // 64 digits

}  // namespace omnihil

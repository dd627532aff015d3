// What every fuzz target has: one function of bytes that must hold for all of them, and how it says that it does not.
//
//   OMNIHIL_FUZZ_TARGET(bytes) {
//     std::vector<ModelProblem> problems;
//     parse_csv(text_of(bytes), "fuzz.csv", {"time_s"}, problems);
//   }
//
// Built by clang (preset fuzz) with libFuzzer behind it, by every build with regression_main.cc, which runs the
// corpus. `./dev check fuzz` does the first, `./dev test -R Fuzz` the second.
#pragma once
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>

namespace omnihil {

inline void demand(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "property broken: %s\n", what);
  std::abort();
}

inline std::string_view text_of(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// The first byte, taken off: what picks one of several things to try.
inline std::uint8_t take_byte(std::span<const std::uint8_t>& bytes) {
  if (bytes.empty()) return 0;
  const std::uint8_t first = bytes[0];
  bytes = bytes.subspan(1);
  return first;
}

// At most `most` bytes, taken off.
inline std::span<const std::uint8_t> take_bytes(std::span<const std::uint8_t>& bytes, std::size_t most) {
  const auto first = bytes.first(most < bytes.size() ? most : bytes.size());
  bytes = bytes.subspan(first.size());
  return first;
}

}  // namespace omnihil

// The target: `bytes` is a std::span<const std::uint8_t>.
#define OMNIHIL_FUZZ_TARGET(bytes)                                                    \
  static void fuzz_one(std::span<const std::uint8_t> bytes);                          \
  extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);  \
  extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) { \
    fuzz_one({data, size});                                                           \
    return 0;                                                                         \
  }                                                                                   \
  static void fuzz_one(std::span<const std::uint8_t> bytes)

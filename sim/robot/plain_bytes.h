// State as bytes and back, for structs that are plain memory.
//
//   append(out, values.data(), values.size());      // behind what is there
//   take(in, values.data(), values.size());         // from the front, in the same order
#pragma once
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace omnihil {

template <typename T>
void append(std::vector<std::uint8_t>& out, const T* items, std::size_t count) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(items);
  out.insert(out.end(), bytes, bytes + count * sizeof(T));
}

template <typename T>
void take(std::span<const std::uint8_t>& in, T* items, std::size_t count) {
  if (count == 0) return;  // memcpy takes no null pointer, not even for nothing (C17 7.24.1)
  std::memcpy(static_cast<void*>(items), in.data(), count * sizeof(T));
  in = in.subspan(count * sizeof(T));
}

}  // namespace omnihil

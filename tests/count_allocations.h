// Counts the allocations of this thread. Replaces operator new of the whole program: one file of a program includes it.
//
//   const std::uint64_t before = allocations;
//   step();
//   EXPECT_EQ(allocations - before, 0u);
#pragma once
#include <cstdint>
#include <cstdlib>
#include <new>

namespace omnihil {
namespace {
thread_local std::uint64_t allocations = 0;

// Not inline, or the compiler pairs malloc with delete and drops both.
__attribute__((noinline)) void* counted_memory(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
}  // namespace
}  // namespace omnihil

__attribute__((noinline)) void* operator new(std::size_t size) { return omnihil::counted_memory(size); }
__attribute__((noinline)) void* operator new[](std::size_t size) { return omnihil::counted_memory(size); }
// As std::stable_sort asks for its buffer: without this one it would come from elsewhere and be given back here.
__attribute__((noinline)) void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++omnihil::allocations;
  return std::malloc(size == 0 ? 1 : size);
}
__attribute__((noinline)) void operator delete(void* memory) noexcept { std::free(memory); }
__attribute__((noinline)) void operator delete[](void* memory) noexcept { std::free(memory); }
__attribute__((noinline)) void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
__attribute__((noinline)) void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

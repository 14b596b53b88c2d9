#pragma once
// Arrays that are read at random places, on large pages of memory where the system grants them: with pages of 4 kB
// most of such reads wait for the page table, not for the memory.
#include <cstddef>
#include <vector>

namespace pith {

/// Memory on a 64-byte boundary, so that a record of 64 bytes lies in one cache line; from 1 MiB on, whole pages of
/// 2 MiB (Linux: transparent huge pages; elsewhere only the alignment). Throws std::bad_alloc.
void* allocate_large(std::size_t bytes);
void release_large(void* memory) noexcept;

template <class T>
struct LargeAllocator {
  using value_type = T;
  LargeAllocator() = default;
  template <class U>
  LargeAllocator(const LargeAllocator<U>&) {}
  T* allocate(std::size_t count) { return static_cast<T*>(allocate_large(count * sizeof(T))); }
  void deallocate(T* memory, std::size_t) noexcept { release_large(memory); }
  template <class U>
  bool operator==(const LargeAllocator<U>&) const {
    return true;
  }
};

/// A vector in such memory.
template <class T>
using LargeArray = std::vector<T, LargeAllocator<T>>;

} // namespace pith

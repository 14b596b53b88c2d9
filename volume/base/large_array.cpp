#include "volume/base/large_array.h"

#include <cstdint>
#include <cstdlib>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace pith {

namespace {
constexpr std::size_t line = 64, page = std::size_t(2) << 20, least = std::size_t(1) << 20;
}

void* allocate_large(std::size_t bytes) {
  const std::size_t unit = bytes < least ? line : page;
  if (bytes > SIZE_MAX - unit) throw std::bad_alloc();
  const std::size_t rounded = (bytes + unit - 1) / unit * unit;
  void* memory = std::aligned_alloc(unit, rounded ? rounded : unit);
  if (!memory) throw std::bad_alloc();
#ifdef __linux__
  if (unit == page) madvise(memory, rounded, MADV_HUGEPAGE); // a wish: refused, it costs speed only
#endif
  return memory;
}

void release_large(void* memory) noexcept { std::free(memory); }

} // namespace pith

// SPDX-License-Identifier: Apache-2.0
#include "vantage/field/pages.h"

#include <cstdint>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace vantage {

#ifdef __linux__
void prefer_large_pages(void* begin, std::size_t bytes) {
  constexpr std::uintptr_t kPage = 2U << 20U;
  const auto first = (reinterpret_cast<std::uintptr_t>(begin) + kPage - 1) / kPage * kPage;
  const auto last = (reinterpret_cast<std::uintptr_t>(begin) + bytes) / kPage * kPage;
  if (last > first) (void)madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);  // A wish: refusal is no error.
}
#else
void prefer_large_pages(void*, std::size_t) {}
#endif

}  // namespace vantage

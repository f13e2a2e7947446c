// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#if defined(__x86_64__)
#define VANTAGE_WIDE 1
#endif
/// Inlined into one function per instruction set; the compiler makes vectors of the loops over lanes, and the bits are the same.
#define VANTAGE_LANES [[gnu::always_inline]] inline
/// Marks the function for the wide instruction set.
#define VANTAGE_AVX2 [[gnu::target("avx2")]]

namespace vantage {

inline constexpr int kLanes = 8;
template <class T>
using Lanes = std::array<T, kLanes>;

/// Whether functions marked VANTAGE_AVX2 run on this machine.
[[nodiscard]] inline bool has_avx2() {
#if VANTAGE_WIDE
  return __builtin_cpu_supports("avx2");
#else
  return false;
#endif
}

}  // namespace vantage

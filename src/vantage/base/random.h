// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace vantage {

/// Small seeded generator (SplitMix64) whose draws are the same on every platform, unlike the distributions of <random>.
class Random {
 public:
  /// Two different (seed, stream) pairs give unrelated sequences; a stream is, say, the number of the step.
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0);
  [[nodiscard]] std::uint64_t next();
  [[nodiscard]] double uniform();  ///< In [0, 1).
  [[nodiscard]] double uniform(double low, double high) { return low + (high - low) * uniform(); }
  [[nodiscard]] std::uint64_t below(std::uint64_t count);  ///< In [0, count); `count` > 0.
  [[nodiscard]] double normal();                           ///< Mean 0, variance 1 (sum of 12 uniforms: no libm, |x| <= 6).

 private:
  std::uint64_t state_;
};

}  // namespace vantage

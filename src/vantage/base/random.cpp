// SPDX-License-Identifier: Apache-2.0
#include "vantage/base/random.h"

namespace vantage {
namespace {

std::uint64_t mix(std::uint64_t z) {  // Finaliser of SplitMix64 (Steele, Lea, Flood 2014).
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15ULL;

}  // namespace

Random::Random(std::uint64_t seed, std::uint64_t stream) : state_(mix(seed + kGolden) ^ mix(mix(stream + 2 * kGolden))) {}

std::uint64_t Random::next() { return mix(state_ += kGolden); }

double Random::uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }

// The bias of the remainder, below count / 2^64, is far below anything measured here.
std::uint64_t Random::below(std::uint64_t count) { return next() % count; }

double Random::normal() {
  double sum = -6.0;
  for (int i = 0; i < 12; ++i) sum += uniform();
  return sum;
}

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#include "vantage/exchange/predictor.h"

#include <algorithm>
#include <array>
#include <new>

namespace vantage {
namespace {

constexpr int kReach = 2047;  ///< Logarithmic odds run from -kReach to kReach, in units of 1/256.
constexpr std::uint32_t kCountMask = 1023;
constexpr std::uint32_t kMostSeen = 500;  ///< After so many bits a slot forgets at a steady pace.
constexpr int kRateShift = 15;
constexpr std::uint32_t kEven = 1U << 31U;  ///< Probability of one half in a slot.

/// Logistic function and its inverse. Made with + * / alone, which IEEE 754 fixes to the bit.
struct Tables {
  std::array<std::uint16_t, 2 * kReach + 1> squash;
  std::array<std::int16_t, 4096> stretch;
  std::array<std::uint32_t, kCountMask + 1> pace;  ///< 2^16 / (n + 1.5).

  Tables() {
    double step = 1.0, term = 1.0;  // e^(1/256)
    for (int k = 1; k < 12; ++k) step += term /= 256.0 * k;
    double odds = 1.0;
    for (int x = 0; x <= kReach; ++x, odds *= step) {
      const double p = 65536.0 * odds / (1.0 + odds);
      squash[static_cast<std::size_t>(kReach + x)] = static_cast<std::uint16_t>(std::min(p, 65535.0 - 16.0));
      squash[static_cast<std::size_t>(kReach - x)] = static_cast<std::uint16_t>(65536 - squash[static_cast<std::size_t>(kReach + x)]);
    }
    int x = -kReach;
    for (std::size_t p = 0; p < stretch.size(); ++p) {
      while (x < kReach && squash[static_cast<std::size_t>(kReach + x)] < 16 * p + 8) ++x;
      stretch[p] = static_cast<std::int16_t>(x);
    }
    for (std::uint32_t n = 0; n <= kCountMask; ++n) pace[n] = (1U << 17U) / (2 * n + 3);
  }
};

const Tables& tables() {
  static const Tables all;
  return all;
}

}  // namespace

Predictor::Predictor(int inputs, int bits, int sets)
    : inputs_(inputs),
      bits_(bits),
      slots_(static_cast<std::uint32_t*>(std::calloc(static_cast<std::size_t>(inputs) << bits, sizeof(std::uint32_t)))),
      weights_(static_cast<std::size_t>(2 * inputs * sets), (1 << 16) / (inputs + 1)),
      used_(static_cast<std::size_t>(inputs)),
      votes_(static_cast<std::size_t>(2 * inputs)) {
  if (!slots_) throw std::bad_alloc();
}

std::uint32_t Predictor::predict(std::span<const std::uint32_t> contexts, int set) {
  const Tables& t = tables();
  row_ = weights_.data() + static_cast<std::ptrdiff_t>(2 * inputs_ * set);
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < used_.size(); ++i) {
    const std::uint32_t place = contexts[i] * 0x9e3779b1U >> (32 - bits_);
    used_[i] = &slots_[(i << bits_) + place];
    const std::uint32_t slot = *used_[i] ^ kEven, seen = slot & kCountMask;
    votes_[2 * i] = seen == 0 ? 0 : t.stretch[slot >> 20U];
    // A second vote that counts only when the context has been seen often.
    votes_[2 * i + 1] = seen < 12 ? 0 : votes_[2 * i];
    sum += std::int64_t{row_[2 * i]} * votes_[2 * i] + std::int64_t{row_[2 * i + 1]} * votes_[2 * i + 1];
  }
  const std::int64_t odds = std::clamp<std::int64_t>(sum >> 16, -kReach, kReach);
  return probability_ = t.squash[static_cast<std::size_t>(kReach + odds)];
}

void Predictor::update(bool bit) {
  const Tables& t = tables();
  const std::int64_t error = (bit ? 65535 : 0) - static_cast<std::int64_t>(probability_);
  for (std::size_t k = 0; k < votes_.size(); ++k) row_[k] += static_cast<std::int32_t>((votes_[k] * error) >> kRateShift);
  for (std::uint32_t* slot : used_) {
    const std::uint32_t seen = *slot & kCountMask;
    const std::int64_t p = (*slot ^ kEven) >> 10U, aim = bit ? (1 << 22) - 1 : 0;
    const std::int64_t next = p + (((aim - p) * t.pace[seen]) >> 16);
    *slot = (static_cast<std::uint32_t>(next) << 10U ^ kEven) | std::min(seen + 1, kMostSeen);
  }
}

}  // namespace vantage

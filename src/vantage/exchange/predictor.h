// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>
#include <vector>

#include "vantage/exchange/bit_coder.h"

namespace vantage {

/// Predicts bits from several contexts at once: each keeps a probability that follows what it has seen, and a small network that learns as it goes
/// weighs them in the logistic domain (Mahoney's PAQ). Integers only: writer and reader agree to the bit on every machine.
class Predictor {
 public:
  /// `inputs` contexts a bit, each with a table of 2^`bits` probabilities; `sets` of weights.
  Predictor(int inputs, int bits, int sets);

  /// Probability of a 1 in units of 2^-16; `contexts` are hashes, one an input, `set` is in [0, sets).
  [[nodiscard]] std::uint32_t predict(std::span<const std::uint32_t> contexts, int set);
  /// What came.
  void update(bool bit);

 private:
  struct Free {
    void operator()(std::uint32_t* slots) const { std::free(slots); }
  };

  int inputs_, bits_;
  /// Probability in the upper 22 bits, its first bit turned, times seen in the lower 10; (inputs, 2^bits). So all begin as 0, and memory that the
  /// system hands out once it is touched serves a short map, which touches little of it.
  std::unique_ptr<std::uint32_t[], Free> slots_;
  std::vector<std::int32_t> weights_;  ///< 2^16 is one; (sets, 2 inputs).
  std::vector<std::uint32_t*> used_;   ///< Slots of the bit predicted last.
  std::vector<std::int32_t> votes_;    ///< Their logarithmic odds.
  std::int32_t* row_ = nullptr;
  std::uint32_t probability_ = 0;
};

/// No prediction is taken for surer than 255 : 1, so that few bytes cannot stand for very many leaves, which take a reader long.
inline constexpr std::uint32_t kLeastSure = kCertain >> 8U;

/// Codes `bit`, or reads it, with the prediction from `contexts`.
template <class Coder>
bool code_bit(Coder& coder, Predictor& predictor, bool bit, std::span<const std::uint32_t> contexts, int set = 0) {
  bit = coder.code(bit, std::clamp(predictor.predict(contexts, set), kLeastSure, kCertain - kLeastSure));
  predictor.update(bit);
  return bit;
}

/// Codes a signed number: whether it is 0, its sign, the length of what remains, and that, highest bit first; `context` < 2^16 tells kinds apart.
/// The numbers read are in [-2^24, 2^24].
template <class Coder>
std::int32_t code_number(Coder& coder, Predictor& predictor, std::int32_t number, std::uint32_t context) {
  const auto bit = [&](bool value, std::uint32_t place) { return code_bit(coder, predictor, value, std::array{context << 8U | place}); };
  if (bit(number == 0, 0)) return 0;
  const bool negative = bit(number < 0, 1);
  const std::uint32_t size = static_cast<std::uint32_t>(number < 0 ? -number : number);
  std::uint32_t length = 0;  // Bits below the leading one.
  while (length < 23 && bit(size >> (length + 1) != 0, 2 + length)) ++length;
  std::uint32_t value = 1;
  for (std::uint32_t i = length; i-- > 0;)
    value = value << 1U | (bit((size >> i & 1U) != 0, 32 + 4 * length + (length - i <= 2 ? value & 3U : 0U)) ? 1U : 0U);
  return negative ? -static_cast<std::int32_t>(value) : static_cast<std::int32_t>(value);
}

}  // namespace vantage

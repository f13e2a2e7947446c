// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace vantage {

/// Probabilities of a 1 are in units of 2^-16, from 1 to 65535.
inline constexpr std::uint32_t kCertain = 1U << 16U;

/// Arithmetic coder of bits whose probabilities the caller predicts (Witten, Neal, Cleary 1987, in the carry-free form of PAQ).
/// A bit of probability p costs -log2 p bits. Writing and reading have one interface, so one piece of code describes a format both ways.
class BitEncoder {
 public:
  static constexpr bool kReads = false;
  /// Writes `bit`, and returns it.
  bool code(bool bit, std::uint32_t probability) {
    const std::uint32_t middle = low_ + static_cast<std::uint32_t>((std::uint64_t{high_ - low_} * probability) >> 16U);
    (bit ? high_ : low_) = bit ? middle : middle + 1;
    while (((low_ ^ high_) & 0xff000000U) == 0) {
      out_.push_back(static_cast<char>(high_ >> 24U));
      low_ <<= 8U;
      high_ = high_ << 8U | 255U;
    }
    return bit;
  }
  /// What was written; the encoder is done.
  [[nodiscard]] std::string finish() {
    // As few bytes as name a number between low and high, zeros following.
    for (std::uint32_t kept = 1; kept <= 4; ++kept) {
      const std::uint32_t mask = kept == 4 ? 0U : 0xffffffffU >> (8 * kept);
      const std::uint32_t value = (low_ + mask) & ~mask;
      if (value < low_ || value > high_) continue;
      for (std::uint32_t i = 0; i < kept; ++i) out_.push_back(static_cast<char>(value >> (24U - 8 * i)));
      break;
    }
    return std::move(out_);
  }

 private:
  std::string out_;
  std::uint32_t low_ = 0, high_ = 0xffffffffU;
};

class BitDecoder {
 public:
  static constexpr bool kReads = true;
  explicit BitDecoder(std::string_view bytes) : bytes_(bytes) {
    for (int i = 0; i < 4; ++i) shift();
  }
  /// The next bit. Behind the end come zeros.
  bool code(bool /*unknown*/, std::uint32_t probability) {
    const std::uint32_t middle = low_ + static_cast<std::uint32_t>((std::uint64_t{high_ - low_} * probability) >> 16U);
    const bool bit = value_ <= middle;
    (bit ? high_ : low_) = bit ? middle : middle + 1;
    while (((low_ ^ high_) & 0xff000000U) == 0) {
      low_ <<= 8U;
      high_ = high_ << 8U | 255U;
      shift();
    }
    return bit;
  }
  /// More was read than the encoder can have written.
  [[nodiscard]] bool overrun() const { return next_ > bytes_.size() + 4; }
  /// Bytes that nothing was read from yet.
  [[nodiscard]] std::size_t unread() const { return next_ < bytes_.size() ? bytes_.size() - next_ : 0; }

 private:
  void shift() {
    value_ = value_ << 8U | (next_ < bytes_.size() ? static_cast<std::uint8_t>(bytes_[next_]) : 0U);
    ++next_;
  }
  std::string_view bytes_;
  std::size_t next_ = 0;
  std::uint32_t low_ = 0, high_ = 0xffffffffU, value_ = 0;
};

}  // namespace vantage

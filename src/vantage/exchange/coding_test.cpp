// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "vantage/base/random.h"
#include "vantage/exchange/bit_coder.h"
#include "vantage/exchange/predictor.h"
#include "vantage/exchange/sha256.h"

namespace vantage {
namespace {

TEST(Sha256, ExamplesOfTheStandard) {
  EXPECT_EQ(as_hex(sha256("")), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(as_hex(sha256("abc")), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(as_hex(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq")),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(as_hex(sha256(std::string(1000000, 'a'))), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

RC_GTEST_PROP(BitCoder, ReadsBackWhatItWroteWithAnyProbabilities, (const std::vector<std::pair<bool, std::uint16_t>>& bits)) {
  BitEncoder encoder;
  for (const auto& [bit, probability] : bits) encoder.code(bit, std::max<std::uint32_t>(probability, 1));
  const std::string bytes = encoder.finish();
  BitDecoder decoder(bytes);
  for (const auto& [bit, probability] : bits) RC_ASSERT(decoder.code(false, std::max<std::uint32_t>(probability, 1)) == bit);
  RC_ASSERT(!decoder.overrun());
}

TEST(BitCoder, SpendsAsManyBitsAsTheInformationIs) {
  Random random(3);
  BitEncoder encoder;
  double information = 0.0;
  for (int i = 0; i < 100000; ++i) {
    const std::uint32_t probability = 655;  // 1 %
    const bool bit = random.uniform() < 0.01;
    information -= std::log2(bit ? probability / 65536.0 : 1.0 - probability / 65536.0);
    encoder.code(bit, probability);
  }
  EXPECT_NEAR(8.0 * static_cast<double>(encoder.finish().size()), information, 0.002 * information + 32);
}

TEST(BitCoder, NoticesThatTheBytesEnded) {
  BitEncoder encoder;
  for (int i = 0; i < 1000; ++i) encoder.code(i % 3 == 0, kCertain / 2);
  const std::string bytes = encoder.finish();
  BitDecoder decoder(std::string_view(bytes).substr(0, bytes.size() / 2));
  for (int i = 0; i < 1000; ++i) static_cast<void>(decoder.code(false, kCertain / 2));
  EXPECT_TRUE(decoder.overrun());
}

/// Bytes for so many bits whose first context tells their probability.
std::size_t coded_size(const std::vector<std::array<std::uint32_t, 2>>& contexts, const std::vector<bool>& bits) {
  BitEncoder encoder;
  Predictor predictor(2, 12, 1);
  for (std::size_t i = 0; i < bits.size(); ++i) code_bit(encoder, predictor, bits[i], contexts[i]);
  return encoder.finish().size();
}

TEST(Predictor, LearnsWhatTheContextsTellAndIgnoresTheRest) {
  Random random(5);
  std::vector<std::array<std::uint32_t, 2>> contexts;
  std::vector<bool> bits;
  double information = 0.0;
  for (int i = 0; i < 40000; ++i) {
    const auto kind = static_cast<std::uint32_t>(random.below(4));
    const double p = 0.02 + 0.2 * kind;
    contexts.push_back({kind, static_cast<std::uint32_t>(random.below(1000))});
    bits.push_back(random.uniform() < p);
    information -= std::log2(bits.back() ? p : 1.0 - p);
  }
  EXPECT_LT(static_cast<double>(8 * coded_size(contexts, bits)), 1.06 * information);
  EXPECT_GT(static_cast<double>(8 * coded_size(contexts, bits)), 0.97 * information);
}

RC_GTEST_PROP(Predictor, NumbersReadBack, (const std::vector<std::int32_t>& raw)) {
  std::vector<std::int32_t> numbers = raw;
  for (std::int32_t& n : numbers) n %= 1 << 23;
  numbers.insert(numbers.end(), {0, 1, -1, (1 << 24) - 1, -(1 << 24) + 1});
  BitEncoder encoder;
  Predictor writer(1, 16, 1), reader(1, 16, 1);
  for (const std::int32_t n : numbers) code_number(encoder, writer, n, 7);
  const std::string bytes = encoder.finish();
  BitDecoder decoder(bytes);
  for (const std::int32_t n : numbers) RC_ASSERT(code_number(decoder, reader, 0, 7) == n);
}

}  // namespace
}  // namespace vantage

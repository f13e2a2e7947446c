// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/bytes.h"

#include <gtest/gtest.h>

#include "vantage/base/error.h"

namespace vantage {
namespace {

TEST(Bytes, ChecksumIsTheStandardOne) {
  EXPECT_EQ(checksum("123456789"), 0xcbf43926U);
  EXPECT_EQ(checksum("6789", checksum("12345")), checksum("123456789"));
}

TEST(Bytes, NumbersComeBackInBothOrders) {
  std::string bytes;
  put<std::uint32_t>(bytes, 0x01020304U);
  put<double>(bytes, -0.1);
  EXPECT_EQ(bytes.substr(0, 4), "\x04\x03\x02\x01");
  EXPECT_EQ(get<std::uint32_t>(bytes, 0), 0x01020304U);
  EXPECT_EQ(get<std::uint32_t>(bytes, 0, std::endian::big), 0x04030201U);
  EXPECT_EQ(get<double>(bytes, 4), -0.1);
}

TEST(Bytes, ReadsAreCheckedAgainstTheBytesThere) {
  const FileBytes file("\1\2\3\4\5", "a.bin");
  EXPECT_EQ(file.number<std::uint32_t>(1, "a number"), 0x05040302U);
  EXPECT_EQ(file.part(5, 0, "nothing"), "");
  EXPECT_THROW((void)file.number<std::uint32_t>(2, "a number"), Error);
  EXPECT_THROW((void)file.part(1, ~std::uint64_t{0}, "a part"), Error);
  EXPECT_THROW((void)file.part(~std::uint64_t{0}, 1, "a part"), Error);
}

TEST(Bytes, ProductsOfSizesAreChecked) {
  EXPECT_EQ(checked_product(1U << 20, 1U << 20, ""), std::size_t{1} << 40);
  EXPECT_EQ(checked_product(~std::uint64_t{0}, 1, ""), ~std::size_t{0});
  EXPECT_EQ(checked_product(~std::uint64_t{0}, 0, ""), 0U);
  EXPECT_THROW((void)checked_product(std::uint64_t{1} << 33, std::uint64_t{1} << 31, "a.ptx"), Error);
}

}  // namespace
}  // namespace vantage

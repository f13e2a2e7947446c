// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/bytes.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#include "vantage/base/error.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

TEST(Error, SaysWhereFirst) {
  EXPECT_STREQ(Error(ErrorCode::io, "cannot be read").what(), "cannot be read");
  const Error error(ErrorCode::bad_input, "list length 4294967295 exceeds the file", "cloud.ply:1204");
  EXPECT_STREQ(error.what(), "cloud.ply:1204: list length 4294967295 exceeds the file");
  EXPECT_EQ(error.code(), ErrorCode::bad_input);
  EXPECT_EQ(error.where(), "cloud.ply:1204");
}

TEST(Error, CodesAreTheExitCodes) {
  EXPECT_EQ(static_cast<int>(ErrorCode::bad_input), 2);
  EXPECT_EQ(static_cast<int>(ErrorCode::io), 3);
  EXPECT_EQ(static_cast<int>(ErrorCode::memory), 4);
  EXPECT_EQ(static_cast<int>(ErrorCode::limit), 5);
  EXPECT_EQ(static_cast<int>(ErrorCode::no_plan), 6);
  EXPECT_EQ(static_cast<int>(ErrorCode::interrupted), 130);
}

TEST(Error, RequireThrowsBadInput) {
  EXPECT_NO_THROW(require(true, "fine"));
  try {
    require(false, "eta = -1: must be > 0", "run.toml");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
    EXPECT_STREQ(error.what(), "run.toml: eta = -1: must be > 0");
  }
}

TEST(Error, MemoryIsAskedForFirst) {
  EXPECT_NO_THROW(require_memory(1000, 8, "a small lattice"));
  try {
    require_memory(1e12, 1e6, "the lattice");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::memory);
    EXPECT_EQ(std::string(error.what()).find("the lattice: needs 931322574.6 GiB, "), 0U) << error.what();
  }
}

}  // namespace
}  // namespace vantage

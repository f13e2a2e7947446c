// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/atomic_file.h"

#include <gtest/gtest.h>

#include "vantage/base/error.h"
#include "vantage/io/bytes.h"

namespace vantage {
namespace {

class AtomicFile : public testing::Test {
 protected:
  AtomicFile() : folder_(std::filesystem::path(testing::TempDir()) / ("vantage_atomic_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~AtomicFile() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

TEST_F(AtomicFile, ReplacesTheWholeFileAndLeavesNothingElse) {
  write_file(folder_ / "a", std::string(100000, 'x'));
  write_file(folder_ / "a", std::string("b\0c", 3));
  EXPECT_EQ(read_file(folder_ / "a"), std::string("b\0c", 3));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
}

TEST_F(AtomicFile, RefusesFoldersAndMissingFolders) {
  EXPECT_THROW(write_file(folder_, "x"), Error);
  EXPECT_THROW(write_file(folder_ / "none" / "a", "x"), Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST(Checksum, IsTheStandardOne) {
  EXPECT_EQ(checksum("123456789"), 0xcbf43926U);
  EXPECT_EQ(checksum("6789", checksum("12345")), checksum("123456789"));
}

}  // namespace
}  // namespace vantage

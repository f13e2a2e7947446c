// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/atomic_file.h"

#include <gtest/gtest.h>

#include "vantage/base/error.h"
#include "vantage/io/test_data.h"

namespace vantage {
namespace {

std::size_t files_in(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()));
}

TEST(AtomicFile, ReplacesWholeFiles) {
  const ScratchFolder folder;
  const std::string bytes(300000, 'x');
  write_file(folder / "a", bytes);
  EXPECT_EQ(read_file(folder / "a"), bytes);
  write_file(folder / "a", std::string("\0\n", 2));
  EXPECT_EQ(read_file(folder / "a"), std::string("\0\n", 2));
  write_file(folder / "b", "");
  EXPECT_EQ(read_file(folder / "b"), "");
  EXPECT_EQ(files_in(folder / ""), 2U);
}

TEST(AtomicFile, LeavesNothingBehindWhenItFails) {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "a");
  write_file(folder / "a/inner", "kept");
  try {
    write_file(folder / "a", "cannot take the place of a folder");
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::io);
    EXPECT_EQ(e.where(), (folder / "a").string());
  }
  EXPECT_EQ(files_in(folder / ""), 1U);
  EXPECT_EQ(read_file(folder / "a/inner"), "kept");
  EXPECT_THROW(write_file(folder / "none/b", "x"), Error);
  EXPECT_THROW((void)read_file(folder / "none"), Error);
}

}  // namespace
}  // namespace vantage

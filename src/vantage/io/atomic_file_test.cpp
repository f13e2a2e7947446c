// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/atomic_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

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

TEST(AtomicFile, WhatStoppedProcessesLeftIsRemoved) {
  const ScratchFolder folder;
  const std::string own = std::to_string(::getpid()), dead = "2147483647";  // No process has so high a number.
  for (const std::string& name : {"a." + own + "-1.part", "a.ply." + dead + "-12.part"}) write_file(folder / name, "");
  const std::vector<std::string> kept = {"a.part", "a.1-1.part", "a." + dead + "-.part", "a." + dead + "-x.part", "a." + dead + "-1", "a.-1-1.part"};
  for (const std::string& name : kept) write_file(folder / name, "");
  remove_stale_parts(folder / "");
  EXPECT_EQ(files_in(folder / ""), kept.size());
  for (const std::string& name : kept) EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
  remove_stale_parts(folder / "missing");
}

TEST(AtomicFile, NamesThatAnEarlierProcessOfTheSameNumberLeftAreNoHindrance) {
  const ScratchFolder folder;
  const std::string stem = (folder / "a").string() + "." + std::to_string(::getpid()) + "-";
  for (int k = 0; k < 300; ++k) std::ofstream(stem + std::to_string(k) + ".part") << "old";
  write_file(folder / "a", "new");
  EXPECT_EQ(read_file(folder / "a"), "new");
  EXPECT_EQ(files_in(folder / ""), 301U);
}

TEST(AtomicFile, AMissingFolderCannotBeSynced) {
  const ScratchFolder folder;
  sync_folder(folder / "");
  EXPECT_THROW(sync_folder(folder / "missing"), Error);
}

}  // namespace
}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/run_folder.h"

#include <gtest/gtest.h>

#include "vantage/base/error.h"
#include "vantage/io/atomic_file.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

class RunFolders : public testing::Test {
 protected:
  RunFolders() : root_(fs::path(testing::TempDir()) / ("vantage_folder_" + std::to_string(::getpid()))) {
    fs::remove_all(root_);
    fs::create_directories(root_);
  }
  ~RunFolders() override { fs::remove_all(root_); }
  /// A folder that looks like a run.
  fs::path run(const std::string& name) {
    fs::create_directories(root_ / name);
    write_file(root_ / name / run_file::kScanLog, "log");
    write_file(root_ / name / run_file::kScenario, "old");
    return root_ / name;
  }
  std::vector<std::string> names() {
    std::vector<std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(root_)) all.push_back(fs::relative(entry.path(), root_).string());
    std::sort(all.begin(), all.end());
    return all;
  }
  fs::path root_;
};

TEST_F(RunFolders, WhatMayBeUsedHow) {
  const fs::path old = run("old");
  fs::create_directories(root_ / "empty");
  fs::create_directories(root_ / "full/x");
  write_file(root_ / "file", "");
  struct Row {
    const char* name;
    bool fresh, replace, resume;
  };
  for (const Row& row : {Row{"none", true, true, false},
                         {"empty", true, true, false},
                         {"old", false, true, true},
                         {"full", false, false, false},
                         {"file", false, false, false}}) {
    const auto allowed = [&](FolderMode mode) {
      try {
        check_run_folder(root_ / row.name, mode);
        return true;
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::bad_input);
        return false;
      }
    };
    EXPECT_EQ(allowed(FolderMode::fresh), row.fresh) << row.name;
    EXPECT_EQ(allowed(FolderMode::replace), row.replace) << row.name;
    EXPECT_EQ(allowed(FolderMode::resume), row.resume) << row.name;
  }
}

TEST_F(RunFolders, AFolderThatIsNotKeptGoesWithItsParents) {
  {
    NewFolder folder(root_ / "a/b/run/");
    folder.own();
    write_file(root_ / "a/b/run/x", "x");
  }
  EXPECT_EQ(names(), std::vector<std::string>{});
  NewFolder folder(root_ / "a/b/run");
  folder.keep();
  EXPECT_EQ(names(), (std::vector<std::string>{"a", "a/b", "a/b/run"}));
}

TEST_F(RunFolders, AnEmptyFolderStaysEmpty) {
  fs::create_directories(root_ / "empty");
  {
    NewFolder folder(root_ / "empty");
    folder.own();
    write_file(root_ / "empty/x", "x");
  }
  EXPECT_EQ(names(), std::vector<std::string>{"empty"});
}

TEST_F(RunFolders, AReplacedRunComesBackUnlessTheNewOneIsKept) {
  const fs::path path = run("old");
  const std::vector<std::string> before = names();
  {
    NewFolder folder(path);
    folder.own();
    write_file(path / "x", "x");
  }
  EXPECT_EQ(names(), before);
  EXPECT_EQ(read_file(path / run_file::kScenario), "old");
  {
    NewFolder folder(path);
    write_file(path / "x", "x");
    folder.keep();
  }
  EXPECT_EQ(names(), (std::vector<std::string>{"old", "old/x"}));
}

TEST_F(RunFolders, AFolderThatCannotBeMadeIsAnIoError) {
  write_file(root_ / "file", "");
  try {
    const NewFolder folder(root_ / "file/run");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::io);
  }
  EXPECT_EQ(names(), std::vector<std::string>{"file"});
}

}  // namespace
}  // namespace vantage

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

TEST_F(RunFolders, ARunThatOnlyBeganMakesRoom) {
  const fs::path path = root_ / "begun";
  fs::create_directories(path);
  EXPECT_FALSE(has_only_begun(path));
  write_file(path / run_file::kScenario, "mine");
  EXPECT_FALSE(has_only_begun(path));  // Without a log it may be anybody's.
  write_file(path / run_file::kScanLog, "VANTSC");
  write_file(path / "manifest.json.1-1.part", "{");
  EXPECT_TRUE(has_only_begun(path));
  EXPECT_NO_THROW(check_run_folder(path, FolderMode::fresh));
  EXPECT_THROW(check_run_folder(path, FolderMode::resume), Error);
  NewFolder folder(path);
  const LogFile log(path / run_file::kScanLog, LogFile::Access::create);
  folder.own();
  folder.keep();
  EXPECT_EQ(names(), (std::vector<std::string>{"begun", "begun/scans.log"}));
  write_file(path / "note.txt", "mine");
  EXPECT_FALSE(has_only_begun(path));
}

TEST_F(RunFolders, ARunThatWasSetAsideAndForgottenComesBack) {
  const fs::path path = run("old"), aside = root_ / "old.replaced.part";
  const std::vector<std::string> before = names();
  EXPECT_FALSE(restore_replaced_run(path));
  fs::rename(path, aside);  // As a process does that is killed then,
  EXPECT_TRUE(restore_replaced_run(path));
  EXPECT_EQ(names(), before);
  fs::rename(path, aside);  // or a little later.
  fs::create_directory(path);
  write_file(path / run_file::kScanLog, "VANT");
  EXPECT_TRUE(restore_replaced_run(path));
  EXPECT_EQ(names(), before);
  EXPECT_EQ(read_file(path / run_file::kScenario), "old");
}

TEST_F(RunFolders, AReplacedRunGoesOnceTheNewOneStands) {
  const fs::path path = run("old");
  fs::rename(path, root_ / "old.replaced.part");
  static_cast<void>(run("old"));
  const std::vector<std::string> kept{"old", "old/scans.log", "old/scenario.toml"};
  EXPECT_FALSE(restore_replaced_run(path));
  write_file(path / "surface.ply.2147483647-3.part", "");
  clean_run_folder(path);
  EXPECT_EQ(names(), kept);
}

TEST_F(RunFolders, ARunThatIsWrittenIsNotReplaced) {
  const fs::path path = run("old");
  const std::vector<std::string> before = names();
  const LogFile writer(path / run_file::kScanLog, LogFile::Access::write);
  EXPECT_THROW(NewFolder{path}, Error);
  fs::rename(path, root_ / "old.replaced.part");
  EXPECT_THROW(static_cast<void>(restore_replaced_run(path)), Error);
  fs::rename(root_ / "old.replaced.part", path);
  EXPECT_EQ(names(), before);
}

TEST_F(RunFolders, AFolderThatAnotherTookMeanwhileStays) {
  {
    const NewFolder folder(root_ / "run");
    write_file(root_ / "run" / run_file::kScanLog, "of another process");
  }
  EXPECT_EQ(names(), (std::vector<std::string>{"run", "run/scans.log"}));
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

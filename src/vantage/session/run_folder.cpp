// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/run_folder.h"

#include <fmt/format.h>

#include <system_error>

#include "vantage/base/error.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

bool is_vacant(const fs::path& folder) {
  std::error_code error;
  return !fs::exists(folder, error) || (fs::is_directory(folder, error) && fs::is_empty(folder, error));
}

/// The name without a slash at its end, which would count as a name of its own.
fs::path trimmed(const fs::path& folder) { return folder.has_filename() ? folder : folder.parent_path(); }

}  // namespace

bool is_run_folder(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder / run_file::kScanLog, error) && fs::exists(folder / run_file::kScenario, error);
}

void check_run_folder(const fs::path& folder, FolderMode mode) {
  const std::string name = folder.string();
  require(!name.empty(), "the name of the run folder is empty");
  std::error_code error;
  require(!fs::exists(folder, error) || fs::is_directory(folder, error), "is a file: a run needs a folder", name);
  if (mode == FolderMode::resume) return require(is_run_folder(folder), "no run to resume: scans.log or scenario.toml is missing", name);
  if (is_vacant(folder)) return;
  require(is_run_folder(folder), "the folder is not empty, and not a run", name);
  require(mode == FolderMode::replace, "a run is there already: --resume goes on with it, --force replaces it", name);
}

NewFolder::NewFolder(fs::path folder) : folder_(trimmed(folder)) {
  try {
    if (!is_vacant(folder_)) {
      const fs::path aside = folder_.string() + ".replaced";
      fs::remove_all(aside);
      fs::rename(folder_, aside);
      aside_ = aside;
    }
    std::vector<fs::path> missing;
    for (fs::path p = folder_; !p.empty() && !fs::exists(p); p = p.parent_path()) missing.insert(missing.begin(), p);
    for (const fs::path& p : missing) {
      fs::create_directory(p);
      made_.push_back(p);
    }
  } catch (const fs::filesystem_error& error) {
    undo();
    throw Error(ErrorCode::io, "the folder cannot be made: " + error.code().message(), folder.string());
  }
}

NewFolder::~NewFolder() {
  if (!kept_) undo();
}

void NewFolder::undo() {
  std::error_code error;
  if (fs::is_directory(folder_, error))
    for (const fs::path& entry : fs::directory_iterator(folder_, error)) fs::remove_all(entry, error);
  for (auto it = made_.rbegin(); it != made_.rend(); ++it) fs::remove(*it, error);  // Parents only if nothing else is in them.
  if (!aside_.empty()) fs::rename(aside_, folder_, error);
}

void NewFolder::keep() {
  kept_ = true;
  std::error_code error;
  if (!aside_.empty()) fs::remove_all(aside_, error);
}

}  // namespace vantage

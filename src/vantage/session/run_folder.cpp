// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/run_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <system_error>

#include "vantage/base/error.h"
#include "vantage/io/atomic_file.h"
#include "vantage/session/scan_log.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

bool is_vacant(const fs::path& folder) {
  std::error_code error;
  const bool exists = fs::exists(folder, error);
  if (error) throw Error(ErrorCode::io, "cannot be read: " + error.message(), folder.string());
  return !exists || (fs::is_directory(folder, error) && fs::is_empty(folder, error));
}

/// The name without a slash at its end, which would count as a name of its own.
fs::path trimmed(const fs::path& folder) { return folder.has_filename() ? folder : folder.parent_path(); }

/// Where a run waits while it is replaced.
fs::path aside_of(const fs::path& folder) { return trimmed(folder).string() + ".replaced.part"; }

fs::path parent_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : "."; }

/// All that is in the folder, without a failure.
std::vector<fs::path> entries(const fs::path& folder) {
  std::vector<fs::path> all;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) all.push_back(it->path());
  return all;
}

/// Empties the folder; the log goes last, by which a folder is known as a run's.
void clear(const fs::path& folder, std::error_code& error) {
  for (const fs::path& entry : entries(folder))
    if (!error && entry.filename() != run_file::kScanLog) fs::remove_all(entry, error);
  if (!error) fs::remove(folder / run_file::kScanLog, error);
}

void make_folder(const fs::path& path) {
  fs::create_directory(path);
  sync_folder(parent_of(path));
}

}  // namespace

bool is_run_folder(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder / run_file::kScanLog, error) && fs::exists(folder / run_file::kScenario, error);
}

bool has_only_begun(const fs::path& folder) {
  constexpr std::array kFirst = {run_file::kScanLog, run_file::kScenario, run_file::kManifest, run_file::kNextSettings};
  const std::vector<fs::path> found = entries(folder);
  const auto is_first = [&](const fs::path& path) {
    return path.extension() == ".part" || std::find(kFirst.begin(), kFirst.end(), path.filename().string()) != kFirst.end();
  };
  std::error_code error;
  const fs::path log = folder / run_file::kScanLog;
  return fs::is_regular_file(log, error) && std::all_of(found.begin(), found.end(), is_first) && is_empty_log(log);
}

bool restore_replaced_run(const fs::path& folder) {
  const fs::path aside = aside_of(folder);
  if (!is_run_folder(aside) || !(is_vacant(folder) || has_only_begun(folder))) return false;
  const LogFile held(aside / run_file::kScanLog, LogFile::Access::write);
  std::error_code error;
  clear(folder, error);
  if (!error) fs::remove(trimmed(folder), error);
  if (!error) fs::rename(aside, trimmed(folder), error);
  if (error) throw Error(ErrorCode::io, "the run that was to be replaced cannot be put back: " + error.message(), aside.string());
  sync_folder(parent_of(trimmed(folder)));
  return true;
}

void clean_run_folder(const fs::path& folder) {
  std::error_code error;
  remove_stale_parts(folder);
  remove_stale_parts(folder / run_file::kScans);
  fs::remove_all(aside_of(folder), error);
}

void check_run_folder(const fs::path& folder, FolderMode mode) {
  const std::string name = folder.string();
  require(!name.empty(), "the name of the run folder is empty");
  std::error_code error;
  require(!fs::exists(folder, error) || fs::is_directory(folder, error), "is a file: a run needs a folder", name);
  if (mode == FolderMode::resume) {
    require(!has_only_begun(folder) || fs::exists(folder / run_file::kManifest, error),
            "the run was stopped before its first scan: name its SCENE to begin again", name);
    return require(is_run_folder(folder), "no run to resume: scans.log or scenario.toml is missing", name);
  }
  if (is_vacant(folder) || has_only_begun(folder)) return;
  require(is_run_folder(folder), "the folder is not empty, and not a run", name);
  require(mode == FolderMode::replace, "a run is there already: --resume goes on with it, --force replaces it", name);
}

NewFolder::NewFolder(fs::path folder) : folder_(trimmed(folder)) {
  try {
    if (is_run_folder(folder_) && !has_only_begun(folder_)) {
      replaced_.emplace(folder_ / run_file::kScanLog, LogFile::Access::write);
      fs::remove_all(aside_of(folder_));
      fs::rename(folder_, aside_of(folder_));
      aside_ = aside_of(folder_);
    }
    std::vector<fs::path> missing;
    for (fs::path p = folder_; !p.empty() && !fs::exists(p); p = p.parent_path()) missing.insert(missing.begin(), p);
    for (const fs::path& p : missing) {
      made_.push_back(p);
      make_folder(p);
    }
  } catch (const fs::filesystem_error& error) {
    undo();
    throw Error(ErrorCode::io, "the folder cannot be made: " + error.code().message(), folder.string());
  } catch (const Error&) {
    undo();
    throw;
  }
}

NewFolder::~NewFolder() {
  if (!kept_) undo();
}

void NewFolder::undo() {
  std::error_code error;
  if (owned_) clear(folder_, error);
  for (auto it = made_.rbegin(); it != made_.rend(); ++it) fs::remove(*it, error);  // Only if nothing else is in them.
  if (!aside_.empty()) fs::rename(aside_, folder_, error);
}

void NewFolder::own() {
  owned_ = true;
  std::error_code error;
  for (const fs::path& entry : entries(folder_))
    if (!error && entry.filename() != run_file::kScanLog) fs::remove_all(entry, error);
  if (error) throw Error(ErrorCode::io, "what a stopped run has left cannot be removed: " + error.message(), folder_.string());
}

void NewFolder::keep() {
  kept_ = true;
  std::error_code error;
  if (!aside_.empty()) fs::remove_all(aside_, error);
}

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vantage/session/log_file.h"

namespace vantage {

/// Names inside a run folder.
namespace run_file {
inline constexpr const char* kScanLog = "scans.log";
inline constexpr const char* kScenario = "scenario.toml";
inline constexpr const char* kManifest = "manifest.json";
inline constexpr const char* kScans = "scans";
inline constexpr const char* kStations = "stations.csv";
inline constexpr const char* kSurface = "surface.ply";
inline constexpr const char* kSurfaceGlb = "surface.glb";
inline constexpr const char* kBelief = "belief.vti";
inline constexpr const char* kPath = "path.csv";
inline constexpr const char* kSteps = "steps.csv";
inline constexpr const char* kReport = "report.html";
inline constexpr const char* kTiming = "timing.json";
inline constexpr const char* kResult = "result.json";
inline constexpr const char* kNext = "next.json";
inline constexpr const char* kNextTable = "next.csv";
inline constexpr const char* kNextSettings = "next.toml";  ///< Of a person's scans only.
}  // namespace run_file

/// What to do with a run folder that is there already: refuse, make a new run in its place, or go on with it.
enum class FolderMode { fresh, replace, resume };

/// Throws bad_input unless a run may use `folder` that way: fresh wants nothing, an empty folder or a run that only began there; replace what fresh
/// wants or a run; resume a run.
void check_run_folder(const std::filesystem::path& folder, FolderMode mode);

/// Whether `folder` holds a run.
[[nodiscard]] bool is_run_folder(const std::filesystem::path& folder);

/// Whether `folder` holds nothing but what a run writes before its first scan: it was stopped then.
[[nodiscard]] bool has_only_begun(const std::filesystem::path& folder);

/// Puts back the run that a process set aside to replace it, if that one stopped before the new run's first scan; true if so. Call before looking
/// into `folder`. Throws io.
bool restore_replaced_run(const std::filesystem::path& folder);

/// Removes what stopped processes left in a run folder, and the run that it replaced; call with its log open.
void clean_run_folder(const std::filesystem::path& folder);

/// A folder that goes away again, with the parents it needed, unless `keep` is called; what it replaces comes back then.
class NewFolder {
 public:
  /// Makes `folder`, on the disk; a run that is there is set aside. Throws io, also when another process writes that run.
  explicit NewFolder(std::filesystem::path folder);
  ~NewFolder();
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;
  /// Call once this process holds the folder's log: what a run that only began has left is removed, and what comes goes away with the folder.
  /// Throws io.
  void own();
  /// From now on the folder stays, and what it replaced is deleted.
  void keep();

 private:
  void undo();

  std::filesystem::path folder_, aside_;
  std::vector<std::filesystem::path> made_;  ///< Outermost first.
  std::optional<LogFile> replaced_;          ///< Held, so that nobody goes on with it.
  bool owned_ = false, kept_ = false;
};

}  // namespace vantage

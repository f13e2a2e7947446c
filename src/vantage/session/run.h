// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vantage/base/progress.h"
#include "vantage/session/result.h"
#include "vantage/session/run_folder.h"
#include "vantage/session/scenario.h"

namespace vantage {

/// How a run goes, free of its dimension.
struct RunStart {
  std::string scene;
  int dim = 3;
  std::size_t nodes = 0;  ///< Of the lattice.
  int logged = 0;         ///< Scans that the log has already.
  std::int64_t max_scans = 0;
};
struct RunStep {
  int scan = 0;
  bool from_log = false;
  std::vector<double> vantage;  ///< [m]
  std::int64_t points = 0;
  double new_volume = 0.0;     ///< [m^Dim]
  double seen_fraction = 0.0;  ///< [1]
  double path = 0.0;           ///< So far [m].
  double seconds = 0.0;        ///< Wall time of this step.
};

/// Watches a run; asked after each step whether to stop.
class RunObserver : public Observer {
 public:
  virtual void begin(const RunStart& /*start*/) {}
  virtual void step(const RunStep& /*step*/) {}
};

/// What to run, and where to.
struct RunRequest {
  std::string scene;              ///< As for make_world; may be empty when resuming.
  std::vector<Setting> settings;  ///< In order of force.
  std::filesystem::path folder;   ///< Empty: `runs/NAME`, with the name of the scene or file.
  FolderMode mode = FolderMode::fresh;
  std::optional<std::int64_t> max_scans;  ///< For this time only; not kept in the folder, so that a later resumption can go further.
  std::vector<int> remove;                ///< Scans to take out of the log first; only when resuming.
  int threads = 0;                        ///< 0: all cores.
};

enum class RunEnd { finished, scan_limit, interrupted, no_plan };

struct RunOutcome {
  RunEnd end = RunEnd::finished;
  std::filesystem::path folder;
  Json result;           ///< `result.json`.
  double seconds = 0.0;  ///< Wall time.
};

/// Explores a scene into a run folder, or goes on with one (or, of a named scene, begins again one that was stopped before its first scan): the same
/// bytes (but timing.json) come out however often a run was interrupted, and for any number of threads. On bad input nothing is left behind. Throws
/// bad_input, io, memory.
[[nodiscard]] RunOutcome run_exploration(const RunRequest& request, RunObserver* observer = nullptr);

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "vantage/base/progress.h"
#include "vantage/session/measured.h"
#include "vantage/session/result.h"
#include "vantage/session/scenario.h"

namespace vantage {

/// Scans, and what is wanted.
struct NextRequest {
  std::vector<std::filesystem::path> inputs;  ///< Point clouds; or a run folder first, which further clouds are added to.
  std::filesystem::path folder;               ///< A new run folder to make of the clouds; empty: none, nothing is written.
  GivenPoses poses;
  std::vector<Setting> settings;  ///< `next.*`, `measured.*` and those of a scenario, in order of force; those of the folder come before.
  std::vector<int> remove;        ///< Scans to take out of the folder's log first.
  bool force = false;             ///< Add a scan even if its points are those of another one.
  int threads = 0;                ///< 0: all cores.
};

struct NextOutcome {
  Json json;                        ///< next.json; interface.md has the names.
  std::filesystem::path folder;     ///< What was written into; empty: nothing.
  bool report = false;              ///< A report was written.
  std::vector<std::string> notes;   ///< What was assumed, one sentence each.
  std::vector<std::string> inputs;  ///< One line on each scan that was read now.
  bool unreachable = false;         ///< Unseen space remains, and no place to scan it from.
};

/// Where to scan next. Of a folder of explored scenes only next.json and next.csv are written; a folder of a person's scans is made anew from its
/// log, which a scan is added to only after all went well. On bad input nothing is changed. Throws bad_input, io, memory.
[[nodiscard]] NextOutcome find_next(const NextRequest& request, Observer* observer = nullptr);

}  // namespace vantage

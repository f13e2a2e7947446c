// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>

#include "contender.h"

namespace vantage::bench {

/// What to measure. `cloud` has at least `scans` scans; with one more, adding it is measured too.
struct Job {
  std::string contender;  ///< NAME:PARAMETER
  std::size_t scans = 16;
  int threads = 1;
  std::vector<std::string> sets;  ///< Surface options of ours.
};

/// Least of the runs made: up to three, while they take no longer than a few seconds together. CPU is that of all threads.
struct Figures {
  double cpu = 0.0, wall = 0.0;  ///< From points in memory to the map [s].
  double output_cpu = 0.0;       ///< From the map to its primitives, as shapes and as a file [s].
  double peak = 0.0;             ///< Growth of the process while the map was built first [MB].
  std::int64_t points = 0;
  std::optional<double> add_cpu;  ///< Adding scan `scans` + 1 [s].
  std::int64_t added_points = 0;  ///< Of that scan.
  std::string error;              ///< Why there are no figures.
};

struct Measured {
  Figures figures;
  Output output;
};

/// Measures in a process of its own, the program itself started once more on `cloud_file`: memory is then nobody else's, and a peer that dies is a
/// row that says so.
[[nodiscard]] Measured measure(const Job& job, const std::filesystem::path& cloud_file);

/// What that process does; returns its exit code.
int run_job(const Job& job, const std::filesystem::path& cloud_file, const std::filesystem::path& out_file);

}  // namespace vantage::bench

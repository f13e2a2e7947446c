// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "vantage/explore/explore.h"
#include "vantage/session/result.h"

namespace vantage {

/// What elevations a person's scans say something of, and what lies beyond them.
struct ScanCoverage {
  Elevations all;  ///< Of all scans together.
  std::vector<Elevations> of_scan;
  std::vector<Vec<3>> from;  ///< Where each was taken [m].

  /// Of `count` scans, asked for one after the other.
  ScanCoverage(int count, const std::function<Scan<3>(int)>& scan);
  /// What the planner is to know of it; nothing if it is all.
  [[nodiscard]] std::optional<Elevations> limits() const;
  /// Unseen volume that lies beyond the elevations of every scan [m^3].
  [[nodiscard]] double beyond(const BeliefView<3>& view) const;
  /// One line for a person; empty if nothing lies beyond.
  [[nodiscard]] std::string note(double beyond) const;
  [[nodiscard]] Json json(double beyond) const;
};

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Resident memory of this process while it lives: what it held before, and the most since (Linux; elsewhere 0). Where the system does not let the
/// peak be reset it is the peak of the process so far.
class PeakMemory {
 public:
  PeakMemory();
  [[nodiscard]] double before() const { return before_; }  ///< [MiB]
  [[nodiscard]] double peak() const;                       ///< [MiB]

 private:
  double before_;
};

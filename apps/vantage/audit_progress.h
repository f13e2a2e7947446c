// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <optional>
#include <string>

#include "line_progress.h"
#include "progress.h"

/// Shows on stderr how an audit goes: one live line on a terminal, elsewhere a line a finished run.
class AuditProgress final : public vantage::Observer {
 public:
  explicit AuditProgress(bool quiet) : quiet_(quiet), line_(std::in_place, quiet) {}

  /// So many runs in all.
  void expect(std::int64_t total) { total_ = total; }
  /// A run that begins, or whatever else takes time.
  void begin(const std::string& what);
  /// The run is finished, played now or found in the folder.
  void done(const std::string& result);
  void found() { ++done_; }
  /// One of many that are played at a time: counts, prints nothing.
  void played() {
    ++done_;
    ++played_;
  }
  /// Takes the live line away; call before printing anything else.
  void finish() { line_.reset(); }

  void stage(std::string_view name) override;
  [[nodiscard]] bool stop_requested() override { return StopSignals::raised(); }

 private:
  using Clock = std::chrono::steady_clock;
  void show();

  bool quiet_;
  std::optional<LineProgress> line_;
  std::int64_t total_ = 0, done_ = 0, played_ = 0, scan_ = 0;
  std::string what_;
  Clock::time_point begin_ = Clock::now();
};

// SPDX-License-Identifier: Apache-2.0
#include "line_progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include "progress.h"

LineProgress::LineProgress(bool quiet) : quiet_(quiet), live_(!quiet && ::isatty(STDERR_FILENO) != 0) {}

LineProgress::~LineProgress() {
  if (!live_) return;
  fmt::print(stderr, "\r\033[K");
  std::fflush(stderr);
}

void LineProgress::stage(std::string_view name) {
  if (!live_) return;
  fmt::print(stderr, "\r\033[K{}", name);
  std::fflush(stderr);
}

void LineProgress::warn(std::string_view message) {
  if (quiet_) return;
  fmt::print(stderr, "{}vantage: warning: {}\n", live_ ? "\r\033[K" : "", message);
  std::fflush(stderr);
}

bool LineProgress::stop_requested() { return StopSignals::raised(); }

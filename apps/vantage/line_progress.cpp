// SPDX-License-Identifier: Apache-2.0
#include "line_progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "progress.h"

namespace {

/// The command goes on even if nobody can be told.
void put(const std::string& text) {
  static_cast<void>(std::fputs(text.c_str(), stderr));
  std::fflush(stderr);
}

}  // namespace

LineProgress::LineProgress(bool quiet) : quiet_(quiet), live_(!quiet && ::isatty(STDERR_FILENO) != 0) {}

LineProgress::~LineProgress() {
  if (!live_) return;
  put("\r\033[K");
}

void LineProgress::stage(std::string_view name) {
  if (!live_) return;
  put(fmt::format("\r\033[K{}", name));
}

void LineProgress::warn(std::string_view message) {
  if (quiet_) return;
  put(fmt::format("{}vantage: warning: {}\n", live_ ? "\r\033[K" : "", message));
}

bool LineProgress::stop_requested() { return StopSignals::raised(); }

// SPDX-License-Identifier: Apache-2.0
#include "audit_progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include "numbers.h"

void AuditProgress::begin(const std::string& what) {
  what_ = what;
  scan_ = 0;
  show();
}

void AuditProgress::done(const std::string& result) {
  ++done_;
  ++played_;
  if (quiet_ || ::isatty(STDERR_FILENO) != 0) return;
  fmt::print(stderr, "{} of {}: {}: {}\n", done_, total_, what_, result);
}

void AuditProgress::stage(std::string_view name) {
  if (name != "scan") return;
  ++scan_;
  show();
}

void AuditProgress::show() {
  std::string text = fmt::format("{} of {}  {}", done_ + 1, total_, what_);
  if (scan_ > 0) text += fmt::format("  scan {}", scan_);
  if (played_ > 0) {
    const double each = std::chrono::duration<double>(Clock::now() - begin_).count() / static_cast<double>(played_);
    text += fmt::format("  ~{} left", stopwatch(each * static_cast<double>(total_ - done_)));
  }
  if (line_) line_->stage(StopSignals::raised() ? "stopping…  " + text : text);
}

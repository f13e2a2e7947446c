// SPDX-License-Identifier: Apache-2.0
#include "progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "numbers.h"

using vantage::RunStart;
using vantage::RunStep;

namespace {

constexpr std::chrono::milliseconds kFrame{120};
constexpr const char* kSpinner[] = {"⠋", "⠙", "⠹", "⠸", "⠼", "⠴", "⠦", "⠧", "⠇", "⠏"};
constexpr double kDoneUnseen = 0.003;  // Runs end about here.

volatile std::sig_atomic_t g_stop = 0;

void on_signal(int) {
  g_stop = 1;
  std::signal(SIGINT, SIG_DFL);  // The next one ends the process.
  std::signal(SIGTERM, SIG_DFL);
}

std::size_t terminal_width() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

/// `width` cells, filled to an eighth of a cell.
std::string bar(double share, std::size_t width) {
  constexpr const char* kEighths[] = {"", "▏", "▎", "▍", "▌", "▋", "▊", "▉"};
  const auto eighths = static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * static_cast<double>(width) * 8.0);
  std::string out;
  for (std::size_t i = 0; i < eighths / 8; ++i) out += "█";
  out += kEighths[eighths % 8];
  for (std::size_t i = (eighths + 7) / 8; i < width; ++i) out += "·";
  return out;
}

/// The run goes on even if nobody can be told.
void put(const std::string& text) { static_cast<void>(std::fputs(text.c_str(), stderr)); }

std::string percent(double share) {
  // Never 100.0 % while anything is missing.
  const double value = share < 1.0 ? std::min(100.0 * share, 99.99) : 100.0;
  return share >= 0.99 ? fmt::format("{:.2f} %", value) : fmt::format("{:.1f} %", value);
}

std::string start_line(const RunStart& start) {
  return fmt::format("{}: {}D, {} lattice nodes{}", start.scene, start.dim, grouped(static_cast<std::int64_t>(start.nodes)),
                     start.logged > 0 ? fmt::format(", {} scans from the log", start.logged) : "");
}

std::string step_line(const RunStep& step) {
  std::string place;
  for (const double v : step.vantage) place += fmt::format("{}{:.1f}", place.empty() ? "" : ", ", v);
  return fmt::format("scan {:>3}  seen {:>7}  {:>9} points  at ({})  path {:.1f} m  {}{}", step.scan, percent(step.seen_fraction),
                     grouped(step.points), place, step.path, duration(step.seconds), step.from_log ? "  from the log" : "");
}

}  // namespace

double remaining_seconds(const std::vector<RunStep>& steps, std::int64_t max_scans) {
  constexpr std::size_t kTrend = 6;  // Steps looked back.
  const std::size_t n = steps.size();
  if (n < 3) return -1.0;
  const std::size_t back = std::min(kTrend, n - 1);
  const double now = 1.0 - steps[n - 1].seen_fraction, then = 1.0 - steps[n - 1 - back].seen_fraction;
  double seconds = 0.0;
  for (std::size_t i = n - back; i < n; ++i) seconds += steps[i].seconds;
  seconds /= static_cast<double>(back);
  const double limit = static_cast<double>(max_scans) - static_cast<double>(n);
  if (now <= kDoneUnseen) return seconds;
  if (!(then > now)) return -1.0;
  const double rate = std::log(then / now) / static_cast<double>(back);  // The unseen share falls about like exp(-rate n).
  return seconds * std::min(limit, std::log(now / kDoneUnseen) / rate);
}

RunProgress::RunProgress(Loudness loudness) : loudness_(loudness) {
  const char *no_color = std::getenv("NO_COLOR"), *term = std::getenv("TERM");
  live_ = loudness != Loudness::quiet && ::isatty(STDERR_FILENO) != 0 && term != nullptr && std::string(term) != "dumb";
  color_ = live_ && (no_color == nullptr || *no_color == '\0');
  if (!live_) return;
  ticker_ = std::thread([this] {
    std::unique_lock lock(mutex_);
    while (!wake_.wait_for(lock, kFrame, [this] { return done_; })) {
      ++frame_;
      draw();
    }
  });
}

RunProgress::~RunProgress() { finish(); }

void RunProgress::finish() {
  {
    const std::lock_guard lock(mutex_);
    done_ = true;
  }
  wake_.notify_all();
  if (ticker_.joinable()) ticker_.join();
  const std::lock_guard lock(mutex_);
  clear();
}

void RunProgress::begin(const RunStart& start) {
  const std::lock_guard lock(mutex_);
  start_ = start;
  stage_ = "scan";
}

void RunProgress::stage(std::string_view name) {
  const std::lock_guard lock(mutex_);
  stage_ = name;
}

void RunProgress::step(const RunStep& step) {
  const std::lock_guard lock(mutex_);
  steps_.push_back(step);
  points_ += step.points;
  const bool lines = loudness_ == Loudness::verbose || (loudness_ == Loudness::normal && !live_);
  if (lines && steps_.size() == 1) print_line(start_line(start_));  // Not before: an error of the first scan stands alone.
  if (lines) print_line(step_line(step));
}

void RunProgress::warn(std::string_view message) {
  const std::lock_guard lock(mutex_);
  if (loudness_ != Loudness::quiet) print_line(fmt::format("vantage: warning: {}", message));
}

bool RunProgress::stop_requested() { return StopSignals::raised(); }

void RunProgress::print_line(const std::string& line) {
  clear();
  put(line + "\n");
}

void RunProgress::clear() {
  if (drawn_) put("\r\033[K");
  drawn_ = false;
  std::fflush(stderr);
}

void RunProgress::draw() {
  const std::size_t width = terminal_width();
  if (width < 20) return;
  put("\r\033[K" + live_line(width - 1));
  drawn_ = true;
  std::fflush(stderr);
}

std::string RunProgress::live_line(std::size_t width) const {
  const double elapsed = std::chrono::duration<double>(Clock::now() - begin_).count();
  const char* spin = kSpinner[frame_ % std::size(kSpinner)];
  const double seen = steps_.empty() ? 0.0 : steps_.back().seen_fraction;
  const double left = remaining_seconds(steps_, start_.max_scans);
  const std::string head = start_.scene.empty() ? "loading" : fmt::format("{}  scan {}", start_.scene, steps_.size());
  const std::string stage = StopSignals::raised() ? "stopping…" : stage_;
  std::string tail = fmt::format("{:>7} seen", percent(seen));
  const auto add = [&](const std::string& more) {
    constexpr std::size_t kBar = 14;  // Always keep room for a bar.
    if (2 + head.size() + 2 + 10 + 2 + kBar + 1 + tail.size() + more.size() <= width) tail += more;
  };
  if (left >= 0.0) add(fmt::format("  ~{} left", stopwatch(std::max(left, 1.0))));
  add(fmt::format("  {} points", rounded(static_cast<double>(points_))));
  add(fmt::format("  {}", stopwatch(elapsed)));
  const std::size_t used = 2 + head.size() + 2 + 10 + 2 + 1 + tail.size();
  if (used + 6 > width) return fmt::format("{} {}  {}", spin, head, percent(seen)).substr(0, width);
  const std::string filled = bar(seen, std::min<std::size_t>(width - used, 40));
  if (!color_) return fmt::format("{} {}  {:<10}  {} {}", spin, head, stage, filled, tail);
  return fmt::format("\033[36m{}\033[0m {}  \033[2m{:<10}\033[0m  \033[36m{}\033[0m {}", spin, head, stage, filled, tail);
}

StopSignals::StopSignals() {
  g_stop = 0;
  struct sigaction action{};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

StopSignals::~StopSignals() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

bool StopSignals::raised() { return g_stop != 0; }

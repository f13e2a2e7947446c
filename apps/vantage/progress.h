// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "vantage/session/run.h"

enum class Loudness { quiet, normal, verbose };

/// Shows a run on stderr: one live line on a terminal, one line a step elsewhere, nothing when quiet. Asks the signal handler whether to stop.
class RunProgress final : public vantage::RunObserver {
 public:
  explicit RunProgress(Loudness loudness);
  ~RunProgress() override;

  void begin(const vantage::RunStart& start) override;
  void stage(std::string_view name) override;
  void step(const vantage::RunStep& step) override;
  void warn(std::string_view message) override;
  [[nodiscard]] bool stop_requested() override;
  /// Takes the live line away; call before printing anything else.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  void draw();   ///< The mutex is held.
  void clear();  ///< The mutex is held.
  void print_line(const std::string& line);
  [[nodiscard]] std::string live_line(std::size_t width) const;

  Loudness loudness_;
  bool live_ = false, color_ = false, drawn_ = false, done_ = false;
  Clock::time_point begin_ = Clock::now();
  vantage::RunStart start_;
  std::vector<vantage::RunStep> steps_;
  std::int64_t points_ = 0;
  std::string stage_ = "scene";
  std::size_t frame_ = 0;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::thread ticker_;
};

/// Seconds until the run is done, from the trend of what is unseen and the time a step takes; negative: no telling yet.
[[nodiscard]] double remaining_seconds(const std::vector<vantage::RunStep>& steps, std::int64_t max_scans);

/// While it lives, the first SIGINT or SIGTERM asks the run to stop after the step; the second ends the process.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;
  [[nodiscard]] static bool raised();
};

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/base/progress.h"

/// Shows the stage of a long computation on a terminal's stderr, one line that is taken away at the end; the first Ctrl-C stops it at its next stage.
class LineProgress final : public vantage::Observer {
 public:
  explicit LineProgress(bool quiet);
  ~LineProgress() override;
  void stage(std::string_view name) override;
  void warn(std::string_view message) override;
  [[nodiscard]] bool stop_requested() override;

 private:
  bool quiet_, live_;
};

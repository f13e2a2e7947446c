// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "vantage/base/progress.h"
#include "vantage/session/result.h"
#include "vantage/world/lidar.h"

/// A table or figure of the paper, made again.
struct PaperItem {
  std::string text;                                        ///< For the terminal.
  vantage::Json json;                                      ///< The figures, for scripts.
  std::vector<std::pair<std::string, std::string>> files;  ///< Name and bytes, for -o DIR.
};

/// Each makes one of them, in a file of its own: paper_NAME.cpp. paper.cpp lists them.
PaperItem paper_table1(const vantage::LidarOptions& sensor, vantage::Observer& observer);

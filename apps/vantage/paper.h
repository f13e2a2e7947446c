// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "vantage/base/progress.h"
#include "vantage/report/image.h"
#include "vantage/session/result.h"
#include "vantage/world/lidar.h"

/// A table or figure of the paper, made again.
struct PaperItem {
  std::string text;                                        ///< For the terminal.
  vantage::Json json;                                      ///< The figures, for scripts.
  std::vector<std::pair<std::string, std::string>> files;  ///< Name and bytes, for -o DIR.

  /// Text and figures as NAME.md and NAME.json.
  void add_texts(const std::string& name);
  /// As PNG, in few colours so that the file is small.
  void add_picture(const std::string& name, vantage::Image image);
};

/// How it is made.
struct PaperSetup {
  vantage::LidarOptions sensor;
  bool quick = false;     ///< Coarser, and less of it: for a look.
  bool pictures = false;  ///< Wanted: there is a folder to put them into.
};

// Each makes one of them, in a file of its own: paper_NAME.cpp. paper.cpp lists them.
PaperItem paper_table1(const PaperSetup& setup, vantage::Observer& observer);
PaperItem paper_fig2(const PaperSetup& setup, vantage::Observer& observer);
PaperItem paper_fig3(const PaperSetup& setup, vantage::Observer& observer);
PaperItem paper_fig4(const PaperSetup& setup, vantage::Observer& observer);
PaperItem paper_fig5(const PaperSetup& setup, vantage::Observer& observer);
PaperItem paper_fig6(const PaperSetup& setup, vantage::Observer& observer);
PaperItem paper_fig7(const PaperSetup& setup, vantage::Observer& observer);

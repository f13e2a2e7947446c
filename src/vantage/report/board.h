// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "vantage/report/marks.h"

namespace vantage {

/// A picture with a line of words under it.
struct Tile {
  Image image;
  std::string caption;
};

/// Pictures in rows under a title, with a legend: a figure as one file.
struct Board {
  std::string title;
  std::string note;  ///< In small letters under the title; may hold line ends.
  struct Row {
    std::string name;  ///< Before the row, reading upwards; may be empty.
    std::vector<Tile> tiles;
  };
  std::vector<Row> rows;
  std::vector<Key> legend;
};

/// The board on white, as wide as its widest row.
[[nodiscard]] Image board_image(const Board& board);

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// One property of all items of an element, as double.
struct PlyColumn {
  std::string name;
  std::vector<double> values;
  std::vector<std::size_t> ends;  ///< Of a list: where each item's part of `values` ends. Empty otherwise.
  bool list = false;
};

struct PlyElement {
  std::string name;  ///< "vertex", "face", ...
  std::size_t count = 0;
  std::vector<PlyColumn> columns;
  /// nullptr if there is none of that name.
  [[nodiscard]] const PlyColumn* find(std::string_view column) const;
};

/// All elements of a PLY file, ASCII or binary of either byte order. No number of the header is believed before the bytes are there.
/// Throws bad_input at `name` for anything that is not PLY or is cut short.
[[nodiscard]] std::vector<PlyElement> parse_ply_elements(std::string_view bytes, const std::string& name);

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <cctype>
#include <vector>

#include "vantage/base/error.h"
#include "vantage/io/point_cloud_formats.h"
#include "vantage/io/text.h"
#include "vantage/io/text_scanner.h"

namespace vantage {
namespace {

constexpr std::string_view kSeparators = " \t\r,;";

/// Which column holds which axis; -1: none.
struct Columns {
  std::array<int, 3> of_axis{0, 1, 2};
  bool named = false;
};

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::string_view word = take_word(line, kSeparators); !word.empty(); word = take_word(line, kSeparators)) words.push_back(word);
  return words;
}

bool is_comment(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  return first == std::string_view::npos || line[first] == '#' || line.substr(first, 2) == "//";
}

/// Names of the columns: `x,y,z`, also `"X"` or `//X`.
Columns named_columns(const std::vector<std::string_view>& words, const std::string& place) {
  Columns columns{{-1, -1, -1}, true};
  for (std::size_t i = 0; i < words.size(); ++i) {
    std::string_view word = words[i];
    while (!word.empty() && word.front() == '"') word.remove_prefix(1);
    while (!word.empty() && word.back() == '"') word.remove_suffix(1);
    if (word.size() != 1) continue;
    const int axis = std::tolower(static_cast<unsigned char>(word.front())) - 'x';
    if (axis < 0 || axis > 2) continue;
    int& column = columns.of_axis[static_cast<std::size_t>(axis)];
    require(column < 0, fmt::format("columns {} and {} are both called {}", column + 1, i + 1, word), place);
    column = static_cast<int>(i);
  }
  require(columns.of_axis[0] >= 0 && columns.of_axis[1] >= 0,
          fmt::format("{}: neither numbers nor column names with x and y", printable(words.front())), place);
  return columns;
}

Columns columns_of(const std::vector<std::string_view>& words, const std::string& place) {
  if (!to_number<double>(words.front())) return named_columns(words, place);
  require(words.size() >= 2, "one number a line: points need two or three", place);
  Columns columns;
  if (words.size() == 2) columns.of_axis[2] = -1;
  return columns;
}

Vec<3> point_of(const std::vector<std::string_view>& words, const Columns& columns, std::string_view where, std::size_t line) {
  Vec<3> p = Vec<3>::Zero();
  for (std::size_t a = 0; a < 3; ++a) {
    if (columns.of_axis[a] < 0) continue;
    const auto column = static_cast<std::size_t>(columns.of_axis[a]);
    if (column >= words.size())
      throw Error(ErrorCode::bad_input, fmt::format("{} numbers: column {} is missing", words.size(), column + 1), fmt::format("{}:{}", where, line));
    const std::optional<double> value = to_number<double>(words[column]);
    if (!value) throw Error(ErrorCode::bad_input, fmt::format("{}: not a number", printable(words[column])), fmt::format("{}:{}", where, line));
    p[static_cast<Eigen::Index>(a)] = *value;
  }
  return p;
}

}  // namespace

PointCloud parse_xyz(std::string_view bytes, std::string_view where) {
  require(bytes.substr(0, 4096).find('\0') == std::string_view::npos,
          "not a point cloud this program reads (PLY, PCD, E57, LAS, PTX, KITTI .bin, OctoMap .bt, XYZ, CSV)", where);
  PointCloud cloud;
  cloud.format = "text";
  std::optional<Columns> columns;
  TextScanner scanner(bytes);
  while (const std::optional<std::string_view> line = scanner.next_line()) {
    if (is_comment(*line)) continue;
    const std::vector<std::string_view> words = words_of(*line);
    if (words.empty()) continue;
    if (!columns) {
      columns = columns_of(words, fmt::format("{}:{}", where, scanner.line()));
      if (columns->of_axis[2] < 0) cloud.dim = 2;
      if (columns->named) continue;
    }
    cloud.points.push_back(point_of(words, *columns, where, scanner.line()));
  }
  return cloud;
}

}  // namespace vantage

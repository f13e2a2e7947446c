// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/poses.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <utility>

#include "vantage/base/error.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/text.h"

namespace vantage {
namespace {

struct Line {
  int number = 0;
  std::vector<std::string> words;
};

/// Place of each number of a line: entries of a 3 x 4 matrix 0 .. 11, quaternion w x y z 12 .. 15, or none of these.
using Layout = std::vector<int>;
constexpr int kName = -1, kIgnored = -2;
constexpr int kQuaternion = 12;

std::vector<std::string> words_of(std::string_view line) {
  std::vector<std::string> words;
  std::string word;
  for (const char c : line) {
    const bool apart = c == ' ' || c == '\t' || c == ',' || c == ';' || c == '\r';
    if (!apart) word += c;
    if (apart && !word.empty()) words.push_back(std::exchange(word, {}));
  }
  if (!word.empty()) words.push_back(word);
  return words;
}

std::optional<double> number_of(const std::string& word) {
  const char first = word.empty() ? ' ' : word.front();
  if ((first < '0' || first > '9') && first != '-' && first != '+' && first != '.') return std::nullopt;
  if (word.find_first_not_of("0123456789+-.eE") != std::string::npos) return std::nullopt;
  return leading_number(word);
}

std::vector<Line> lines_of(std::string_view text) {
  std::vector<Line> lines;
  for (int number = 1; !text.empty(); ++number) {
    const std::string_view line = next_line(text);
    Line next{number, words_of(line)};
    if (!next.words.empty() && next.words.front().front() != '#') lines.push_back(std::move(next));
  }
  return lines;
}

int column_of(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  static const std::array<const char*, 3> kPlaces[] = {{"x", "y", "z"}, {"tx", "ty", "tz"}, {"x_m", "y_m", "z_m"}};
  for (const auto& names : kPlaces)
    for (int a = 0; a < 3; ++a)
      if (name == names[static_cast<std::size_t>(a)]) return 4 * a + 3;
  static const char* const kTurns[] = {"qw", "qx", "qy", "qz"};
  for (int k = 0; k < 4; ++k)
    if (name == kTurns[k]) return kQuaternion + k;
  const bool entry = name.size() == 3 && (name[0] == 'r' || name[0] == 'm') && name[1] >= '0' && name[1] <= '2' && name[2] >= '0' && name[2] <= '3';
  return entry ? 4 * (name[1] - '0') + (name[2] - '0') : kIgnored;
}

Layout from_header(const Line& header) {
  Layout layout;
  for (const std::string& word : header.words) layout.push_back(column_of(word));
  if (!layout.empty() && layout.front() == kIgnored) layout.front() = kName;
  return layout;
}

Layout from_count(std::size_t count, bool named) {
  const Layout matrix{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  Layout layout;
  if (count == 3 || count == 4) layout = {3, 7, 11};
  if (count == 7) layout = {3, 7, 11, 12, 13, 14, 15};
  if (count == 8) layout = named ? Layout{3, 7, 11, 12, 13, 14, 15} : Layout{3, 7, 11, 13, 14, 15, 12};
  if (count == 12 || count == 13 || count == 16) layout = matrix;
  if (count == 16) layout.insert(layout.end(), 4, kIgnored);
  if (layout.size() < count) layout.insert(layout.begin(), kName);
  return layout;
}

bool has(const Layout& layout, int from, int count) {
  for (int k = from; k < from + count; ++k)
    if (std::count(layout.begin(), layout.end(), k) != 1) return false;
  return true;
}

bool has_rotation(const Layout& layout) { return has(layout, 0, 3) && has(layout, 4, 3) && has(layout, 8, 3); }

/// The rotation nearest to a matrix that is one but for its digits.
Eigen::Quaterniond rotation_of(const std::array<double, 16>& v, const std::string& where) {
  Eigen::Matrix3d r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r(i, j) = v[static_cast<std::size_t>(4 * i + j)];
  const double off = (r * r.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  require(off < 1e-2 && r.determinant() > 0.0, fmt::format("the matrix is no rotation: off by {:.3g}", off), where);
  return Eigen::Quaterniond(r).normalized();
}

FilePose pose_of(const Line& line, const Layout& layout, const std::string& file) {
  const std::string where = fmt::format("{}:{}", file, line.number);
  require(line.words.size() == layout.size(), fmt::format("{} columns: the line above has {}", line.words.size(), layout.size()), where);
  FilePose pose;
  std::array<double, 16> v{};
  for (std::size_t k = 0; k < layout.size(); ++k) {
    if (layout[k] == kName) pose.name = line.words[k];
    if (layout[k] < 0) continue;
    const std::optional<double> value = number_of(line.words[k]);
    require(value && std::isfinite(*value), fmt::format("{}: must be a finite number", printable(line.words[k])), where);
    v[static_cast<std::size_t>(layout[k])] = *value;
  }
  pose.position = {v[3], v[7], v[11]};
  if (has(layout, kQuaternion, 4)) {
    const Eigen::Quaterniond q(v[12], v[13], v[14], v[15]);
    require(std::abs(q.norm() - 1.0) < 1e-2, fmt::format("the quaternion has length {:.3g}: must be 1", q.norm()), where);
    pose.orientation = q.normalized();
  } else if (has_rotation(layout)) {
    pose.orientation = rotation_of(v, where);
  }
  return pose;
}

/// Four lines of four numbers, the last 0 0 0 1: one pose.
bool is_one_matrix(const std::vector<Line>& lines) {
  if (lines.size() != 4) return false;
  for (const Line& line : lines)
    if (line.words.size() != 4) return false;
  for (int k = 0; k < 4; ++k)
    if (number_of(lines[3].words[static_cast<std::size_t>(k)]) != (k == 3 ? 1.0 : 0.0)) return false;
  return true;
}

}  // namespace

std::vector<FilePose> parse_poses(std::string_view text, const std::string& where) {
  std::vector<Line> lines = lines_of(text);
  require(!lines.empty(), "no poses in it", where);
  if (is_one_matrix(lines)) {
    for (std::size_t k = 1; k < 4; ++k) lines[0].words.insert(lines[0].words.end(), lines[k].words.begin(), lines[k].words.end());
    lines.resize(1);
  }
  const Line& first = lines.front();
  const bool header = first.words.size() < 2 || !number_of(first.words[1]);
  if (header && lines.size() < 2) throw Error(ErrorCode::bad_input, "no poses in it", where);
  const bool named = !header && !number_of(first.words[0]);
  const Layout layout = header ? from_header(first) : from_count(first.words.size(), named);
  const std::string place = fmt::format("{}:{}", where, first.number);
  require(
      has(layout, 3, 1) && has(layout, 7, 1) && has(layout, 11, 1),
      fmt::format(
          "{} columns are no poses: x y z, x y z qw qx qy qz, t x y z qx qy qz qw (TUM) or a 3 x 4 matrix row by row (KITTI), or a header that names "
          "them (x,y,z,qw,qx,qy,qz)",
          first.words.size()),
      place);
  const auto turns = std::count_if(layout.begin(), layout.end(), [](int k) { return k >= 0 && k % 4 != 3 && k < kQuaternion; });
  const auto quaternion = std::count_if(layout.begin(), layout.end(), [](int k) { return k >= kQuaternion; });
  require((turns == 0 || has_rotation(layout)) && (quaternion == 0 || has(layout, kQuaternion, 4)), "the columns name a part of a rotation", place);
  std::vector<FilePose> poses;
  for (std::size_t k = header ? 1 : 0; k < lines.size(); ++k) poses.push_back(pose_of(lines[k], layout, where));
  return poses;
}

std::vector<FilePose> read_poses(const std::filesystem::path& path) { return parse_poses(read_file(path), path.string()); }

}  // namespace vantage

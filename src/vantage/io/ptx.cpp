// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "vantage/base/error.h"
#include "vantage/io/scan_formats.h"
#include "vantage/io/text.h"
#include "vantage/io/text_scanner.h"

namespace vantage {
namespace {

constexpr std::size_t kLeastLine = 6;  // Bytes of "0 0 0\n".
constexpr double kRigid = 1e-3;        // A pose's rows may differ from unit and right angles by so much.

class PtxReader {
 public:
  PtxReader(std::string_view bytes, std::string_view where) : scanner_(bytes), where_(where) {}

  [[nodiscard]] std::optional<MeasuredScan> next_scan() {
    std::optional<std::string_view> line = filled_line();
    if (!line) return std::nullopt;
    const std::int64_t columns = size(*line, "columns"), rows = size(needed_line(), "rows");
    const std::uint64_t count = checked_product(static_cast<std::uint64_t>(columns), static_cast<std::uint64_t>(rows), place());
    if (count > scanner_.remaining() / kLeastLine + 1)
      fail(fmt::format("{} x {} points exceed the file ({} bytes left)", columns, rows, scanner_.remaining()));
    MeasuredScan scan;
    scan.format = "PTX";
    const Eigen::Isometry3d pose = read_pose();
    scan.position = pose.translation();
    scan.orientation = Eigen::Quaterniond(pose.linear()).normalized();
    scan.rays = RayTable{static_cast<std::int32_t>(columns), static_cast<std::int32_t>(rows), {}};
    read_rays(scan, pose, count);
    return scan;
  }

 private:
  [[nodiscard]] std::string place() const { return fmt::format("{}:{}", where_, scanner_.line()); }
  [[noreturn]] void fail(const std::string& message) const { throw Error(ErrorCode::bad_input, message, place()); }

  std::optional<std::string_view> filled_line() {
    while (const std::optional<std::string_view> line = scanner_.next_line())
      if (line->find_first_not_of(" \t\r") != std::string_view::npos) return line;
    return std::nullopt;
  }
  std::string_view needed_line() {
    const std::optional<std::string_view> line = filled_line();
    if (!line) fail("the file ends within a scan");
    return *line;
  }
  std::int64_t size(std::string_view line, std::string_view what) const {
    const std::string_view word = take_word(line);
    const std::optional<std::int32_t> value = to_number<std::int32_t>(word);
    if (!value || *value < 0 || !take_word(line).empty())
      fail(fmt::format("{}: the number of {} must stand here, a whole number from 0", printable(word), what));
    return *value;
  }
  void read_numbers(std::string_view line, std::span<double> values) const {
    for (double& value : values) {
      const std::string_view word = take_word(line);
      const std::optional<double> number = to_number<double>(word);
      if (!number) fail(word.empty() ? fmt::format("fewer than {} numbers", values.size()) : fmt::format("{}: not a number", printable(word)));
      value = *number;
    }
  }

  /// The scanner's place and axes, which the matrix repeats, then the matrix, for row vectors: its last row is the translation.
  Eigen::Isometry3d read_pose() {
    std::array<double, 4> row{};
    for (int i = 0; i < 4; ++i) read_numbers(needed_line(), std::span(row).first(3));
    Eigen::Matrix4d matrix;
    for (int i = 0; i < 4; ++i) {
      read_numbers(needed_line(), row);
      matrix.col(i) = Eigen::Map<const Eigen::Vector4d>(row.data());
    }
    const Eigen::Matrix3d turn = matrix.topLeftCorner<3, 3>();
    const bool rigid = matrix.allFinite() && (turn * turn.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < kRigid &&
                       turn.determinant() > 0.0 && (matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() < kRigid;
    if (!rigid) fail("the matrix of the scan is no rigid motion");
    return Eigen::Isometry3d(matrix);
  }

  void read_rays(MeasuredScan& scan, const Eigen::Isometry3d& pose, std::uint64_t count) {
    if (count > static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max())) fail(fmt::format("{} rays are too many", count));
    std::vector<std::int32_t>& table = scan.rays->point;
    table.reserve(count);
    Vec<3> p;
    while (table.size() < count) {
      read_numbers(needed_line(), std::span(p.data(), 3));
      const Vec<3> q = pose * p;
      const bool finite = q.allFinite(), back = !p.isZero(0.0);
      scan.not_finite += !finite;
      table.push_back(!finite ? RayTable::kNoData : back ? static_cast<std::int32_t>(scan.points.size()) : RayTable::kNoReturn);
      if (finite && back) scan.points.push_back(q);
    }
  }

  TextScanner scanner_;
  std::string_view where_;
};

bool has_numbers(std::string_view line, int count) {
  for (int i = 0; i < count; ++i)
    if (!to_number<double>(take_word(line))) return false;
  return take_word(line).empty();
}

}  // namespace

bool looks_like_ptx(std::string_view bytes) {
  TextScanner scanner(bytes.substr(0, 4096));
  for (const int count : {1, 1, 3, 3, 3, 3, 4}) {
    const std::optional<std::string_view> line = scanner.next_line();
    if (!line || !has_numbers(*line, count)) return false;
  }
  return true;
}

std::vector<MeasuredScan> parse_ptx(std::string_view bytes, std::string_view where) {
  PtxReader reader(bytes, where);
  std::vector<MeasuredScan> scans;
  while (std::optional<MeasuredScan> scan = reader.next_scan()) scans.push_back(std::move(*scan));
  require(!scans.empty(), "no scan", where);
  return scans;
}

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
// PLY and PCD: a text header, then the coordinates of one point after the other.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "vantage/base/error.h"
#include "vantage/io/bytes.h"
#include "vantage/io/scan_writers.h"

namespace vantage {
namespace {

using Number = ScanWriteOptions::Number;

/// Coordinates as both formats hold them.
struct Coordinates {
  std::string bytes;
  bool wide = false;      ///< Doubles, else floats.
  double rounding = 0.0;  ///< Largest error of a float.
};

double float_error(std::span<const MeasuredScan> scans) {
  double largest = 0.0;
  for (const MeasuredScan& scan : scans)
    for (const Vec<3>& p : scan.points)
      for (const double c : p) largest = std::max(largest, std::abs(static_cast<double>(static_cast<float>(c)) - c));
  return largest;
}

template <class Real>
std::string binary(std::span<const MeasuredScan> scans, int dim) {
  std::string out;
  out.reserve(point_count(scans) * static_cast<std::size_t>(dim) * sizeof(Real));
  for (const MeasuredScan& scan : scans)
    for (const Vec<3>& p : scan.points)
      for (int a = 0; a < dim; ++a) put(out, static_cast<Real>(p[a]));
  return out;
}

template <class Real>
std::string text(std::span<const MeasuredScan> scans, int dim) {
  std::string out;
  for (const MeasuredScan& scan : scans)
    for (const Vec<3>& p : scan.points)
      for (int a = 0; a < dim; ++a) fmt::format_to(std::back_inserter(out), "{}{}", static_cast<Real>(p[a]), a + 1 < dim ? ' ' : '\n');
  return out;
}

Coordinates coordinates(std::span<const MeasuredScan> scans, int dim, const ScanWriteOptions& options) {
  Coordinates out;
  const double error = options.number == Number::float64 ? 0.0 : float_error(scans);
  out.wide = options.number == Number::float64 || (options.number == Number::exact && error > 0.0);
  if (!out.wide) {
    require(std::isfinite(error), "coordinates too large for floats");
    out.rounding = error;
    out.bytes = options.ascii ? text<float>(scans, dim) : binary<float>(scans, dim);
  } else {
    out.bytes = options.ascii ? text<double>(scans, dim) : binary<double>(scans, dim);
  }
  return out;
}

WrittenScans written_with(const Coordinates& coordinates, const std::string& header) {
  WrittenScans written{.bytes = header + coordinates.bytes, .precision = coordinates.wide ? "doubles" : "floats", .left_out = {}};
  if (coordinates.rounding > 0.0) written.left_out.push_back(fmt::format("digits beyond a float (up to {:.2g})", coordinates.rounding));
  return written;
}

/// Place, then the quaternion w x y z.
std::string viewpoint(const MeasuredScan& scan) {
  if (!scan.position) return "0 0 0 1 0 0 0";
  const Eigen::Quaterniond& q = scan.orientation;
  return fmt::format("{} {} {} {} {} {} {}", (*scan.position)[0], (*scan.position)[1], (*scan.position)[2], q.w(), q.x(), q.y(), q.z());
}

}  // namespace

WrittenScans scans_as_ply(std::span<const MeasuredScan> scans, const ScanWriteOptions& options) {
  const Coordinates all = coordinates(scans, 3, options);
  return written_with(
      all, fmt::format("ply\nformat {0} 1.0\ncomment dim {1}\nelement vertex {2}\nproperty {3} x\nproperty {3} y\nproperty {3} z\nend_header\n",
                       options.ascii ? "ascii" : "binary_little_endian", common_dim(scans), point_count(scans), all.wide ? "double" : "float"));
}

WrittenScans scans_as_pcd(std::span<const MeasuredScan> scans, const ScanWriteOptions& options) {
  const int dim = common_dim(scans);
  const bool plane = dim < 3;
  const Coordinates all = coordinates(scans, dim, options);
  const bool posed = scans.size() == 1 && scans.front().position.has_value();
  const std::string view = posed ? viewpoint(scans.front()) : viewpoint({});
  std::string header =
      fmt::format("# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS {}\nSIZE {}\nTYPE {}\nCOUNT {}\n", plane ? "x y" : "x y z",
                  all.wide ? (plane ? "8 8" : "8 8 8") : (plane ? "4 4" : "4 4 4"), plane ? "F F" : "F F F", plane ? "1 1" : "1 1 1");
  header += fmt::format("WIDTH {0}\nHEIGHT 1\nVIEWPOINT {1}\nPOINTS {0}\nDATA {2}\n", point_count(scans), view, options.ascii ? "ascii" : "binary");
  WrittenScans written = written_with(all, header);
  if (posed && view == viewpoint({})) written.left_out.emplace_back("the pose (one at the origin reads as none in PCD)");
  return written;
}

}  // namespace vantage

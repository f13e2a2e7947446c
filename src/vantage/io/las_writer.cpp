// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "vantage/base/error.h"
#include "vantage/base/version.h"
#include "vantage/geometry/box.h"
#include "vantage/io/bytes.h"
#include "vantage/io/scan_writers.h"

namespace vantage {
namespace {

constexpr int kFinest = -4;                                                        // Power of ten of what is chosen at most.
constexpr double kLargest = std::numeric_limits<std::int32_t>::max() - 1;          // Of a coordinate's whole number.
constexpr std::uint64_t kLegacyCount = std::numeric_limits<std::uint32_t>::max();  // Points that LAS 1.2 can count.
constexpr std::size_t kDescription = 32, kName = 32, kUser = 16;                   // Bytes of texts.
constexpr std::uint16_t kWktBit = 1 << 4;

/// A coordinate is offset + scale * (whole number).
struct Steps {
  double scale = 0.0;
  Vec<3> offset = Vec<3>::Zero();
  [[nodiscard]] std::int32_t whole(const Vec<3>& p, int axis) const {
    return static_cast<std::int32_t>(std::round((p[axis] - offset[axis]) / scale));
  }
};

/// Offsets are whole numbers where they may be, so that decimal coordinates stay decimal.
std::optional<Steps> steps_for(const Box<3>& box, double scale) {
  Steps steps{scale};
  if (box.empty()) return steps;
  for (int a = 0; a < 3; ++a) {
    const double unit = scale < 1.0 && 0.5 * box.size()[a] + 1.0 < scale * kLargest ? 1.0 : scale;
    steps.offset[a] = std::round(box.center()[a] / unit) * unit;
    const double reach = std::max(box.high[a] - steps.offset[a], steps.offset[a] - box.low[a]);
    if (!(std::round(reach / scale) <= kLargest)) return std::nullopt;
  }
  return steps;
}

/// The steps asked, or the finest power of ten that fits.
Steps choose_steps(const Box<3>& box, double resolution) {
  if (resolution > 0.0) {
    const std::optional<Steps> steps = steps_for(box, resolution);
    if (steps) return *steps;
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: LAS holds 4294967294 steps an axis, an extent of {:g} needs {:.2g} or more", resolution, box.size().maxCoeff(),
                            box.size().maxCoeff() / (2.0 * kLargest)),
                "--resolution");
  }
  for (int power = kFinest; power < 300; ++power)
    if (const std::optional<Steps> steps = steps_for(box, power < 0 ? 1.0 / std::pow(10.0, -power) : std::pow(10.0, power))) return *steps;
  throw Error(ErrorCode::bad_input, "coordinates too large for LAS");
}

struct Layout {
  int minor = 2;
  int format = 0;
  std::uint64_t points = 0;
  std::string records_before;  ///< Variable length records.
  [[nodiscard]] std::size_t header() const { return minor >= 4 ? 375 : 227; }
  [[nodiscard]] std::size_t record() const { return format == 0 ? 20 : 30; }
};

void put_text(std::string& out, std::string text, std::size_t size) {
  text.resize(size, '\0');
  out += text;
}

/// GeoTIFF's key directory: a projected system with this code.
std::string geo_keys(int epsg) {
  const std::uint16_t keys[] = {1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, static_cast<std::uint16_t>(epsg)};
  std::string out;
  put<std::uint16_t>(out, 0);
  put_text(out, "LASF_Projection", kUser);
  put<std::uint16_t>(out, 34735);
  put<std::uint16_t>(out, sizeof(keys));
  put_text(out, "GeoKeyDirectoryTag", kDescription);
  for (const std::uint16_t key : keys) put(out, key);
  return out;
}

Layout choose_layout(std::uint64_t points, const ScanWriteOptions& options) {
  Layout layout;
  layout.points = points;
  layout.minor = options.las_minor != 0 ? options.las_minor : points > kLegacyCount ? 4 : 2;
  require(layout.minor == 2 || layout.minor == 4, fmt::format("LAS 1.{}: must be 1.2 or 1.4", layout.minor));
  require(layout.minor == 4 || points <= kLegacyCount, fmt::format("{} points: LAS 1.2 counts up to {}", points, kLegacyCount));
  // Formats from 6 on want the coordinate system as a text that would need a register of them all.
  layout.format = layout.minor == 4 && !options.epsg ? 6 : 0;
  if (options.epsg) layout.records_before = geo_keys(*options.epsg);
  return layout;
}

/// Bounds of what the file says, not of what it was made from.
using WholeBounds = std::array<std::pair<std::int32_t, std::int32_t>, 3>;

std::string header_of(const Layout& layout, const Steps& steps, const WholeBounds& bounds) {
  const std::uint32_t legacy = layout.format == 0 && layout.points <= kLegacyCount ? static_cast<std::uint32_t>(layout.points) : 0;
  std::string out = "LASF";
  put<std::uint16_t>(out, 0);
  put<std::uint16_t>(out, layout.format == 6 ? kWktBit : 0);
  out.append(16, '\0');
  put<std::uint8_t>(out, 1);
  put(out, static_cast<std::uint8_t>(layout.minor));
  put_text(out, "OTHER", kName);
  put_text(out, fmt::format("vantage {}", kVersion), kName);
  put<std::uint32_t>(out, 0);  // Day and year: none, so that equal scans give equal files.
  put(out, static_cast<std::uint16_t>(layout.header()));
  put(out, static_cast<std::uint32_t>(layout.header() + layout.records_before.size()));
  put<std::uint32_t>(out, layout.records_before.empty() ? 0 : 1);
  put(out, static_cast<std::uint8_t>(layout.format));
  put(out, static_cast<std::uint16_t>(layout.record()));
  put(out, legacy);
  put(out, legacy);  // All are first returns.
  out.append(16, '\0');
  for (int a = 0; a < 3; ++a) put(out, steps.scale);
  for (int a = 0; a < 3; ++a) put(out, steps.offset[a]);
  for (std::size_t a = 0; a < 3; ++a) {
    const double offset = steps.offset[static_cast<Eigen::Index>(a)];
    put(out, layout.points == 0 ? 0.0 : bounds[a].second * steps.scale + offset);
    put(out, layout.points == 0 ? 0.0 : bounds[a].first * steps.scale + offset);
  }
  if (layout.minor < 4) return out;
  out.append(20, '\0');  // No waveforms, no records behind the points.
  put(out, layout.points);
  put(out, layout.points);
  out.append(14 * sizeof(std::uint64_t), '\0');
  return out;
}

/// What follows the coordinates: first of one return, never classified, of scan `source`.
std::string tail_of(const Layout& layout, std::uint16_t source) {
  const bool wide = layout.format == 6;
  std::string out;
  put<std::uint16_t>(out, 0);
  put<std::uint8_t>(out, wide ? 0x11 : 0x09);
  out.append(wide ? 5 : 3, '\0');
  put(out, source);
  if (wide) put<double>(out, 0.0);
  return out;
}

}  // namespace

WrittenScans scans_as_las(std::span<const MeasuredScan> scans, const ScanWriteOptions& options) {
  Box<3> box;
  for (const MeasuredScan& scan : scans)
    for (const Vec<3>& p : scan.points) box.extend(p);
  const Steps steps = choose_steps(box, options.resolution);
  const Layout layout = choose_layout(point_count(scans), options);
  WholeBounds bounds;
  bounds.fill({std::numeric_limits<std::int32_t>::max(), std::numeric_limits<std::int32_t>::min()});
  std::string points;
  points.reserve(layout.points * layout.record());
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const std::string tail = tail_of(layout, k < std::numeric_limits<std::uint16_t>::max() ? static_cast<std::uint16_t>(k + 1) : std::uint16_t{0});
    for (const Vec<3>& p : scans[k].points) {
      for (int a = 0; a < 3; ++a) {
        const std::int32_t whole = steps.whole(p, a);
        auto& [low, high] = bounds[static_cast<std::size_t>(a)];
        low = std::min(low, whole);
        high = std::max(high, whole);
        put(points, whole);
      }
      points += tail;
    }
  }
  WrittenScans written{.bytes = header_of(layout, steps, bounds) + layout.records_before + points,
                       .precision = fmt::format("multiples of {}", steps.scale),
                       .left_out = {}};
  if (common_dim(scans) == 2) written.left_out.emplace_back("that it is a plane (z is 0)");
  return written;
}

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "vantage/io/records.h"
#include "vantage/io/scan_formats.h"

namespace vantage {
namespace {

constexpr double kFarthest = 1e7;              // Of a coordinate that a sensor gives as a float [m].
constexpr double kLargestReflectance = 65535;  // Sets store 0 to 1, to 255 or to 65535.

/// Whether `column` of records of `floats` floats holds numbers from `low` to `high`, but for one in a hundred.
bool within(const FileBytes& file, std::size_t floats, std::size_t column, double low, double high) {
  const std::size_t step = 4 * floats, count = file.size() / step;
  std::size_t outside = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto value = static_cast<double>(get<float>(file.all(), i * step + 4 * column));
    if (!(value >= low && value <= high) && !std::isnan(value)) ++outside;
  }
  return outside <= count / 100;
}

bool fits(const FileBytes& file, std::size_t floats) {
  if (file.size() % (4 * floats) != 0) return false;
  for (std::size_t a = 0; a < 3; ++a)
    if (!within(file, floats, a, -kFarthest, kFarthest)) return false;
  return floats == 3 || within(file, floats, 3, 0.0, kLargestReflectance);
}

}  // namespace

std::vector<MeasuredScan> parse_kitti(FileBytes file) {
  // Four first: read by threes, a reflectance would become a coordinate and pass; read by fours, coordinates below zero do not pass as reflectances.
  const std::size_t floats = fits(file, 4) ? 4 : fits(file, 3) ? 3 : 0;
  if (floats == 0) file.fail(0, "not records of 3 or 4 floats (x y z, x y z reflectance), which a name ending in .bin stands for");
  MeasuredScan scan;
  scan.name = file.where();
  scan.format = floats == 4 ? "KITTI, x y z reflectance" : "KITTI, x y z";
  const std::size_t step = 4 * floats;
  const PointColumns columns{{NumberColumn{0, step}, NumberColumn{4, step}, NumberColumn{8, step}}};
  scan.points = widen_points(file.all(), file.size() / step, columns, file.where());
  return {std::move(scan)};
}

}  // namespace vantage

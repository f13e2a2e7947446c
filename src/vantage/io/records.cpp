// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/records.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "vantage/base/error.h"
#include "vantage/io/bytes.h"

namespace vantage {
namespace {

constexpr std::size_t kBlock = 1024;  // Points whose axes are filled one after the other while they are in the cache.

/// Calls `work` with a zero of the type.
template <class Work>
void with_type(NumberType type, Work&& work) {
  switch (type) {
    case NumberType::int8: return work(std::int8_t{});
    case NumberType::uint8: return work(std::uint8_t{});
    case NumberType::int16: return work(std::int16_t{});
    case NumberType::uint16: return work(std::uint16_t{});
    case NumberType::int32: return work(std::int32_t{});
    case NumberType::uint32: return work(std::uint32_t{});
    case NumberType::int64: return work(std::int64_t{});
    case NumberType::uint64: return work(std::uint64_t{});
    case NumberType::float32: return work(float{});
    case NumberType::float64: return work(double{});
  }
}

void check_room(std::string_view bytes, std::uint64_t count, const NumberColumn& column, std::string_view where) {
  if (count == 0) return;
  const std::size_t size = size_of(column.type);
  const bool fits = column.offset <= bytes.size() && bytes.size() - column.offset >= size &&
                    (column.stride == 0 || count - 1 <= (bytes.size() - column.offset - size) / column.stride);
  require(fits, fmt::format("{} points exceed the file ({} bytes left)", count, bytes.size()), where);
}

/// Three columns of one type and stride, in one pass.
template <class Number>
void fill_points(std::string_view bytes, const PointColumns& columns, std::endian order, std::vector<Vec<3>>& points, std::size_t count) {
  const NumberColumn x = *columns[0], y = *columns[1], z = *columns[2];
  const auto at = [&](std::size_t i, const NumberColumn& column) {
    return static_cast<double>(get<Number>(bytes, i * x.stride + column.offset, order)) * column.scale + column.shift;
  };
  for (std::size_t i = 0; i < count; ++i) points.emplace_back(at(i, x), at(i, y), at(i, z));
}

/// Points [first, second) of one axis.
template <class Coordinate>
void fill_axis(std::string_view bytes, const NumberColumn& column, std::endian order, std::pair<std::size_t, std::size_t> range,
               Coordinate&& coordinate) {
  with_type(column.type, [&]<class Number>(Number) {
    for (std::size_t i = range.first; i < range.second; ++i)
      coordinate(i) = static_cast<double>(get<Number>(bytes, column.offset + i * column.stride, order)) * column.scale + column.shift;
  });
}

bool alike(const PointColumns& columns) {
  for (const auto& column : columns)
    if (!column || column->type != columns[0]->type || column->stride != columns[0]->stride) return false;
  return true;
}

}  // namespace

std::size_t size_of(NumberType type) {
  constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kSizes[static_cast<int>(type)];
}

std::vector<Vec<3>> widen_points(std::string_view bytes, std::uint64_t count, const PointColumns& columns, std::string_view where,
                                 std::endian order) {
  require(columns[0].has_value() && columns[0]->stride > 0, "points without an x column", where);
  for (const auto& column : columns)
    if (column) check_room(bytes, count, *column, where);
  std::vector<Vec<3>> points;
  points.reserve(count);
  if (alike(columns)) {
    with_type(columns[0]->type, [&]<class Number>(Number) { fill_points<Number>(bytes, columns, order, points, count); });
    return points;
  }
  for (std::size_t begin = 0; begin < count; begin += kBlock) {
    const std::size_t end = std::min<std::size_t>(count, begin + kBlock);
    points.resize(end, Vec<3>::Zero());
    for (std::size_t a = 0; a < 3; ++a)
      if (columns[a])
        fill_axis(bytes, *columns[a], order, {begin, end}, [&](std::size_t i) -> double& { return points[i][static_cast<Eigen::Index>(a)]; });
  }
  return points;
}

}  // namespace vantage

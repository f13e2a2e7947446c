// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "vantage/geometry/vec.h"

namespace vantage {

enum class NumberType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

[[nodiscard]] std::size_t size_of(NumberType type);

/// The numbers of one axis: the first at `offset`, the next `stride` bytes on; a coordinate is number * scale + shift.
struct NumberColumn {
  std::size_t offset = 0, stride = 0;
  NumberType type = NumberType::float32;
  double scale = 1.0, shift = 0.0;
};

/// x, y and z of points; an axis without a column is zero.
using PointColumns = std::array<std::optional<NumberColumn>, 3>;

/// `count` points from binary columns, widened to doubles. Throws bad_input naming `where` if the bytes do not hold them all.
[[nodiscard]] std::vector<Vec<3>> widen_points(std::string_view bytes, std::uint64_t count, const PointColumns& columns, std::string_view where,
                                               std::endian order = std::endian::little);

}  // namespace vantage

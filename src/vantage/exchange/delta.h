// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "vantage/exchange/leaf_code.h"
#include "vantage/exchange/sha256.h"
#include "vantage/geometry/box.h"

namespace vantage {

/// What one scan adds to the map of the vehicle that made it. Its bytes say everything, and their SHA-256 is its name: two vehicles that name the
/// same delta hold the same bytes.
struct Delta {
  int dim = 3;
  std::string source;            ///< Who made the scan: 1 to 64 printable characters.
  std::uint32_t number = 0;      ///< Of the scan, counted by its source from 0.
  double tolerance = 0.0;        ///< No certified error is larger [m].
  double spacing = 0.0;          ///< Of the lattice (ExchangeLattice) [m].
  double data_to_surface = 0.0;  ///< Certified: every point of the scan is so near to a patch of this delta or one of lower number of its source [m].
  double surface_to_data = 0.0;  ///< Certified: every place of this delta's patches is so near to a point of the scan [m].
  std::uint64_t points = 0;      ///< Finite points of the scan, each once.
  std::uint64_t new_points = 0;  ///< Those that the earlier deltas did not explain.
  Box<3> bounds;                 ///< Of the points; z is 0 in the plane; empty without points [m].
  LeafCounts counts;
  std::string code;  ///< encode_leaves().
};

/// Throws bad_input for a field out of its range.
[[nodiscard]] std::string delta_bytes(const Delta& delta);
/// Reads what `delta_bytes` wrote; nothing else is accepted, so equal deltas have equal bytes. Throws bad_input, naming `where` and the offset from
/// `start` on.
[[nodiscard]] Delta parse_delta(std::string_view bytes, std::string_view where, std::size_t start = 0);

/// The leaves it holds; `Dim` is its dimension. Throws bad_input for a code that is none.
template <int Dim>
[[nodiscard]] Leaves<Dim> decoded(const Delta& delta, std::string_view where);

}  // namespace vantage

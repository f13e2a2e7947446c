// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "vantage/field/grid.h"

namespace vantage {

/// One value a node, axis 0 fastest.
struct ImageArray {
  std::string name;  ///< "psi"
  std::variant<std::span<const std::uint8_t>, std::span<const float>> values;
};

/// VTK ImageData (`.vti`, for ParaView): version 1.0, appended raw data, zlib blocks, 64-bit headers. A plane becomes one layer at z = 0.
/// Every array holds window.size() values.
template <int Dim>
[[nodiscard]] std::string image_as_vti(const Grid<Dim>& window, std::span<const ImageArray> arrays);

/// What the head of a .vti says.
struct ImageInfo {
  std::vector<std::int64_t> nodes;      ///< Along x, y, z.
  std::vector<double> origin, spacing;  ///< [m]
  struct Array {
    std::string name, type;
  };
  std::vector<Array> arrays;
};

/// Throws bad_input naming `where`.
[[nodiscard]] ImageInfo parse_vti_header(std::string_view bytes, std::string_view where);

/// One value a node, axis 0 fastest.
struct LatticeArray {
  std::string name;
  std::variant<std::vector<std::uint8_t>, std::vector<float>> values;
};
/// A .vti with its values.
struct LatticeImage {
  Grid<3> window;  ///< A plane is one layer.
  std::vector<LatticeArray> arrays;
};

/// Reads what `image_as_vti` wrote. Every size is checked against the bytes there before memory is taken. Throws bad_input naming `where`, also for
/// other encodings and types of VTK and for nodes that are not multiples of one spacing.
[[nodiscard]] LatticeImage parse_vti(std::string_view bytes, std::string_view where);

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "vantage/io/vti.h"

namespace vantage {

/// NumPy's format 1.0 (`.npy`), little-endian uint8 or float32, in Fortran order: `a = numpy.load(FILE)` has the shape of `nodes`, and a[i, j, k] is
/// the node at origin + spacing * (i, j, k). Throws bad_input unless the array has one value a node.
[[nodiscard]] std::string array_as_npy(const LatticeArray& array, std::span<const std::int64_t> nodes);

/// The type and shape that the header of a .npy names, "'<f4', (3, 4, 5)"; throws bad_input naming `where` if it is none.
[[nodiscard]] std::string describe_npy(std::string_view bytes, std::string_view where);

}  // namespace vantage

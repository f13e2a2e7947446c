// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "vantage/io/vti.h"

namespace vantage {

/// Whether this build has OpenVDB.
[[nodiscard]] bool has_openvdb();

/// OpenVDB's format (`.vdb`, zip), for Blender, Houdini and OpenVDB's tools: one grid named as the array, Float, or Int32 of whole numbers. Index (i,
/// j, k) is the node's own, at spacing * (i, j, k); what is 0 is background and takes no room. Throws bad_input without OpenVDB. Same bytes every
/// time.
[[nodiscard]] std::string array_as_vdb(const LatticeArray& array, const Grid<3>& window);

/// The array again: of a file with one such grid, on its window of active nodes. For tests.
[[nodiscard]] LatticeImage parse_vdb(const std::string& bytes);

}  // namespace vantage

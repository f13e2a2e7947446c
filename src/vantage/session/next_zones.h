// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "vantage/geometry/zone.h"
#include "vantage/session/measured.h"

namespace vantage {

/// Zones as a person names them, one after the other with `;` between them: a box `x0,y0,z0,x1,y1,z1` [m] (of a plane: four numbers), a polygon
/// `x,y x,y x,y`, holes behind a `/`, or a file of polygons (zone_file.h). Behind a polygon or a file, `z=LOW..HIGH` bounds its heights.

/// The same text without files: their polygons and those of the text, which count in the coordinates of the scan files (the two axes that are level
/// there, in their order), are put in metres, z up. Boxes stay. Throws bad_input at `where` or in the file, io.
[[nodiscard]] std::string settled_zones(const std::string& text, const MeasuredOptions& options, const std::string& where);

/// The zones of a text that is settled. Throws bad_input at `where`.
template <int Dim>
[[nodiscard]] std::vector<Zone> zones_of(const std::string& text, const std::string& where);

}  // namespace vantage

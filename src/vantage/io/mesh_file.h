// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "vantage/geometry/mesh.h"

namespace vantage {

/// How a mesh file is read.
struct MeshFileOptions {
  enum class Up { file, y, z } up = Up::file;  ///< Up axis; `file`: what DAE says, y for glTF (its standard), else z.
  double unit = 0.0;                           ///< Metres per file unit; 0: what DAE says, else 1.
  double detail = -1.0;                        ///< Of a city model: highest level of detail that is shown; < 0: the highest of each object.
};

/// Triangles of an OBJ, PLY, STL, OFF, DAE, glTF, GLB, CityJSON or CityGML file, in metres, z up (y up turns into z up, x stays). Node transforms are
/// applied, polygons cut into triangles (corners - 2 each, in the order of the file), equal vertices joined, unused ones left out. Numbers stay
/// double where the format has them. Throws io when a file cannot be read; bad_input, naming the file, when it is not such a file, is cut short, has
/// a vertex that is not finite, an index out of range or no triangles.
[[nodiscard]] Mesh<3> read_mesh(const std::filesystem::path& path, const MeshFileOptions& options = {});
/// The same of bytes; the name's ending says what they are. Of a glTF file also what lies beside `path` is read.
[[nodiscard]] Mesh<3> parse_mesh(std::string_view bytes, const std::filesystem::path& path, const MeshFileOptions& options = {});

/// Whether the file's name ends like a mesh that `read_mesh` knows.
[[nodiscard]] bool is_mesh_file(const std::filesystem::path& path);
/// `.obj, .ply, ...`, for messages.
[[nodiscard]] std::string mesh_extensions();

/// Writes PLY (binary, double), OBJ or STL (binary, float; 3D only), by the name's ending, aside and then renamed. A 2D mesh becomes edges at
/// z = 0. Throws bad_input for another ending, io.
template <int Dim>
void write_mesh(const std::filesystem::path& path, const Mesh<Dim>& mesh);

}  // namespace vantage

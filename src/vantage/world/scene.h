// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "vantage/geometry/mesh.h"

namespace vantage {

/// A ground-truth world and how it wants to be explored. Nothing of the explorer may see it but through a sensor.
template <int Dim>
  requires SpatialDim<Dim>
struct Scene {
  std::string name;
  Mesh<Dim> mesh;
  Box<Dim> domain;                    ///< To be explored [m].
  Vec<Dim> start = Vec<Dim>::Zero();  ///< First vantage point [m].
  double voxel = 0.5;                 ///< Lattice spacing that suits it [m]; doors are at least three of them wide.
  double eta = 0.1;                   ///< Hausdorff tolerance that suits it [m].
  double range = 80.0;                ///< Sensor range that suits it [m].
  double clearance = 0.5;             ///< To obstacles [m].
  struct Part {
    std::string name;                    ///< "ground", "house", "wire", "pole", ...
    std::uint32_t first = 0, count = 0;  ///< Facets.
  };
  std::vector<Part> parts;  ///< Consecutive facets by kind; may be empty for a file.
};

using AnyScene = std::variant<Scene<2>, Scene<3>>;

/// One line of `vantage scene --list`.
struct SceneInfo {
  std::string name;
  int dim = 3;
  std::string description;  ///< One sentence with its size.
  struct Parameter {
    std::string name;
    double value, low, high;
    std::string doc;  ///< With unit.
  };
  std::vector<Parameter> parameters;  ///< `seed` always among them.
};
[[nodiscard]] const std::vector<SceneInfo>& scene_list();

/// How a mesh file is read.
struct SceneFileOptions {
  enum class Up { file, y, z } up = Up::file;  ///< Up axis; `file`: what DAE says, y for glTF, else z.
  double unit = 0.0;                           ///< Metres per file unit, of a map per pixel; 0: what the file says, else 1 (map 0.05).
  double detail = -1.0;                        ///< Highest level of detail of a city model; < 0: the highest of each object.
  double ground = -kInfinity;                  ///< Height of level ground under the mesh files that is added to them [m]; -infinity: none.
};

/// A built-in scene `NAME[:key=value,...]`, a mesh file (OBJ, PLY, STL, DAE, glTF, GLB, CityJSON, CityGML), or a 2D occupancy map (`.yaml` of ROS, or
/// the image). Throws bad_input with what is allowed; io when the file cannot be read.
[[nodiscard]] AnyScene make_scene(std::string_view spec, const SceneFileOptions& options = {});

}  // namespace vantage

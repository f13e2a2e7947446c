// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "vantage/base/progress.h"
#include "vantage/surface/surface.h"
#include "vantage/world/lidar.h"

namespace vantage {

/// A row of the paper's Table I ("explicit surface reconstruction statistics"), as printed or made again. The paper gives lengths in units of the
/// cube that holds the scene; of its cubes' sides it says nothing.
struct Table1Row {
  std::string domain;       ///< "patio", "church"
  std::string rules;        ///< "paper" as printed, "surface.paper = true" or "surface.paper = false".
  std::int64_t scans = 0;   ///< Vantage points.
  std::int64_t points = 0;  ///< In the cube.
  double side = 0.0;        ///< Of the cube [m]; 0: not known.
  double eta = 0.0;         ///< [side]
  std::int64_t depth = 0;   ///< The root has 0.
  std::int64_t nodes = 0, leaves = 0, fits = 0;
  std::int64_t segments = 0, loose_points = 0;  ///< Not in the paper.
  double hausdorff = 0.0;                       ///< Global, by an exhaustive look at points and patches [side].
  double certified = 0.0;                       ///< What the tree says of itself [side]; 0: not known.
};

/// The table, and the surfaces of its rows with `surface.paper = false` for a picture.
struct Table1 {
  std::vector<Table1Row> rows;  ///< By domain: as printed, made again by the paper's rules, and by ours.
  struct Surface {
    std::string domain;
    Box<3> box;  ///< What the scene calls its domain [m].
    std::vector<Patch<3>> patches;
  };
  std::vector<Surface> surfaces;
};

/// Scans the scenes `patio` and `church` at 16 and 11 fixed stations, those of an exploration, and reconstructs them with the paper's eta: the patio
/// within its 20 m, the church from all that was scanned (Sec. VI). `observer` hears of every scan and may stop it (throws interrupted). The paper's
/// sensor is the default. Same bits for any number of threads; about 25 s of one.
[[nodiscard]] Table1 make_table1(const LidarOptions& sensor = {}, Observer* observer = nullptr);

/// As a Markdown table, lengths in both units.
[[nodiscard]] std::string table1_as_markdown(const std::vector<Table1Row>& rows);

}  // namespace vantage

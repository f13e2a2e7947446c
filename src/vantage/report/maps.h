// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/explore/record.h"
#include "vantage/report/camera.h"
#include "vantage/report/figure.h"

namespace vantage {

/// Colours of the three states on a map.
struct StateColours {
  Rgb seen, obstacle, unseen, hatch;
};
inline constexpr StateColours kLightStates{{249, 250, 252}, {43, 52, 66}, {205, 212, 227}, {177, 188, 212}};
inline constexpr StateColours kDarkStates{{38, 43, 56}, {150, 164, 189}, {13, 17, 26}, {27, 34, 50}};

/// Frames of the maps that stand alone and of the panels of several, in a report whose pictures are so wide [pixels].
[[nodiscard]] constexpr Frame map_frame(int width) { return {width, width * 11 / 14, 36.0}; }
[[nodiscard]] constexpr Frame panel_frame(int width) { return {width * 16 / 35, width * 16 / 35, 0.0}; }

/// A flat lattice as a box of cells around its nodes; z = 0.
[[nodiscard]] Box<3> map_box(const Grid<2>& window);
/// States on a map, the unseen hatched; transparent beyond the lattice.
[[nodiscard]] Image state_map(const Field<2, NodeState>& state, const Camera& camera, const StateColours& colours);
/// E where it was evaluated and `state` is seen, brighter for larger; interpolated, and single nodes as small squares.
[[nodiscard]] Image metric_map(const Field<2, float>& metric, const Field<2, NodeState>& state, const Camera& camera);

/// Up to nine of the snapshots, evenly spread, the first and the last among them.
template <int Dim>
[[nodiscard]] std::vector<const Snapshot<Dim>*> chosen(const std::vector<Snapshot<Dim>>& snapshots);
/// Fig. 2 of the paper, lower row: E on cuts through the place, with the vantage points so far and the next.
template <int Dim>
[[nodiscard]] Figure metric_figure(const std::vector<Snapshot<Dim>>& snapshots, const Frame& frame);
/// `12.3, 5.0, 2.0`.
template <int Dim>
[[nodiscard]] std::string place_text(const Vec<Dim>& p);

}  // namespace vantage

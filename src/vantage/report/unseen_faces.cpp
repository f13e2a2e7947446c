// SPDX-License-Identifier: Apache-2.0
#include "vantage/report/unseen_faces.h"

#include <array>

#include "vantage/base/parallel.h"

namespace vantage {

namespace {

constexpr std::array<double, 3> kAxisLight{0.78, 0.9, 1.08};

/// The square between node `i` and its neighbour along `axis`.
void draw_face(Raster& raster, const Grid<3>& window, const Index<3>& i, int axis) {
  const double half = 0.5 * window.spacing;
  Vec<3> centre = window.position(i), across = Vec<3>::Zero(), along = Vec<3>::Zero();
  centre[axis] += half;
  across[(axis + 1) % 3] = half;
  along[(axis + 2) % 3] = half;
  const std::array<Vec<3>, 4> corners{centre - across - along, centre + across - along, centre + across + along, centre - across + along};
  raster.polygon(corners, scaled(kUnseenColour, kAxisLight[static_cast<std::size_t>(axis)]));
}

bool is_border(NodeState a, NodeState b) {
  return (a == NodeState::unseen && b == NodeState::seen) || (a == NodeState::seen && b == NodeState::unseen);
}

}  // namespace

void draw_unseen(Raster& raster, const Field<3, NodeState>& state, bool lids) {
  const Grid<3>& window = state.window;
  parallel_for(static_cast<std::size_t>(window.extent.y()) * static_cast<std::size_t>(window.extent.z()), 64, [&](std::size_t row) {
    Index<3> i(0, static_cast<int>(row) % window.extent.y(), static_cast<int>(row) / window.extent.y());
    std::size_t node = window.linear(i);
    for (; i.x() < window.extent.x(); ++i.x(), ++node) {
      for (int axis = 0; axis < 3; ++axis) {
        if (i[axis] + 1 >= window.extent[axis] || !is_border(state[node], state[node + window.stride(axis)])) continue;
        if (lids || axis < 2 || state[node] == NodeState::unseen) draw_face(raster, window, i, axis);
      }
    }
  });
}

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/last_look.h"

#include <algorithm>

#include "vantage/base/parallel.h"

namespace vantage {
namespace {

constexpr std::size_t kMostFaces = 400, kMostPlaces = 1500;
constexpr double kLeastCosine = 0.1;  // Less teaches nothing.

/// An even choice of at most `limit`, in their order.
std::vector<std::size_t> some_of(const std::vector<std::size_t>& all, std::size_t limit) {
  if (all.size() <= limit) return all;
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < limit; ++k) chosen.push_back(all[k * all.size() / limit]);
  return chosen;
}

/// Reachable nodes nobody has stood at or right beside.
template <int Dim>
std::vector<std::size_t> new_places(const Ground<Dim>& ground) {
  const Grid<Dim>& grid = ground.reachable.window;
  const double least = 0.9 * grid.spacing;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < grid.size(); ++i)
    if (ground.reachable[i] != 0) places.push_back(i);
  std::erase_if(places, [&](std::size_t i) {
    const Vec<Dim> p = grid.position(i);
    return std::any_of(ground.visited.begin(), ground.visited.end(), [&](const Vec<Dim>& v) { return (p - v).norm() < least; });
  });
  return places;
}

}  // namespace

template <int Dim>
bool in_doubt(const BoundaryFace<Dim>& face) {
  constexpr std::uint8_t kFailed = 5;  // Bin of the evidence from which on it has been looked at in vain (opening.cpp).
  return face.bin[1] < kFailed && face.frontal <= 0.3;
}

template <int Dim>
double depth_behind(const BeliefView<Dim>& view, const BoundaryFace<Dim>& face, double limit) {
  const Grid<Dim>& grid = view.window();
  const int axis = face.direction / 2, inward = face.direction % 2 == 0 ? 1 : -1;
  double depth = 0.0;
  for (Index<Dim> node = grid.local(face.unseen); grid.inside(node) && view.state.at(node) == NodeState::unseen && depth < limit;
       node[axis] += inward)
    depth += grid.spacing;
  return std::min(depth, limit);
}

template <int Dim>
Field<Dim, std::uint8_t> squeezed_nodes(const BeliefView<Dim>& view, const Field<Dim, std::uint8_t>& reachable, double clearance) {
  const Grid<Dim>& grid = view.window();
  Grid<Dim> fine{0.5 * grid.spacing, 2 * grid.first, (2 * grid.extent.array() - 1).matrix()};
  const auto passable = [&](const Index<Dim>& place) {
    const Index<Dim> low = place / 2, odd = place - 2 * low;
    const Grid<Dim> corners{1.0, low, Index<Dim>(odd.array() + 1)};
    double nearest = kInfinity;
    bool all_obstacle = true;
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const std::size_t node = grid.linear(low + corners.local(c));
      if (view.state[node] == NodeState::unseen) return false;
      all_obstacle = all_obstacle && view.state[node] == NodeState::obstacle;
      nearest = std::min(nearest, static_cast<double>(view.known_distance[node]));
    }
    // Halfway across a passage the walls on both sides are half a step farther away.
    return !all_obstacle && nearest + (odd.any() ? 0.5 * grid.spacing : 0.0) >= clearance;
  };
  Field<Dim, std::uint8_t> squeezed = reachable, tried(fine);
  std::vector<std::size_t> queue;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (reachable[i] == 0) continue;
    queue.push_back(fine.linear(2 * grid.local(i)));
    tried[queue.back()] = 1;
  }
  for (std::size_t k = 0; k < queue.size(); ++k) {
    const Index<Dim> at = fine.local(queue[k]);
    for (int a = 0; a < Dim; ++a)
      for (const int by : {-1, 1}) {
        const Index<Dim> to = at + by * Index<Dim>::Unit(a);
        if (!fine.inside(to) || tried.at(to) != 0) continue;
        tried.at(to) = 1;
        if (!passable(to)) continue;
        queue.push_back(fine.linear(to));
        const Grid<Dim> corners{1.0, to / 2, Index<Dim>((to - 2 * (to / 2)).array() + 1)};
        for (std::size_t c = 0; c < corners.size(); ++c) {
          const std::size_t node = grid.linear(corners.first + corners.local(c));
          if (view.seen(node)) squeezed[node] = 1;
        }
      }
  }
  return squeezed;
}

template <int Dim>
LastLook last_look(const BeliefView<Dim>& view, std::span<const BoundaryFace<Dim>> faces, const RayMarch<Dim>& rays, const Ground<Dim>& ground) {
  const Grid<Dim>& grid = view.window();
  const double h = grid.spacing;
  LastLook look;
  look.viewer.assign(faces.size(), kNoNode);
  std::vector<std::size_t> doubtful;
  for (std::size_t i = 0; i < faces.size(); ++i)
    if (in_doubt(faces[i])) doubtful.push_back(i);
  if (doubtful.empty()) return look;
  const std::vector<std::size_t> asked = some_of(doubtful, kMostFaces), places = some_of(new_places(ground), kMostPlaces);
  const double share = static_cast<double>(doubtful.size()) / static_cast<double>(asked.size());

  std::vector<std::vector<std::uint32_t>> seen_by(places.size());  // Numbers in `asked`.
  parallel_for(places.size(), 4, [&](std::size_t p) {
    const Vec<Dim> z = grid.position(places[p]);
    for (std::size_t k = 0; k < asked.size(); ++k) {
      const BoundaryFace<Dim>& face = faces[asked[k]];
      const Vec<Dim> offset = z - face.center;
      const double distance = offset.norm();
      if (distance > ground.max_range || distance < 0.5 * h || offset.dot(face.step()) < kLeastCosine * distance) continue;
      if (rays.line_of_sight(z, face.center, 1.5 * h)) seen_by[p].push_back(static_cast<std::uint32_t>(k));
    }
  });
  std::vector<double> behind(asked.size()), best_cosine(asked.size());
  for (std::size_t k = 0; k < asked.size(); ++k) {
    behind[k] = depth_behind(view, faces[asked[k]], ground.max_range) * share;
    for (int a = 1; a < Dim; ++a) behind[k] *= h;
  }
  for (std::size_t p = 0; p < places.size(); ++p) {
    const Vec<Dim> z = grid.position(places[p]);
    double volume = 0.0;
    for (const std::uint32_t k : seen_by[p]) {
      const BoundaryFace<Dim>& face = faces[asked[k]];
      const double cosine = (z - face.center).normalized().dot(face.step()), answer = std::min(1.0, cosine / 0.3);
      volume += behind[k] * answer * answer;
      if (cosine <= best_cosine[k]) continue;
      best_cosine[k] = cosine;
      look.viewer[asked[k]] = places[p];
    }
    if (volume <= look.volume) continue;
    look.volume = volume;
    look.place = places[p];
  }
  // A face that was not asked has the answer of the one asked before it.
  std::size_t last = kNoNode;
  for (std::size_t i = 0, k = 0; i < faces.size(); ++i) {
    if (k < asked.size() && asked[k] == i) last = look.viewer[asked[k++]];
    if (in_doubt(faces[i])) look.viewer[i] = last;
  }
  return look;
}

#define VANTAGE_INSTANTIATE(D)                                                                    \
  template bool in_doubt<D>(const BoundaryFace<D>&);                                              \
  template double depth_behind<D>(const BeliefView<D>&, const BoundaryFace<D>&, double);          \
  template Field<D, std::uint8_t> squeezed_nodes<D>(const BeliefView<D>&, const Field<D, std::uint8_t>&, double);                              \
  template LastLook last_look<D>(const BeliefView<D>&, std::span<const BoundaryFace<D>>, const RayMarch<D>&, const Ground<D>&);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage

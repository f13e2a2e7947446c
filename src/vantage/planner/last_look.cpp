// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/last_look.h"

#include <algorithm>
#include <cmath>

#include "vantage/base/parallel.h"

namespace vantage {
namespace {

constexpr std::size_t kMostQuestions = 120, kMostPlaces = 200, kNearPlaces = 40;
constexpr double kLeastCosine = 0.1;  // Less teaches nothing.
constexpr double kAnswered = 0.9, kInTheOpen = 0.75;
constexpr double kDeep = 3.0;  // Cells behind a slit; less is the inside of a wall.

/// An even choice of at most `limit`, in their order.
template <class T>
std::vector<T> some_of(const std::vector<T>& all, std::size_t limit) {
  if (all.size() <= limit) return all;
  std::vector<T> chosen;
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

/// The kNearPlaces of `places` nearest to a point, nearest first.
template <int Dim>
std::vector<std::size_t> nearest_of(const Grid<Dim>& grid, std::span<const std::size_t> places, const Vec<Dim>& point) {
  std::vector<std::pair<double, std::size_t>> nearest;  // A heap, the farthest on top.
  for (const std::size_t place : places) {
    const std::pair entry((grid.position(place) - point).squaredNorm(), place);
    if (nearest.size() == kNearPlaces) {
      if (entry >= nearest.front()) continue;
      std::pop_heap(nearest.begin(), nearest.end());
      nearest.pop_back();
    }
    nearest.push_back(entry);
    std::push_heap(nearest.begin(), nearest.end());
  }
  std::sort_heap(nearest.begin(), nearest.end());
  std::vector<std::size_t> sorted;
  for (const auto& [distance, place] : nearest) sorted.push_back(place);
  return sorted;
}

/// Nothing known lies between a place and the middle of a face, and all but the last bit is known.
template <int Dim>
bool may_see(const BeliefView<Dim>& view, const Ground<Dim>& ground, const Vec<Dim>& from, const Vec<Dim>& to) {
  const Grid<Dim>& grid = view.window();
  const Vec<Dim> way = to - from;
  const double distance = way.norm(), known = distance - 1.5 * grid.spacing;
  for (double t = 0.0; t < known; t += 0.4 * grid.spacing) {
    const Index<Dim> node = grid.nearest(from + way * (t / distance));
    if (!grid.inside(node)) continue;
    const NodeState state = view.state.at(node);
    if (state == NodeState::unseen || (ground.surface == nullptr && state == NodeState::obstacle)) return false;
  }
  return ground.surface == nullptr || ground.surface->cast(from, way / distance, distance).range > distance;
}

/// How much of an answer a look from `from` gives: 1 for a frontal one; 0 if it gives none.
template <int Dim, class Question>
double answer_from(const BeliefView<Dim>& view, const Ground<Dim>& ground, const Question& question, const Vec<Dim>& from) {
  const Vec<Dim> offset = from - question.center;
  const double distance = offset.norm(), along = offset.dot(question.step);
  if (distance > ground.max_range || distance < 0.5 * view.window().spacing || along < kLeastCosine * distance) return 0.0;
  if (!may_see(view, ground, from, question.center)) return 0.0;
  const double frontal = std::min(1.0, along / (0.3 * distance));
  return frontal * frontal;
}

template <int Dim>
bool looked_at(const BoundaryFace<Dim>& face) {
  constexpr std::uint8_t kFailed = 5;  // Bin of the evidence from which on it has been looked at in vain (opening.cpp).
  return face.bin[1] >= kFailed || face.frontal > 0.3;
}

}  // namespace

const LastLook::Open* LastLook::find(std::size_t unseen) const {
  const auto at = std::lower_bound(open.begin(), open.end(), unseen, [](const Open& o, std::size_t u) { return o.unseen < u; });
  return at != open.end() && at->unseen == unseen ? &*at : nullptr;
}

template <int Dim>
Mesh<Dim> patch_mesh(std::span<const Patch<Dim>> patches, double margin) {
  Mesh<Dim> mesh;
  for (const Patch<Dim>& patch : patches) {
    const auto count = static_cast<std::uint32_t>(patch.count);
    if (count < static_cast<std::uint32_t>(Dim)) continue;
    Vec<Dim> middle = Vec<Dim>::Zero();
    for (const Vec<Dim>& v : patch.corners()) middle += v / static_cast<double>(count);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vec<Dim>& v : patch.corners()) {
      const double radius = (v - middle).norm();
      mesh.vertices.push_back(radius > 0.0 ? Vec<Dim>(v + (v - middle) * (margin / radius)) : v);
    }
    for (std::uint32_t k = 1; k + Dim - 2 < count; ++k) {
      typename Mesh<Dim>::Facet facet;
      facet[0] = first;
      for (std::uint32_t a = 1; a < static_cast<std::uint32_t>(Dim); ++a) facet[a] = first + k + a - 1;
      mesh.facets.push_back(facet);
    }
  }
  return mesh;
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
  requires SpatialDim<Dim>
auto LastLooks<Dim>::questions(const BeliefView<Dim>& view, std::span<const BoundaryFace<Dim>> faces, const Ground<Dim>& ground) const
    -> std::vector<Question> {
  const Grid<Dim>& grid = view.window();
  double area = 1.0;
  for (int a = 1; a < Dim; ++a) area *= grid.spacing;
  const auto answered = [&](std::size_t node) { return !answered_.values.empty() && static_cast<double>(answered_[node]) >= kAnswered; };
  std::vector<Question> all;
  for (const BoundaryFace<Dim>& face : faces)
    if (!looked_at(face) && !answered(face.unseen) && (ground.slits || face.known_distance >= kInTheOpen * grid.spacing))
      all.push_back({face.unseen, face.center, face.step(), area * depth_behind(view, face, ground.max_range)});
  for (std::size_t i = 0; ground.slits && ground.surface != nullptr && i < grid.size(); ++i) {
    if (view.state[i] != NodeState::obstacle) continue;
    const Index<Dim> node = grid.local(i);
    for (int direction = 0; direction < 2 * Dim; ++direction) {
      BoundaryFace<Dim> slit;
      slit.direction = direction;
      const Index<Dim> to = node - slit.step().template cast<std::int32_t>();
      if (!grid.inside(to) || view.state.at(to) != NodeState::unseen) continue;
      slit.unseen = grid.linear(to);
      if (answered(slit.unseen)) continue;
      const double depth = depth_behind(view, slit, ground.max_range);
      if (depth < kDeep * grid.spacing) continue;
      all.push_back({slit.unseen, 0.5 * (grid.position(i) + grid.position(to)), slit.step(), 0.25 * area * depth, true});
    }
  }
  if (ground.weight == nullptr) return all;
  for (Question& question : all) question.behind *= static_cast<double>((*ground.weight)[question.unseen]);
  std::erase_if(all, [](const Question& question) { return !(question.behind > 0.0); });
  return all;
}

template <int Dim>
  requires SpatialDim<Dim>
LastLook LastLooks<Dim>::look(const BeliefView<Dim>& view, std::span<const BoundaryFace<Dim>> faces, const Ground<Dim>& ground) const {
  const Grid<Dim>& grid = view.window();
  LastLook look;
  look.asked = true;
  for (const BoundaryFace<Dim>& face : faces)
    if (face.known_distance >= kInTheOpen * grid.spacing && !answered_.values.empty() && static_cast<double>(answered_[face.unseen]) >= kAnswered)
      look.stubborn.push_back(face.unseen);
  std::sort(look.stubborn.begin(), look.stubborn.end());
  const std::vector<Question> all = questions(view, faces, ground), asked = some_of(all, kMostQuestions);
  const std::vector<std::size_t> everywhere = new_places(ground), places = some_of(everywhere, kMostPlaces);
  struct Answer {
    std::size_t place;
    double worth;
  };
  std::vector<std::vector<Answer>> answers(asked.size());
  parallel_for(asked.size(), 1, [&](std::size_t q) {
    const auto try_from = [&](std::size_t place) {
      const double worth = answer_from(view, ground, asked[q], grid.position(place));
      if (worth > 0.0) answers[q].push_back({place, worth});
    };
    for (const std::size_t place : places) try_from(place);
    if (!answers[q].empty() || places.size() == everywhere.size()) return;
    for (const std::size_t place : nearest_of(grid, everywhere, asked[q].center)) try_from(place);  // Most of them have not been tried.
  });
  std::vector<std::pair<std::size_t, double>> volume;  // By place.
  const double share = static_cast<double>(all.size()) / std::max<double>(1.0, static_cast<double>(asked.size()));
  for (std::size_t q = 0; q < asked.size(); ++q) {
    if (answers[q].empty()) continue;
    const auto best = std::max_element(answers[q].begin(), answers[q].end(), [](const Answer& a, const Answer& b) { return a.worth < b.worth; });
    look.open.push_back({asked[q].unseen, best->place, asked[q].slit});
    for (const Answer& a : answers[q]) volume.emplace_back(a.place, a.worth * asked[q].behind * share);
  }
  std::stable_sort(look.open.begin(), look.open.end(), [](const auto& a, const auto& b) { return a.unseen < b.unseen; });
  look.open.erase(std::unique(look.open.begin(), look.open.end(), [](const auto& a, const auto& b) { return a.unseen == b.unseen; }),
                  look.open.end());
  std::stable_sort(volume.begin(), volume.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < volume.size();) {
    double sum = 0.0;
    const std::size_t place = volume[i].first;
    for (; i < volume.size() && volume[i].first == place; ++i) sum += volume[i].second;
    if (sum <= look.volume) continue;
    look.volume = sum;
    look.place = place;
  }
  return look;
}

template <int Dim>
  requires SpatialDim<Dim>
void LastLooks<Dim>::answer(const BeliefView<Dim>& view, std::span<const BoundaryFace<Dim>> faces, const Ground<Dim>& ground, std::size_t place) {
  const Grid<Dim>& grid = view.window();
  if (answered_.values.empty()) answered_ = Field<Dim>(grid);
  const std::vector<Question> all = questions(view, faces, ground);
  std::vector<double> worth(all.size());
  parallel_for(all.size(), 64, [&](std::size_t q) { worth[q] = answer_from(view, ground, all[q], grid.position(place)); });
  for (std::size_t q = 0; q < all.size(); ++q) answered_[all[q].unseen] += static_cast<float>(worth[q]);
}

template <int Dim>
Field<Dim, std::uint8_t> squeezed_nodes(const BeliefView<Dim>& view, const Field<Dim, std::uint8_t>& reachable, double clearance) {
  const Grid<Dim>& grid = view.window();
  Grid<Dim> fine{0.5 * grid.spacing, 2 * grid.first, (2 * grid.extent.array() - 1).matrix()};
  const auto known = [&](const Index<Dim>& node) { return static_cast<double>(view.known_distance.at(node)); };
  // Distance half a step beyond a node, away from what lies behind it: farther from a wall right behind, no farther along a passage.
  const auto beyond = [&](const Index<Dim>& node, const Index<Dim>& step) {
    const Index<Dim> behind = node - step;
    if (!grid.inside(behind)) return known(node);
    const double slope = view.state.at(behind) == NodeState::obstacle ? 1.0 : (known(node) - known(behind)) / grid.spacing;
    return known(node) + 0.5 * grid.spacing * std::clamp(slope, 0.0, 1.0);
  };
  const auto passable = [&](const Index<Dim>& place) {
    const Index<Dim> low = place / 2, odd = place - 2 * low;
    const Grid<Dim> corners{1.0, low, Index<Dim>(odd.array() + 1)};
    bool all_obstacle = true;
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const NodeState state = view.state.at(low + corners.local(c));
      if (state == NodeState::unseen) return false;
      all_obstacle = all_obstacle && state == NodeState::obstacle;
    }
    if (all_obstacle) return false;
    double distance = odd.any() ? 0.0 : known(low);
    for (int a = 0; a < Dim; ++a) {
      if (odd[a] == 0) continue;
      double across = kInfinity;  // Between the nodes on both sides along this axis.
      for (std::size_t c = 0; c < corners.size(); ++c) {
        const Index<Dim> local = corners.local(c), step = (local[a] == 0 ? 1 : -1) * Index<Dim>::Unit(a);
        across = std::min(across, beyond(low + local, step));
      }
      distance = std::max(distance, across);
    }
    return distance >= clearance;
  };
  Field<Dim, std::uint8_t> squeezed(grid), tried(fine);
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
          if (view.seen(node) && reachable[node] == 0) squeezed[node] = 1;
        }
      }
  }
  return squeezed;
}

#define VANTAGE_INSTANTIATE(D)                                                           \
  template double depth_behind<D>(const BeliefView<D>&, const BoundaryFace<D>&, double); \
  template Mesh<D> patch_mesh<D>(std::span<const Patch<D>>, double);                     \
  template class LastLooks<D>;                                                           \
  template Field<D, std::uint8_t> squeezed_nodes<D>(const BeliefView<D>&, const Field<D, std::uint8_t>&, double);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage

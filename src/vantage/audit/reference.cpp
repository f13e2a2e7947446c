// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/geometry/angle.h"

namespace vantage {
namespace {

constexpr std::uint32_t kNone = 0xffffffff;
constexpr std::int32_t kBlock = 8;  // Nodes along an edge of the blocks that are tested at once.
constexpr double kTouch = 1e-6;     // Nearer than this is on the surface [m].

/// Calls `visit(neighbour)` for the face neighbours of a node that lie in the window.
template <int Dim, class Visit>
void for_faces(const Grid<Dim>& grid, std::size_t node, Visit&& visit) {
  const Index<Dim> at = grid.local(node);
  for (int a = 0; a < Dim; ++a) {
    if (at[a] > 0) visit(node - grid.stride(a));
    if (at[a] + 1 < grid.extent[a]) visit(node + grid.stride(a));
  }
}

/// The same for all 3^Dim - 1 neighbours.
template <int Dim, class Visit>
void for_neighbours(const Grid<Dim>& grid, std::size_t node, Visit&& visit) {
  const Grid<Dim> stencil{1.0, Index<Dim>::Zero(), Index<Dim>::Constant(3)};
  const Index<Dim> at = grid.local(node);
  for (std::size_t i = 0; i < stencil.size(); ++i) {
    const Index<Dim> other = at + (stencil.local(i).array() - 1).matrix();
    if (i != stencil.size() / 2 && grid.inside(other)) visit(grid.linear(other));
  }
}

/// Builds the truth in three passes: near which surfaces (classify), where one can stand (flood), what can be seen from there (reveal).
template <int Dim>
class Builder {
 public:
  Builder(const RayCaster<Dim>& caster, const Box<Dim>& domain, const ReferenceOptions& options)
      : caster_(caster), domain_(domain), directions_(fixed_directions<Dim>(options.rays)) {
    reference_.options = options;
    const Grid<Dim> window = window_over(domain, 0.5 * options.voxel);
    const double count = window.extent.template cast<double>().prod();
    require(count < kNone, fmt::format("audit: {:.3g} nodes of the reference lattice: must be below {:.3g}, so coarser voxel", count, double{kNone}));
    require_memory(count, sizeof(Truth) + 2 * sizeof(std::uint32_t) + 1, "nodes of the reference lattice");
    reference_.nodes = Field<Dim, Truth>(window);
  }

  Reference<Dim> build(const Vec<Dim>& start) {
    classify();
    flood(first_node(start));
    reveal();
    count();
    return std::move(reference_);
  }

 private:
  struct Step {
    std::uint32_t from, to;
  };

  const Grid<Dim>& grid() const { return reference_.nodes.window; }
  Truth& node(std::size_t i) { return reference_.nodes[i]; }

  void classify() {
    Grid<Dim> blocks = grid();
    for (int a = 0; a < Dim; ++a) blocks.extent[a] = (blocks.extent[a] + kBlock - 1) / kBlock;
    parallel_for(blocks.size(), 4, [&](std::size_t b) { classify_block(blocks.local(b) * kBlock); });
  }

  void classify_block(const Index<Dim>& low) {
    Grid<Dim> block = grid();
    block.first += low;
    block.extent = (grid().extent - low).cwiseMin(kBlock);
    const ReferenceOptions& o = reference_.options;
    const double reach = std::max({o.clearance, o.eta + o.voxel}) + kTouch;
    const double radius = 0.5 * block.bounds().size().norm();
    const bool clear = caster_.distance(block.bounds().center(), reach + radius) >= reach + radius;
    for (std::size_t i = 0; i < block.size(); ++i) {
      Truth& truth = node(grid().linear(low + block.local(i)));
      truth.inside = domain_.grown(kTouch).contains(block.position(i));
      if (!clear) classify_node(truth, caster_.distance(block.position(i), reach));
    }
  }

  void classify_node(Truth& truth, double distance) const {
    const ReferenceOptions& o = reference_.options;
    truth.near = distance <= std::max(o.eta, o.voxel);
    truth.blurred = distance <= o.eta + 0.5 * std::sqrt(double{Dim}) * o.voxel;
    truth.tight = distance < o.clearance;
    truth.close = distance < grid().spacing + kTouch;
    truth.touching = distance < kTouch;
  }

  bool stands(const Truth& truth) const { return truth.inside && !truth.tight && !truth.touching; }

  /// No surface crosses the step between two nodes.
  bool open(std::size_t a, std::size_t b) { return !(node(a).close && node(b).close) || in_sight(caster_, grid().position(a), grid().position(b)); }

  /// Nearest node within two steps and the clearance of `start` where one can stand and that is in sight of it.
  std::size_t first_node(const Vec<Dim>& start) {
    const Index<Dim> centre = grid().nearest(start);
    const auto reach = static_cast<std::int32_t>(std::ceil(reference_.options.clearance / grid().spacing)) + 2;
    const Grid<Dim> around{1.0, centre.array() - reach, Index<Dim>::Constant(2 * reach + 1)};
    std::optional<std::size_t> best;
    double least = kInfinity;
    for (std::size_t i = 0; i < around.size(); ++i) {
      const Index<Dim> at = around.first + around.local(i);
      if (!grid().inside(at) || !stands(reference_.nodes.at(at))) continue;
      const double distance = (grid().position(at) - start).norm();
      if (distance >= least || !in_sight(caster_, start, grid().position(at))) continue;
      best = grid().linear(at);
      least = distance;
    }
    require(best.has_value(), fmt::format("audit: no place with {} m clearance is in sight near the start", reference_.options.clearance));
    return *best;
  }

  void flood(std::size_t first) {
    std::vector<std::uint32_t> queue{static_cast<std::uint32_t>(first)};
    node(first).reachable = node(first).visible = true;
    for (std::size_t k = 0; k < queue.size(); ++k) {
      for_faces(grid(), queue[k], [&](std::size_t to) {
        if (node(to).reachable || !stands(node(to)) || !open(queue[k], to)) return;
        node(to).reachable = node(to).visible = true;
        queue.push_back(static_cast<std::uint32_t>(to));
      });
    }
  }

  /// Layer by layer from the reachable nodes through all space that unblocked steps join to them.
  void reveal() {
    witness_.assign(grid().size(), kNone);
    joined_.assign(grid().size(), 0);
    std::vector<std::uint32_t> layer;
    for (std::uint32_t i = 0; i < grid().size(); ++i) {
      if (!node(i).reachable) continue;
      witness_[i] = i;
      joined_[i] = 1;
      bool edge = false;
      for_faces(grid(), i, [&](std::size_t to) { edge = edge || !node(to).reachable; });
      if (edge) layer.push_back(i);
    }
    while (!layer.empty()) {
      layer = next_layer(layer);
      look(layer);
    }
  }

  std::vector<std::uint32_t> next_layer(const std::vector<std::uint32_t>& layer) {
    std::vector<Step> steps;
    for (const std::uint32_t from : layer) {
      if (node(from).touching) continue;  // On a surface: which side a step leaves it on is not known.
      for_faces(grid(), from, [&](std::size_t to) {
        if (!joined_[to] && node(to).inside) steps.push_back({from, static_cast<std::uint32_t>(to)});
      });
    }
    std::vector<std::uint8_t> free(steps.size());
    parallel_for(steps.size(), 256, [&](std::size_t i) { free[i] = open(steps[i].from, steps[i].to); });
    std::vector<std::uint32_t> next;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      if (!free[i] || joined_[steps[i].to]) continue;
      joined_[steps[i].to] = 1;
      next.push_back(steps[i].to);
    }
    return next;
  }

  void look(const std::vector<std::uint32_t>& layer) {
    std::vector<std::uint32_t> found(layer.size());
    parallel_for(layer.size(), 16, [&](std::size_t i) { found[i] = look_from(layer[i]); });
    for (std::size_t i = 0; i < layer.size(); ++i) {
      witness_[layer[i]] = found[i];
      node(layer[i]).visible = found[i] != kNone;
    }
  }

  /// A reachable node that sees this one, or kNone.
  std::uint32_t look_from(std::uint32_t i) const {
    const Vec<Dim> place = grid().position(i);
    std::uint32_t found = kNone, failed = kNone;
    for_neighbours(grid(), i, [&](std::size_t other) {
      const std::uint32_t w = witness_[other];
      if (found != kNone || w == kNone || w == failed) return;
      const Vec<Dim> from = grid().position(w);
      if ((place - from).norm() <= reference_.options.range && in_sight(caster_, from, place))
        found = w;
      else
        failed = w;
    });
    if (found != kNone) return found;
    const auto view = find_view<Dim>(reference_, caster_, place, directions_);
    return view ? static_cast<std::uint32_t>(*view) : kNone;
  }

  /// Does a node of the runs' lattice at or beside this one stand clear of surfaces? If none does, no run can call it seen.
  bool decided(std::size_t i) const {
    const Index<Dim> at = grid().local(i), odd = (grid().first + at).unaryExpr([](std::int32_t v) { return v & 1; });
    const Grid<Dim> beside{1.0, Index<Dim>(at - odd), Index<Dim>(odd.array() + 1)};  // One or two along each axis.
    for (std::size_t k = 0; k < beside.size(); ++k) {
      const Index<Dim> other = beside.first + 2 * beside.local(k);
      if (grid().inside(other) && !reference_.nodes.at(other).blurred) return true;
    }
    return false;
  }

  /// Is there a straight way from a node to a reachable one over nodes that are not close to any surface?
  bool shows_widely(std::size_t i) const {
    if (reference_.nodes[i].reachable) return true;
    const Vec<Dim> place = grid().position(i);
    const auto along = [&](const Vec<Dim>& direction) {
      for (double t = 0.0; t <= reference_.options.range; t += 0.5 * grid().spacing) {
        const Index<Dim> at = grid().nearest(place + t * direction);
        if (!grid().inside(at) || reference_.nodes.at(at).close) return false;
        if (reference_.nodes.at(at).reachable) return true;
      }
      return false;
    };
    const Vec<Dim> way = grid().position(witness_[i]) - place;
    return along(way / std::max(way.norm(), kTouch)) || std::any_of(directions_.begin(), directions_.end(), along);
  }

  void count() {
    std::vector<std::uint8_t> left_out(grid().size());
    parallel_for(grid().size(), 64, [&](std::size_t i) { left_out[i] = node(i).counts() && !decided(i); });
    for (std::size_t i = 0; i < grid().size(); ++i)
      if (left_out[i] != 0) node(i).near = true;
    parallel_for(grid().size(), 64, [&](std::size_t i) { left_out[i] = node(i).counts() && !shows_widely(i); });
    for (std::size_t i = 0; i < grid().size(); ++i)
      if (left_out[i] != 0) node(i).narrow = true;
    for (const Truth& truth : reference_.nodes.values) {
      reference_.counted += truth.counts() ? 1 : 0;
      reference_.narrow += truth.narrow ? 1 : 0;
    }
    require(reference_.counted > 0, fmt::format("audit: nothing visible lies farther than {} m from a surface", reference_.options.voxel));
  }

  const RayCaster<Dim>& caster_;
  Box<Dim> domain_;
  std::vector<Vec<Dim>> directions_;
  Reference<Dim> reference_;
  std::vector<std::uint32_t> witness_;  // A reachable node that sees the node.
  std::vector<std::uint8_t> joined_;
};

template <int Dim>
Vec<Dim> fixed_direction(std::int64_t i, std::int64_t count);

template <>
Vec<2> fixed_direction<2>(std::int64_t i, std::int64_t count) {
  const auto [s, c] = sin_cos(2.0 * kPi * (static_cast<double>(i) + 0.5) / static_cast<double>(count));
  return {c, s};
}

template <>
Vec<3> fixed_direction<3>(std::int64_t i, std::int64_t count) {
  const double height = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(count);
  const double golden = kPi * (3.0 - std::sqrt(5.0));
  const auto [s, c] = sin_cos(golden * static_cast<double>(i));
  const double radius = std::sqrt(1.0 - height * height);
  return {radius * c, radius * s, height};
}

}  // namespace

void describe(ReferenceOptions& o, const OptionVisitor& visit) {
  visit("voxel", o.voxel, "m", Range{1e-4, 1e4}, "lattice spacing of the runs to be judged; the reference uses half of it");
  visit("eta", o.eta, "m", Range{1e-6, 1e3}, "Hausdorff tolerance of those runs");
  visit("clearance", o.clearance, "m", Range{0.0, 1e3}, "of a vantage point to surfaces");
  visit("range", o.range, "m", Range{1e-3, 1e5}, "of the sensor");
  visit("rays", o.rays, "", Range{1, 1e6}, "fixed directions in which a node looks for a reachable place");
}

template <int Dim>
  requires SpatialDim<Dim>
double Reference<Dim>::node_volume() const {
  double volume = 1.0;
  for (int a = 0; a < Dim; ++a) volume *= nodes.window.spacing;
  return volume;
}

template <int Dim>
std::vector<Vec<Dim>> fixed_directions(std::int64_t count) {
  std::vector<Vec<Dim>> all;
  for (std::int64_t i = 0; i < count; ++i) all.push_back(fixed_direction<Dim>(i, count));
  return all;
}

template <int Dim>
bool in_sight(const RayCaster<Dim>& truth, const Vec<Dim>& from, const Vec<Dim>& to) {
  const double length = (to - from).norm();
  if (length < kTouch) return true;
  return truth.cast(from, (to - from) / length, length).range > length - kTouch;
}

template <int Dim>
std::optional<std::size_t> find_view(const Reference<Dim>& reference, const RayCaster<Dim>& truth, const Vec<Dim>& place,
                                     std::span<const Vec<Dim>> directions) {
  const Grid<Dim>& grid = reference.nodes.window;
  const double range = reference.options.range;
  for (const Vec<Dim>& direction : directions) {
    const double end = std::min(range, truth.cast(place, direction, range).range);
    for (double t = 0.0; t < end; t += 0.5 * grid.spacing) {
      const Index<Dim> at = grid.nearest(place + t * direction);
      if (!grid.inside(at)) break;
      if (reference.nodes.at(at).reachable) return grid.linear(at);
    }
  }
  return std::nullopt;
}

template <int Dim>
Reference<Dim> make_reference(const RayCaster<Dim>& truth, const Box<Dim>& domain, const Vec<Dim>& start, const ReferenceOptions& options) {
  check_options(options, "audit");
  require(domain.contains(start), "audit: the start lies outside the domain");
  return Builder<Dim>(truth, domain, options).build(start);
}

template struct Reference<2>;
template struct Reference<3>;
template std::vector<Vec<2>> fixed_directions<2>(std::int64_t);
template std::vector<Vec<3>> fixed_directions<3>(std::int64_t);
template bool in_sight<2>(const RayCaster<2>&, const Vec<2>&, const Vec<2>&);
template bool in_sight<3>(const RayCaster<3>&, const Vec<3>&, const Vec<3>&);
template std::optional<std::size_t> find_view<2>(const Reference<2>&, const RayCaster<2>&, const Vec<2>&, std::span<const Vec<2>>);
template std::optional<std::size_t> find_view<3>(const Reference<3>&, const RayCaster<3>&, const Vec<3>&, std::span<const Vec<3>>);
template Reference<2> make_reference<2>(const RayCaster<2>&, const Box<2>&, const Vec<2>&, const ReferenceOptions&);
template Reference<3> make_reference<3>(const RayCaster<3>&, const Box<3>&, const Vec<3>&, const ReferenceOptions&);

}  // namespace vantage

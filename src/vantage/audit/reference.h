// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "vantage/base/options.h"
#include "vantage/field/field.h"
#include "vantage/geometry/ray_caster.h"

namespace vantage {

/// What the truth says of a lattice node.
struct Truth {
  bool inside : 1 = false;     ///< In the domain.
  bool reachable : 1 = false;  ///< One can stand there: clear of surfaces, and joined to the start by clear nodes.
  bool visible : 1 = false;    ///< From a reachable place within range; reachable nodes are.
  bool near : 1 = false;       ///< Within max(eta, h) of a surface; of a visible node also: all nodes of the runs' lattice beside it are blurred.
  bool blurred : 1 = false;    ///< Within sqrt(Dim)/2 h + eta of a surface: an explorer may take it for an obstacle.
  bool tight : 1 = false;      ///< Nearer to a surface than the clearance.
  bool close : 1 = false;      ///< Nearer to a surface than the node spacing: a step from here may be blocked.
  bool touching : 1 = false;   ///< On a surface.
  bool narrow : 1 = false;     ///< Belongs to the reference set, but shows only through what is about as narrow as the spacing h, or narrower.
  /// Belongs to the reference set.
  [[nodiscard]] bool counts() const { return visible && !near; }
};

struct ReferenceOptions {
  double voxel = 0.5;        ///< Lattice spacing h of the runs to be judged [m]; the reference uses h/2.
  double eta = 0.1;          ///< Hausdorff tolerance of those runs [m].
  double clearance = 0.5;    ///< Of a vantage point to surfaces [m].
  double range = 80.0;       ///< Of the sensor [m].
  std::int64_t rays = 1000;  ///< Fixed directions in which a node looks for a reachable place.
};

void describe(ReferenceOptions& options, const OptionVisitor& visit);

/// The reachable visible volume: all that any sequence of scans can show, and nothing else.
template <int Dim>
  requires SpatialDim<Dim>
struct Reference {
  ReferenceOptions options;
  Field<Dim, Truth> nodes;  ///< Over the domain, at spacing h/2: every second node is one of the runs' lattice.
  std::size_t counted = 0;  ///< Nodes of the reference set.
  std::size_t narrow = 0;   ///< Of them those that show only through something narrow.

  [[nodiscard]] double node_volume() const;                                                     ///< [m^Dim]
  [[nodiscard]] double volume() const { return static_cast<double>(counted) * node_volume(); }  ///< [m^Dim]
};

/// Nodes clear of surfaces and joined to `start` by face steps that no surface blocks are reachable. A node joined to them by unblocked steps of
/// any clearance is visible if one of the fixed rays from it passes through the cell of a reachable node unobstructed, or it is in line of sight
/// with a reachable node that a neighbour of it sees; spaces that no lattice step enters are hidden. Throws bad_input if no clear node is in
/// sight near `start`, memory if the lattice does not fit. Cost: one distance for a node near surfaces, a few rays for one that cannot be reached,
/// all rays for one that is joined but hidden. Same bits for any number of threads.
template <int Dim>
[[nodiscard]] Reference<Dim> make_reference(const RayCaster<Dim>& truth, const Box<Dim>& domain, const Vec<Dim>& start,
                                            const ReferenceOptions& options);

/// The fixed directions: a uniform circle, or a Fibonacci sphere.
template <int Dim>
[[nodiscard]] std::vector<Vec<Dim>> fixed_directions(std::int64_t count);

/// True if nothing lies between; a surface at `to` itself does not hide it.
template <int Dim>
[[nodiscard]] bool in_sight(const RayCaster<Dim>& truth, const Vec<Dim>& from, const Vec<Dim>& to);

/// First reachable node whose cell a fixed ray from `place` passes through unobstructed within range: a place that sees it.
template <int Dim>
[[nodiscard]] std::optional<std::size_t> find_view(const Reference<Dim>& reference, const RayCaster<Dim>& truth, const Vec<Dim>& place,
                                                   std::span<const Vec<Dim>> directions);

}  // namespace vantage

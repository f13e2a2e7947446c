// SPDX-License-Identifier: Apache-2.0
#include "vantage/surface/flat.h"

#include <algorithm>
#include <cmath>

#include "vantage/geometry/hausdorff.h"

namespace vantage {
namespace {

/// Area for each point, in squared limits: with more of it a region is hardly ever covered. A disc has pi.
constexpr double kSparse = 1.2;

float rounded_up(double value) {
  const float near = static_cast<float>(value);
  return static_cast<double>(near) >= value ? near : std::nextafter(near, std::numeric_limits<float>::infinity());
}

/// Sites in the coordinates of a frame.
template <int Dim>
struct Projected {
  std::array<std::vector<double>, Dim> at;
  Vec<Dim> low, high;

  void set(std::span<const Site<Dim>> sites, const Frame<Dim>& frame, const Snap<Dim>& snap) {
    low = Vec<Dim>::Constant(kInfinity);
    high = -low;
    for (auto& axis : at) axis.resize(sites.size());
    for (std::size_t i = 0; i < sites.size(); ++i) {
      const Vec<Dim> y = frame.local(snap.local(sites[i]));
      for (int a = 0; a < Dim; ++a) at[a][i] = y[a];
      low = low.cwiseMin(y);
      high = high.cwiseMax(y);
    }
  }
  [[nodiscard]] std::size_t size() const { return at[0].size(); }
  /// Number of leading axes in which the points have an extent.
  [[nodiscard]] int rank(double thin) const {
    int rank = 0;
    while (rank < Dim - 1 && high[rank] - low[rank] > thin) ++rank;
    return rank;
  }
};

template <int Rank, int Dim>
const Feet<Rank>& feet(const Projected<Dim>& points) {
  thread_local Feet<Rank> out;
  for (int a = 0; a < Rank; ++a) out.at[a] = points.at[a];
  out.height2.assign(points.size(), 0.0);
  for (int a = Rank; a < Dim; ++a)
    for (std::size_t i = 0; i < points.size(); ++i) out.height2[i] += points.at[a][i] * points.at[a][i];
  return out;
}

/// Does the region hold the box of the feet, up to rounding (which the slack of the certificate covers)?
template <int Rank>
bool holds_all(const RegionEdges<Rank>& edges, const Feet<Rank>& points) {
  const ConvexRegion<Rank> box = outline(points);
  double outside = -kInfinity;
  for (int i = 0; i < box.count; ++i) outside = std::max(outside, edges.outside(box.vertices[i]));
  return outside <= 1e-13;
}

/// Largest distance of the points to the region: closed form.
template <int Rank>
double farthest_point(const ConvexRegion<Rank>& region, const Feet<Rank>& points) {
  const RegionEdges<Rank> edges(region);
  double largest2 = 0.0;
  if (holds_all(edges, points)) return std::sqrt(*std::max_element(points.height2.begin(), points.height2.end()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    typename ConvexRegion<Rank>::Place foot;
    for (int a = 0; a < Rank; ++a) foot[a] = points.at[a][i];
    double distance2 = points.height2[i];
    if (edges.outside(foot) > 0.0) distance2 += (region.closest(foot) - foot).squaredNorm();
    largest2 = std::max(largest2, distance2);
  }
  return std::sqrt(largest2);
}

struct Errors {
  double data_to_surface, surface_to_data;
};

struct Limits {
  double data, surface;
};

/// Length or area for each point: regions with more of it are not tried.
template <int Rank>
double most_for_each(double limit, bool paper) {
  return Rank == 1 ? 2.0 * limit : (paper ? kPi : kSparse) * limit * limit;
}

/// Tries regions of one plane or line on its points.
template <int Rank>
class Attempts {
 public:
  Attempts(const Feet<Rank>& points, Limits limits, bool sharp, bool paper)
      : points_(points), limits_(limits), most_each_(most_for_each<Rank>(limits.surface, paper)), search_{sharp ? 0.0 : 1.0, nullptr} {}

  /// Both one-sided errors, if they are within the limit.
  std::optional<Errors> errors(const ConvexRegion<Rank>& region) {
    if (region.count == 0 || region.measure() > static_cast<double>(points_.size()) * most_each_) return std::nullopt;
    const double data = farthest_point(region, points_);
    if (data > limits_.data) return std::nullopt;
    const CoverRadius<Rank> covering = cover<Rank>(region, points_, limits_.surface, search_);
    if (covering.radius) return Errors{data, *covering.radius};
    hole_ = covering.farthest;  // Most likely the next region has it too.
    search_.first = &*hole_;
    return std::nullopt;
  }
  /// Of the last region that has one.
  [[nodiscard]] const std::optional<typename ConvexRegion<Rank>::Place>& hole() const { return hole_; }

 private:
  const Feet<Rank>& points_;
  Limits limits_;
  double most_each_;
  CoverSearch<Rank> search_;
  std::optional<typename ConvexRegion<Rank>::Place> hole_;
};

template <int Dim, int Rank>
Patch<Dim> make_patch(const ConvexRegion<Rank>& region, const Errors& errors, const Frame<Dim>& frame, const Snap<Dim>& snap) {
  Patch<Dim> patch;
  for (int i = 0; i < region.count; ++i)
    patch.vertices[patch.count++] = snap.world(frame.origin + frame.axes.template leftCols<Rank>() * region.vertices[i]);
  patch.data_to_surface = rounded_up(errors.data_to_surface + snap.slack());
  patch.surface_to_data = rounded_up(errors.surface_to_data + snap.slack());
  return patch;
}

/// Where the plane meets the bounding box of the points, which is widened so that all their feet are in.
template <int Dim>
ConvexRegion<Dim - 1> in_bounding_box(std::span<const Site<Dim>> sites, const Feet<Dim - 1>& feet, const Frame<Dim>& frame, const Snap<Dim>& snap) {
  Site<Dim> low = sites[0], high = low;
  for (const Site<Dim>& site : sites)
    for (int a = 0; a < Dim; ++a) {
      low[a] = std::min(low[a], site[a]);
      high[a] = std::max(high[a], site[a]);
    }
  const double thickness = std::sqrt(*std::max_element(feet.height2.begin(), feet.height2.end()));
  return clip_to_box(frame, Box<Dim>{snap.local(low), snap.local(high)}.grown(thickness + snap.step()));
}

/// How far places of a patch of that rank may be from the sites.
template <int Rank, int Dim>
double surface_limit(std::span<const Site<Dim>> sites, const Frame<Dim>& frame, const FitRules<Dim>& rules) {
  if (rules.spacing == nullptr) return rules.limit;
  const double apart = Rank == Dim - 1 ? rules.spacing->on_plane(sites, frame.origin, frame.axes.col(Dim - 1))
                                       : rules.spacing->on_line(sites, frame.origin, frame.axes.col(0));
  return std::max(rules.limit, apart);
}

template <int Dim, int Rank>
std::optional<Patch<Dim>> fit_rank(std::span<const Site<Dim>> sites, const Projected<Dim>& points, const Frame<Dim>& frame,
                                   const FitRules<Dim>& rules, const Cell<Dim>* cell, FlatReport<Dim>* report) {
  const Feet<Rank>& data = feet<Rank>(points);
  const auto farthest = std::max_element(data.height2.begin(), data.height2.end());
  if (*farthest > rules.limit * rules.limit) {
    if (report != nullptr && Rank == Dim - 1) report->refusal.off = sites[static_cast<std::size_t>(farthest - data.height2.begin())];
    return std::nullopt;
  }
  Attempts<Rank> attempts(data, {rules.limit, surface_limit<Rank>(sites, frame, rules)}, rules.sharp, rules.paper);
  Errors bounds{};
  const auto attempt = [&](const ConvexRegion<Rank>& region) -> std::optional<Patch<Dim>> {
    if (region.count > Patch<Dim>::kMaxVertices) return std::nullopt;
    const auto errors = attempts.errors(region);
    if (!errors) return std::nullopt;
    bounds = *errors;
    return make_patch(region, *errors, frame, rules.snap);
  };
  std::optional<Patch<Dim>> patch;
  std::optional<typename ConvexRegion<Rank>::Place> in_cell;
  if constexpr (Rank == Dim - 1) {
    if (cell != nullptr) {
      const auto region = clip_to_box(frame, cell->box(rules.snap.step()));
      patch = attempt(region);
      if (patch && report != nullptr) {
        report->data = bounds.data_to_surface;
        report->surface = bounds.surface_to_data;
      }
      in_cell = attempts.hole();
    }
    if (!patch && rules.paper) patch = attempt(in_bounding_box<Dim>(sites, data, frame, rules.snap));
  }
  if (!patch && !rules.paper) patch = attempt(outline(data));
  if constexpr (Rank == Dim - 1)
    if (!patch && in_cell && report != nullptr) {
      const auto place = [&](const auto& hole) { return Vec<Dim>(frame.origin + frame.axes.template leftCols<Rank>() * hole); };
      const Vec<Dim> among = place(*attempts.hole());
      report->refusal.holes = {place(*in_cell), among, extreme_sites<Dim>(sites, frame, rules.snap)};
    }
  return patch;
}

/// Rank 0: the site nearest to the mean stands for all.
template <int Dim>
std::optional<Patch<Dim>> fit_point(std::span<const Site<Dim>> sites, const Frame<Dim>& frame, const FitRules<Dim>& rules) {
  const auto farther = [&](const Vec<Dim>& from) {
    return [&rules, from](const Site<Dim>& a, const Site<Dim>& b) {
      return (rules.snap.local(a) - from).squaredNorm() < (rules.snap.local(b) - from).squaredNorm();
    };
  };
  const Site<Dim> middle = *std::min_element(sites.begin(), sites.end(), farther(frame.origin));
  const Vec<Dim> p = rules.snap.local(middle);
  const double error = (rules.snap.local(*std::max_element(sites.begin(), sites.end(), farther(p))) - p).norm();
  if (error > rules.limit) return std::nullopt;
  Patch<Dim> patch = loose_patch<Dim>(middle, rules);
  patch.data_to_surface = rounded_up(error + rules.snap.slack());
  return patch;
}

}  // namespace

template <int Dim>
std::optional<Patch<Dim>> fit_flat(std::span<const Site<Dim>> sites, const Frame<Dim>& frame, const FitRules<Dim>& rules, const Cell<Dim>* cell,
                                   int most_rank, FlatReport<Dim>* report) {
  thread_local Projected<Dim> points;
  points.set(sites, frame, rules.snap);
  const int rank = rules.paper ? Dim - 1 : points.rank(kThin * rules.limit);
  if (rank > most_rank) return std::nullopt;
  switch (rank) {
    case 0: return fit_point<Dim>(sites, frame, rules);
    case 1: return fit_rank<Dim, 1>(sites, points, frame, rules, cell, report);
    default: return fit_rank<Dim, Dim - 1>(sites, points, frame, rules, cell, report);
  }
}

template <int Dim>
void set_limit_bounds(Patch<Dim>& patch, const FitRules<Dim>& rules) {
  patch.data_to_surface = patch.surface_to_data = rounded_up(rules.limit + rules.snap.slack());
}

namespace {

constexpr double kCertain = 1.0 - 1e-4;  ///< Of the limit: bounds that pass it are not trusted to decide as fit_flat does.

/// The plane clipped to the cell, if fit_flat would try it.
template <int Dim>
ConvexRegion<Dim - 1> clipped_plane(const Moments<Dim>& moments, const Frame<Dim>& frame, const Cell<Dim>& cell, const FitRules<Dim>& rules) {
  auto region = clip_to_box(frame, cell.box(rules.snap.step()));
  double most = static_cast<double>(moments.count) * most_for_each<Dim - 1>(rules.limit, false);
  if (region.count > Patch<Dim>::kMaxVertices || region.measure() > most) region.count = 0;
  if (!(frame.variance[Dim - 2] > kThin * kThin * rules.limit * rules.limit)) region.count = 0;  // Of lower rank, perhaps.
  return region;
}

template <int Dim>
double farthest_corner(const Patch<Dim>& from, const Patch<Dim>& to) {
  double most = 0.0;  // Of a convex function, in a corner.
  for (const Vec<Dim>& corner : from.corners()) most = std::max(most, distance(to, corner));
  return most;
}

}  // namespace

template <int Dim>
std::optional<std::pair<Patch<Dim>, Standing<Dim>>> advance(const Patch<Dim>& patch, const Standing<Dim>& standing, std::span<const Site<Dim>> added,
                                                            const Cell<Dim>& cell, const FitRules<Dim>& rules) {
  Standing<Dim> next = standing;
  next.moments.add(moments<Dim>(added, cell.low, cell.bits));
  const Frame<Dim> frame = principal_frame(next.moments, rules.snap.step());
  const auto region = clipped_plane(next.moments, frame, cell, rules);
  if (region.count == 0) return std::nullopt;
  Patch<Dim> moved = make_patch(region, Errors{0.0, 0.0}, frame, rules.snap);
  set_limit_bounds(moved, rules);
  next.data += farthest_corner(patch, moved);
  next.surface += farthest_corner(moved, patch);
  for (const Site<Dim>& site : added) next.data = std::max(next.data, distance(moved, rules.snap.world(rules.snap.local(site))));
  if (std::max(next.data, next.surface) > kCertain * rules.limit) return std::nullopt;
  return std::pair{moved, next};
}

template <int Dim>
std::optional<Patch<Dim>> fit_chord(std::span<const Site<Dim>> sites, const FitRules<Dim>& rules, double thin) {
  thread_local Feet<1> feet;
  feet.clear();
  std::array<std::size_t, Dim> first{}, last{};
  for (std::size_t i = 1; i < sites.size(); ++i)
    for (int a = 0; a < Dim; ++a) {
      if (sites[i][a] < sites[first[a]][a]) first[a] = i;
      if (sites[i][a] > sites[last[a]][a]) last[a] = i;
    }
  int axis = 0;
  for (int a = 1; a < Dim; ++a)
    if (sites[last[a]][a] - sites[first[a]][a] > sites[last[axis]][axis] - sites[first[axis]][axis]) axis = a;
  const Vec<Dim> from = rules.snap.local(sites[first[axis]]), way = rules.snap.local(sites[last[axis]]) - from;
  const double length = way.norm();
  if (!(length > thin)) return std::nullopt;
  const Vec<Dim> along = way / length;
  double data2 = 0.0;
  for (const Site<Dim>& site : sites) {
    const Vec<Dim> p = rules.snap.local(site) - from;
    const double at = p.dot(along), height2 = std::max(0.0, p.squaredNorm() - at * at), beyond = std::max({0.0, -at, at - length});
    data2 = std::max(data2, height2 + beyond * beyond);
    if (data2 > thin * thin) return std::nullopt;
    feet.at[0].push_back(at);
    feet.height2.push_back(height2);
  }
  using Place = ConvexRegion<1>::Place;
  const double apart = rules.spacing != nullptr ? rules.spacing->on_line(sites, from + 0.5 * way, along) : 0.0;
  const double limit = std::max(rules.limit, apart);
  const CoverRadius<1> covering = cover<1>(ConvexRegion<1>::box(Place(0.0), Place(length)), feet, limit, {rules.sharp ? 0.0 : 1.0, nullptr});
  if (!covering.radius) return std::nullopt;
  Patch<Dim> patch = segment_patch<Dim>(rules.snap.world(from), rules.snap.world(from + way));
  patch.data_to_surface = rounded_up(std::sqrt(data2) + rules.snap.slack());
  patch.surface_to_data = rounded_up(*covering.radius + rules.snap.slack());
  return patch;
}

template <int Dim>
Patch<Dim> force_plane(std::span<const Site<Dim>> sites, const Frame<Dim>& frame, const FitRules<Dim>& rules) {
  thread_local Projected<Dim> points;
  points.set(sites, frame, rules.snap);
  const Feet<Dim - 1>& data = feet<Dim - 1>(points);
  auto region = in_bounding_box<Dim>(sites, data, frame, rules.snap);
  if (region.count == 0 || region.count > Patch<Dim>::kMaxVertices) region = outline(data);
  return make_patch(region, *Attempts<Dim - 1>(data, {kInfinity, kInfinity}, true, true).errors(region), frame, rules.snap);
}

template <int Dim>
Patch<Dim> pair_patch(const Site<Dim>& a, const Site<Dim>& b, const Snap<Dim>& snap) {
  Patch<Dim> patch = segment_patch<Dim>(snap.world(snap.local(a)), snap.world(snap.local(b)));
  patch.data_to_surface = rounded_up(snap.slack());
  patch.surface_to_data = rounded_up(0.5 * (snap.local(a) - snap.local(b)).norm() + snap.slack());
  return patch;
}

template <int Dim>
Patch<Dim> loose_patch(const Site<Dim>& site, const FitRules<Dim>& rules) {
  Patch<Dim> patch = point_patch(rules.snap.world(rules.snap.local(site)));
  patch.data_to_surface = patch.surface_to_data = rounded_up(rules.snap.slack());
  return patch;
}

#define VANTAGE_INSTANTIATE(D)                                                                                                                       \
  template std::optional<Patch<D>> fit_flat<D>(std::span<const Site<D>>, const Frame<D>&, const FitRules<D>&, const Cell<D>*, int, FlatReport<D>*);  \
  template std::optional<std::pair<Patch<D>, Standing<D>>> advance<D>(const Patch<D>&, const Standing<D>&, std::span<const Site<D>>, const Cell<D>&, \
                                                                      const FitRules<D>&);                                                           \
  template void set_limit_bounds<D>(Patch<D>&, const FitRules<D>&);                                                                                  \
  template std::optional<Patch<D>> fit_chord<D>(std::span<const Site<D>>, const FitRules<D>&, double);                                               \
  template Patch<D> force_plane<D>(std::span<const Site<D>>, const Frame<D>&, const FitRules<D>&);                                                   \
  template Patch<D> pair_patch<D>(const Site<D>&, const Site<D>&, const Snap<D>&);                                                                   \
  template Patch<D> loose_patch<D>(const Site<D>&, const FitRules<D>&);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage

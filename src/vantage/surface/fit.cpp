// SPDX-License-Identifier: Apache-2.0
#include "vantage/surface/fit.h"

#include <algorithm>
#include <cmath>

#include "vantage/geometry/hausdorff.h"
#include "vantage/surface/cluster.h"

namespace vantage {
namespace {

/// Points with an extent below this share of the limit have none in that axis.
constexpr double kThin = 0.5;
/// So many sites are asked whether they hang together, in quadratic time.
constexpr std::size_t kFewSites = 128;

float rounded_up(double value) {
  const float near = static_cast<float>(value);
  return static_cast<double>(near) >= value ? near : std::nextafter(near, std::numeric_limits<float>::infinity());
}

/// Sites in the coordinates of a frame.
template <int Dim>
struct Projected {
  std::array<std::vector<double>, Dim> at;
  Vec<Dim> low = Vec<Dim>::Constant(kInfinity), high = -low;

  Projected(std::span<const Site<Dim>> sites, const Frame<Dim>& frame, const Snap<Dim>& snap) {
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
Feet<Rank> feet(const Projected<Dim>& points) {
  Feet<Rank> out;
  for (int a = 0; a < Rank; ++a) out.at[a] = points.at[a];
  out.height2.assign(points.size(), 0.0);
  for (int a = Rank; a < Dim; ++a)
    for (std::size_t i = 0; i < points.size(); ++i) out.height2[i] += points.at[a][i] * points.at[a][i];
  return out;
}

/// Largest distance of the points to the region: closed form.
template <int Rank>
double farthest_point(const ConvexRegion<Rank>& region, const Feet<Rank>& points) {
  double largest2 = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    typename ConvexRegion<Rank>::Place foot;
    for (int a = 0; a < Rank; ++a) foot[a] = points.at[a][i];
    largest2 = std::max(largest2, points.height2[i] + (region.closest(foot) - foot).squaredNorm());
  }
  return std::sqrt(largest2);
}

struct Errors {
  double data_to_surface, surface_to_data;
};

/// Both one-sided errors, if they are within the limit.
template <int Rank>
std::optional<Errors> errors_within(const ConvexRegion<Rank>& region, const Feet<Rank>& points, double limit) {
  if (region.count == 0) return std::nullopt;
  const double data = farthest_point(region, points);
  if (data > limit) return std::nullopt;
  const auto surface = covering_radius(region, points, limit);
  if (!surface) return std::nullopt;
  return Errors{data, *surface};
}

template <int Dim, int Rank>
Patch<Dim> make_patch(const ConvexRegion<Rank>& region, const Errors& errors, const Frame<Dim>& frame, const Snap<Dim>& snap) {
  Patch<Dim> patch;
  for (int i = 0; i < region.count; ++i)
    patch.vertices[patch.count++] = snap.world(frame.origin + frame.axes.template leftCols<Rank>() * region.vertices[i]);
  patch.data_to_surface = rounded_up(errors.data_to_surface + snap.slack());
  patch.surface_to_data = rounded_up(errors.surface_to_data + snap.slack());
  return patch;
}

/// The plane in the whole cell: enough points to cover it with discs?
template <int Dim>
bool coverable(const ConvexRegion<Dim - 1>& region, std::size_t count, double limit) {
  constexpr double kBall[] = {1.0, 2.0, kPi};
  double disc = kBall[Dim - 1];
  for (int a = 0; a < Dim - 1; ++a) disc *= limit;
  return region.measure() <= static_cast<double>(count) * disc;
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

template <int Dim, int Rank>
std::optional<Patch<Dim>> fit_rank(std::span<const Site<Dim>> sites, const Projected<Dim>& points, const Frame<Dim>& frame,
                                   const FitRules<Dim>& rules, const Cell<Dim>* cell) {
  const Feet<Rank> data = feet<Rank>(points);
  for (const double height2 : data.height2)
    if (height2 > rules.limit * rules.limit) return std::nullopt;
  const auto attempt = [&](const ConvexRegion<Rank>& region) -> std::optional<Patch<Dim>> {
    if (region.count > Patch<Dim>::kMaxVertices) return std::nullopt;
    const auto errors = errors_within(region, data, rules.limit);
    if (!errors) return std::nullopt;
    return make_patch(region, *errors, frame, rules.snap);
  };
  std::optional<Patch<Dim>> patch;
  if constexpr (Rank == Dim - 1) {
    if (cell != nullptr) {
      const auto region = clip_to_box(frame, cell->box(rules.snap.step()));
      if (coverable<Dim>(region, data.size(), rules.limit)) patch = attempt(region);
    }
    if (!patch) patch = attempt(in_bounding_box<Dim>(sites, data, frame, rules.snap));
  }
  if (!patch && !rules.paper) patch = attempt(outline(data));
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

template <int Dim>
std::vector<std::uint32_t> all_of(std::span<const Site<Dim>> sites) {
  std::vector<std::uint32_t> all(sites.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint32_t>(i);
  return all;
}

template <int Dim>
Frame<Dim> frame_of(std::span<const Site<Dim>> sites, const Cell<Dim>& cell, const FitRules<Dim>& rules) {
  return principal_frame<Dim>(moments<Dim>(sites, cell.low, cell.bits), rules.snap.step());
}

/// Each cluster its own patch.
template <int Dim>
std::optional<CellFit<Dim>> fit_clusters(const Clusters<Dim>& clusters, const Cell<Dim>& cell, const FitRules<Dim>& rules) {
  CellFit<Dim> fit;
  for (const std::vector<Site<Dim>>& cluster : clusters) {
    if (rules.paper && static_cast<std::int64_t>(cluster.size()) < rules.min_points) return std::nullopt;
    const auto patch = fit_flat<Dim>(cluster, frame_of<Dim>(cluster, cell, rules), rules, nullptr);
    if (!patch) return std::nullopt;
    fit.patches.push_back(*patch);
  }
  return fit;
}

}  // namespace

template <int Dim>
std::optional<Patch<Dim>> fit_flat(std::span<const Site<Dim>> sites, const Frame<Dim>& frame, const FitRules<Dim>& rules, const Cell<Dim>* cell) {
  const Projected<Dim> points(sites, frame, rules.snap);
  const int rank = rules.paper ? Dim - 1 : points.rank(kThin * rules.limit);
  switch (rank) {
    case 0: return fit_point<Dim>(sites, frame, rules);
    case 1: return fit_rank<Dim, 1>(sites, points, frame, rules, cell);
    default: return fit_rank<Dim, Dim - 1>(sites, points, frame, rules, cell);
  }
}

template <int Dim>
std::optional<CellFit<Dim>> fit_cell(GatheredSites<Dim>& sites, const Moments<Dim>& moments, const Cell<Dim>& cell, const FitRules<Dim>& rules) {
  const bool few = sites.size() <= kFewSites;
  if (few) {
    Clusters<Dim> clusters;
    const int parts = connected_parts<Dim>(sites.all(), rules.snap, 2.0 * rules.limit * (1.0 + 1e-9), clusters);
    if (parts >= 3) return std::nullopt;
    if (parts == 2) return fit_clusters<Dim>(clusters, cell, rules);
  }
  const Frame<Dim> frame = principal_frame(moments, rules.snap.step());
  const bool too_thick = frame.variance[Dim - 1] > rules.limit * rules.limit;  // The largest distance to the plane is at least the mean square's.
  if (!too_thick && (few || !shows_hole<Dim>(spread_sample<Dim>(sites.view(), cell), sites.view(), cell, frame, rules.snap, rules.limit)))
    if (const auto one = fit_flat<Dim>(sites.all(), frame, rules, &cell)) return CellFit<Dim>{{*one}, {}};
  for (int axis = 0; axis < Dim; ++axis)
    if (frame.variance[axis] > kThin * kThin * rules.limit * rules.limit)
      if (const auto clusters = two_clusters<Dim>(sites, cell, rules, frame, axis))
        if (auto fit = fit_clusters<Dim>(*clusters, cell, rules)) return fit;
  return std::nullopt;
}

template <int Dim>
CellFit<Dim> fit_at_limit(std::span<const Site<Dim>> sites, const Cell<Dim>& cell, const FitRules<Dim>& rules) {
  const Frame<Dim> frame = frame_of<Dim>(sites, cell, rules);
  if (rules.paper) {
    const Projected<Dim> points(sites, frame, rules.snap);
    const auto data = feet<Dim - 1>(points);
    auto region = in_bounding_box<Dim>(sites, data, frame, rules.snap);
    if (region.count == 0 || region.count > Patch<Dim>::kMaxVertices) region = outline(data);
    return {{make_patch(region, *errors_within(region, data, kInfinity), frame, rules.snap)}, {}};
  }
  CellFit<Dim> fit;
  std::vector<Site<Dim>> carried;
  for (std::uint32_t i = 0; i < sites.size(); ++i) {
    const bool on_plane = std::abs(frame.local(rules.snap.local(sites[i]))[Dim - 1]) <= rules.limit;
    if (on_plane) carried.push_back(sites[i]);
    if (!on_plane) fit.loose.push_back(i);
  }
  if (static_cast<std::int64_t>(carried.size()) >= rules.min_points)
    if (const auto patch = fit_flat<Dim>(carried, frame, rules, nullptr)) {
      fit.patches.push_back(*patch);
      return fit;
    }
  return {{}, all_of<Dim>(sites)};
}

template <int Dim>
Patch<Dim> loose_patch(const Site<Dim>& site, const FitRules<Dim>& rules) {
  Patch<Dim> patch = point_patch(rules.snap.world(rules.snap.local(site)));
  patch.data_to_surface = patch.surface_to_data = rounded_up(rules.snap.slack());
  return patch;
}

#define VANTAGE_INSTANTIATE(D)                                                                                                 \
  template std::optional<Patch<D>> fit_flat<D>(std::span<const Site<D>>, const Frame<D>&, const FitRules<D>&, const Cell<D>*); \
  template std::optional<CellFit<D>> fit_cell<D>(GatheredSites<D>&, const Moments<D>&, const Cell<D>&, const FitRules<D>&);    \
  template CellFit<D> fit_at_limit<D>(std::span<const Site<D>>, const Cell<D>&, const FitRules<D>&);                           \
  template Patch<D> loose_patch<D>(const Site<D>&, const FitRules<D>&);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage

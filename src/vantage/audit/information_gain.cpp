// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/information_gain.h"

#include <algorithm>
#include <cmath>

#include "vantage/base/error.h"
#ifdef VANTAGE_OCTOMAP
#include <octomap/OcTree.h>

#include "vantage/base/parallel.h"
#include "vantage/planner/ray_march.h"
#endif

namespace vantage {

#ifdef VANTAGE_OCTOMAP
namespace {

constexpr std::size_t kPlacesAtATime = 4;  // A worker's; each has a buffer of its own for the voxels of a ray.

/// Length of the ray inside the box.
template <int Dim>
double length_in(const Box<Dim>& box, const Vec<Dim>& from, const Vec<Dim>& direction, double length) {
  for (int a = 0; a < Dim; ++a) {
    const double to = direction[a] > 0.0 ? box.high[a] : box.low[a];
    if (direction[a] != 0.0) length = std::min(length, std::max(0.0, (to - from[a]) / direction[a]));
  }
  return length;
}

}  // namespace

bool has_octomap() { return true; }

template <int Dim>
  requires SpatialDim<Dim>
struct InformationGain<Dim>::Map {
  Sensor<Dim>& sensor;
  Box<Dim> domain;
  Options options;
  octomap::OcTree tree{options.voxel};
  double range = 0.0;

  Map(Sensor<Dim>& s, const Box<Dim>& d, const Options& o) : sensor(s), domain(d), options(o) {}

  /// Nodes are the middles of voxels; 2D is the layer above z = 0.
  [[nodiscard]] octomap::point3d narrow(const Vec<Dim>& p) const {
    octomap::point3d q;
    for (unsigned a = 0; a < 3; ++a) q(a) = static_cast<float>((a < Dim ? p[a] : 0.0) + 0.5 * options.voxel);
    return q;
  }

  void insert(const Scan<Dim>& scan) {
    range = scan.pattern.max_range;
    const std::vector<Vec<Dim>> rays = directions<Dim>(scan.pattern);
    octomap::Pointcloud points;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (std::isnan(scan.ranges[i])) continue;
      const double length = scan.ranges[i] == kNoReturn ? 2.0 * range : static_cast<double>(scan.ranges[i]);  // Beyond the range: no end.
      points.push_back(narrow(scan.origin + length * (scan.world_from_sensor * rays[i])));
    }
    tree.insertPointCloud(points, narrow(scan.origin), 1.001 * range);
  }

  /// Unknown voxels along one ray.
  [[nodiscard]] std::int64_t unknown(const Vec<Dim>& from, const Vec<Dim>& direction, octomap::KeyRay& voxels) const {
    const octomap::point3d end = narrow(from + length_in(domain, from, direction, range) * direction);
    octomap::OcTreeKey last;
    if (!tree.coordToKeyChecked(end, last) || !tree.computeRayKeys(narrow(from), end, voxels)) return 0;
    voxels.addKey(last);  // OctoMap leaves it out.
    std::int64_t count = 0;
    for (const octomap::OcTreeKey& key : voxels) {
      const octomap::OcTreeNode* node = tree.search(key);
      if (node != nullptr && tree.isNodeOccupied(node)) break;
      count += node == nullptr ? 1 : 0;
    }
    return count;
  }
};

template <int Dim>
  requires SpatialDim<Dim>
InformationGain<Dim>::InformationGain(Sensor<Dim>& sensor, const Box<Dim>& domain, const Options& options)
    : map_(std::make_unique<Map>(sensor, domain, options)) {}

template <int Dim>
  requires SpatialDim<Dim>
Scan<Dim> InformationGain<Dim>::scan(const Vec<Dim>& vantage_point, int index) {
  Scan<Dim> scan = map_->sensor.scan(vantage_point, index);
  map_->insert(scan);
  return scan;
}

template <int Dim>
  requires SpatialDim<Dim>
std::vector<std::int64_t> InformationGain<Dim>::gains(std::span<const Vec<Dim>> places) const {
  const std::vector<Vec<Dim>> rays = spread_directions<Dim>(rays_in<Dim>(map_->options.rays), 1);
  std::vector<std::int64_t> gains(places.size());
  parallel_chunks(places.size(), kPlacesAtATime, [&](std::size_t begin, std::size_t end) {
    octomap::KeyRay voxels;
    for (std::size_t i = begin; i < end; ++i)
      for (const Vec<Dim>& direction : rays) gains[i] += map_->unknown(places[i], direction, voxels);
  });
  return gains;
}
#else
bool has_octomap() { return false; }

template <int Dim>
  requires SpatialDim<Dim>
struct InformationGain<Dim>::Map {};

template <int Dim>
  requires SpatialDim<Dim>
InformationGain<Dim>::InformationGain(Sensor<Dim>& /*sensor*/, const Box<Dim>& /*domain*/, const Options& /*options*/) {
  throw Error(ErrorCode::bad_input, "this build has no OctoMap (liboctomap-dev)");
}

template <int Dim>
  requires SpatialDim<Dim>
Scan<Dim> InformationGain<Dim>::scan(const Vec<Dim>& /*vantage_point*/, int /*index*/) {
  return {};
}

template <int Dim>
  requires SpatialDim<Dim>
std::vector<std::int64_t> InformationGain<Dim>::gains(std::span<const Vec<Dim>> places) const {
  return std::vector<std::int64_t>(places.size());
}
#endif

template <int Dim>
  requires SpatialDim<Dim>
InformationGain<Dim>::~InformationGain() = default;

template <int Dim>
  requires SpatialDim<Dim>
std::optional<Vec<Dim>> InformationGain<Dim>::next(const Explorer<Dim>& explorer) {
  const Field<Dim> metric = explorer.metric();
  std::vector<Vec<Dim>> places;
  for (std::size_t i = 0; i < metric.values.size(); ++i)
    if (!std::isnan(metric[i]) && explorer.reachable()[i] != 0) places.push_back(metric.window.position(i));
  const std::vector<std::int64_t> gained = gains(places);
  const auto most = std::max_element(gained.begin(), gained.end());
  if (most == gained.end() || *most == 0) return std::nullopt;
  return places[static_cast<std::size_t>(most - gained.begin())];
}

template class InformationGain<2>;
template class InformationGain<3>;

}  // namespace vantage

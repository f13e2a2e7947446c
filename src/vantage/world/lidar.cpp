// SPDX-License-Identifier: Apache-2.0
#include "vantage/world/lidar.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/base/random.h"
#include "vantage/geometry/ray_caster.h"
#include "vantage/world/inside_solid.h"

namespace vantage {
namespace {

constexpr double kTouching = 1e-3;  ///< Nearest that a scanner may stand to a surface [m].

template <int Dim>
std::string text(const Vec<Dim>& p) {
  return fmt::format("({:.4g})", fmt::join(p.data(), p.data() + Dim, ", "));
}

/// What the scanner reports for a ray whose true range is `range` [m], infinity for none.
float measure(double range, const LidarOptions& options, Random random) {
  if (options.dropout > 0.0 && random.uniform() < options.dropout) return kNoData;
  if (range == kInfinity) return kNoReturn;
  if (range < options.pattern.min_range) return kNoData;
  const double low = options.pattern.min_range, high = options.pattern.max_range;
  if (options.outliers > 0.0 && random.uniform() < options.outliers) return static_cast<float>(random.uniform(low, range));
  if (options.range_noise > 0.0) range = std::min(range + options.range_noise * random.normal(), high);
  return range < std::max(low, kTouching) ? kNoData : static_cast<float>(range);
}

}  // namespace

void describe(LidarOptions& o, const OptionVisitor& visit) {
  describe(o.pattern, visit);
  visit("range_noise", o.range_noise, "m", Range{0.0, 100.0}, "standard deviation of the range");
  visit("dropout", o.dropout, "1", Range{0.0, 1.0}, "share of the rays that give no data");
  visit("outliers", o.outliers, "1", Range{0.0, 1.0}, "share of the hits put at a random shorter range");
  visit("seed", o.seed, "", Range{0.0, 9.0e15}, "of noise, drop-out and outliers");
}

template <int Dim>
  requires SpatialDim<Dim>
struct SimulatedLidar<Dim>::Impl {
  Impl(const Mesh<Dim>& world, const LidarOptions& lidar) : caster(world), options(lidar) {
    check_options(options, "scan");
    require(options.pattern.min_range < options.pattern.max_range,
            fmt::format("scan.min_range = {}: must be below scan.range = {} [m]", options.pattern.min_range, options.pattern.max_range));
    rays = directions<Dim>(options.pattern);
  }
  /// Throws bad_input where nobody could put a scanner.
  void check_place(const Vec<Dim>& p) const {
    require(p.allFinite(), fmt::format("vantage point {}: must be finite", text<Dim>(p)));
    const double gap = caster.distance(p, kTouching);
    require(gap >= kTouching, fmt::format("vantage point {}: {:.2g} m from a surface, must be at least {} m", text<Dim>(p), gap, kTouching));
    require(!inside_solid<Dim>(caster, p), fmt::format("vantage point {}: inside an obstacle", text<Dim>(p)));
  }

  RayCaster<Dim> caster;
  LidarOptions options;
  std::vector<Vec<Dim>> rays;  ///< In the sensor's frame, which is the world's.
};

template <int Dim>
  requires SpatialDim<Dim>
SimulatedLidar<Dim>::SimulatedLidar(const Mesh<Dim>& world, const LidarOptions& options) : impl_(std::make_unique<Impl>(world, options)) {}

template <int Dim>
  requires SpatialDim<Dim>
SimulatedLidar<Dim>::~SimulatedLidar() = default;

template <int Dim>
  requires SpatialDim<Dim>
Scan<Dim> SimulatedLidar<Dim>::scan(const Vec<Dim>& vantage_point, int index) {
  impl_->check_place(vantage_point);
  Scan<Dim> scan;
  scan.origin = vantage_point;
  scan.pattern = impl_->options.pattern;
  scan.ranges.resize(impl_->rays.size());
  parallel_for(impl_->rays.size(), 1024, [&](std::size_t i) {
    const double range = impl_->caster.cast(vantage_point, impl_->rays[i], scan.pattern.max_range).range;
    const std::uint64_t stream = (static_cast<std::uint64_t>(static_cast<std::uint32_t>(index)) << 32) + i;
    scan.ranges[i] = measure(range, impl_->options, Random(static_cast<std::uint64_t>(impl_->options.seed), stream));
  });
  return scan;
}

template class SimulatedLidar<2>;
template class SimulatedLidar<3>;

}  // namespace vantage

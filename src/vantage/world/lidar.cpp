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
#include "vantage/geometry/angle.h"
#include "vantage/geometry/ray_caster.h"
#include "vantage/scan/confirm.h"
#include "vantage/scan/smooth.h"
#include "vantage/world/inside_solid.h"

namespace vantage {
namespace {

constexpr double kTouching = 1e-3;  ///< Nearest that a scanner may stand to a surface [m].
constexpr int kWaysOut = 64;        ///< Directions in which the nearest open place is looked for.

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

/// Turns by an angle in each of the planes that two axes span.
template <int Dim>
Eigen::Matrix<double, Dim, Dim> random_turn(double deviation, Random& random) {
  Eigen::Matrix<double, Dim, Dim> turn = Eigen::Matrix<double, Dim, Dim>::Identity();
  for (int a = 0; a < Dim; ++a)
    for (int b = a + 1; b < Dim; ++b) {
      const auto [s, c] = sin_cos(deviation * random.normal());
      Eigen::Matrix<double, Dim, Dim> plane = Eigen::Matrix<double, Dim, Dim>::Identity();
      plane(a, a) = plane(b, b) = c;
      plane(a, b) = -s;
      plane(b, a) = s;
      turn = turn * plane;
    }
  return turn;
}

/// Random numbers of a whole scan; its rays have the streams below.
Random random_of_scan(const LidarOptions& options, int index) {
  const std::uint64_t stream = (static_cast<std::uint64_t>(static_cast<std::uint32_t>(index)) << 32) + 0xffffffffU;
  return Random(static_cast<std::uint64_t>(options.seed), stream);
}

}  // namespace

void describe(LidarOptions& o, const OptionVisitor& visit) {
  describe(o.pattern, visit);
  visit("range_noise", o.range_noise, "m", Range{0.0, 100.0}, "standard deviation of the range");
  visit("dropout", o.dropout, "1", Range{0.0, 1.0}, "share of the rays that give no data");
  visit("outliers", o.outliers, "1", Range{0.0, 1.0}, "share of the hits put at a random shorter range");
  visit("pose_noise", o.pose_noise, "m", Range{0.0, 100.0}, "standard deviation of the place from the one it reports, along each axis");
  visit.angle("pose_noise_deg", o.pose_turn, Range{0.0, 45.0}, "standard deviation of the orientation from the one it reports, about each axis");
  visit("confirmed", o.confirmed, "hits that too few rays beside them confirm give no data: against outliers, and at the cost of wires");
  visit("smoothed", o.smoothed,
        "hits are put onto the planes of the hits around them: against range_noise, and at the cost of what is smaller than it");
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
    const double gap = caster.distance(p, kTouching);
    require(gap >= kTouching, fmt::format("vantage point {}: {:.2g} m from a surface, must be at least {} m", text<Dim>(p), gap, kTouching));
    require(!inside_solid<Dim>(caster, p), fmt::format("vantage point {}: inside an obstacle", text<Dim>(p)));
  }

  [[nodiscard]] bool open(const Vec<Dim>& p) const { return caster.distance(p, kTouching) >= kTouching && !inside_solid<Dim>(caster, p); }

  /// The nearest open place to p in some directions.
  [[nodiscard]] Vec<Dim> nearest_open(const Vec<Dim>& p, Random& random) const {
    Vec<Dim> nearest = p;
    double least = kInfinity;
    for (int way = 0; way < kWaysOut; ++way) {
      Vec<Dim> along;
      for (int a = 0; a < Dim; ++a) along[a] = random.normal();
      along.normalize();
      for (double t = 0.0; t < least;) {
        t += caster.cast(p + t * along, along, least - t).range + 2.0 * kTouching;
        if (!(t < least) || !open(p + t * along)) continue;
        least = t;
        nearest = p + t * along;
      }
    }
    return nearest;
  }

  /// Where the scanner stands when it says that it stands at `wanted`: in the open still, whatever the noise. A place after the first was chosen by
  /// a map that noise made wrong, and may lie in an obstacle: nobody gets in there.
  Vec<Dim> true_place(const Vec<Dim>& wanted, int index, Random& random) const {
    require(wanted.allFinite(), fmt::format("vantage point {}: must be finite", text<Dim>(wanted)));
    const bool misled = index > 0 && (options.pose_noise > 0.0 || options.pose_turn > 0.0 || options.range_noise > 0.0);
    const Vec<Dim> p = misled && !open(wanted) ? nearest_open(wanted, random) : wanted;
    check_place(p);
    if (!(options.pose_noise > 0.0)) return p;
    Vec<Dim> off;
    for (int a = 0; a < Dim; ++a) off[a] = options.pose_noise * random.normal();
    for (int halvings = 0; halvings < 20; ++halvings, off *= 0.5) {
      const double length = off.norm();
      const bool free = !(length > 0.0) || caster.cast(p, off / length, length + kTouching).range == kInfinity;
      if (free && caster.distance(p + off, kTouching) >= kTouching) return p + off;
    }
    return p;
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
  Random random = random_of_scan(impl_->options, index);
  const Vec<Dim> place = impl_->true_place(vantage_point, index, random);
  Scan<Dim> scan;
  scan.origin = vantage_point;
  scan.pattern = impl_->options.pattern;
  scan.ranges.resize(impl_->rays.size());
  const bool turned = impl_->options.pose_turn > 0.0;
  const auto turn = random_turn<Dim>(impl_->options.pose_turn, random);
  parallel_for(impl_->rays.size(), 1024, [&](std::size_t i) {
    const Vec<Dim> ray = turned ? Vec<Dim>((turn * impl_->rays[i]).normalized()) : impl_->rays[i];
    const double range = impl_->caster.cast(place, ray, scan.pattern.max_range).range;
    const std::uint64_t stream = (static_cast<std::uint64_t>(static_cast<std::uint32_t>(index)) << 32) + i;
    scan.ranges[i] = measure(range, impl_->options, Random(static_cast<std::uint64_t>(impl_->options.seed), stream));
  });
  if (impl_->options.confirmed) (void)drop_unconfirmed(scan, impl_->options.range_noise);
  if (impl_->options.smoothed) (void)put_on_planes(scan, impl_->options.range_noise);
  return scan;
}

template class SimulatedLidar<2>;
template class SimulatedLidar<3>;

}  // namespace vantage

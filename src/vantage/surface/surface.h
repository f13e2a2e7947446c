// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "vantage/base/options.h"
#include "vantage/geometry/patch.h"

namespace vantage {

/// Hausdorff tree (paper Sec. IV, after DeVore et al. [5]).
struct SurfaceOptions {
  double eta = 0.1;             ///< Hausdorff tolerance of a fit [m].
  std::int64_t min_points = 0;  ///< Fewest points in a fitted cell; 0 means Dim + 2, the paper's five in 3D.
  std::int64_t max_depth = 14;  ///< Deepest cell; the root has depth 0.
  bool paper = false;           ///< The paper's own behaviour: small cells dropped, best fit kept at the depth limit.
  /// How far a place of a patch may be from the points: eta, or (ours) as far as the rays of the scans are apart there, if that is more.
  enum class Spacing { fixed, sensor } spacing = Spacing::fixed;
  double spacing_factor = 1.0;  ///< Times range * step / cos(incidence).
  double spacing_most = 1.0;    ///< Never farther than this [m].
  double quantise = 0.0;        ///< Points count as the centre of their cell of this side [m]; 0: as themselves. Bounds the memory by the surface.
};

void describe(SurfaceOptions& options, const OptionVisitor& visit);

/// By the names of the paper's Table I. A split makes all 2^Dim children, so leaves = (2^Dim - 1) * inner nodes + 1.
struct SurfaceStatistics {
  std::int64_t points = 0;      ///< Held by the tree.
  std::int64_t outside = 0;     ///< Left out: outside the domain of interest.
  std::int64_t not_finite = 0;  ///< Left out: NaN or infinite.
  int depth = 0;
  std::int64_t nodes = 0, leaves = 0;
  std::int64_t fits = 0;          ///< Polygons in 3D, segments in 2D.
  std::int64_t segments = 0;      ///< Rank-1 fits in 3D.
  std::int64_t loose_points = 0;  ///< Measured points kept as themselves, or one of several within eta of it.
  double eta = 0.0;               ///< [m]
  double quantise = 0.0;          ///< [m]
  std::int64_t beyond_eta = 0;    ///< Patches with places farther than eta from the points, as `spacing = sensor` allows.
  double data_to_surface = 0.0;   ///< Certified upper bound, all points [m].
  double surface_to_data = 0.0;   ///< Certified upper bound, all patches [m].
  [[nodiscard]] double certified() const { return data_to_surface > surface_to_data ? data_to_surface : surface_to_data; }
};

/// Where a scan was taken, and the angle between its rays.
template <int Dim>
struct SurfaceSensor {
  Vec<Dim> position;  ///< [m]
  double step = 0.0;  ///< [rad]
};

/// What an insertion changed.
template <int Dim>
struct SurfaceUpdate {
  std::int64_t points = 0;  ///< Accepted.
  Box<Dim> changed;         ///< Covers every patch that came or went.
};

/// Surfaces within eta of every measured point, kept up to date as scans arrive. The tree depends only on the set of points: not on their
/// order, the order of insertions, or the number of threads, bit for bit.
template <int Dim>
  requires SpatialDim<Dim>
class HausdorffTree {
 public:
  /// The domain of interest is the smallest cube that shares `domain`'s centre and covers it. Throws bad_input for a bad option or an empty box.
  HausdorffTree(const Box<Dim>& domain, const SurfaceOptions& options);
  ~HausdorffTree();
  HausdorffTree(HausdorffTree&&) noexcept;
  HausdorffTree& operator=(HausdorffTree&&) noexcept;

  /// Adds measured points, (N, Dim) [m] (Sec. IV-A with its slips mended). Cost follows the touched cells. With `spacing = sensor` the points are
  /// one scan's, and `sensor` must be given (bad_input); else it is not looked at.
  SurfaceUpdate<Dim> insert(std::span<const Vec<Dim>> points, const std::optional<SurfaceSensor<Dim>>& sensor = std::nullopt);
  /// Takes points out again, as if they had never been added. Points that are not there (with `spacing = sensor`: from that scan) are ignored.
  SurfaceUpdate<Dim> remove(std::span<const Vec<Dim>> points, const std::optional<SurfaceSensor<Dim>>& sensor = std::nullopt);

  /// All patches in the order of the cells (Morton), with bounds at most 10 % above the truth. These are worked out when asked for, here and
  /// by statistics(), for what has changed since: not from two threads at once.
  [[nodiscard]] std::vector<Patch<Dim>> patches() const;
  /// Those whose bounding boxes meet `box`, in the same order, with the bounds that need no work: eta. Cost follows the cells that meet it.
  [[nodiscard]] std::vector<Patch<Dim>> patches(const Box<Dim>& box) const;
  [[nodiscard]] SurfaceStatistics statistics() const;
  [[nodiscard]] const SurfaceOptions& options() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vantage

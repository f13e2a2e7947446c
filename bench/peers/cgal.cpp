// SPDX-License-Identifier: Apache-2.0
// CGAL 5: normals by PCA, then planes by region growing.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Shape_detection/Region_growing/Region_growing.h>
#include <CGAL/Shape_detection/Region_growing/Region_growing_on_point_set.h>
#include <CGAL/linear_least_squares_fitting_3.h>
#include <CGAL/pca_estimate_normals.h>
#include <CGAL/property_map.h>

#include <Eigen/Geometry>
#include <set>

#include "../contender.h"

namespace vantage::bench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Oriented = std::pair<Kernel::Point_3, Kernel::Vector_3>;
using Range = std::vector<Oriented>;
using PointMap = CGAL::First_of_pair_property_map<Oriented>;
using NormalMap = CGAL::Second_of_pair_property_map<Oriented>;
using Neighbours = CGAL::Shape_detection::Point_set::K_neighbor_query<Kernel, Range, PointMap>;
using PlaneRegion = CGAL::Shape_detection::Point_set::Least_squares_plane_fit_region<Kernel, Range, PointMap, NormalMap>;
using Growing = CGAL::Shape_detection::Region_growing<Range, Neighbours, PlaneRegion>;

constexpr std::size_t kNeighbours = 12;  ///< CGAL's default.
constexpr double kAngle = 25.0;          ///< CGAL's default [degrees].
constexpr std::size_t kFewest = 5;       ///< Points of a plane, as for ours in the paper.

class RegionGrowing final : public Contender {
 public:
  explicit RegionGrowing(double epsilon) : epsilon_(epsilon) {}

  void build(const Cloud& cloud, std::size_t scans) override {
    for (const Vec<3>& p : cloud.scans_before(scans)) range_.push_back({{p[0], p[1], p[2]}, {}});
    const auto parameters = CGAL::parameters::point_map(PointMap()).normal_map(NormalMap());
    CGAL::pca_estimate_normals<CGAL::Sequential_tag>(range_, kNeighbours, parameters);
    Neighbours neighbours(range_, kNeighbours);
    PlaneRegion region(range_, epsilon_, kAngle, kFewest);
    Growing growing(range_, neighbours, region);
    growing.detect(std::back_inserter(regions_));
  }
  /// A region's surface: of its plane, the squares of side 2 epsilon with a point's foot in them. (Its convex hull would close doors and streets.)
  Output output() override {
    Output out;
    for (const std::vector<std::size_t>& region : regions_) add_squares(region, out.soup);
    const std::size_t squares = out.soup.size() / 2;
    out.primitives = static_cast<std::int64_t>(regions_.size());
    out.kind = "planes with " + std::to_string(squares) + " squares; a plane counted as 9 floats, a square as two 16-bit numbers";
    out.bytes = 36.0 * static_cast<double>(regions_.size()) + 4.0 * static_cast<double>(squares);
    return out;
  }

 private:
  void add_squares(const std::vector<std::size_t>& region, Soup& soup) const {
    std::vector<Kernel::Point_3> points;
    for (const std::size_t i : region) points.push_back(range_[i].first);
    Kernel::Plane_3 plane;
    Kernel::Point_3 centroid;
    CGAL::linear_least_squares_fitting_3(points.begin(), points.end(), plane, centroid, CGAL::Dimension_tag<0>());
    const auto vec = [](const auto& v) { return Vec<3>(v.x(), v.y(), v.z()); };
    const Vec<3> normal = vec(plane.orthogonal_vector()).normalized(), origin = vec(centroid);
    const Vec<3> u = normal.unitOrthogonal(), v = normal.cross(u);
    const double side = 2.0 * epsilon_;
    std::set<std::pair<int, int>> squares;
    for (const Kernel::Point_3& p : points) {
      const Vec<3> d = vec(p) - origin;
      squares.emplace(static_cast<int>(std::floor(d.dot(u) / side)), static_cast<int>(std::floor(d.dot(v) / side)));
    }
    for (const auto& [i, j] : squares) {
      const Vec<3> a = origin + side * (i * u + j * v), b = a + side * u, c = b + side * v, d = a + side * v;
      add_polygon(soup, std::array{a, b, c, d});
    }
  }

  double epsilon_;
  Range range_;
  std::vector<std::vector<std::size_t>> regions_;
};

}  // namespace

std::vector<ContenderKind> cgal_contenders() {
  return {{"cgal",
           "CGAL region growing, ε {} m",
           "PCA normals and planes by region growing, 12 neighbours, 25 degrees, five points at least",
           {0.1},
           [](double epsilon) { return std::make_unique<RegionGrowing>(epsilon); }}};
}

}  // namespace vantage::bench

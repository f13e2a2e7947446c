// SPDX-License-Identifier: Apache-2.0
#include "vantage/visibility/visibility.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "vantage/base/parallel.h"
#include "vantage/visibility/depth_image.h"
#include "vantage/visibility/seen_from.h"

namespace vantage {
namespace {

template <class T>
class Visibility : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Visibility, Dimensions);

/// Range to a ball along a unit direction from the origin; infinity if missed.
template <int Dim>
double ball_range(const Vec<Dim>& direction, const Vec<Dim>& center, double radius) {
  const double along = direction.dot(center), off2 = center.squaredNorm() - along * along;
  return along > 0.0 && off2 < radius * radius ? along - std::sqrt(radius * radius - off2) : kInfinity;
}

template <int Dim>
Vec<Dim> ball_center() {
  Vec<Dim> c = Vec<Dim>::Zero();
  c[0] = 4.0;
  c[1] = 1.0;
  return c;
}
constexpr double kRadius = 1.0;

/// Scan from the origin of one ball in empty space.
template <int Dim>
Scan<Dim> scan_of_ball(double step_deg = 0.5) {
  Scan<Dim> scan;
  scan.pattern.step = radians(step_deg);
  scan.pattern.max_range = 9.0;
  for (const Vec<Dim>& d : directions<Dim>(scan.pattern)) {
    const double range = ball_range<Dim>(d, ball_center<Dim>(), kRadius);
    scan.ranges.push_back(range <= scan.pattern.max_range ? static_cast<float>(range) : kNoReturn);
  }
  return scan;
}

template <int Dim>
Grid<Dim> window_around_origin(double half_side, double h) {
  return window_over(Box<Dim>{Vec<Dim>::Constant(-half_side), Vec<Dim>::Constant(half_side)}, h);
}

template <int Dim>
std::vector<Patch<Dim>> points_of(const Scan<Dim>& scan) {
  std::vector<Patch<Dim>> patches;
  for (const Vec<Dim>& p : hit_points(scan)) patches.push_back(point_patch<Dim>(p));
  return patches;
}

TYPED_TEST(Visibility, ShadowOfABall) {
  constexpr int Dim = TypeParam::value;
  const Scan<Dim> scan = scan_of_ball<Dim>();
  const std::vector<Patch<Dim>> patches = points_of(scan);
  const Field<Dim> phi = visibility<Dim>(patches, scan, window_around_origin<Dim>(7.0, 0.25), 0.02);
  int seen = 0, hidden = 0, wrongly_hidden = 0;
  for (std::size_t i = 0; i < phi.values.size(); ++i) {
    const Vec<Dim> p = phi.window.position(i);
    const double range = p.norm();
    if (range == 0.0) continue;
    const bool truth = range <= scan.pattern.max_range && range < ball_range<Dim>(p / range, ball_center<Dim>(), kRadius);
    if (truth)
      ++seen;
    else
      ++hidden;
    // Nothing behind the ball or out of range is ever called seen, but for the finite width of a ray at its rim.
    const bool well_inside_shadow =
        !truth && (range > scan.pattern.max_range || ball_range<Dim>(p / range, ball_center<Dim>(), 0.97 * kRadius) < range);
    if (well_inside_shadow) {
      ASSERT_LE(phi[i], 0.0F) << p.transpose();
    }
    if (truth && phi[i] <= 0.0F) ++wrongly_hidden;
  }
  EXPECT_GT(hidden, 0);
  EXPECT_LT(wrongly_hidden, 0.01 * seen);  // Beside the rim only.
}

TYPED_TEST(Visibility, MagnitudeIsTheDistanceLessEta) {
  constexpr int Dim = TypeParam::value;
  const std::vector<Patch<Dim>> patches{point_patch<Dim>(ball_center<Dim>())};
  const Field<Dim> phi = visibility<Dim>(patches, scan_of_ball<Dim>(2.0), window_around_origin<Dim>(5.0, 0.5), 0.3);
  for (std::size_t i = 0; i < phi.values.size(); ++i)
    ASSERT_NEAR(std::abs(phi[i]), std::max(0.0, (phi.window.position(i) - ball_center<Dim>()).norm() - 0.3), 1e-5);
}

TYPED_TEST(Visibility, NoDataShowsNothingAndNoReturnIsFree) {
  constexpr int Dim = TypeParam::value;
  Scan<Dim> scan = scan_of_ball<Dim>(2.0);
  const Grid<Dim> window = window_around_origin<Dim>(5.0, 0.5);
  std::fill(scan.ranges.begin(), scan.ranges.end(), kNoData);
  const Field<Dim> dark = visibility<Dim>({}, scan, window, 0.1);
  std::fill(scan.ranges.begin(), scan.ranges.end(), kNoReturn);
  const Field<Dim> clear = visibility<Dim>({}, scan, window, 0.1);
  for (std::size_t i = 0; i < dark.values.size(); ++i) {
    const double range = window.position(i).norm();
    EXPECT_EQ(dark[i] > 0.0F, range == 0.0);
    if (range < 4.9) {
      EXPECT_GT(clear[i], 0.0F);
    }
  }
}

TYPED_TEST(Visibility, FieldOfViewEndsWhereThePatternEnds) {
  constexpr int Dim = TypeParam::value;
  Scan<Dim> scan;
  scan.pattern.step = radians(1.0);
  scan.pattern.horizontal_fov = radians(90.0);
  scan.ranges.assign(directions<Dim>(scan.pattern).size(), kNoReturn);
  const Field<Dim> phi = visibility<Dim>({}, scan, window_around_origin<Dim>(5.0, 0.5), 0.1);
  Vec<Dim> ahead = Vec<Dim>::Zero(), behind = ahead, beside = ahead;
  ahead[0] = 3.0;
  behind[0] = -3.0;
  beside[1] = 3.0;
  const auto at = [&](const Vec<Dim>& p) { return phi.at(phi.window.nearest(p)); };
  EXPECT_GT(at(ahead), 0.0F);
  EXPECT_LE(at(behind), 0.0F);
  EXPECT_LE(at(beside), 0.0F);
}

/// Oracle: every pixel of the depth image against every patch.
TYPED_TEST(Visibility, DepthImageEqualsAskingEveryPatch) {
  constexpr int Dim = TypeParam::value;
  std::vector<Patch<Dim>> patches = points_of(scan_of_ball<Dim>(6.0));
  for (std::size_t i = 0; i + 1 < patches.size(); i += 3) patches[i] = segment_patch<Dim>(patches[i].vertices[0], patches[i + 1].vertices[0]);
  const Vec<Dim> origin = Vec<Dim>::Constant(0.3);
  DepthImage<Dim> image(64, 50.0F);
  draw_patches<Dim>(image, patches, origin, 0.05, 0.02);
  for (std::size_t p = 0; p < image.size(); ++p) {
    const Vec<Dim> u = image.direction(p);
    ASSERT_EQ(image.pixel(u), p);
    double nearest = 50.0;
    for (const Patch<Dim>& patch : patches) {
      Vec<Dim> center = Vec<Dim>::Zero();
      for (const Vec<Dim>& v : patch.corners()) center += (v - origin) / patch.count;
      const double margin = 0.05 + std::max(0.0, center.dot(u)) * std::tan(0.01);
      nearest = std::min(nearest, ray_range<Dim>(patch, origin, u, margin).value_or(kInfinity));
    }
    ASSERT_NEAR(image[p], nearest, 1e-4);
  }
}

/// Rectangles hide at least what every place within the margin hides, and at most what lies within their mitred corners.
TEST(VisibilityPolygons, LieBetweenRoundAndMitredCorners) {
  std::vector<Patch<3>> patches;
  for (int i = 0; i < 60; ++i) {
    const auto turn = [&](int k) { return std::fmod(0.618 * (5 * i + k), 1.0); };
    const Vec<3> corner(20.0 * turn(0) - 10.0, 20.0 * turn(1) - 10.0, 8.0 * turn(2) - 4.0);
    const Vec<3> a = (1.0 + 3.0 * turn(3)) * Vec<3>(turn(4) - 0.5, turn(1) - 0.4, turn(2) - 0.3).normalized();
    const Vec<3> b = 1.5 * a.cross(Vec<3>(turn(2), turn(3) - 0.5, 0.7)).normalized();
    Patch<3> patch;
    patch.count = 4;
    patch.vertices[0] = corner;
    patch.vertices[1] = corner + a;
    patch.vertices[2] = corner + a + b;
    patch.vertices[3] = corner + b;
    patches.push_back(patch);
  }
  const Vec<3> origin(0.2, 0.1, -0.3);
  for (const double margin : {0.0, 0.1, 0.5}) {
    DepthImage<3> image(48, 30.0F);
    draw_patches<3>(image, patches, origin, margin, 0.0);
    std::size_t met = 0;
    for (std::size_t p = 0; p < image.size(); ++p) {
      double round = 30.0, mitred = 30.0;
      for (const Patch<3>& patch : patches) {
        round = std::min(round, ray_range<3>(patch, origin, image.direction(p), margin).value_or(kInfinity));
        mitred = std::min(mitred, ray_range<3>(patch, origin, image.direction(p), 1.4143 * margin + 1e-9).value_or(kInfinity));
      }
      ASSERT_LE(image[p], round + 1e-4);
      ASSERT_GE(image[p], mitred - 1e-4);
      met += image[p] < 30.0F ? 1 : 0;
    }
    EXPECT_GT(met, image.size() / 20);
  }
}

/// Any rotation of the sensor frame, by turns in the planes of two axes.
template <int Dim>
Eigen::Matrix<double, Dim, Dim> turned(double angle) {
  Eigen::Matrix<double, Dim, Dim> r = Eigen::Matrix<double, Dim, Dim>::Identity();
  for (int a = 0; a < Dim; ++a)
    for (int b = a + 1; b < Dim; ++b) {
      const auto [s, c] = sin_cos(angle * (1 + a + b));
      Eigen::Matrix<double, Dim, Dim> turn = Eigen::Matrix<double, Dim, Dim>::Identity();
      turn(a, a) = turn(b, b) = c;
      turn(a, b) = -s;
      turn(b, a) = s;
      r = turn * r;
    }
  return r;
}

/// Oracle: the column and row of a direction by angles, then the least of the 2 x 2 rays around.
template <int Dim>
float least_of_neighbours(const Scan<Dim>& scan, const Vec<Dim>& direction) {
  const Vec<Dim> d = scan.world_from_sensor.transpose() * direction;
  const int columns = scan.pattern.columns(), rows = scan.pattern.template rows<Dim>();
  const bool wraps = scan.pattern.full_circle();
  const double azimuth = angle_of(d[1], d[0]), elevation = angle_of((Dim - 2) * d[Dim - 1], d.template head<2>().norm());
  const double column = wraps ? (azimuth + kPi) / (2.0 * kPi) * columns : azimuth / scan.pattern.step + 0.5 * (columns - 1);
  const double row = elevation / scan.pattern.step + 0.5 * (rows - 1), half = 0.5 + 1e-9;
  if ((!wraps && std::abs(column - 0.5 * (columns - 1)) > 0.5 * (columns - 1) + half) || row < -half || row > rows - 1 + half) return 0.0F;
  float least = std::numeric_limits<float>::infinity();
  for (const int c : {0, 1})
    for (const int r : {0, 1}) {
      const int at = static_cast<int>(std::floor(column)) + c;
      const float range =
          scan.range(wraps ? at % columns : std::clamp(at, 0, columns - 1), std::clamp(static_cast<int>(std::floor(row)) + r, 0, rows - 1));
      least = std::min(least, std::isnan(range) ? 0.0F : std::min(range, static_cast<float>(scan.pattern.max_range)));
    }
  return least;
}

TYPED_TEST(Visibility, RangesAreTheLeastOfTheRaysAround) {
  constexpr int Dim = TypeParam::value;
  for (const double fov : {360.0, 90.0, 200.0})
    for (const double step : {0.4, 3.0, 30.0})
      for (const double turn : {0.0, 0.5 * kPi, 0.7}) {
        Scan<Dim> scan;
        scan.pattern.step = radians(step);
        scan.pattern.horizontal_fov = radians(fov);
        scan.pattern.vertical_fov = radians(fov < 180.0 ? 60.0 : 179.5);
        scan.world_from_sensor = turned<Dim>(turn);
        const std::size_t rays = directions<Dim>(scan.pattern).size();
        for (std::size_t i = 0; i < rays; ++i)
          scan.ranges.push_back(i % 17 == 3 ? kNoData : i % 11 == 5 ? kNoReturn : 2.0F + static_cast<float>(i * 7919 % 5003) * 0.01F);
        DepthImage<Dim> image(97, 40.0F);
        draw_ranges(image, scan);
        for (std::size_t p = 0; p < image.size(); ++p)
          ASSERT_EQ(image[p], std::min(40.0F, least_of_neighbours<Dim>(scan, image.direction(p)))) << fov << " " << step << " " << turn;
      }
}

/// A node's answer is that of its pixel's centre, half a pixel's diagonal away at most: where exact rays differ, they differ within that angle.
TYPED_TEST(Visibility, DiffersFromExactRaysWithinHalfAPixel) {
  constexpr int Dim = TypeParam::value;
  std::vector<Patch<Dim>> patches = points_of(scan_of_ball<Dim>(6.0));
  for (std::size_t i = 0; i + 1 < patches.size(); i += 2) patches[i] = segment_patch<Dim>(patches[i].vertices[0], patches[i + 1].vertices[0]);
  const Vec<Dim> origin = Vec<Dim>::Constant(0.13);
  const double eta = 0.1, far = 9.0;
  const auto first = [&](const Vec<Dim>& u) {
    double range = far;
    for (const Patch<Dim>& patch : patches) range = std::min(range, ray_range<Dim>(patch, origin, u, eta).value_or(kInfinity));
    return range;
  };
  for (const int resolution : {64, 65, 256}) {
    DepthImage<Dim> image(resolution, static_cast<float>(far));
    draw_patches<Dim>(image, patches, origin, eta, 0.0);
    const Grid<Dim> window = window_around_origin<Dim>(6.0, Dim == 2 ? 0.1 : 0.41);
    int differ = 0, hidden = 0;
    for (std::size_t i = 0; i < window.size(); ++i) {
      const Vec<Dim> offset = window.position(i) - origin;
      const double range = offset.norm();
      const Vec<Dim> u = offset / range, center = image.direction(image.pixel(offset));
      ASSERT_LE((u - center).norm(), std::sqrt(Dim - 1.0) / resolution * (1.0 + 1e-9));
      if (range > far) continue;
      const bool seen = sees<Dim>(image, far, offset), exact = range <= first(u);
      hidden += exact ? 0 : 1;
      if (seen == exact) continue;
      ++differ;
      const double there = first(center);
      ASSERT_TRUE(std::abs(there - range) < 1e-5 || seen == (range <= there)) << offset.transpose();
    }
    EXPECT_GT(hidden, 50);
    EXPECT_LE(differ, hidden * 20 / resolution);  // They follow the rim, so their share falls with the size of a pixel.
  }
}

/// Law of the cones: what a cone meets is the least over the plain rays in it.
TYPED_TEST(Visibility, ConeIsTheLeastOverItsOpening) {
  constexpr int Dim = TypeParam::value;
  const std::vector<Patch<Dim>> patches = points_of(scan_of_ball<Dim>(8.0));
  const int resolution = Dim == 2 ? 2000 : 120;
  const double half = radians(5.0), pixel = std::sqrt(Dim - 1.0) / resolution, margin = 10.0 / resolution;  // No point falls between pixels.
  DepthImage<Dim> plain(resolution, 50.0F), cone(resolution, 50.0F);
  draw_patches<Dim>(plain, patches, Vec<Dim>::Zero(), margin, 0.0);
  draw_patches<Dim>(cone, patches, Vec<Dim>::Zero(), margin, 2.0 * half);
  std::size_t lowered = 0;
  for (std::size_t p = 0; p < cone.size(); p += 23) {
    float inner = 50.0F, outer = 50.0F;
    for (std::size_t q = 0; q < plain.size(); ++q) {
      if (plain[q] >= 50.0F) continue;
      const double angle = (cone.direction(p) - cone.direction(q)).norm();
      if (angle <= half - 2.0 * pixel) inner = std::min(inner, plain[q]);
      if (angle <= half + 2.0 * pixel) outer = std::min(outer, plain[q]);
    }
    ASSERT_LE(cone[p], inner * 1.001F);
    ASSERT_GE(cone[p], outer * 0.99F);
    lowered += cone[p] < plain[p] ? 1 : 0;
  }
  EXPECT_GT(lowered, 10U);
}

/// Sharing a wall out among patches with a gap: plain rays leak through, the 1 degree cone does not.
TYPED_TEST(Visibility, ConesCloseCracks) {
  constexpr int Dim = TypeParam::value;
  std::vector<Patch<Dim>> wall;
  for (double y = -3.0; y < 3.0; y += 0.05) {
    Vec<Dim> p = Vec<Dim>::Zero();
    p[0] = 5.0;
    p[1] = y;
    wall.push_back(point_patch<Dim>(p));
  }
  Scan<Dim> scan;
  scan.pattern.max_range = 9.0;
  scan.ranges.assign(directions<Dim>(scan.pattern).size(), kNoReturn);
  Grid<Dim> behind = window_around_origin<Dim>(1.0, 0.1);
  behind.first[0] += 70;
  for (int a = 2; a < Dim; ++a) {  // Only the plane of the points.
    behind.first[a] = 0;
    behind.extent[a] = 1;
  }
  const auto leaks = [&](const VisibilityOptions& options) {
    const Field<Dim> phi = visibility<Dim>(wall, scan, behind, 0.001, options);
    return std::count_if(phi.values.begin(), phi.values.end(), [](float v) { return v > 0.0F; });
  };
  EXPECT_GT(leaks({.range_image = false}), 0);
  EXPECT_EQ(leaks({.range_image = false, .cone_angle = radians(1.0)}), 0);
}

TYPED_TEST(Visibility, SameBitsForAnyNumberOfThreads) {
  constexpr int Dim = TypeParam::value;
  const Scan<Dim> scan = scan_of_ball<Dim>(1.0);
  const auto patches = points_of(scan);
  std::vector<std::vector<float>> results;
  for (const int threads : {1, 2, 7}) {
    const ThreadLimit limit(threads);
    results.push_back(visibility<Dim>(patches, scan, window_around_origin<Dim>(6.0, 0.5), 0.05).values);
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

/// Extrusion law: on the scanner's own slice a long cylinder hides what its disc hides in the plane.
TEST(VisibilityExtrusion, CylinderHidesWhatItsDiscHides) {
  Scan<3> solid;
  Scan<2> plane;
  plane.pattern.max_range = solid.pattern.max_range = 9.0;
  const Vec<2> center(4.0, 1.0);
  for (const Vec<2>& d : directions<2>(plane.pattern)) {
    const double range = ball_range<2>(d, center, 1.0);
    plane.ranges.push_back(range < 9.0 ? static_cast<float>(range) : kNoReturn);
  }
  for (const Vec<3>& d : directions<3>(solid.pattern)) {
    const Vec<2> flat = d.head<2>();
    const double range = ball_range<2>(flat.normalized(), center, 1.0) / flat.norm();
    solid.ranges.push_back(range < 9.0 ? static_cast<float>(range) : kNoReturn);
  }
  const Grid<2> window = window_around_origin<2>(6.0, 0.25);
  const Grid<3> slice{window.spacing, {window.first[0], window.first[1], 0}, {window.extent[0], window.extent[1], 1}};
  const Field<2> flat = visibility<2>({}, plane, window, 0.0);
  const Field<3> cut = visibility<3>({}, solid, slice, 0.0);
  int differ = 0;
  for (std::size_t i = 0; i < flat.values.size(); ++i) differ += (flat[i] > 0.0F) != (cut[i] > 0.0F);
  EXPECT_LE(differ, static_cast<int>(flat.values.size() / 200));  // Pixels of the cube map at the rim.
}

}  // namespace
}  // namespace vantage

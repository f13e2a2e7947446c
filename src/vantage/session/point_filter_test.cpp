// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/point_filter.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "vantage/base/parallel.h"
#include "vantage/base/random.h"

namespace vantage {
namespace {

enum Kind : std::size_t { room, panel, pole, wire, mixed, rain, kinds };

/// A room of 24 x 16 x 5 m with a panel before its wall, three poles and two wires; the scanner at 1.6 m. What is met, and how far away.
struct Met {
  double range;
  Kind kind;
};

void closer(Met& met, double range, Kind kind) {
  if (range > 0.0 && range < met.range) met = {range, kind};
}

/// Of a line along axis a through `p` with a radius.
void meet_rod(Met& met, const Vec<3>& d, const Vec<3>& p, int a, double radius, double from, double to, Kind kind) {
  Vec<3> u = d, v = p;
  u[a] = v[a] = 0.0;
  const double A = u.squaredNorm(), B = u.dot(v), C = v.squaredNorm() - radius * radius, root = B * B - A * C;
  if (!(root > 0.0)) return;
  const double range = (B - std::sqrt(root)) / A;
  if (range * d[a] >= from && range * d[a] <= to) closer(met, range, kind);
}

Met meet(const Vec<3>& d) {
  Met met{kInfinity, room};
  const std::array<double, 6> walls{-12.0, 12.0, -8.0, 8.0, -1.6, 3.4};
  for (std::size_t w = 0; w < 6; ++w) closer(met, walls[w] / d[static_cast<Eigen::Index>(w / 2)], room);
  const Vec<3> p = d * (5.0 / d[0]);
  if (d[0] > 0.0 && std::abs(p[1]) < 1.5 && std::abs(p[2]) < 1.0) closer(met, 5.0 / d[0], panel);
  for (const Vec<3>& foot : {Vec<3>(4, 3, 0), Vec<3>(-6, 2, 0), Vec<3>(2, -5, 0)}) meet_rod(met, d, foot, 2, 0.06, -1.6, 3.4, pole);
  meet_rod(met, d, {-5, 0, 1.5}, 1, 0.04, -8.0, 8.0, wire);
  meet_rod(met, d, {0, 5, 2.0}, 0, 0.04, -12.0, 12.0, wire);
  return met;
}

struct Truth {
  std::vector<Vec<3>> points;
  std::vector<Kind> kind;
};

/// A scan every half degree with 5 mm of noise. A beam is 0.2 degrees wide: where its corners meet surfaces more than half a metre apart, three in
/// four give a range between them; one ray in 2,000 meets a drop of rain.
Truth synthetic(std::uint64_t seed) {
  constexpr double kStep = 0.5, kHalfBeam = 0.1;
  Random random(seed);
  Truth truth;
  const auto direction = [](double azimuth, double elevation) {
    const auto [sa, ca] = sin_cos(radians(azimuth));
    const auto [se, ce] = sin_cos(radians(elevation));
    return Vec<3>(ce * ca, ce * sa, se);
  };
  for (double azimuth = -180.0; azimuth < 179.9; azimuth += kStep)
    for (double elevation = -60.0; elevation <= 60.0; elevation += kStep) {
      const Vec<3> d = direction(azimuth + 0.01, elevation + 0.01);
      Met met = meet(d);
      double near = met.range, far = met.range;
      for (const double a : {-kHalfBeam, kHalfBeam})
        for (const double e : {-kHalfBeam, kHalfBeam}) {
          const double range = meet(direction(azimuth + 0.01 + a, elevation + 0.01 + e)).range;
          near = std::min(near, range);
          far = std::max(far, range);
        }
      if (far - near > 0.5 && random.uniform() < 0.75) {
        met = {near + (far - near) * random.uniform(), mixed};
        if (std::min(met.range - near, far - met.range) < 0.2) met.kind = kinds;  // Hardly off a surface: not counted.
      } else if (random.uniform() < 0.0005) {
        met = {1.0 + (met.range - 1.0) * random.uniform(), rain};
      }
      truth.points.push_back(d * (met.range + 0.005 * random.normal()));
      truth.kind.push_back(met.kind);
    }
  return truth;
}

/// Of each kind how many there are, and how many the filter keeps.
struct Tally {
  std::array<double, kinds + 1> all{}, kept{};
  [[nodiscard]] double share(Kind kind) const { return kept[kind] / all[kind]; }
};

Tally tally(const Truth& truth, const Pose<3>& pose, const FilterOptions& options) {
  std::vector<Vec<3>> points = truth.points;
  for (Vec<3>& p : points) p = pose.world_from_sensor * p + pose.position;
  const std::vector<Vec<3>> before = points;
  const FilterReport report = filter_points(points, pose, radians(0.5), options);
  EXPECT_EQ(report.points, static_cast<std::int64_t>(before.size()));
  EXPECT_EQ(report.points - report.mixed - report.isolated, static_cast<std::int64_t>(points.size()));
  Tally tally;
  for (std::size_t i = 0, k = 0; i < before.size(); ++i) {
    ++tally.all[truth.kind[i]];
    if (k == points.size() || points[k] != before[i]) continue;
    ++k;
    ++tally.kept[truth.kind[i]];
  }
  return tally;
}

FilterOptions options_of(FilterOptions::What what) {
  FilterOptions options;
  options.what = what;
  return options;
}

TEST(PointFilter, IsOffByDefault) {
  std::vector<Vec<3>> points = synthetic(1).points;
  const std::size_t count = points.size();
  const FilterReport report = filter_points(points, {}, radians(0.5), {});
  EXPECT_EQ(points.size(), count);
  EXPECT_EQ(report.mixed + report.isolated, 0);
}

TEST(PointFilter, TakesMixedPixelsAndKeepsPolesAndWires) {
  for (const std::uint64_t seed : {1, 2}) {
    const Tally t = tally(synthetic(seed), {}, options_of(FilterOptions::What::mixed));
    ASSERT_GT(t.all[mixed], 300.0);
    ASSERT_GT(t.all[pole], 300.0);
    ASSERT_GT(t.all[wire], 200.0);
    const std::array<const char*, kinds> names{"room", "panel", "pole", "wire", "mixed", "rain"};
    for (std::size_t k = 0; k < kinds; ++k)
      RecordProperty(std::to_string(seed) + "_" + names[k], std::to_string(t.kept[k]) + " of " + std::to_string(t.all[k]) + " kept");
    EXPECT_LT(t.share(mixed), 0.3) << t.all[mixed];
    EXPECT_GT(t.share(pole), 0.9) << t.all[pole];
    EXPECT_GT(t.share(wire), 0.9) << t.all[wire];
    EXPECT_GT(t.share(room), 0.995);
    EXPECT_GT(t.share(panel), 0.98);
  }
}

TEST(PointFilter, TakesIsolatedPoints) {
  const Tally t = tally(synthetic(4), {}, options_of(FilterOptions::What::both));
  ASSERT_GT(t.all[rain], 40.0);
  EXPECT_LT(t.share(rain), 0.25);
  EXPECT_LT(t.share(mixed), 0.3);
  EXPECT_GT(t.share(pole), 0.9);
  EXPECT_GT(t.share(wire), 0.85);
  EXPECT_GT(t.share(room), 0.99);
}

TEST(PointFilter, GrazingFloorsStay) {
  // A floor seen at down to 2 degrees, far below the limit of 10.
  std::vector<Vec<3>> points;
  for (double elevation = -60.0; elevation <= -2.0; elevation += 0.5)
    for (double azimuth = -180.0; azimuth < 179.9; azimuth += 0.5) {
      const auto [sa, ca] = sin_cos(radians(azimuth));
      const auto [se, ce] = sin_cos(radians(elevation));
      points.push_back(Vec<3>(ce * ca, ce * sa, se) * (-1.6 / se));
    }
  const std::size_t count = points.size();
  const FilterReport report = filter_points(points, {}, radians(0.5), options_of(FilterOptions::What::mixed));
  EXPECT_EQ(report.mixed, 0) << "of " << count;
}

TEST(PointFilter, DoesNotDependOnThePoseOrTheThreads) {
  const Truth truth = synthetic(5);
  const FilterOptions options = options_of(FilterOptions::What::both);
  const Tally here = tally(truth, {}, options);
  Pose<3> pose{{84616.0, 447423.0, 12.0}, Eigen::AngleAxisd(0.4, Vec<3>(1, 2, 2) / 3.0).toRotationMatrix()};
  const Tally there = tally(truth, pose, options);
  for (std::size_t k = 0; k <= kinds; ++k) EXPECT_NEAR(there.kept[k], here.kept[k], 2.0 + 0.002 * here.all[k]) << k;
  std::vector<Vec<3>> one = truth.points, many = truth.points;
  {
    const ThreadLimit limit(1);
    (void)filter_points(one, {}, radians(0.5), options);
  }
  (void)filter_points(many, {}, radians(0.5), options);
  EXPECT_EQ(one, many);
}

}  // namespace
}  // namespace vantage

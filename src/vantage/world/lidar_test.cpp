// SPDX-License-Identifier: Apache-2.0
#include "vantage/world/lidar.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/world/inside_solid.h"

namespace vantage {
namespace {

void add(Mesh<2>& mesh, const Box<2>& b) {
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {b.low, {b.high[0], b.low[1]}, b.high, {b.low[0], b.high[1]}});
  for (std::uint32_t i = 0; i < 4; ++i) mesh.facets.push_back({n + i, n + (i + 1) % 4});
}

void add(Mesh<3>& mesh, const Box<3>& b) {
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < 8; ++i) mesh.vertices.push_back({(i & 1 ? b.high : b.low)[0], (i & 2 ? b.high : b.low)[1], (i & 4 ? b.high : b.low)[2]});
  for (const auto& f : std::vector<std::array<std::uint32_t, 3>>{
           {0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4}, {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 3, 7}, {1, 7, 5}})
    mesh.facets.push_back({n + f[0], n + f[1], n + f[2]});
}

/// Solid cube of half width `half`.
template <int Dim>
Mesh<Dim> cube(double half) {
  Mesh<Dim> mesh;
  add(mesh, Box<Dim>{Vec<Dim>::Constant(-half), Vec<Dim>::Constant(half)});
  return mesh;
}

/// Room of solid walls, 0.2 thick, free within half width 3.
template <int Dim>
Mesh<Dim> hollow_room() {
  Mesh<Dim> mesh = cube<Dim>(3.0);
  add(mesh, Box<Dim>{Vec<Dim>::Constant(-3.2), Vec<Dim>::Constant(3.2)});
  return mesh;
}

LidarOptions coarse() {
  LidarOptions options;
  options.pattern.step = radians(3.0);
  options.pattern.vertical_fov = radians(177.0);
  return options;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

std::string error_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::bad_input);
    return e.what();
  }
  return "no error";
}

template <class T>
class Lidar : public testing::Test {};
using Dims = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Lidar, Dims);

TYPED_TEST(Lidar, SeesARoomAtTheDistanceOfItsWalls) {
  constexpr int Dim = TypeParam::value;
  SimulatedLidar<Dim> lidar(hollow_room<Dim>(), coarse());
  const Vec<Dim> origin = Vec<Dim>::Constant(0.5);
  const Scan<Dim> scan = lidar.scan(origin, 0);
  ASSERT_EQ(scan.ranges.size(), static_cast<std::size_t>(scan.pattern.columns() * scan.pattern.template rows<Dim>()));
  const auto points = hit_points(scan);
  ASSERT_EQ(points.size(), scan.ranges.size());
  for (const Vec<Dim>& p : points) ASSERT_NEAR(p.cwiseAbs().maxCoeff(), 3.0, 1e-5);
}

TYPED_TEST(Lidar, TellsHitsFromNoReturnsAndNoData) {
  constexpr int Dim = TypeParam::value;
  LidarOptions options = coarse();
  options.pattern.min_range = 2.7;
  options.pattern.max_range = 3.0;
  SimulatedLidar<Dim> lidar(hollow_room<Dim>(), options);
  const auto exact = [&](double range) { return range < 2.7 ? kNoData : range > 3.0 ? kNoReturn : static_cast<float>(range); };
  const Vec<Dim> origin = 0.4 * Vec<Dim>::Unit(0);
  const auto rays = directions<Dim>(options.pattern);
  const Scan<Dim> scan = lidar.scan(origin, 0);
  int counts[3] = {};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    double range = kInfinity;
    for (int a = 0; a < Dim; ++a)
      if (rays[i][a] != 0.0) range = std::min(range, ((rays[i][a] > 0.0 ? 3.0 : -3.0) - origin[a]) / rays[i][a]);
    const float truth = exact(range), got = scan.ranges[i];
    if (std::isfinite(truth))
      ASSERT_FLOAT_EQ(got, truth);
    else
      ASSERT_TRUE(std::isnan(truth) ? std::isnan(got) : got == kNoReturn) << range;
    ++counts[std::isnan(got) ? 0 : std::isinf(got) ? 1 : 2];
  }
  for (const int count : counts) EXPECT_GT(count, 0);
}

TYPED_TEST(Lidar, NoiseHasItsDeviationAndIsSeeded) {
  constexpr int Dim = TypeParam::value;
  LidarOptions options = coarse();
  options.pattern.step = radians(Dim == 2 ? 0.1 : 3.0);
  SimulatedLidar<Dim> quiet(hollow_room<Dim>(), options);
  options.range_noise = 0.05;
  SimulatedLidar<Dim> noisy(hollow_room<Dim>(), options), again(hollow_room<Dim>(), options);
  options.seed = 2;
  SimulatedLidar<Dim> other(hollow_room<Dim>(), options);
  const Vec<Dim> origin = Vec<Dim>::Zero();
  const auto truth = quiet.scan(origin, 4).ranges, a = noisy.scan(origin, 4).ranges;
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    sum += a[i] - truth[i];
    squares += (a[i] - truth[i]) * (a[i] - truth[i]);
  }
  const auto n = static_cast<double>(truth.size());
  EXPECT_NEAR(sum / n, 0.0, 0.005);
  EXPECT_NEAR(std::sqrt(squares / n), 0.05, 0.003);
  EXPECT_TRUE(same_bits(a, again.scan(origin, 4).ranges));
  EXPECT_FALSE(same_bits(a, noisy.scan(origin, 5).ranges));
  EXPECT_FALSE(same_bits(a, other.scan(origin, 4).ranges));
}

/// In a room, by its walls: half the difference of the ranges ahead and behind is how far off the scanner stands.
TYPED_TEST(Lidar, StandsOffWhereItSaysAsFarAsAsked) {
  constexpr int Dim = TypeParam::value;
  LidarOptions options = coarse();
  options.pattern.step = radians(30.0);
  options.pattern.vertical_fov = radians(180.0);
  options.pose_noise = 0.1;
  SimulatedLidar<Dim> lidar(hollow_room<Dim>(), options), again(hollow_room<Dim>(), options);
  const auto rays = directions<Dim>(options.pattern);
  const auto along = [&](const std::vector<float>& ranges, int sign) {
    for (std::size_t i = 0; i < rays.size(); ++i)
      if ((rays[i] - sign * Vec<Dim>::Unit(0)).norm() < 1e-6) return static_cast<double>(ranges[i]);
    return kInfinity;
  };
  double sum = 0.0, squares = 0.0;
  constexpr int kScans = 400;
  for (int index = 0; index < kScans; ++index) {
    const Scan<Dim> scan = lidar.scan(Vec<Dim>::Zero(), index);
    EXPECT_EQ(scan.origin, Vec<Dim>(Vec<Dim>::Zero()));  // What it says.
    const double off = 0.5 * (along(scan.ranges, -1) - along(scan.ranges, 1));
    sum += off / kScans;
    squares += off * off / kScans;
    EXPECT_TRUE(index >= 3 || same_bits(scan.ranges, again.scan(Vec<Dim>::Zero(), index).ranges));
  }
  EXPECT_NEAR(sum, 0.0, 4 * 0.1 / std::sqrt(kScans));
  EXPECT_NEAR(std::sqrt(squares), 0.1, 4 * 0.1 / std::sqrt(2.0 * kScans));
}

/// A disc seen from its middle looks the same however it is turned; a wall ahead does not: its ranges give the angle back.
TYPED_TEST(Lidar, IsTurnedAsFarAsAsked) {
  constexpr int Dim = TypeParam::value;
  LidarOptions options = coarse();
  options.pose_turn = radians(2.0);
  SimulatedLidar<Dim> lidar(hollow_room<Dim>(), options);
  options.pose_turn = 0.0;
  SimulatedLidar<Dim> straight(hollow_room<Dim>(), options);
  const auto truth = straight.scan(Vec<Dim>::Zero(), 0).ranges;
  const auto rays = directions<Dim>(options.pattern);
  double squares = 0.0;
  int count = 0;
  for (int index = 0; index < 200; ++index) {
    const auto ranges = lidar.scan(Vec<Dim>::Zero(), index).ranges;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      // Rays near 30 degrees off the wall ahead, level: range = 3 / cos(a), so da = dr cos^2(a) / (3 sin(a)).
      const double cosine = rays[i][0], sine = rays[i][1];
      if (std::abs(cosine * cosine + sine * sine - 1.0) > 1e-3 || cosine < 0.8 || cosine > 0.9) continue;
      const double turn = (static_cast<double>(ranges[i]) - static_cast<double>(truth[i])) * cosine * cosine / (3.0 * sine);
      squares += turn * turn;
      ++count;
    }
  }
  ASSERT_GT(count, 1000);
  EXPECT_NEAR(std::sqrt(squares / count), radians(2.0), 0.2 * radians(2.0));
}

/// Where noise would put the scanner behind a wall it stays this side, and its scans stay within the room.
TYPED_TEST(Lidar, NeverStandsBehindAWall) {
  constexpr int Dim = TypeParam::value;
  LidarOptions options = coarse();
  options.pose_noise = 5.0;
  SimulatedLidar<Dim> lidar(hollow_room<Dim>(), options);
  for (int index = 0; index < 50; ++index)
    for (const float range : lidar.scan(2.9 * Vec<Dim>::Unit(0), index).ranges) ASSERT_LT(range, 6.0 * std::sqrt(Dim));
}

TYPED_TEST(Lidar, DropsAndDisplacesTheAskedShare) {
  constexpr int Dim = TypeParam::value;
  LidarOptions options = coarse();
  options.pattern.step = radians(Dim == 2 ? 0.1 : 3.0);
  options.dropout = 0.2;
  options.outliers = 0.1;
  SimulatedLidar<Dim> lidar(hollow_room<Dim>(), options);
  const auto ranges = lidar.scan(Vec<Dim>::Zero(), 0).ranges;
  const auto share = [&](auto&& test) {
    return static_cast<double>(std::count_if(ranges.begin(), ranges.end(), test)) / static_cast<double>(ranges.size());
  };
  EXPECT_NEAR(share([](float r) { return std::isnan(r); }), 0.2, 0.03);
  EXPECT_NEAR(share([](float r) { return r < 2.999F; }), 0.8 * 0.1, 0.02);
}

TYPED_TEST(Lidar, ConfirmedHitsHoldFewStrays) {
  constexpr int Dim = TypeParam::value;
  LidarOptions options = coarse();
  options.pattern.step = radians(Dim == 2 ? 0.1 : 3.0);
  options.outliers = 0.05;
  const auto strays = [&] {
    SimulatedLidar<Dim> lidar(hollow_room<Dim>(), options);
    const auto ranges = lidar.scan(Vec<Dim>::Zero(), 0).ranges;
    return static_cast<double>(std::count_if(ranges.begin(), ranges.end(), [](float r) { return r < 2.5F; })) / static_cast<double>(ranges.size());
  };
  const double all = strays();
  EXPECT_NEAR(all, 0.05 * 2.5 / (Dim == 2 ? 3.4 : 3.8), 0.015);  // Of the room's mean range.
  options.confirmed = true;
  EXPECT_LT(strays(), (Dim == 2 ? 0.2 : 0.6) * all);
}

TYPED_TEST(Lidar, AnswersTheSameOnEveryThread) {
  constexpr int Dim = TypeParam::value;
  LidarOptions options = coarse();
  options.range_noise = 0.02;
  options.dropout = 0.1;
  options.pose_noise = 0.05;
  options.pose_turn = radians(0.5);
  SimulatedLidar<Dim> lidar(hollow_room<Dim>(), options);
  const auto scan = [&](int threads) {
    const ThreadLimit limit(threads);
    return lidar.scan(Vec<Dim>::Constant(0.1), 3).ranges;
  };
  EXPECT_TRUE(same_bits(scan(1), scan(7)));
}

TYPED_TEST(Lidar, RefusesToStandInAnObstacle) {
  constexpr int Dim = TypeParam::value;
  SimulatedLidar<Dim> lidar(hollow_room<Dim>(), coarse());
  using testing::HasSubstr;
  EXPECT_THAT(error_of([&] { (void)lidar.scan(3.1 * Vec<Dim>::Unit(0), 0); }), HasSubstr("(3.1, 0"));
  EXPECT_THAT(error_of([&] { (void)lidar.scan(3.1 * Vec<Dim>::Unit(0), 0); }), HasSubstr("inside an obstacle"));
  EXPECT_THAT(error_of([&] { (void)lidar.scan(2.9995 * Vec<Dim>::Unit(0), 0); }), HasSubstr("from a surface"));
  EXPECT_THAT(error_of([&] { (void)lidar.scan(Vec<Dim>::Constant(kInfinity), 0); }), HasSubstr("must be finite"));
  EXPECT_EQ(error_of([&] { (void)lidar.scan(2.998 * Vec<Dim>::Unit(0), 0); }), "no error");
  EXPECT_EQ(error_of([&] { (void)lidar.scan(5.0 * Vec<Dim>::Unit(0), 0); }), "no error");
}

/// The map that chose a later place was made with noise: it may be wrong, and the scanner stays on this side of the wall.
TYPED_TEST(Lidar, StandsBesideTheObstacleThatNoiseSentItInto) {
  constexpr int Dim = TypeParam::value;
  LidarOptions options = coarse();
  options.pattern.step = radians(30.0);
  options.pattern.vertical_fov = radians(180.0);
  options.pose_noise = 1e-9;
  SimulatedLidar<Dim> lidar(hollow_room<Dim>(), options);
  const auto rays = directions<Dim>(options.pattern);
  const std::size_t back = static_cast<std::size_t>(
      std::min_element(rays.begin(), rays.end(), [](const Vec<Dim>& a, const Vec<Dim>& b) { return a[0] < b[0]; }) - rays.begin());
  const Vec<Dim> wanted = 3.05 * Vec<Dim>::Unit(0);  // In the wall, 0.05 from the room and 0.15 from the open.
  EXPECT_THAT(error_of([&] { (void)lidar.scan(wanted, 0); }), testing::HasSubstr("inside an obstacle"));
  for (int index = 1; index < 20; ++index) {
    const Scan<Dim> scan = lidar.scan(wanted, index);
    EXPECT_EQ(scan.origin, wanted);
    EXPECT_NEAR(static_cast<double>(scan.ranges[back]), 6.0, 0.01);
  }
  EXPECT_EQ(error_of([&] { (void)lidar.scan(2.9995 * Vec<Dim>::Unit(0), 1); }), "no error");
  EXPECT_THAT(error_of([&] { (void)lidar.scan(Vec<Dim>::Constant(kInfinity), 1); }), testing::HasSubstr("must be finite"));
}

TYPED_TEST(Lidar, SmoothedHitsLieNearTheWalls) {
  constexpr int Dim = TypeParam::value;
  LidarOptions options = coarse();
  options.pattern.step = radians(Dim == 2 ? 0.5 : 2.0);
  options.range_noise = 0.1;
  const auto off = [&] {
    SimulatedLidar<Dim> lidar(hollow_room<Dim>(), options);
    double squares = 0.0;
    const auto points = hit_points(lidar.scan(Vec<Dim>::Zero(), 0));
    for (const Vec<Dim>& p : points) squares += std::pow(p.cwiseAbs().maxCoeff() - 3.0, 2);
    return std::sqrt(squares / static_cast<double>(points.size()));
  };
  const double before = off();
  options.smoothed = true;
  EXPECT_LT(off(), 0.6 * before);
}

TYPED_TEST(Lidar, RefusesOptionsOutOfRange) {
  constexpr int Dim = TypeParam::value;
  LidarOptions options = coarse();
  options.dropout = 1.5;
  EXPECT_EQ(error_of([&] { SimulatedLidar<Dim>(cube<Dim>(1.0), options); }), "scan.dropout = 1.5: must be 0 .. 1 [1]");
  options = coarse();
  options.pattern.min_range = 90.0;
  EXPECT_THAT(error_of([&] { SimulatedLidar<Dim>(cube<Dim>(1.0), options); }), testing::HasSubstr("must be below scan.range = 80"));
}

TYPED_TEST(Lidar, KnowsTheInsideOfSolids) {
  constexpr int Dim = TypeParam::value;
  const RayCaster<Dim> solid(cube<Dim>(1.0)), room(hollow_room<Dim>());
  EXPECT_TRUE(inside_solid<Dim>(solid, Vec<Dim>::Zero()));
  EXPECT_TRUE(inside_solid<Dim>(solid, Vec<Dim>::Constant(0.999)));
  EXPECT_FALSE(inside_solid<Dim>(solid, Vec<Dim>::Constant(1.001)));
  EXPECT_FALSE(inside_solid<Dim>(room, Vec<Dim>::Zero()));
  EXPECT_TRUE(inside_solid<Dim>(room, 3.1 * Vec<Dim>::Unit(Dim - 1)));
  EXPECT_FALSE(inside_solid<Dim>(room, Vec<Dim>::Constant(9.0)));
}

TYPED_TEST(Lidar, DoubledWallsStaySolid) {
  constexpr int Dim = TypeParam::value;
  Mesh<Dim> mesh = cube<Dim>(1.0);
  const std::size_t count = mesh.facets.size();
  for (std::size_t i = 0; i < count; ++i) mesh.facets.push_back(mesh.facets[i]);
  const RayCaster<Dim> world(mesh);
  EXPECT_TRUE(inside_solid<Dim>(world, Vec<Dim>::Constant(0.3)));
  EXPECT_FALSE(inside_solid<Dim>(world, Vec<Dim>::Constant(1.3)));
}

TEST(LidarGround, AnOpenSheetHidesNoSolid) {
  for (const double base : {0.0, -1.0}) {  // A house on the ground, and one sunk into it.
    Mesh<3> mesh;
    add(mesh, {{-4.0, -4.0, base}, {4.0, 4.0, 6.0}});
    const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {{-100.0, -100.0, 0.0}, {100.0, -100.0, 0.0}, {100.0, 100.0, 0.0}, {-100.0, 100.0, 0.0}});
    mesh.facets.push_back({n, n + 1, n + 2});
    mesh.facets.push_back({n, n + 2, n + 3});
    const RayCaster<3> world(mesh);
    EXPECT_TRUE(inside_solid<3>(world, {0.0, 0.0, 1.5}));
    EXPECT_TRUE(inside_solid<3>(world, {3.0, 2.0, 5.5}));
    EXPECT_FALSE(inside_solid<3>(world, {10.0, 0.0, 1.5}));
    EXPECT_FALSE(inside_solid<3>(world, {4.1, 0.0, 0.01}));
    EXPECT_FALSE(inside_solid<3>(world, {0.0, 0.0, 6.1}));
    EXPECT_FALSE(inside_solid<3>(world, {10.0, 0.0, -1.5}));
  }
}

}  // namespace
}  // namespace vantage

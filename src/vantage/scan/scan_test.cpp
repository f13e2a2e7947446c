// SPDX-License-Identifier: Apache-2.0
#include "vantage/scan/scan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <type_traits>

#include "vantage/base/error.h"
#include "vantage/base/random.h"

namespace vantage {
namespace {

template <class Dimension>
class ScanOf : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(ScanOf, Dimensions);

template <int Dim>
std::size_t rays(const ScanPattern& p) {
  return static_cast<std::size_t>(p.columns()) * static_cast<std::size_t>(p.rows<Dim>());
}

template <int Dim>
double angle(const Vec<Dim>& a, const Vec<Dim>& b) {
  return 2.0 * std::asin(0.5 * (a - b).norm());
}

/// Turned by 0.3 rad in the plane of the first two axes, then in 3D by 1.1 rad in that of the last two.
template <int Dim>
Eigen::Matrix<double, Dim, Dim> turned() {
  Eigen::Matrix<double, Dim, Dim> all = Eigen::Matrix<double, Dim, Dim>::Identity();
  double theta = 0.3;
  for (int a = 0; a + 1 < Dim; ++a, theta = 1.1) {
    Eigen::Matrix<double, Dim, Dim> one = Eigen::Matrix<double, Dim, Dim>::Identity();
    one(a, a) = one(a + 1, a + 1) = std::cos(theta);
    one(a + 1, a) = std::sin(theta);
    one(a, a + 1) = -std::sin(theta);
    all = one * all;
  }
  return all;
}

ScanPattern coarse() {
  ScanPattern p;
  p.step = radians(7.5);
  return p;
}

TEST(ScanPattern, PaperSensorHas259200Rays) {
  const ScanPattern paper;
  EXPECT_EQ(paper.columns(), 720);
  EXPECT_EQ(paper.rows<3>(), 360);
  EXPECT_EQ(paper.rows<2>(), 1);
  EXPECT_EQ(directions<3>(paper).size(), 259200U);
  EXPECT_EQ(directions<2>(paper).size(), 720U);
  EXPECT_EQ(paper.max_range, 80.0);
}

TEST(ScanPattern, CountsOfOtherSteps) {
  ScanPattern p;
  p.step = radians(1.0);
  p.vertical_fov = radians(180.0);
  EXPECT_EQ(p.columns(), 360);
  EXPECT_EQ(p.rows<3>(), 181);
  p.step = radians(0.1);
  p.vertical_fov = radians(90.0);
  EXPECT_EQ(p.columns(), 3600);
  EXPECT_EQ(p.rows<3>(), 901);
  p.horizontal_fov = radians(270.0);
  p.step = radians(0.25);
  EXPECT_EQ(p.columns(), 1081);  // An opening below the full circle has a ray at both ends.
}

TEST(ScanPattern, LinesAreSymmetricAboutTheHorizon) {
  const ScanPattern paper;
  EXPECT_NEAR(degrees(paper.elevation(0)), -89.75, 1e-9);
  for (int r = 0; r < 360; ++r) EXPECT_NEAR(paper.elevation(r), -paper.elevation(359 - r), 1e-12);
  for (int r = 1; r < 360; ++r) EXPECT_NEAR(paper.elevation(r) - paper.elevation(r - 1), paper.step, 1e-12);
}

TEST(ScanPattern, PartOfACircleIsCentredOnTheFirstAxis) {
  ScanPattern p;
  p.horizontal_fov = radians(90.0);
  p.step = radians(1.0);
  ASSERT_EQ(p.columns(), 91);
  EXPECT_FALSE(p.full_circle());
  EXPECT_NEAR(p.azimuth(0), -kPi / 4.0, 1e-12);
  EXPECT_NEAR(p.azimuth(45), 0.0, 1e-12);
  EXPECT_NEAR(p.azimuth(90), kPi / 4.0, 1e-12);
}

TYPED_TEST(ScanOf, DirectionsHaveUnitLength) {
  constexpr int Dim = TypeParam::value;
  for (const Vec<Dim>& d : directions<Dim>(ScanPattern{})) ASSERT_NEAR(d.norm(), 1.0, 1e-14);
}

TYPED_TEST(ScanOf, DirectionsFollowTheAngles) {
  constexpr int Dim = TypeParam::value;
  const ScanPattern p = coarse();
  const auto all = directions<Dim>(p);
  const int rows = p.rows<Dim>();
  ASSERT_EQ(all.size(), rays<Dim>(p));
  for (int c = 0; c < p.columns(); ++c) {
    for (int r = 0; r < rows; ++r) {
      const Vec<Dim>& d = all[static_cast<std::size_t>(c * rows + r)];
      const double elevation = rows == 1 ? 0.0 : p.elevation(r);
      EXPECT_NEAR(d[0], std::cos(elevation) * std::cos(p.azimuth(c)), 1e-14);
      EXPECT_NEAR(d[1], std::cos(elevation) * std::sin(p.azimuth(c)), 1e-14);
      if (rows > 1) {
        EXPECT_NEAR(d[Dim - 1], std::sin(elevation), 1e-14);
      }
    }
  }
}

TYPED_TEST(ScanOf, NeighbouringColumnsAreOneStepApartAroundTheCircle) {
  constexpr int Dim = TypeParam::value;
  const ScanPattern p;
  const auto all = directions<Dim>(p);
  const auto rows = static_cast<std::size_t>(p.rows<Dim>()), columns = static_cast<std::size_t>(p.columns());
  const std::size_t level = rows / 2;  // The row nearest the horizon, 0.25 degrees above it in 3D.
  const double cosine = std::sqrt(all[level].template head<2>().squaredNorm());
  const double expected = 2.0 * std::asin(cosine * std::sin(0.5 * p.step));
  for (std::size_t c = 0; c < columns; ++c) EXPECT_NEAR(angle<Dim>(all[c * rows + level], all[(c + 1) % columns * rows + level]), expected, 1e-12);
  EXPECT_NEAR(expected, p.step, 1e-6);
}

TYPED_TEST(ScanOf, NeighbouringRowsAreOneStepApart) {
  constexpr int Dim = TypeParam::value;
  const ScanPattern p;
  const auto all = directions<Dim>(p);
  const auto rows = static_cast<std::size_t>(p.rows<Dim>());
  EXPECT_EQ(rows > 1, Dim > 2);
  for (const std::size_t column : {std::size_t{0}, std::size_t{100}, std::size_t{719}})
    for (std::size_t r = 1; r < rows; ++r) EXPECT_NEAR(angle<Dim>(all[column * rows + r], all[column * rows + r - 1]), p.step, 1e-12);
}

TYPED_TEST(ScanOf, HitPointsGoBackToTheirRanges) {
  constexpr int Dim = TypeParam::value;
  Random random(11);
  Scan<Dim> scan;
  scan.pattern = coarse();
  scan.world_from_sensor = turned<Dim>();
  scan.origin = Vec<Dim>::LinSpaced(Dim, -3.0, 40.0);
  const auto rays_in_sensor = directions<Dim>(scan.pattern);
  std::vector<std::size_t> hits;
  for (std::size_t i = 0; i < rays_in_sensor.size(); ++i) {
    const bool hit = i % 3 == 0;
    scan.ranges.push_back(hit ? static_cast<float>(random.uniform(0.5, 80.0)) : i % 3 == 1 ? kNoReturn : kNoData);
    if (hit) hits.push_back(i);
  }
  const auto points = hit_points(scan);
  ASSERT_EQ(points.size(), hits.size());
  for (std::size_t k = 0; k < hits.size(); ++k) {
    const Vec<Dim> back = scan.world_from_sensor.transpose() * (points[k] - scan.origin);
    const double range = static_cast<double>(scan.ranges[hits[k]]);
    EXPECT_NEAR(back.norm(), range, 1e-12 * range);
    EXPECT_NEAR((back / back.norm() - rays_in_sensor[hits[k]]).norm(), 0.0, 1e-13);
  }
}

TYPED_TEST(ScanOf, RangeOfAColumnAndRow) {
  constexpr int Dim = TypeParam::value;
  Scan<Dim> scan;
  scan.pattern = coarse();
  for (std::size_t i = 0; i < rays<Dim>(scan.pattern); ++i) scan.ranges.push_back(static_cast<float>(i));
  const int rows = scan.pattern.template rows<Dim>();
  for (int c = 0; c < scan.pattern.columns(); ++c)
    for (int r = 0; r < rows; ++r) EXPECT_EQ(scan.range(c, r), static_cast<float>(c * rows + r));
}

TEST(ScanOptions, DefaultsAreAllowed) { EXPECT_NO_THROW(check_options(ScanPattern{}, "sensor")); }

TEST(ScanOptions, AnglesAreWrittenInDegrees) {
  ScanPattern p;
  for (Option& option : list_options(p)) {
    if (option.name == "step_deg") {
      EXPECT_EQ(option.text(), "0.5");
      option.parse("2", "sensor.step_deg");
    }
    if (option.name == "vertical_fov_deg") {
      EXPECT_EQ(option.text(), "179.5");
      option.parse("180", "sensor.vertical_fov_deg");
    }
  }
  EXPECT_NEAR(p.step, radians(2.0), 1e-15);
  EXPECT_NEAR(p.vertical_fov, kPi, 1e-15);
  EXPECT_EQ(p.columns(), 180);
}

TEST(ScanOptions, WrongValuesAreRefusedByName) {
  const auto refused = [](auto&& change, const std::string& name) {
    ScanPattern p;
    change(p);
    try {
      check_options(p, "sensor");
      ADD_FAILURE() << name << " was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_input);
      EXPECT_NE(std::string(error.what()).find("sensor." + name), std::string::npos) << error.what();
    }
  };
  refused([](ScanPattern& p) { p.step = 0.0; }, "step_deg");
  refused([](ScanPattern& p) { p.step = radians(31.0); }, "step_deg");
  refused([](ScanPattern& p) { p.step = std::nan(""); }, "step_deg");
  refused([](ScanPattern& p) { p.horizontal_fov = radians(361.0); }, "horizontal_fov_deg");
  refused([](ScanPattern& p) { p.vertical_fov = radians(-1.0); }, "vertical_fov_deg");
  refused([](ScanPattern& p) { p.min_range = -0.1; }, "min_range");
  refused([](ScanPattern& p) { p.max_range = 0.0; }, "range");
  refused([](ScanPattern& p) { p.max_range = kInfinity; }, "range");
}

}  // namespace
}  // namespace vantage

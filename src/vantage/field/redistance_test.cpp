// SPDX-License-Identifier: Apache-2.0
#include "vantage/field/redistance.h"

#include <gtest/gtest.h>

#include "vantage/field/fast_marching.h"
#include "vantage/field/stencil.h"

namespace vantage {
namespace {

template <class T>
class Redistance : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Redistance, Dimensions);

template <int Dim>
Grid<Dim> centred_window(double half_side, double spacing) {
  return window_over(Box<Dim>{Vec<Dim>::Constant(-half_side), Vec<Dim>::Constant(half_side)}, spacing);
}

/// Radius minus distance to the centre, stretched unevenly: the right set, the wrong slope.
template <int Dim>
Field<Dim> distorted_ball(double radius, double spacing) {
  Field<Dim> phi(centred_window<Dim>(1.0, spacing));
  for (std::size_t i = 0; i < phi.values.size(); ++i) {
    const Vec<Dim> p = phi.window.position(i);
    const double d = radius - p.norm();
    phi[i] = static_cast<float>(d * (1.5 + p[0]) * (2.0 + p[Dim - 1]));
  }
  return phi;
}

template <int Dim>
double worst_error(double spacing) {
  const Field<Dim> d = redistance(distorted_ball<Dim>(0.6, spacing));
  double worst = 0.0;
  for (std::size_t i = 0; i < d.values.size(); ++i) {
    const Vec<Dim> p = d.window.position(i);
    if (p.norm() > 0.15 && p.norm() < 0.95) worst = std::max(worst, std::abs(static_cast<double>(d[i]) - (0.6 - p.norm())));
  }
  return worst;
}

TYPED_TEST(Redistance, RecoversTheBallsDistanceAndConverges) {
  constexpr int Dim = TypeParam::value;
  const double coarse = worst_error<Dim>(0.05), fine = worst_error<Dim>(0.025);
  EXPECT_LT(coarse, 1.5 * 0.05);
  EXPECT_LT(fine, 0.75 * coarse);  // First order up to the logarithm of the front's start.
}

/// Closed forms with |gradient| = 1; the cone (a wedge in 2D) has its tip at (0, .., -0.4).
template <int Dim>
double plane_distance(const Vec<Dim>& p) {
  Vec<Dim> normal = Vec<Dim>::Constant(0.48);
  normal[0] = 0.6;
  return p.dot(normal.normalized()) - 0.1;
}

template <int Dim>
double cone_distance(const Vec<Dim>& p) {
  return 0.8 * p.template head<Dim - 1>().norm() - 0.6 * (p[Dim - 1] + 0.4);
}

/// Largest error within four steps of the surface, and mean angle of the normal off the truth's [rad], away from the tip and the sides.
template <int Dim, class Truth>
std::pair<double, double> band_errors(double spacing, Truth&& truth) {
  Field<Dim> phi(centred_window<Dim>(1.0, spacing));
  for (std::size_t i = 0; i < phi.values.size(); ++i) {
    const Vec<Dim> p = phi.window.position(i);
    phi[i] = static_cast<float>(truth(p) * (1.5 + p[0]) * (2.0 + p[Dim - 1]));
  }
  const Field<Dim> d = redistance(phi);
  double worst = 0.0, angle = 0.0, count = 0.0;
  for (std::size_t i = 0; i < d.values.size(); ++i) {
    const Vec<Dim> p = d.window.position(i);
    if (std::abs(truth(p)) > 4.0 * spacing || p.cwiseAbs().maxCoeff() > 0.8 || p.template head<Dim - 1>().norm() < 0.3) continue;
    worst = std::max(worst, std::abs(static_cast<double>(d[i]) - truth(p)));
    Vec<Dim> normal;
    for (int a = 0; a < Dim; ++a) normal[a] = (truth(p + 1e-5 * Vec<Dim>::Unit(a)) - truth(p - 1e-5 * Vec<Dim>::Unit(a))) / 2e-5;
    angle += std::acos(std::clamp(gradient(d, d.window.local(i)).normalized().dot(normal.normalized()), -1.0, 1.0));
    count += 1.0;
  }
  return {worst, angle / count};
}

TYPED_TEST(Redistance, RecoversPlanesAndConesAtFirstOrder) {
  constexpr int Dim = TypeParam::value;
  const auto check = [](auto&& truth) {
    const auto [coarse, coarse_angle] = band_errors<Dim>(0.05, truth);
    const auto [fine, fine_angle] = band_errors<Dim>(0.025, truth);
    EXPECT_LT(coarse, 0.4 * 0.05);
    EXPECT_LT(fine, 0.6 * coarse);
    EXPECT_LT(std::max(coarse_angle, fine_angle), 2.0 * kPi / 180.0);
  };
  check(plane_distance<Dim>);
  check(cone_distance<Dim>);
}

TYPED_TEST(Redistance, KeepsTheSet) {
  constexpr int Dim = TypeParam::value;
  const Field<Dim> phi = distorted_ball<Dim>(0.6, 0.05), d = redistance(phi);
  for (std::size_t i = 0; i < d.values.size(); ++i) EXPECT_EQ(d[i] > 0.0F, phi[i] > 0.0F);
}

TYPED_TEST(Redistance, OfABinarySetIsGoodToHalfADiagonal) {
  constexpr int Dim = TypeParam::value;
  const double h = 0.05;
  Field<Dim, std::uint8_t> inside(centred_window<Dim>(1.0, h));
  for (std::size_t i = 0; i < inside.values.size(); ++i) inside[i] = inside.window.position(i).norm() < 0.6;
  const Field<Dim> d = signed_distance(inside, 10.0);
  for (std::size_t i = 0; i < d.values.size(); ++i) {
    EXPECT_EQ(d[i] > 0.0F, inside[i] != 0);
    EXPECT_NEAR(d[i], 0.6 - inside.window.position(i).norm(), std::sqrt(double{Dim}) * h / 2 + h / 2);
  }
}

TYPED_TEST(Redistance, OneSidedSetsGiveTheCap) {
  constexpr int Dim = TypeParam::value;
  const Field<Dim, std::uint8_t> all(centred_window<Dim>(1.0, 0.5), 1), none(centred_window<Dim>(1.0, 0.5), 0);
  for (const float d : signed_distance(all, 3.0).values) EXPECT_FLOAT_EQ(d, 3.0F);
  for (const float d : signed_distance(none, 3.0).values) EXPECT_FLOAT_EQ(d, -3.0F);
}

TYPED_TEST(Redistance, MarchingFromAPointGivesItsDistance) {
  constexpr int Dim = TypeParam::value;
  const double h = 0.05;
  const Field<Dim, std::uint8_t> open(centred_window<Dim>(1.0, h), 1);
  const Seed seed{open.window.linear(open.window.nearest(Vec<Dim>::Zero())), 0.0F};
  const Field<Dim> u = fast_march(open, std::span(&seed, 1));
  for (std::size_t i = 0; i < u.values.size(); ++i) {
    const double d = open.window.position(i).norm();
    EXPECT_GE(u[i], d - 1e-5);
    EXPECT_LE(u[i], d + 3.0 * h);
  }
}

/// A wall with one gap: the way goes through it and never touches the wall.
TYPED_TEST(Redistance, PathsGoThroughTheGap) {
  constexpr int Dim = TypeParam::value;
  Field<Dim, std::uint8_t> open(centred_window<Dim>(1.0, 0.1), 1);
  for (std::size_t i = 0; i < open.values.size(); ++i) {
    const Vec<Dim> p = open.window.position(i);
    if (std::abs(p[0]) < 0.01 && p[1] < 0.75) open[i] = 0;
  }
  Vec<Dim> from = Vec<Dim>::Constant(-0.5), to = Vec<Dim>::Constant(-0.5);
  to[0] = 0.5;
  const std::size_t start = open.window.linear(open.window.nearest(from)), goal = open.window.linear(open.window.nearest(to));
  const Seed seed{goal, 0.0F};
  const Field<Dim> u = fast_march_to(open, std::span(&seed, 1), start);
  const std::vector<Vec<Dim>> path = descend(u, start);
  ASSERT_GE(path.size(), 3U);
  EXPECT_LT((path.front() - from).norm(), 1e-6);
  EXPECT_LT((path.back() - to).norm(), 1e-6);
  double length = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    length += (path[i] - path[i - 1]).norm();
    for (double t = 0.0; t <= 1.0; t += 0.01) EXPECT_NE(open.at(open.window.nearest(path[i - 1] + t * (path[i] - path[i - 1]))), 0);
  }
  EXPECT_LT(length, 2.0 * std::hypot(0.5, 1.35) * 1.1);
}

TYPED_TEST(Redistance, ClosedRoomsAreNotReached) {
  constexpr int Dim = TypeParam::value;
  Field<Dim, std::uint8_t> open(centred_window<Dim>(1.0, 0.1), 1);
  for (std::size_t i = 0; i < open.values.size(); ++i) open[i] = std::abs(open.window.position(i)[0]) > 0.01;
  const Seed seed{0, 0.0F};
  const Field<Dim> u = fast_march(open, std::span(&seed, 1));
  for (std::size_t i = 0; i < u.values.size(); ++i) EXPECT_EQ(std::isfinite(u[i]), open.window.position(i)[0] < -0.01);
  EXPECT_TRUE(descend(u, u.values.size() - 1).empty());
}

TYPED_TEST(Redistance, StencilsAreExactOnQuadratics) {
  constexpr int Dim = TypeParam::value;
  Field<Dim> f(centred_window<Dim>(1.0, 0.25));
  for (std::size_t i = 0; i < f.values.size(); ++i) f[i] = static_cast<float>(f.window.position(i).squaredNorm());
  const Index<Dim> center = f.window.nearest(Vec<Dim>::Constant(0.25));
  EXPECT_LT((gradient(f, center) - Vec<Dim>::Constant(0.5)).norm(), 1e-5);
  EXPECT_NEAR(laplacian(f, center), 2.0 * Dim, 1e-4);
  // One pass of [1 2 1]/4 along an axis adds h^2/2 to x^2.
  EXPECT_NEAR(smooth(f, 1).at(center) - f.at(center), Dim * 0.25 * 0.25 / 2.0, 1e-6);
}

TEST(Delta, IntegratesToOneAndThePrintedOneDoesNot) {
  double repaired = 0.0, printed = 0.0;
  constexpr double kStep = 1e-3, kEpsilon = 0.2;
  for (double x = -0.3; x < 0.3; x += kStep) {
    repaired += smeared_delta(x, kEpsilon) * kStep;
    printed += printed_delta(x, kEpsilon) * kStep;
  }
  EXPECT_NEAR(repaired, 1.0, 1e-3);
  EXPECT_NEAR(printed, 1.84, 0.01);  // 1 + sin 1.
}

/// Extrusion law: the distances of a plane set, extruded, are those of the plane on every slice.
TEST(Extrusion, DistancesAgreeOnEverySlice) {
  Field<2, std::uint8_t> plane(centred_window<2>(1.0, 0.1));
  for (std::size_t i = 0; i < plane.values.size(); ++i) plane[i] = (plane.window.position(i) - Vec<2>(0.2, -0.1)).norm() < 0.4;
  Grid<3> window{0.1, {plane.window.first[0], plane.window.first[1], -2}, {plane.window.extent[0], plane.window.extent[1], 5}};
  Field<3, std::uint8_t> solid(window);
  for (std::size_t i = 0; i < solid.values.size(); ++i) solid[i] = plane[i % plane.values.size()];
  const Field<2> d2 = signed_distance(plane, 5.0);
  const Field<3> d3 = signed_distance(solid, 5.0);
  for (std::size_t i = 0; i < d3.values.size(); ++i) ASSERT_EQ(d3[i], d2[i % d2.values.size()]);
}

}  // namespace
}  // namespace vantage

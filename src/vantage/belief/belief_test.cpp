// SPDX-License-Identifier: Apache-2.0
#include "vantage/belief/belief.h"

#include <gtest/gtest.h>

#include "vantage/base/random.h"
#include "vantage/field/redistance.h"

namespace vantage {
namespace {

template <class T>
class BeliefTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(BeliefTest, Dimensions);

constexpr double kH = 0.5, kEta = 0.1;

template <int Dim>
Grid<Dim> domain() {
  return window_over(Box<Dim>{Vec<Dim>::Zero(), Vec<Dim>::Constant(8.0)}, kH);
}

/// Seen within `radius` of `center`; a known surface in the plane x = 7.
template <int Dim>
Field<Dim> ball_view(const Grid<Dim>& window, const Vec<Dim>& center, double radius) {
  Field<Dim> phi(window);
  for (std::size_t i = 0; i < phi.values.size(); ++i) {
    const Vec<Dim> p = window.position(i);
    const auto d = static_cast<float>(std::max(std::abs(p[0] - 7.0) - kEta, 1e-30));
    phi[i] = (p - center).norm() < radius ? d : -d;
  }
  return phi;
}

TYPED_TEST(BeliefTest, KnowsThreeStates) {
  constexpr int Dim = TypeParam::value;
  Belief<Dim> belief(domain<Dim>(), kEta);
  belief.unite(ball_view<Dim>(domain<Dim>(), Vec<Dim>::Constant(5.0), 3.0));
  const BeliefView<Dim> view = belief.view();
  const double wall = 0.5 * std::sqrt(double{Dim}) * kH;
  EXPECT_DOUBLE_EQ(belief.obstacle_distance(), wall);
  for (std::size_t i = 0; i < view.state.values.size(); ++i) {
    const Vec<Dim> p = view.window().position(i);
    const NodeState truth = std::abs(p[0] - 7.0) <= wall                 ? NodeState::obstacle
                            : (p - Vec<Dim>::Constant(5.0)).norm() < 3.0 ? NodeState::seen
                                                                         : NodeState::unseen;
    ASSERT_EQ(view.state[i], truth);
    ASSERT_EQ(view.psi[i] > 0.0F, truth == NodeState::seen);
  }
}

TYPED_TEST(BeliefTest, OccludedSetOnlyShrinksAndTheOrderOfTheUnionDoesNotMatter) {
  constexpr int Dim = TypeParam::value;
  Belief<Dim> one(domain<Dim>(), kEta), other(domain<Dim>(), kEta);
  const auto a = ball_view<Dim>(domain<Dim>(), Vec<Dim>::Constant(2.0), 2.5), b = ball_view<Dim>(domain<Dim>(), Vec<Dim>::Constant(4.0), 2.0);
  one.unite(a);
  const BlockBits<Dim> before = one.ever_seen();
  one.unite(b);
  other.unite(b);
  other.unite(a);
  for (std::size_t i = 0; i < before.window().size(); ++i) EXPECT_GE(one.ever_seen()[i], before[i]);
  EXPECT_EQ(one.view().state.values, other.view().state.values);
  EXPECT_EQ(one.view().psi.values, other.view().psi.values);
}

TYPED_TEST(BeliefTest, UnitingTwiceChangesNothing) {
  constexpr int Dim = TypeParam::value;
  Belief<Dim> belief(domain<Dim>(), kEta);
  const auto phi = ball_view<Dim>(domain<Dim>(), Vec<Dim>::Constant(2.0), 2.5);
  belief.unite(phi);
  const auto psi = belief.view().psi.values;
  belief.unite(phi);
  EXPECT_EQ(belief.view().psi.values, psi);
}

/// Oracle for the windows: psi after local updates equals redistancing everything.
TEST(BeliefWindows, LocalUpdatesEqualRedistancingTheWholeDomain) {
  const Grid<2> whole = window_over(Box<2>{Vec<2>::Zero(), Vec<2>(100.0, 60.0)}, kH);
  Belief<2> belief(whole, kEta);
  Random random(3);
  for (int k = 0; k < 12; ++k) {
    const Vec<2> center(random.uniform(5.0, 95.0), random.uniform(5.0, 55.0));
    Field<2> phi(intersection(window_over(Box<2>{center.array() - 5.0, center.array() + 5.0}, kH), whole));
    for (std::size_t i = 0; i < phi.values.size(); ++i) phi[i] = (phi.window.position(i) - center).norm() < 4.0 ? 50.0F : -50.0F;
    belief.unite(phi);
  }
  Field<2, std::uint8_t> inside(whole);
  for (std::size_t i = 0; i < inside.values.size(); ++i) inside[i] = belief.view().seen(i);
  const Field<2> psi = signed_distance(inside, belief.cap());
  for (std::size_t i = 0; i < psi.values.size(); ++i) ASSERT_EQ(psi[i], belief.view().psi[i]) << whole.position(i).transpose();
}

/// Extrusion law: a plane's union, extruded, is the union on every slice. eta is wider than the obstacle blanket of both dimensions.
TEST(BeliefExtrusion, UnionAgreesOnEverySlice) {
  constexpr double kWide = 0.6;
  const Grid<2> plane = domain<2>();
  const Grid<3> solid{kH, {plane.first[0], plane.first[1], -1}, {plane.extent[0], plane.extent[1], 4}};
  Belief<2> flat(plane, kWide);
  Belief<3> tall(solid, kWide);
  for (const double x : {2.0, 5.0}) {
    const Field<2> phi = ball_view<2>(plane, Vec<2>::Constant(x), 2.5);
    Field<3> extruded(solid);
    for (std::size_t i = 0; i < extruded.values.size(); ++i) extruded[i] = phi[i % phi.values.size()];
    flat.unite(phi);
    tall.unite(extruded);
  }
  for (std::size_t i = 0; i < solid.size(); ++i) {
    ASSERT_EQ(tall.view().state[i], flat.view().state[i % plane.size()]);
    ASSERT_EQ(tall.view().psi[i], flat.view().psi[i % plane.size()]);
  }
}

}  // namespace
}  // namespace vantage

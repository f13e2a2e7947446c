// SPDX-License-Identifier: Apache-2.0
#include "vantage/belief/belief.h"

#include <gtest/gtest.h>

#include "vantage/base/parallel.h"
#include "vantage/base/random.h"
#include "vantage/field/redistance.h"
#include "vantage/field/stencil.h"

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

/// What a scan showed.
template <int Dim>
struct View {
  Field<Dim, std::uint8_t> seen;
  Field<Dim> known;
  explicit View(const Grid<Dim>& window) : seen(window), known(window, 1e3F) {}
};

template <int Dim>
void unite(Belief<Dim>& belief, const View<Dim>& view, std::span<const Vec<Dim>> walls = {}) {
  belief.unite(SeenSet<Dim>(view.seen), view.known, walls);
}

/// Seen within `radius` of `center`; a known surface in the plane x = 7.
template <int Dim>
View<Dim> ball_view(const Grid<Dim>& window, const Vec<Dim>& center, double radius) {
  View<Dim> view(window);
  for (std::size_t i = 0; i < window.size(); ++i) {
    const Vec<Dim> p = window.position(i);
    view.known[i] = static_cast<float>(std::abs(p[0] - 7.0));
    view.seen[i] = (p - center).norm() < radius;
  }
  return view;
}

TYPED_TEST(BeliefTest, KnowsThreeStates) {
  constexpr int Dim = TypeParam::value;
  Belief<Dim> belief(domain<Dim>(), kEta);
  unite(belief, ball_view<Dim>(domain<Dim>(), Vec<Dim>::Constant(5.0), 3.0));
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
  unite(one, a);
  const SeenSet<Dim> before = one.ever_seen();
  unite(one, b);
  unite(other, b);
  unite(other, a);
  for (std::size_t i = 0; i < before.window().size(); ++i)
    EXPECT_GE(one.ever_seen().at(before.window().local(i)), before.at(before.window().local(i)));
  EXPECT_EQ(one.view().state.values, other.view().state.values);
  EXPECT_EQ(one.view().psi.values, other.view().psi.values);
}

TYPED_TEST(BeliefTest, UnitingTwiceChangesNothing) {
  constexpr int Dim = TypeParam::value;
  Belief<Dim> belief(domain<Dim>(), kEta);
  const auto phi = ball_view<Dim>(domain<Dim>(), Vec<Dim>::Constant(2.0), 2.5);
  unite(belief, phi);
  const auto psi = belief.view().psi.values;
  unite(belief, phi);
  EXPECT_EQ(belief.view().psi.values, psi);
}

template <int Dim>
std::vector<ShadowFace<Dim>> faces_of(const ShadowBoundary<Dim>& boundary) {
  std::vector<ShadowFace<Dim>> faces;
  boundary.for_faces([&](const ShadowFace<Dim>& face) { faces.push_back(face); });
  return faces;
}

/// Oracle for the windows: what local updates bring equals working everything out from the states of the whole domain.
TYPED_TEST(BeliefTest, LocalUpdatesEqualStartingAnew) {
  constexpr int Dim = TypeParam::value;
  Box<Dim> box{Vec<Dim>::Zero(), Vec<Dim>::Constant(Dim == 2 ? 60.0 : 20.0)};
  box.high[0] = 100.0;
  const Grid<Dim> whole = window_over(box, kH);
  Belief<Dim> belief(whole, kEta);
  Random random(3);
  const auto random_place = [&] {
    Vec<Dim> p;
    for (int a = 0; a < Dim; ++a) p[a] = random.uniform(5.0, box.high[a] - 5.0);
    return p;
  };
  for (int k = 0; k < 12; ++k) {
    const Vec<Dim> center = random_place(), obstacle = center + Vec<Dim>::Constant(1.3);
    View<Dim> view(intersection(window_over(Box<Dim>{center.array() - 5.0, center.array() + 5.0}, kH), whole));
    for (std::size_t i = 0; i < view.seen.values.size(); ++i) {
      const Vec<Dim> p = view.seen.window.position(i);
      view.seen[i] = (p - center).norm() < 4.0;
      view.known[i] = static_cast<float>((p - obstacle).norm());
    }
    const std::vector<Vec<Dim>> walls{random_place()};
    unite<Dim>(belief, view, walls);
  }
  const BeliefView<Dim> view = belief.view();
  Field<Dim, std::uint8_t> inside(whole);
  for (std::size_t i = 0; i < inside.values.size(); ++i) inside[i] = view.seen(i);
  const Field<Dim> psi = signed_distance(inside, belief.cap());
  for (std::size_t i = 0; i < psi.values.size(); ++i) ASSERT_EQ(psi[i], view.psi[i]) << whole.position(i).transpose();

  const auto seen = static_cast<double>(std::count(view.state.values.begin(), view.state.values.end(), NodeState::seen));
  EXPECT_DOUBLE_EQ(belief.seen_volume(), seen * std::pow(kH, Dim));

  ShadowBoundary<Dim> anew(whole);
  for (std::size_t i = 0; i < whole.size(); ++i) anew.touch(whole.local(i));
  anew.renew(view.state, psi, whole);
  const std::vector<ShadowFace<Dim>> fresh = faces_of(anew);
  const std::vector<ShadowFace<Dim>> faces = faces_of(view.boundary);
  std::size_t expected = 0;
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (int direction = 0; direction < 2 * Dim; ++direction) {
      Index<Dim> there = whole.local(i);
      there[direction / 2] += direction % 2 == 0 ? 1 : -1;
      expected += view.seen(i) && whole.inside(there) && view.state.at(there) == NodeState::unseen ? 1 : 0;
    }
  ASSERT_EQ(faces.size(), expected);
  ASSERT_EQ(view.boundary.size(), expected);
  ASSERT_EQ(fresh.size(), expected);
  for (std::size_t k = 0; k < faces.size(); ++k) {
    const ShadowFace<Dim>& face = faces[k];
    ASSERT_TRUE(view.seen(face.seen) && view.state[face.unseen] == NodeState::unseen);
    ASSERT_LT((whole.position(face.seen) - whole.position(face.unseen) - kH * face.step()).norm(), 1e-12);
    ASSERT_LT((0.5 * (whole.position(face.seen) + whole.position(face.unseen)) - face.center).norm(), 1e-12);
    ASSERT_TRUE(k == 0 || faces[k - 1].key < face.key);  // Each once.
    ASSERT_TRUE(fresh[k].key == face.key && fresh[k].normal == face.normal);
  }
}

/// Closed form: the faces of a seen ball, projected along their normals, add up to the area of a sphere.
TYPED_TEST(BeliefTest, BoundaryHasTheAreaOfASphere) {
  constexpr int Dim = TypeParam::value;
  constexpr double kRadius = 7.0;
  const Grid<Dim> window = window_over(Box<Dim>{Vec<Dim>::Constant(-9.0), Vec<Dim>::Constant(9.0)}, kH);
  Belief<Dim> belief(window, kEta);
  View<Dim> view(window);
  for (std::size_t i = 0; i < window.size(); ++i) view.seen[i] = window.position(i).norm() < kRadius;
  unite(belief, view);
  double area = 0.0, outwards = -1.0, off = 0.0, off_smoothed = 0.0;
  const Field<Dim> smoothed = smooth(belief.view().psi, 4);
  const auto angle = [](const Vec<Dim>& a, const Vec<Dim>& b) { return std::acos(std::clamp(a.dot(b), -1.0, 1.0)); };
  for (const ShadowFace<Dim>& face : faces_of(belief.view().boundary)) {
    area += face.area(kH);
    outwards = std::max(outwards, face.normal.dot(face.center.normalized()));
    const Vec<Dim> slope = gradient(smoothed, window.local(face.seen)) + gradient(smoothed, window.local(face.unseen));
    off += angle(face.normal, -face.center.normalized());
    off_smoothed += angle(slope.normalized(), -face.center.normalized());
  }
  const double degrees = 180.0 / kPi / static_cast<double>(belief.view().boundary.size());
  EXPECT_LT(off * degrees, Dim == 2 ? 3.2 : 2.0);
  EXPECT_LT(off, 1.2 * off_smoothed);  // As good as smoothing four times, which costs a pass over everything.
  const double truth = Dim == 2 ? 2.0 * kPi * kRadius : 4.0 * kPi * kRadius * kRadius;
  EXPECT_NEAR(area, truth, 0.02 * truth);
  EXPECT_LT(outwards, -0.98);  // Into the seen space.
}

TYPED_TEST(BeliefTest, SameBitsOnAnyNumberOfThreads) {
  constexpr int Dim = TypeParam::value;
  const auto make = [&](int threads) {
    const ThreadLimit limit(threads);
    Belief<Dim> belief(domain<Dim>(), kEta);
    unite(belief, ball_view<Dim>(domain<Dim>(), Vec<Dim>::Constant(2.0), 2.5));
    unite(belief, ball_view<Dim>(domain<Dim>(), Vec<Dim>::Constant(4.0), 2.0));
    return belief;
  };
  const Belief<Dim> one = make(1), many = make(4);
  EXPECT_EQ(one.view().psi.values, many.view().psi.values);
  const auto a = faces_of(one.view().boundary), b = faces_of(many.view().boundary);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) ASSERT_TRUE(a[k].key == b[k].key && a[k].normal == b[k].normal);
}

/// Extrusion law: a plane's union, extruded, is the union on every slice. eta is wider than the obstacle blanket of both dimensions.
TEST(BeliefExtrusion, UnionAgreesOnEverySlice) {
  constexpr double kWide = 0.6;
  const Grid<2> plane = domain<2>();
  const Grid<3> solid{kH, {plane.first[0], plane.first[1], -1}, {plane.extent[0], plane.extent[1], 4}};
  Belief<2> flat(plane, kWide);
  Belief<3> tall(solid, kWide);
  for (const double x : {2.0, 5.0}) {
    const View<2> view = ball_view<2>(plane, Vec<2>::Constant(x), 2.5);
    View<3> extruded(solid);
    for (std::size_t i = 0; i < solid.size(); ++i) {
      extruded.known[i] = view.known[i % plane.size()];
      extruded.seen[i] = view.seen[i % plane.size()];
    }
    unite(flat, view);
    unite(tall, extruded);
  }
  for (std::size_t i = 0; i < solid.size(); ++i) {
    ASSERT_EQ(tall.view().state[i], flat.view().state[i % plane.size()]);
    ASSERT_EQ(tall.view().psi[i], flat.view().psi[i % plane.size()]);
  }
}

}  // namespace
}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/plain_sum.h"

#include <gtest/gtest.h>

#include "vantage/base/random.h"
#include "vantage/planner/test_belief.h"

namespace vantage {
namespace {

template <class T>
class PlainSumOf : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(PlainSumOf, Dimensions);

template <int Dim>
Vec<Dim> anywhere(Random& random, double side) {
  Vec<Dim> p;
  for (int a = 0; a < Dim; ++a) p[a] = random.uniform(-side, side);
  return p;
}

/// Elements of a few balls, some of them scattered with any normal, far from the origin of coordinates.
template <int Dim>
std::vector<BoundaryElement<Dim>> some_elements(std::size_t count, const Vec<Dim>& origin) {
  Random random(7, Dim);
  std::vector<Vec<Dim>> middles;
  for (int k = 0; k < 6; ++k) middles.push_back(anywhere<Dim>(random, 20.0));
  std::vector<BoundaryElement<Dim>> elements;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec<Dim> normal = anywhere<Dim>(random, 1.0).normalized();
    const bool loose = random.uniform() < 0.1;
    const Vec<Dim> place = loose ? anywhere<Dim>(random, 20.0) : Vec<Dim>(middles[random.below(6)] + 3.0 * normal);
    elements.push_back({origin + place, normal, random.uniform(0.01, 0.1)});
  }
  return elements;
}

template <int Dim>
struct Place {
  Place()
      : belief(cube<Dim>(2.0), [](const Vec<Dim>&) { return NodeState::seen; }), openness(belief.state.window), weight(belief.state.window, 3.0F) {}
  HandMade<Dim> belief;
  Field<Dim> openness, weight;  // w is 3 in the window, 1 elsewhere.
};

/// Largest difference to the sum term by term, over the largest sum.
template <int Dim>
double worst(const PlannerOptions& options, const Vec<Dim>& origin = Vec<Dim>::Zero()) {
  const Place<Dim> place;
  const RayMarch<Dim> rays(place.belief.view(), place.openness, {.weight = &place.weight});
  const auto elements = some_elements<Dim>(3000, origin);
  const PlainSum<Dim> sum(elements, rays, options);
  Random random(11, Dim);
  double largest = 0.0, difference = 0.0;
  for (int k = 0; k < 100; ++k) {
    const Vec<Dim> z = k == 0 ? elements[5].place : Vec<Dim>(origin + anywhere<Dim>(random, 25.0));
    const double slow = boundary_metric<Dim>(elements, rays, z, options);
    largest = std::max(largest, slow);
    difference = std::max(difference, std::abs(sum.at(z) - slow));
  }
  EXPECT_GT(largest, 0.1);
  return difference / largest;
}

PlannerOptions plain(double angle) {
  PlannerOptions options;
  options.line_of_sight = false;
  options.tree_angle = angle;
  return options;
}

/// Every way to write Eq. (1), element by element: only the rounding of floats is left.
TYPED_TEST(PlainSumOf, AngleZeroIsTheSumTermByTerm) {
  using Facing = PlannerOptions::Facing;
  for (const Facing facing : {Facing::seen, Facing::behind, Facing::absolute})
    for (const bool normalise : {true, false})
      for (const double tau : {0.0, 0.25, 0.5, 1.75, 2.0}) {
        PlannerOptions options = plain(0.0);
        options.facing = facing;
        options.normalise = normalise;
        options.tau_power = tau;
        const double rounding = tau < 1.0 ? 2e-6 : 1e-4;  // Steep terms of elements close by magnify it.
        EXPECT_LT(worst<TypeParam::value>(options), rounding) << static_cast<int>(facing) << normalise << tau;
      }
}

TYPED_TEST(PlainSumOf, WiderAnglesCostLittle) {
  constexpr int Dim = TypeParam::value;
  EXPECT_LT(worst<Dim>(plain(0.1)), 1e-3);
  EXPECT_LT(worst<Dim>(plain(0.2)), 4e-3);
  EXPECT_LT(worst<Dim>(plain(0.5)), 3e-2);
  EXPECT_GT(worst<Dim>(plain(0.5)), worst<Dim>(plain(0.0)));  // It does sum groups at once.
  PlannerOptions steep = plain(0.2);
  steep.tau_power = 2.0;
  EXPECT_LT(worst<Dim>(steep), 2e-3);
}

/// Without normalisation every term is linear in the place, so that two moments are all there is.
TYPED_TEST(PlainSumOf, TheSumAsPrintedIsExactFromAfar) {
  PlannerOptions options = plain(1.0);
  options.normalise = false;
  EXPECT_LT(worst<TypeParam::value>(options), 2e-6);
}

TYPED_TEST(PlainSumOf, LargeCoordinatesLoseNothing) {
  constexpr int Dim = TypeParam::value;
  EXPECT_LT(worst<Dim>(plain(0.0), Vec<Dim>::Constant(4.0e6)), 2e-6);
}

TYPED_TEST(PlainSumOf, NothingSumsToNothing) {
  constexpr int Dim = TypeParam::value;
  const Place<Dim> place;
  const RayMarch<Dim> rays(place.belief.view(), place.openness, {});
  EXPECT_EQ(PlainSum<Dim>({}, rays, plain(0.2)).at(Vec<Dim>::Zero()), 0.0);
}

}  // namespace
}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#include "vantage/world/blocks.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <map>

namespace vantage {
namespace {

template <class T>
class BlocksTest : public testing::Test {};
using Dims = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(BlocksTest, Dims);

template <int Dim>
Box<Dim> cube(double low, double high) {
  return {Vec<Dim>::Constant(low), Vec<Dim>::Constant(high)};
}

/// Content enclosed by an outward-facing closed surface, as the sum of the signed cones from the origin [m^Dim].
template <int Dim>
double enclosed(const Mesh<Dim>& mesh) {
  double sum = 0.0;
  for (const auto& facet : mesh.facets) {
    Eigen::Matrix<double, Dim, Dim> corners;
    for (int i = 0; i < Dim; ++i) corners.col(i) = mesh.vertices[facet[static_cast<std::size_t>(i)]];
    sum += corners.determinant();
  }
  return sum / std::tgamma(Dim + 1);
}

template <int Dim>
double power(double x) {
  return std::pow(x, Dim);
}

TYPED_TEST(BlocksTest, EnclosesWhatIsFilledLessWhatIsCarved) {
  constexpr int Dim = TypeParam::value;
  Mesh<Dim> mesh;
  Blocks<Dim>().fill(cube<Dim>(0.0, 4.0)).carve(cube<Dim>(1.0, 3.0)).fill(cube<Dim>(1.5, 2.0)).append_to(mesh);
  EXPECT_NEAR(enclosed(mesh), power<Dim>(4.0) - power<Dim>(2.0) + power<Dim>(0.5), 1e-12);
}

TYPED_TEST(BlocksTest, LaterStepsWin) {
  constexpr int Dim = TypeParam::value;
  Mesh<Dim> mesh;
  Blocks<Dim>().carve(cube<Dim>(0.0, 1.0)).fill(cube<Dim>(0.0, 2.0)).append_to(mesh);
  EXPECT_NEAR(enclosed(mesh), power<Dim>(2.0), 1e-12);
}

TYPED_TEST(BlocksTest, HasNoFacetInsideTheSolid) {
  constexpr int Dim = TypeParam::value;
  Mesh<Dim> mesh;
  Box<Dim> right = cube<Dim>(0.0, 1.0);
  right.low[0] += 1.0 + 1e-9;  // Meets the first within the tolerance.
  right.high[0] += 1.0;
  Blocks<Dim>().fill(cube<Dim>(0.0, 1.0)).fill(right).append_to(mesh);
  for (const auto& facet : mesh.facets) {
    Vec<Dim> middle = Vec<Dim>::Zero();
    for (std::uint32_t corner : facet) middle += mesh.vertices[corner] / Dim;
    EXPECT_GT(std::abs(middle[0] - 1.0), 0.1);
  }
  EXPECT_NEAR(enclosed(mesh), 2.0, 1e-8);
}

TYPED_TEST(BlocksTest, StandsWhereItIsPlaced) {
  constexpr int Dim = TypeParam::value;
  Box<Dim> box = cube<Dim>(0.0, 1.0);
  box.high[0] = 3.0;
  Mesh<Dim> mesh;
  const Placement<Dim> place = Placement<Dim>{Vec<Dim>::Constant(5.0)}.at(Vec<Dim>::Zero(), 0.5 * kPi);
  Blocks<Dim>().fill(box).append_to(mesh, place);
  Box<Dim> expected = cube<Dim>(5.0, 6.0);  // A quarter turn: x becomes y, y becomes -x.
  expected.low[0] = 4.0;
  expected.high[0] = 5.0;
  expected.high[1] = 8.0;
  EXPECT_LT((mesh.bounds().low - expected.low).norm() + (mesh.bounds().high - expected.high).norm(), 1e-12);
  EXPECT_NEAR(enclosed(mesh), 3.0, 1e-12);
}

}  // namespace
}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#include "vantage/geometry/clip.h"

#include <gtest/gtest.h>

#include "vantage/base/random.h"

namespace vantage {
namespace {

template <int Dim>
Frame<Dim> random_frame(Random& random, double half) {
  Frame<Dim> frame;
  Eigen::Matrix<double, Dim, Dim> m;
  for (int i = 0; i < Dim; ++i) {
    frame.origin[i] = random.uniform(-half, half);
    for (int j = 0; j < Dim; ++j) m(i, j) = random.uniform(-1.0, 1.0);
  }
  for (int i = 0; i < Dim; ++i) {  // Gram and Schmidt, twice over for accuracy.
    for (int j = 0; j < 2 * i; ++j) m.col(i) -= m.col(i).dot(m.col(j % i)) * m.col(j % i);
    m.col(i).normalize();
  }
  frame.axes = m;
  return frame;
}

template <class T>
class Clip : public ::testing::Test {};
using Dims = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Clip, Dims);

TYPED_TEST(Clip, PlaceIsInTheRegionIfItIsInTheBox) {
  constexpr int Dim = TypeParam::value;
  Random random(1);
  const Box<Dim> box{Vec<Dim>::Constant(-1.0), Vec<Dim>::Constant(1.0)};
  int inside = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const auto frame = random_frame<Dim>(random, 1.3);
    const auto region = clip_to_box(frame, box);
    EXPECT_LE(region.count, 2 * Dim);
    for (int i = 0; i < region.count; ++i) EXPECT_LT(box.distance(frame.origin + frame.axes.template leftCols<Dim - 1>() * region.vertices[i]), 1e-8);
    EXPECT_EQ(region.count > 0, region.measure() > 0.0);
    const RegionEdges<Dim - 1> edges(region);
    for (int i = 0; i < 50; ++i) {
      typename ConvexRegion<Dim - 1>::Place y;
      for (int k = 0; k < Dim - 1; ++k) y[k] = random.uniform(-2.5, 2.5);
      const bool in_box = box.grown(-1e-6).contains(frame.origin + frame.axes.template leftCols<Dim - 1>() * y);
      const bool off_box = !box.grown(1e-6).contains(frame.origin + frame.axes.template leftCols<Dim - 1>() * y);
      const bool in_region = region.count > 0 && (region.closest(y) - y).norm() == 0.0;
      if (in_box) {
        ++inside;
        EXPECT_TRUE(in_region);
      }
      EXPECT_FALSE(off_box && in_region);
      if (region.count > 0) {
        const double outside = edges.outside(y), distance = (region.closest(y) - y).norm();
        EXPECT_LE(outside, distance + 1e-9);
        EXPECT_EQ(outside > 1e-12, distance > 1e-12);
      }
    }
  }
  EXPECT_GT(inside, 500);
}

TYPED_TEST(Clip, PlaneInAFaceOfTheBoxStaysWhole) {
  constexpr int Dim = TypeParam::value;
  const Box<Dim> box{Vec<Dim>::Zero(), Vec<Dim>::Ones()};
  for (const double at : {0.0, 1.0}) {
    Frame<Dim> frame;
    frame.axes.setIdentity();
    frame.origin = Vec<Dim>::Constant(0.5);
    frame.origin[Dim - 1] = at;
    EXPECT_NEAR(clip_to_box(frame, box).measure(), 1.0, 1e-6);
    frame.origin[Dim - 1] = at + (at - 0.5) * 0.01;
    EXPECT_EQ(clip_to_box(frame, box).count, 0);
  }
}

TYPED_TEST(Clip, ClosestPlaceAgreesWithSampling) {
  constexpr int Dim = TypeParam::value;
  Random random(2);
  const Box<Dim> box{Vec<Dim>::Constant(-1.0), Vec<Dim>::Constant(1.0)};
  for (int trial = 0; trial < 50; ++trial) {
    const auto region = clip_to_box(random_frame<Dim>(random, 0.5), box);
    ASSERT_GT(region.count, 0);
    for (int i = 0; i < 20; ++i) {
      typename ConvexRegion<Dim - 1>::Place p;
      for (int k = 0; k < Dim - 1; ++k) p[k] = random.uniform(-3.0, 3.0);
      const auto q = region.closest(p);
      for (int s = 0; s < 50; ++s) {  // No convex combination of the corners is nearer.
        typename ConvexRegion<Dim - 1>::Place z = ConvexRegion<Dim - 1>::Place::Zero();
        double sum = 0.0;
        for (int c = 0; c < region.count; ++c) {
          const double weight = -std::log(1.0 - random.uniform());
          z += weight * region.vertices[c];
          sum += weight;
        }
        EXPECT_GE((z / sum - p).norm(), (q - p).norm() - 1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace vantage

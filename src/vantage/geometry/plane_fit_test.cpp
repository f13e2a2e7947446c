// SPDX-License-Identifier: Apache-2.0
#include "vantage/geometry/plane_fit.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>

#include "vantage/base/random.h"

namespace vantage {
namespace {

template <int Dim>
std::vector<Site<Dim>> random_sites(Random& random, std::size_t count, const Site<Dim>& base, int bits) {
  std::vector<Site<Dim>> sites(count);
  for (auto& site : sites)
    for (int a = 0; a < Dim; ++a) site[a] = base[a] + static_cast<std::uint32_t>(random.below(std::uint64_t{1} << bits));
  return sites;
}

template <class T>
class PlaneFit : public ::testing::Test {};
using Dims = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(PlaneFit, Dims);

TYPED_TEST(PlaneFit, MomentsAreExactAndAdd) {
  constexpr int Dim = TypeParam::value;
  Random random(1);
  for (const int bits : {1, 7, 20, 27, 28, 32}) {
    Site<Dim> base{};
    base.fill(bits == 32 ? 0U : 0xC0000000U);
    const auto sites = random_sites<Dim>(random, 3000, base, bits);
    Moments<Dim> expected;
    expected.count = 3000;
    for (const auto& site : sites)
      for (int i = 0, k = 0; i < Dim; ++i) {
        expected.sum[i] += site[i];
        for (int j = i; j < Dim; ++j) expected.product[k++] += static_cast<WideInt>(site[i]) * site[j];
      }
    const std::span<const Site<Dim>> all(sites);
    Moments<Dim> added = moments<Dim>(all.first(1234), base, bits);
    added.add(moments<Dim>(all.subspan(1234), base, bits));
    for (const auto& m : {moments<Dim>(all, base, bits), added}) {
      EXPECT_EQ(m.count, expected.count);
      EXPECT_TRUE(m.sum == expected.sum);
      EXPECT_TRUE(m.product == expected.product);
    }
  }
}

TYPED_TEST(PlaneFit, RecoversAPlaneToTheLastSteps) {
  constexpr int Dim = TypeParam::value;
  Random random(2);
  for (int trial = 0; trial < 20; ++trial) {
    Vec<Dim> normal;
    for (int a = 0; a < Dim; ++a) normal[a] = random.uniform(-1.0, 1.0);
    normal[0] += normal[0] < 0.0 ? -0.5 : 0.5;
    normal.normalize();
    std::vector<Site<Dim>> sites(500);
    for (auto& site : sites) {
      Vec<Dim> p;
      double rest = 2000.0 * normal[0];
      for (int a = 1; a < Dim; ++a) {
        p[a] = random.uniform(1000.0, 1100.0);
        rest -= (p[a] - 1000.0) * normal[a];
      }
      p[0] = rest / normal[0];
      for (int a = 0; a < Dim; ++a) site[a] = static_cast<std::uint32_t>(std::floor(p[a] / 4000.0 * 0x1p32 + 0.5));
    }
    const double step = 4000.0 * 0x1p-32;
    const auto frame = principal_frame<Dim>(moments<Dim>(sites, Site<Dim>{}, 32), step);
    EXPECT_NEAR((frame.axes.transpose() * frame.axes - Eigen::Matrix<double, Dim, Dim>::Identity()).norm(), 0.0, 1e-12);
    EXPECT_GE(frame.variance[0], frame.variance[Dim - 1]);
    for (const auto& site : sites) {
      Vec<Dim> p;
      for (int a = 0; a < Dim; ++a) p[a] = static_cast<double>(site[a]) * step;
      EXPECT_LT(std::abs(frame.local(p)[Dim - 1]), 1e-4);
    }
  }
}

TYPED_TEST(PlaneFit, VariancesAreThoseAlongTheAxes) {
  constexpr int Dim = TypeParam::value;
  Random random(3);
  const auto sites = random_sites<Dim>(random, 700, Site<Dim>{}, 20);
  const auto frame = principal_frame<Dim>(moments<Dim>(sites, Site<Dim>{}, 20), 0.5);
  Vec<Dim> mean2 = Vec<Dim>::Zero();
  for (const auto& site : sites) {
    Vec<Dim> p;
    for (int a = 0; a < Dim; ++a) p[a] = site[a] * 0.5;
    mean2 += frame.local(p).cwiseAbs2() / 700.0;
  }
  EXPECT_NEAR((mean2 - frame.variance).norm() / mean2.norm(), 0.0, 1e-9);
}

TYPED_TEST(PlaneFit, EqualPointsHaveNoVariance) {
  constexpr int Dim = TypeParam::value;
  Site<Dim> site{};
  site.fill(0xFFFFFFFFU);
  const std::vector<Site<Dim>> sites(1000, site);
  const auto frame = principal_frame<Dim>(moments<Dim>(sites, Site<Dim>{}, 32), 1.0);
  EXPECT_EQ(frame.variance, Vec<Dim>(Vec<Dim>::Zero()));
  EXPECT_EQ(frame.origin, Vec<Dim>(Vec<Dim>::Constant(4294967295.0)));
  EXPECT_NEAR(std::abs(frame.axes.determinant()), 1.0, 1e-12);
}

}  // namespace
}  // namespace vantage

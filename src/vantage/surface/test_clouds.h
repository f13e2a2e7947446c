// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <cstring>

#include "vantage/base/random.h"
#include "vantage/surface/surface.h"

namespace vantage {

template <int Dim>
using Cloud = std::vector<Vec<Dim>>;

template <int Dim>
Box<Dim> domain(double half = 5.0) {
  return {Vec<Dim>::Constant(-half), Vec<Dim>::Constant(half)};
}

template <int Dim>
Vec<Dim> anywhere(Random& random, double half) {
  Vec<Dim> p;
  for (int a = 0; a < Dim; ++a) p[a] = random.uniform(-half, half);
  return p;
}

/// Two walls that meet, a floor-like slope, a ball, a wire and dust.
template <int Dim>
Cloud<Dim> scene(std::uint64_t seed, std::size_t count) {
  Random random(seed);
  Cloud<Dim> cloud;
  for (std::size_t i = 0; i < count; ++i) {
    Vec<Dim> p = anywhere<Dim>(random, 4.9);
    switch (random.below(8)) {
      case 0:
      case 1: p[0] = -4.0; break;
      case 2: p[1] = -4.5; break;
      case 3: p[Dim - 1] = 0.3 * p[0] - 1.0; break;
      case 4: p = Vec<Dim>::Constant(1.5) + 1.2 * anywhere<Dim>(random, 1.0).normalized(); break;
      case 5: p = Vec<Dim>::Constant(0.5) + p[0] * Vec<Dim>::Unit(0) + 0.2 * p[0] * Vec<Dim>::Unit(1); break;
      default:
        if (random.below(20) != 0) p[1] = 3.0 + 0.02 * random.normal();
    }
    if (domain<Dim>().contains(p)) cloud.push_back(p);
  }
  return cloud;
}

template <int Dim>
double distance_to(const std::vector<Patch<Dim>>& patches, const Vec<Dim>& p) {
  double best = kInfinity;
  for (const Patch<Dim>& patch : patches)
    if (patch.bounds().distance(p) < best) best = std::min(best, distance(patch, p));
  return best;
}

template <int Dim>
double distance_to(const Cloud<Dim>& cloud, const Vec<Dim>& p) {
  double best = kInfinity;
  for (const Vec<Dim>& q : cloud) best = std::min(best, (p - q).squaredNorm());
  return std::sqrt(best);
}

template <int Dim>
double data_to_surface(const Cloud<Dim>& cloud, const std::vector<Patch<Dim>>& patches) {
  double worst = 0.0;
  for (const Vec<Dim>& p : cloud) worst = std::max(worst, distance_to(patches, p));
  return worst;
}

/// Samples of a patch, random convex combinations and its corners.
template <int Dim>
double surface_to_data(const std::vector<Patch<Dim>>& patches, const Cloud<Dim>& cloud, int samples) {
  Random random(77);
  double worst = 0.0;
  for (const Patch<Dim>& patch : patches) {
    for (const Vec<Dim>& corner : patch.corners()) worst = std::max(worst, distance_to(cloud, corner));
    for (int s = 0; s < samples && patch.count > 1; ++s) {
      Vec<Dim> p = Vec<Dim>::Zero();
      double sum = 0.0;
      for (const Vec<Dim>& corner : patch.corners()) {
        const double weight = std::pow(random.uniform(), 3.0);
        p += weight * corner;
        sum += weight;
      }
      const double d = distance_to(cloud, Vec<Dim>(p / sum));
      EXPECT_LE(d, static_cast<double>(patch.surface_to_data));
      worst = std::max(worst, d);
    }
  }
  return worst;
}

template <int Dim>
bool same_patches(const std::vector<Patch<Dim>>& a, const std::vector<Patch<Dim>>& b) {
  const auto equal = [](const Patch<Dim>& p, const Patch<Dim>& q) {
    return p.count == q.count && std::memcmp(&p.data_to_surface, &q.data_to_surface, 2 * sizeof(float)) == 0 &&
           std::memcmp(p.vertices.data(), q.vertices.data(), static_cast<std::size_t>(p.count) * sizeof(Vec<Dim>)) == 0;
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), equal);
}

template <int Dim>
void expect_same(const HausdorffTree<Dim>& a, const HausdorffTree<Dim>& b) {
  EXPECT_TRUE(same_patches(a.patches(), b.patches()));
  const SurfaceStatistics s = a.statistics(), t = b.statistics();
  EXPECT_EQ(s.points, t.points);
  EXPECT_EQ(s.outside, t.outside);
  EXPECT_EQ(s.not_finite, t.not_finite);
  EXPECT_EQ(s.depth, t.depth);
  EXPECT_EQ(s.nodes, t.nodes);
  EXPECT_EQ(s.leaves, t.leaves);
  EXPECT_EQ(s.fits, t.fits);
  EXPECT_EQ(s.segments, t.segments);
  EXPECT_EQ(s.loose_points, t.loose_points);
  EXPECT_EQ(s.data_to_surface, t.data_to_surface);
  EXPECT_EQ(s.surface_to_data, t.surface_to_data);
}

template <int Dim>
HausdorffTree<Dim> tree_of(const Cloud<Dim>& cloud, const SurfaceOptions& options = {}) {
  HausdorffTree<Dim> tree(domain<Dim>(), options);
  tree.insert(cloud);
  return tree;
}

/// The certificate against an exhaustive verifier, and the counts of Table I.
template <int Dim>
void expect_certified(const HausdorffTree<Dim>& tree, const Cloud<Dim>& cloud, int samples = 8) {
  const SurfaceStatistics statistics = tree.statistics();
  const auto patches = tree.patches();
  EXPECT_EQ(statistics.points, static_cast<std::int64_t>(cloud.size()));
  EXPECT_EQ(statistics.leaves, ((1 << Dim) - 1) * (statistics.nodes - statistics.leaves) + 1);
  EXPECT_EQ(statistics.fits + statistics.segments + statistics.loose_points, static_cast<std::int64_t>(patches.size()));
  EXPECT_LE(statistics.certified(), statistics.eta);
  EXPECT_LE(data_to_surface(cloud, patches), statistics.data_to_surface);
  EXPECT_LE(surface_to_data(patches, cloud, samples), statistics.surface_to_data);
}

}  // namespace vantage

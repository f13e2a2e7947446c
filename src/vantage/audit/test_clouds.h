// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "vantage/audit/certificate.h"
#include "vantage/base/random.h"
#include "vantage/surface/surface.h"

namespace vantage::test {

template <int Dim>
using Cloud = std::vector<Vec<Dim>>;

/// Uniform in the cube from -half to half.
template <int Dim>
Vec<Dim> anywhere(Random& random, double half) {
  Vec<Dim> p;
  for (int a = 0; a < Dim; ++a) p[a] = random.uniform(-half, half);
  return p;
}

/// The cloud's tree over a domain a little larger than its finite points, as `vantage reconstruct` makes it.
template <int Dim>
HausdorffTree<Dim> reconstruct(const Cloud<Dim>& cloud, const SurfaceOptions& options) {
  Box<Dim> box;
  for (const Vec<Dim>& p : cloud)
    if (p.allFinite()) box.extend(p);
  if (box.empty()) box.extend(Vec<Dim>::Zero());
  HausdorffTree<Dim> tree(box.grown(0.001 * box.size().maxCoeff() + 1e-6), options);
  tree.insert(cloud);
  return tree;
}

template <int Dim>
Certificate certificate_of(const HausdorffTree<Dim>& tree) {
  const SurfaceStatistics s = tree.statistics();
  return {s.eta, s.data_to_surface, s.surface_to_data, !tree.options().paper};
}

}  // namespace vantage::test

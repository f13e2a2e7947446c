// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "vantage/geometry/patch.h"
#include "vantage/surface/cell_fit.h"
#include "vantage/surface/snap.h"

namespace vantage {

template <int Dim>
  requires SpatialDim<Dim>
class Proof;
template <int Dim>
struct InnerNode;
template <int Dim>
struct Refusal;

/// Sums over a subtree, by the names of SurfaceStatistics.
struct Totals {
  std::int64_t points = 0, sites = 0, nodes = 0, leaves = 0, fits = 0, segments = 0, loose = 0, beyond_eta = 0;
  int depth = 0;
  float data_to_surface = 0.0F, surface_to_data = 0.0F;

  void add(const Totals& other);
};

template <int Dim>
struct LeafNode {
  std::vector<Site<Dim>> sites;  ///< In Morton order.
  CellFit<Dim> fit;              ///< Of its loose sites, those in one place are there once.
  std::int64_t points = 0;       ///< That the sites stand for.
  /// Bounds of each patch, at most 10 % above the truth; empty: not worked out yet.
  struct Sharp {
    float data_to_surface, surface_to_data;
  };
  std::vector<Sharp> sharp;
};

/// Node of the Hausdorff tree; an empty leaf has neither.
template <int Dim>
struct Node {
  std::unique_ptr<LeafNode<Dim>> leaf;
  std::unique_ptr<InnerNode<Dim>> inner;
};

template <int Dim>
struct InnerNode {
  std::array<Node<Dim>, Cell<Dim>::kChildren> children;
  Totals totals;
  bool sharp = false;                     ///< Sharp bounds are worked out everywhere below.
  std::unique_ptr<Proof<Dim>> proof;      ///< That the cell had to be split; null if none was found.
  std::unique_ptr<Moments<Dim>> moments;  ///< Of all sites below, in large cells without a proof: these are asked again.
  std::unique_ptr<Refusal<Dim>> refusal;  ///< Why the plane of a large cell without a proof failed the last time, if known.
};

}  // namespace vantage

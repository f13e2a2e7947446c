// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <span>
#include <string>

#include "vantage/exchange/exchange_map.h"

namespace vantage {

/// One vehicle's side of the exchange: turns its scans into deltas, one after the other.
template <int Dim>
  requires SpatialDim<Dim>
class Publisher {
 public:
  /// `source` names the vehicle among all; no certified error of its deltas exceeds `tolerance` [m]. Throws bad_input for what no delta may have.
  Publisher(std::string source, double tolerance);
  ~Publisher();
  Publisher(Publisher&&) noexcept;
  Publisher& operator=(Publisher&&) noexcept;

  /// What the points of a scan, (N, Dim) [m], add to what was published before. Points that are not finite, or more than 2^29 cells (about
  /// tolerance * 10^9) from the origin, are left out. Depends on the set of points, not on their order or the number of threads. Cost follows the
  /// scan, not the map.
  [[nodiscard]] Delta publish(std::span<const Vec<Dim>> points);
  /// Goes on where a map stops: its deltas of this source and tolerance count as published. Throws bad_input for another dimension.
  void resume(const ExchangeMap& map);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vantage

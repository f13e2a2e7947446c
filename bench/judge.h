// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "cloud.h"
#include "distance.h"

namespace vantage::bench {

/// One side of a Hausdorff distance [m].
struct Side {
  double maximum = 0.0, p99 = 0.0, mean = 0.0;
};

/// How good a reconstruction is.
struct Score {
  Side data_to_surface;  ///< Over all measured points.
  /// Over all places of the reconstruction: the maximum decided within 1 mm by branch and bound, the others over places at most 0.1 m apart.
  Side surface_to_data;
  double poles = 0.0, wires = 0.0;  ///< Share of the observed true surface with the reconstruction within 0.1 m [1].

  [[nodiscard]] double worst() const { return std::max(data_to_surface.maximum, surface_to_data.maximum); }
};

/// The same measure for every contender: made once from the data and the truth.
class Judge {
 public:
  Judge(const Scene<3>& scene, std::span<const Vec<3>> points);
  [[nodiscard]] Score score(const Soup& soup) const;
  [[nodiscard]] std::size_t pole_places() const { return poles_.size(); }
  [[nodiscard]] std::size_t wire_places() const { return wires_.size(); }

 private:
  std::span<const Vec<3>> points_;
  Nearest data_;
  std::vector<Vec<3>> poles_, wires_;
};

}  // namespace vantage::bench

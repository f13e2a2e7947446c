// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "vantage/field/belief_view.h"
#include "vantage/planner/ray_march.h"

namespace vantage {

/// A face of the shadow boundary and what is made of it.
template <int Dim>
struct BoundaryFace : ShadowFace<Dim> {
  double known_distance = 0.0;        ///< Of the nearer of its nodes to the known surface [m].
  double frontal = 0.0;               ///< Best cosine at which an earlier observer in line of sight has looked at it [1].
  int frontal_views = 0;              ///< How many looked at it at a cosine above 0.08.
  std::array<std::uint8_t, 3> bin{};  ///< Distance, evidence, company.
  double probability = 0.5;           ///< That it opens when looked at [1].
};

/// Which boundary faces are true shadow boundary, learned while exploring (planner.md Sec. 2): faces alike in distance to the known surface, in how
/// frontally they were looked at, and in company share one Beta count of how often such faces opened.
template <int Dim>
  requires SpatialDim<Dim>
class OpeningModel {
 public:
  static constexpr int kDistanceBins = 5, kEvidenceBins = 8, kCompanyBins = 3;
  enum class Rule { learned, masks };  ///< masks: probability 1 or 0 by the two rules of method.md Sec. 5.

  explicit OpeningModel(Rule rule) : rule_(rule) {}

  /// Takes in the belief after a scan from `observer`: counts which of the old faces in view opened, then lists the faces anew. `grid`: see
  /// RayMarch::Medium.
  void update(const BeliefView<Dim>& view, const Vec<Dim>& observer, double max_range, const MarchGrid<Dim>* grid = nullptr);

  [[nodiscard]] std::span<const BoundaryFace<Dim>> faces() const { return faces_; }
  /// Per unseen node the largest probability of its faces; 0 elsewhere.
  [[nodiscard]] const Field<Dim>& openness() const { return openness_; }

 private:
  void learn(const RayMarch<Dim>& rays, const BeliefView<Dim>& view, const Vec<Dim>& observer, double max_range);
  void list_faces(const BeliefView<Dim>& view);
  void gather_evidence(const RayMarch<Dim>& rays, double max_range);
  void classify(const Grid<Dim>& grid);

  Rule rule_;
  std::vector<Vec<Dim>> observers_;
  std::vector<BoundaryFace<Dim>> faces_;                                                      // In the order of the view's boundary.
  Field<Dim> openness_, failures_;                                                            // failures_: F of planner.md, per unseen node.
  std::array<std::array<double, 2>, kDistanceBins * kEvidenceBins * kCompanyBins> counts_{};  // Opened, stayed.
};

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/opening.h"

#include <algorithm>
#include <cmath>

#include "vantage/base/parallel.h"

namespace vantage {
namespace {

constexpr double kPriorStrength = 4.0;
constexpr std::array<double, 5> kPriorByDistance{.01, .05, .5, .5, .5};
constexpr std::array<double, 8> kPriorByEvidence{1, .8, .4, .15, .05, .2, .05, .02};

/// Number of `edges` at or below `value`.
template <std::size_t N>
std::uint8_t bin_of(double value, const std::array<double, N>& edges) {
  return static_cast<std::uint8_t>(std::upper_bound(edges.begin(), edges.end(), value) - edges.begin());
}

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
void OpeningModel<Dim>::update(const BeliefView<Dim>& view, const Vec<Dim>& observer, double max_range, const MarchGrid<Dim>* grid) {
  if (openness_.values.empty()) openness_ = failures_ = Field<Dim>(view.window());
  observers_.push_back(observer);
  const RayMarch<Dim> rays(view, openness_, {0.0, max_range, 0.0, nullptr, grid});
  learn(rays, view, observer, max_range);
  for (const BoundaryFace<Dim>& face : faces_) openness_[face.unseen] = 0.0F;
  list_faces(view);
  gather_evidence(rays, max_range);
  classify(view.window());
}

template <int Dim>
  requires SpatialDim<Dim>
void OpeningModel<Dim>::learn(const RayMarch<Dim>& rays, const BeliefView<Dim>& view, const Vec<Dim>& observer, double max_range) {
  const double h = view.window().spacing;
  std::vector<float> cosine(faces_.size(), -1.0F);  // At which the new scan looked at an old face; -1: it did not.
  parallel_for(faces_.size(), 256, [&](std::size_t i) {
    const Vec<Dim> to_observer = observer - faces_[i].center;
    const double distance = to_observer.norm();
    if (distance > max_range || distance == 0.0) return;
    const double c = faces_[i].step().dot(to_observer) / distance;
    if (c >= 0.03 && rays.line_of_sight(observer, faces_[i].center, 1.5 * h)) cosine[i] = static_cast<float>(c);
  });
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    if (cosine[i] < 0.0F) continue;
    const auto& [a, c, l] = faces_[i].bin;
    const bool opened = view.seen(faces_[i].unseen);
    if (cosine[i] >= 0.3F) counts_[static_cast<std::size_t>((a * kEvidenceBins + c) * kCompanyBins + l)][opened ? 0 : 1] += 1.0;
    if (view.state[faces_[i].unseen] == NodeState::unseen) {
      const double frontal = std::min(1.0, static_cast<double>(cosine[i]) / 0.3);
      failures_[faces_[i].unseen] += static_cast<float>(frontal * frontal);
    }
  }
}

template <int Dim>
  requires SpatialDim<Dim>
void OpeningModel<Dim>::list_faces(const BeliefView<Dim>& view) {
  std::vector<BoundaryFace<Dim>> faces;
  faces.reserve(view.boundary.size());
  view.boundary.for_faces([&](const ShadowFace<Dim>& face) {
    faces.push_back({face, static_cast<double>(std::min(view.known_distance[face.seen], view.known_distance[face.unseen]))});
  });
  // What earlier observers made of a face stays with it.
  auto old = faces_.begin();
  for (BoundaryFace<Dim>& face : faces) {
    while (old != faces_.end() && old->key < face.key) ++old;
    face.frontal = -1.0;
    if (old == faces_.end() || old->key != face.key) continue;
    face.frontal = old->frontal;
    face.frontal_views = old->frontal_views;
  }
  faces_ = std::move(faces);
}

template <int Dim>
  requires SpatialDim<Dim>
void OpeningModel<Dim>::gather_evidence(const RayMarch<Dim>& rays, double max_range) {
  const double h = openness_.window.spacing;
  parallel_for(faces_.size(), 64, [&](std::size_t i) {
    BoundaryFace<Dim>& face = faces_[i];
    const Vec<Dim> before = face.center + 0.7 * h * face.normal;
    // A new face hears every observer, an old one only the newest.
    for (std::size_t k = face.frontal < 0.0 ? 0 : observers_.size() - 1; k < observers_.size(); ++k) {
      const Vec<Dim> to_observer = observers_[k] - face.center;
      const double distance = to_observer.norm();
      if (distance > max_range || distance == 0.0) continue;
      const double cosine = to_observer.dot(face.normal) / distance;
      if (cosine <= std::max(face.frontal, 0.03) && (cosine <= 0.08 || face.frontal_views >= 2)) continue;
      if (!rays.line_of_sight(observers_[k], before, 2.5 * h)) continue;
      face.frontal = std::max(face.frontal, cosine);
      if (cosine > 0.08) ++face.frontal_views;
    }
    face.frontal = std::max(face.frontal, 0.0);
  });
}

template <int Dim>
  requires SpatialDim<Dim>
void OpeningModel<Dim>::classify(const Grid<Dim>& grid) {
  const double h = grid.spacing;
  Grid<Dim> blocks = grid;  // Of 3 h.
  blocks.extent = (grid.extent.array() + 2) / 3;
  const auto block = [&](std::size_t node) { return blocks.linear(grid.local(node) / 3); };
  std::vector<int> company(blocks.size());
  for (const BoundaryFace<Dim>& face : faces_)
    if (face.known_distance >= 0.75 * h) ++company[block(face.unseen)];
  for (BoundaryFace<Dim>& face : faces_) {
    const double failed = static_cast<double>(failures_[face.unseen]);
    const int others = company[block(face.unseen)];
    const auto a = bin_of(face.known_distance / h, std::array{.5, .75, 1.2, 2.0});
    const auto c =
        failed >= 0.3 ? static_cast<std::uint8_t>(4 + bin_of(failed, std::array{.3, .9, 2.0})) : bin_of(face.frontal, std::array{.03, .08, .16, .3});
    const auto l = static_cast<std::uint8_t>(others == 0 ? 0 : others <= 2 * (Dim - 1) ? 1 : 2);
    face.bin = {a, c, l};
    if (rule_ == Rule::learned) {
      const auto& [opened, stayed] = counts_[static_cast<std::size_t>((a * kEvidenceBins + c) * kCompanyBins + l)];
      const double prior = kPriorByDistance[a] * kPriorByEvidence[c];
      face.probability = (opened + kPriorStrength * prior) / (opened + stayed + kPriorStrength);
    } else {
      face.probability = face.known_distance > 0.75 * h && face.frontal <= 0.3 && face.frontal_views < 2 ? 1.0 : 0.0;
    }
    openness_[face.unseen] = std::max(openness_[face.unseen], static_cast<float>(face.probability));
  }
}

template class OpeningModel<2>;
template class OpeningModel<3>;

}  // namespace vantage

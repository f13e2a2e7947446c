// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "vantage/geometry/patch.h"
#include "vantage/geometry/ray_caster.h"
#include "vantage/planner/opening.h"

namespace vantage {

/// Length of the unseen straight behind a face, at most `limit` [m].
template <int Dim>
[[nodiscard]] double depth_behind(const BeliefView<Dim>& view, const BoundaryFace<Dim>& face, double limit);

/// What a run still has to look at before it may end: whatever is expected of it, nobody has looked there frontally.
struct LastLook {
  struct Open {
    std::size_t unseen = 0;        ///< Node that may be seen.
    std::size_t viewer = kNoNode;  ///< Node it is seen from best, of those tried.
    bool slit = false;             ///< Only through a gap of the known surface.
  };
  bool asked = false;  ///< False: `open` says nothing.
  std::vector<std::size_t>
      stubborn;                      ///< Ascending: unseen nodes in the open that stay unseen although nothing known hides them from where one stood.
  std::vector<Open> open;            ///< Ascending by `unseen`, none twice.
  std::optional<std::size_t> place;  ///< The node from where most may open.
  double volume = 0.0;               ///< At most, from there [m^Dim].

  [[nodiscard]] const Open* find(std::size_t unseen) const;
};

/// Where one may stand, where one stood, and what is known to be in the way.
template <int Dim>
struct Ground {
  const Field<Dim, std::uint8_t>& reachable;
  std::span<const Vec<Dim>> visited;
  double max_range = 80.0;                  ///< Of the sensor [m].
  const RayCaster<Dim>* surface = nullptr;  ///< As known; none: every obstacle node is in the way.
  bool slits = true;                        ///< Ask for what lies beside the known surface too: slits, and the shadow boundary there.
  const Field<Dim>* weight = nullptr;       ///< w per node, as RayMarch::Medium; nobody looks where it is 0.
};

/// Known patches as a mesh for rays, each grown by `margin` in its own plane [m].
template <int Dim>
[[nodiscard]] Mesh<Dim> patch_mesh(std::span<const Patch<Dim>> patches, double margin);

/// Remembers what has been looked at in vain, face by face. A question is a face of an unseen node: with a seen node, the shadow boundary; with an
/// obstacle node, for there may be a slit narrower than the lattice between the patches.
template <int Dim>
  requires SpatialDim<Dim>
class LastLooks {
 public:
  /// Tries the open questions from the reachable nodes that are new, an even choice where there are many: in range, nothing known in the way.
  /// Cost: some 100,000 lines of sight.
  [[nodiscard]] LastLook look(const BeliefView<Dim>& view, std::span<const BoundaryFace<Dim>> faces, const Ground<Dim>& ground) const;
  /// A scan will be taken at this node: what it sees frontally is answered then.
  void answer(const BeliefView<Dim>& view, std::span<const BoundaryFace<Dim>> faces, const Ground<Dim>& ground, std::size_t place);

 private:
  struct Question {
    std::size_t unseen = 0;
    Vec<Dim> center, step;  // Of the face; from the unseen node.
    double behind = 0.0;    // Volume straight behind it [m^Dim].
    bool slit = false;
  };
  [[nodiscard]] std::vector<Question> questions(const BeliefView<Dim>& view, std::span<const BoundaryFace<Dim>> faces,
                                                const Ground<Dim>& ground) const;

  Field<Dim> answered_;  // Per unseen node; 1: looked at frontally.
};

/// Seen nodes that someone with the clearance might get to although no node of the lattice leads there: known places half a step apart are tried,
/// with the distance to the surface that their nodes allow. The reachable nodes are not among them (1, else 0).
template <int Dim>
[[nodiscard]] Field<Dim, std::uint8_t> squeezed_nodes(const BeliefView<Dim>& view, const Field<Dim, std::uint8_t>& reachable, double clearance);

}  // namespace vantage

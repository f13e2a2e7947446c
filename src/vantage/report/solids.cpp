// SPDX-License-Identifier: Apache-2.0
#include "vantage/report/solids.h"

#include <algorithm>
#include <array>

#include "vantage/base/parallel.h"

namespace vantage {

namespace {

constexpr Rgb kShade{126, 130, 142};
constexpr double kSteep = 0.35;  ///< Patches whose normal rises less are walls.

/// Clay under a sun over the viewer's left shoulder, and cooler in its shade; both sides of a patch are alike.
Rgb lit_clay(const Patch<3>& patch, const Camera& camera) {
  Vec<3> n = normal(patch);
  if (n.dot(camera.forward()) > 0.0) n = -n;
  const Vec<3> sun = (Vec<3>::UnitZ() * 1.1 - camera.forward() * 0.35 - camera.right() * 0.55).normalized();
  return mix(kShade, kClay, std::clamp(1.08 * n.dot(sun) + 0.12, 0.0, 1.0));
}

/// Colour of a single point or a thin piece at a height.
Rgb mark_colour(const Patch<3>& patch, const ModelView& view) {
  const std::array<Rgb, 2> kinds{kLoose, kWire}, clays{scaled(kClay, 0.86), scaled(kClay, 0.8)};
  const Rgb colour = (view.colours == Colours::by_kind ? kinds : clays)[static_cast<std::size_t>(patch.rank())];
  const auto [low, high] = view.heights;
  return scaled(colour, 0.78 + 0.37 * std::clamp((patch.corners()[0].z() - low) / std::max(high - low, 1e-9), 0.0, 1.0));
}

/// A single point or a thin piece.
void draw_mark(Raster& raster, const Patch<3>& patch, Rgb colour) {
  const auto ends = patch.corners();
  if (patch.rank() == 0) {
    raster.point(ends[0], 1.2, colour);
  } else {
    raster.segment(ends[0], ends[1], 2.0, colour);
  }
}

void draw_patch(Raster& raster, const Patch<3>& patch, const ModelView& view) {
  if (patch.rank() < 2) {
    draw_mark(raster, patch, mark_colour(patch, view));
  } else {
    raster.polygon(patch.corners(), lit_clay(patch, raster.camera()));
  }
}

/// The corners of the patch's meeting with the plane z = cut: none or two.
std::vector<Vec<3>> section(const Patch<3>& patch, double cut) {
  const auto corners = patch.corners();
  std::vector<Vec<3>> ends;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec<3>&a = corners[i], &b = corners[(i + 1) % corners.size()];
    if ((a.z() <= cut) == (b.z() <= cut)) continue;
    ends.push_back(a + (b - a) * ((cut - a.z()) / (b.z() - a.z())));
  }
  return ends;
}

/// A flat piece on the plan: itself, its edges if it is a wall below the cut, and the line where it is cut.
void draw_cut(Raster& raster, const Patch<3>& patch, const ModelView& view, double cut) {
  const std::vector<Vec<3>> ends = section(patch, cut);
  if (ends.size() == 2) raster.segment(ends[0], ends[1], 2.6, kSection);
  if (patch.bounds().high.z() > cut) return;
  draw_patch(raster, patch, view);
  if (std::abs(normal(patch).z()) > kSteep) return;
  const auto corners = patch.corners();
  for (std::size_t k = 0; k < corners.size(); ++k) raster.segment(corners[k], corners[(k + 1) % corners.size()], 1.0, kShade);
}

bool is_empty(const Patch<3>& patch, const ModelView& view) { return patch.count == 0 || patch.bounds().intersection(view.domain).empty(); }

}  // namespace

void draw_patches(Raster& raster, std::span<const Patch<3>> patches, const ModelView& view) {
  parallel_for(patches.size(), 256, [&](std::size_t i) {
    if (!is_empty(patches[i], view)) draw_patch(raster, patches[i], view);
  });
}

void draw_plan(Raster& raster, std::span<const Patch<3>> patches, const ModelView& view, const PlanCut& cut) {
  parallel_for(patches.size(), 256, [&](std::size_t i) {
    const Patch<3>& patch = patches[i];
    const double low = patch.bounds().low.z();
    if (is_empty(patch, view) || low > cut.height) return;
    if (patch.rank() == 2) return draw_cut(raster, patch, view, cut.height);
    const bool is_cut = patch.bounds().high.z() > cut.height - cut.reach;
    draw_mark(raster, patch, is_cut ? kSection : mark_colour(patch, view));
  });
}

}  // namespace vantage

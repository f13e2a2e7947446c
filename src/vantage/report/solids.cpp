// SPDX-License-Identifier: Apache-2.0
#include "vantage/report/solids.h"

#include <algorithm>

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

void draw_patch(Raster& raster, const Patch<3>& patch, Colours colours) {
  const auto corners = patch.corners();
  const bool kinds = colours == Colours::by_kind;
  switch (patch.rank()) {
    case 0: raster.point(corners[0], kinds ? 1.3 : 0.8, kinds ? kLoose : scaled(kClay, 0.75)); break;
    case 1: raster.segment(corners[0], corners[1], 2.0, kinds ? kWire : scaled(kClay, 0.7)); break;
    default: raster.polygon(corners, lit_clay(patch, raster.camera()));
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

}  // namespace

void draw_patches(Raster& raster, std::span<const Patch<3>> patches, const Box<3>& domain, Colours colours) {
  parallel_for(patches.size(), 256, [&](std::size_t i) {
    if (!patches[i].bounds().intersection(domain).empty()) draw_patch(raster, patches[i], colours);
  });
}

void draw_plan(Raster& raster, std::span<const Patch<3>> patches, const Box<3>& domain, double cut) {
  parallel_for(patches.size(), 256, [&](std::size_t i) {
    const Patch<3>& patch = patches[i];
    const Box<3> box = patch.bounds();
    if (box.low.z() > cut || box.intersection(domain).empty()) return;
    if (box.high.z() <= cut) draw_patch(raster, patch, Colours::clay);
    if (patch.rank() < 2) return;
    const std::vector<Vec<3>> ends = section(patch, cut);
    if (ends.size() == 2) raster.segment(ends[0], ends[1], 2.6, kSection);
    if (std::abs(normal(patch).z()) > kSteep || box.high.z() > cut) return;
    const auto corners = patch.corners();
    for (std::size_t k = 0; k < corners.size(); ++k) raster.segment(corners[k], corners[(k + 1) % corners.size()], 1.0, kShade);
  });
}

}  // namespace vantage

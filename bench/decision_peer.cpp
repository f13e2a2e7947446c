// SPDX-License-Identifier: Apache-2.0
#include "decision_peer.h"

#ifdef VANTAGE_OCTOMAP
#include <octomap/OcTree.h>
#include <time.h>

#include <algorithm>
#include <cmath>

#include "vantage/planner/ray_march.h"

namespace vantage::bench {
namespace {

double cpu_seconds() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

octomap::point3d narrow(const Vec<3>& p) { return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])}; }

octomap::OcTree tree_of(const BeliefView<3>& view) {
  octomap::OcTree tree(view.window().spacing);
  for (std::size_t i = 0; i < view.window().size(); ++i) {
    if (view.state[i] == NodeState::unseen) continue;
    // Nodes are the voxels' centres.
    const Vec<3> center = view.window().position(i).array() + 0.5 * view.window().spacing;
    tree.setNodeValue(narrow(center), view.seen(i) ? tree.getProbMissLog() : tree.getProbHitLog(), true);
  }
  tree.updateInnerOccupancy();
  tree.prune();
  return tree;
}

struct Gain {
  double rays = 0.0, volume = 0.0;
};

Gain gain_of(const octomap::OcTree& tree, const Vec<3>& view, std::span<const Vec<3>> directions, double range, bool beyond) {
  Gain gain;
  const octomap::point3d origin = narrow(view);
  octomap::point3d end, wall;
  for (const Vec<3>& d : directions) {
    if (tree.castRay(origin, narrow(d), end, false, range) || tree.search(end) != nullptr) continue;  // A wall, or free as far as it goes.
    gain.rays += 1.0;
    if (!beyond) continue;
    const bool hit = tree.castRay(end, narrow(d), wall, true, std::max(0.01, range - static_cast<double>((end - origin).norm())));
    const double near = (end - origin).norm(), far = hit ? static_cast<double>((wall - origin).norm()) : range;
    gain.volume += std::max(0.0, far * far * far - near * near * near);
  }
  return gain;
}

}  // namespace

std::optional<PeerChoice> octomap_choice(const BeliefView<3>& view, std::span<const Vec<3>> views, double range) {
  const octomap::OcTree tree = tree_of(view);
  const auto directions = spread_directions<3>(4050, 1);
  const Vec<3> half = Vec<3>::Constant(0.5 * view.window().spacing);
  PeerChoice choice;
  std::vector<Gain> gains(views.size());
  const auto all = [&](bool beyond) {
    const double begin = cpu_seconds();
    for (std::size_t i = 0; i < views.size(); ++i) gains[i] = gain_of(tree, views[i] + half, directions, range, beyond);
    return cpu_seconds() - begin;
  };
  const auto best = [&](double Gain::* term) {
    return static_cast<std::size_t>(std::max_element(gains.begin(), gains.end(), [term](const Gain& a, const Gain& b) { return a.*term < b.*term; }) -
                                    gains.begin());
  };
  choice.cpu = all(false);
  choice.cpu_volume = all(true);
  choice.most_rays = best(&Gain::rays);
  choice.most_volume = best(&Gain::volume);
  return choice;
}

}  // namespace vantage::bench
#else
namespace vantage::bench {
std::optional<PeerChoice> octomap_choice(const BeliefView<3>&, std::span<const Vec<3>>, double) { return std::nullopt; }
}  // namespace vantage::bench
#endif

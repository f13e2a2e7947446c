// SPDX-License-Identifier: Apache-2.0
// OctoMap 1.9: only the voxels that are hit, or with the free ones along the rays.
#include <octomap/OcTree.h>

#include "../contender.h"

namespace vantage::bench {
namespace {

octomap::point3d narrow(const Vec<3>& p) { return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])}; }
Vec<3> widen(const octomap::point3d& p) { return {p.x(), p.y(), p.z()}; }

class Octomap final : public Contender {
 public:
  enum class Mode { occupied, centers, rays };
  Octomap(double resolution, Mode mode) : mode_(mode), tree_(resolution) {}

  void build(const Cloud& cloud, std::size_t scans) override {
    for (std::size_t i = 0; i < scans; ++i) insert(cloud, i, true);
    tree_.updateInnerOccupancy();
    if (mode_ != Mode::centers) tree_.prune();  // The centre of eight voxels in one is farther from their points.
  }
  bool add(const Cloud& cloud, std::size_t scan) override {
    insert(cloud, scan, false);
    return true;
  }
  Output output() override {
    Output out;
    std::int64_t free = 0;
    std::size_t leaves = 0;
    for (auto leaf = tree_.begin_leafs(); leaf != tree_.end_leafs(); ++leaf) {
      ++leaves;
      if (!tree_.isNodeOccupied(*leaf)) {
        ++free;
        continue;
      }
      const Vec<3> center = widen(leaf.getCoordinate()), half = Vec<3>::Constant(0.5 * leaf.getSize());
      out.soup.push_back(mode_ == Mode::centers ? point(center) : box(center - half, center + half));
    }
    out.primitives = static_cast<std::int64_t>(out.soup.size());
    out.kind = mode_ == Mode::rays ? "voxels, and " + std::to_string(free) + " free" : "voxels";
    out.bytes = 2.0 * static_cast<double>(tree_.size() - leaves);  // A .bt file: two bits for each child of an inner node.
    return out;
  }

 private:
  /// `lazy`: inner nodes and pruning are left for the end.
  void insert(const Cloud& cloud, std::size_t scan, bool lazy) {
    if (mode_ != Mode::rays) {
      const float hit = tree_.getProbHitLog();
      for (const Vec<3>& p : cloud.scan(scan)) tree_.setNodeValue(narrow(p), hit, lazy);
      return;
    }
    octomap::Pointcloud points;
    points.reserve(cloud.scan(scan).size());
    for (const Vec<3>& p : cloud.scan(scan)) points.push_back(narrow(p));
    tree_.insertPointCloud(points, narrow(cloud.origins[scan]), -1.0, lazy, true);
  }

  Mode mode_;
  octomap::OcTree tree_;
};

template <Octomap::Mode mode>
std::unique_ptr<Contender> make(double resolution) {
  return std::make_unique<Octomap>(resolution, mode);
}

}  // namespace

std::vector<ContenderKind> octomap_contenders() {
  return {{"octomap", "OctoMap, occupied only, {} m", "setNodeValue of each hit; voxels are solid cubes", {0.2}, make<Octomap::Mode::occupied>, true},
          {"octomap-centers",
           "OctoMap, the same, voxel centres, {} m",
           "the same map without pruning, read as the centres of its voxels",
           {0.2},
           make<Octomap::Mode::centers>,
           true},
          {"octomap-insert", "OctoMap insertPointCloud, {} m", "discretised, with free space along the rays", {0.2}, make<Octomap::Mode::rays>}};
}

}  // namespace vantage::bench

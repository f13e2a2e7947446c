// SPDX-License-Identifier: Apache-2.0
// OpenVDB 10: a truncated signed distance field (Curless and Levoy), then the mesh of its zero level.
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <sstream>

#include "../contender.h"

namespace vantage::bench {
namespace {

constexpr double kBand = 3.0;  ///< Half width of the truncated field [voxels], OpenVDB's own.

class Tsdf final : public Contender {
 public:
  explicit Tsdf(double voxel)
      : voxel_(voxel), distance_(openvdb::FloatGrid::create(static_cast<float>(kBand * voxel))), weight_(openvdb::FloatGrid::create(0.0F)) {
    openvdb::initialize();
  }

  void build(const Cloud& cloud, std::size_t scans) override {
    for (std::size_t i = 0; i < scans; ++i) integrate(cloud, i);
    extract();
  }
  bool add(const Cloud& cloud, std::size_t scan) override {
    integrate(cloud, scan);
    extract();
    return true;
  }
  Output output() override {
    Output out;
    const auto corner = [&](std::uint32_t i) {
      const openvdb::Vec3s& p = points_[i];
      return Vec<3>(voxel_ * p.x(), voxel_ * p.y(), voxel_ * p.z());
    };
    for (const openvdb::Vec4I& q : quads_)
      if (observed(q)) add_polygon(out.soup, std::array{corner(q[0]), corner(q[1]), corner(q[2]), corner(q[3])});
    out.primitives = static_cast<std::int64_t>(out.soup.size()) / 2;
    out.kind = "quads; the file is the field's";
    std::ostringstream file;
    openvdb::io::Stream(file).write(openvdb::GridCPtrVec{distance_});
    out.bytes = static_cast<double>(file.str().size());
    return out;
  }

 private:
  /// Along each ray, the voxels within the band around the hit take the mean of the ranges to it.
  void integrate(const Cloud& cloud, std::size_t scan) {
    auto distance = distance_->getAccessor();
    auto weight = weight_->getAccessor();
    for (const Vec<3>& p : cloud.scan(scan)) {
      const Vec<3> ray = (p - cloud.origins[scan]).normalized();
      openvdb::Coord last = openvdb::Coord::max();
      for (double t = -kBand; t <= kBand; t += 0.5) {
        const Vec<3> q = p / voxel_ + t * ray;
        const openvdb::Coord ijk = openvdb::Coord::round(openvdb::Vec3d(q[0], q[1], q[2]));
        if (ijk == last) continue;
        last = ijk;
        const double range = (p - voxel_ * Vec<3>(ijk.x(), ijk.y(), ijk.z())).dot(ray);
        if (std::abs(range) > kBand * voxel_) continue;
        const float w = weight.getValue(ijk);
        distance.setValue(ijk, w > 0.0F ? (distance.getValue(ijk) * w + static_cast<float>(range)) / (w + 1.0F) : static_cast<float>(range));
        weight.setValue(ijk, w + 1.0F);
      }
    }
  }
  void extract() {
    std::vector<openvdb::Vec3I> triangles;
    points_.clear();
    quads_.clear();
    openvdb::tools::volumeToMesh(*distance_, points_, triangles, quads_, 0.0, 0.0);
  }
  /// A quad stands across the lattice edge that its four corners' cells share. True when rays have met both ends of it: the sheet behind the band,
  /// where the field meets its background, is nobody's surface.
  [[nodiscard]] bool observed(const openvdb::Vec4I& quad) const {
    openvdb::Coord low = openvdb::Coord::max(), high = openvdb::Coord::min();
    for (int c = 0; c < 4; ++c) {
      const openvdb::Coord cell = openvdb::Coord::floor(points_[quad[c]]);
      low.minComponent(cell);
      high.maxComponent(cell);
    }
    openvdb::Coord end = high;  // All corners are in the cells around the edge from `high`, along the axis in which they agree.
    for (int a = 0; a < 3; ++a)
      if (low[a] == high[a]) ++end[a];
    return weight_->tree().getValue(high) > 0.0F && weight_->tree().getValue(end) > 0.0F;
  }

  double voxel_;
  openvdb::FloatGrid::Ptr distance_, weight_;
  std::vector<openvdb::Vec3s> points_;
  std::vector<openvdb::Vec4I> quads_;
};

}  // namespace

std::vector<ContenderKind> openvdb_contenders() {
  return {{"openvdb",
           "OpenVDB TSDF, {} m",
           "weighted mean of the ranges in a band of three voxels, then volumeToMesh without the sheet behind the band",
           {0.2},
           [](double voxel) { return std::make_unique<Tsdf>(voxel); }}};
}

}  // namespace vantage::bench

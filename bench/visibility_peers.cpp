// SPDX-License-Identifier: Apache-2.0
#include "visibility_peers.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#define VANTAGE_EMBREE 4
#else
#include <embree3/rtcore.h>
#define VANTAGE_EMBREE 3
#endif
#ifdef VANTAGE_OCTOMAP
#include <octomap/OcTree.h>

#include "vantage/base/random.h"
#endif

namespace vantage::bench {
namespace {

/// The scene's triangles in Embree.
class EmbreeWorld {
 public:
  explicit EmbreeWorld(const Mesh<3>& mesh) : device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_)) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* v = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, mesh.vertices.size()));
    for (const Vec<3>& p : mesh.vertices)
      for (int a = 0; a < 3; ++a) *v++ = static_cast<float>(p[a]);
    auto* f = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.facets.size()));
    for (const auto& facet : mesh.facets) f = std::copy(facet.begin(), facet.end(), f);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~EmbreeWorld() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeWorld(const EmbreeWorld&) = delete;
  EmbreeWorld& operator=(const EmbreeWorld&) = delete;

  /// Nodes of the window that a ray from `origin` reaches; one ray at a time, or sixteen along axis 0.
  std::size_t visible(const Vec<3>& origin, const Grid<3>& window, bool packets) const {
    std::size_t seen = 0;
    const Vec<3> start = window.position(Index<3>::Zero()) - origin;
    const auto h = static_cast<float>(window.spacing);
    for (std::size_t i = 0; i < window.size(); i += 16) {
      const Index<3> at = window.local(i);
      const Vec<3> d = start + at.cast<double>() * window.spacing;
      RTCRay16 rays{};
      alignas(64) int valid[16];
      for (int k = 0; k < 16; ++k) {
        valid[k] = -1;
        rays.org_x[k] = static_cast<float>(origin[0]), rays.org_y[k] = static_cast<float>(origin[1]), rays.org_z[k] = static_cast<float>(origin[2]);
        rays.dir_x[k] = static_cast<float>(d[0]) + static_cast<float>(k) * h;
        rays.dir_y[k] = static_cast<float>(d[1]), rays.dir_z[k] = static_cast<float>(d[2]);
        rays.tfar[k] = 1.0F;
        rays.mask[k] = ~0U;
      }
      packets ? occluded16(valid, rays) : occluded1(rays);
      for (const float t : rays.tfar) seen += t >= 0.0F ? 1 : 0;
    }
    return seen;
  }

 private:
#if VANTAGE_EMBREE == 4
  void occluded16(const int* valid, RTCRay16& rays) const {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcOccluded16(valid, scene_, &rays, &arguments);
  }
  void occluded(RTCRay& ray) const { rtcOccluded1(scene_, &ray); }
#else
  void occluded16(const int* valid, RTCRay16& rays) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcOccluded16(valid, scene_, &context, &rays);
  }
  void occluded(RTCRay& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene_, &context, &ray);
  }
#endif
  void occluded1(RTCRay16& rays) const {
    for (int k = 0; k < 16; ++k) {
      RTCRay ray{};
      ray.org_x = rays.org_x[k], ray.org_y = rays.org_y[k], ray.org_z = rays.org_z[k];
      ray.dir_x = rays.dir_x[k], ray.dir_y = rays.dir_y[k], ray.dir_z = rays.dir_z[k];
      ray.tfar = 1.0F;
      ray.mask = ~0U;
      occluded(ray);
      rays.tfar[k] = ray.tfar;
    }
  }

  RTCDevice device_;
  RTCScene scene_;
};

#ifdef VANTAGE_OCTOMAP
PeerTime octomap_time(std::span<const Vec<3>> points, const Vec<3>& origin, const Grid<3>& window) {
  octomap::OcTree tree(window.spacing);
  const auto narrow = [](const Vec<3>& p) { return octomap::point3d(static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])); };
  for (const Vec<3>& p : points) tree.setNodeValue(narrow(p), tree.getProbHitLog(), true);
  tree.updateInnerOccupancy();
  Random random(2);
  std::vector<Vec<3>> sample;
  for (int i = 0; i < 20000; ++i) sample.push_back(window.position(static_cast<std::size_t>(random.below(window.size()))));
  const double time = seconds(1, [&] {
    octomap::point3d end;
    for (const Vec<3>& p : sample)
      if (const double range = (p - origin).norm(); range > 0.0) (void)tree.castRay(narrow(origin), narrow(p - origin), end, true, range);
  });
  const double share = static_cast<double>(sample.size()) / static_cast<double>(window.size());
  return {"OctoMap castRay", time / share, share};
}
#endif

}  // namespace

std::vector<PeerTime> visibility_peers(const Mesh<3>& mesh, [[maybe_unused]] std::span<const Vec<3>> points, const Vec<3>& origin,
                                       const Grid<3>& window) {
  const EmbreeWorld embree(mesh);
  std::vector<PeerTime> out;
  out.push_back({"Embree, packets of 16", seconds(3, [&] { (void)embree.visible(origin, window, true); }), 1.0});
  out.push_back({"Embree, one ray a node", seconds(1, [&] { (void)embree.visible(origin, window, false); }), 1.0});
#ifdef VANTAGE_OCTOMAP
  out.push_back(octomap_time(points, origin, window));
#endif
  return out;
}

}  // namespace vantage::bench

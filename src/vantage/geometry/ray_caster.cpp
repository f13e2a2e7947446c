// SPDX-License-Identifier: Apache-2.0
#include "vantage/geometry/ray_caster.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#define VANTAGE_EMBREE 4
#else
#include <embree3/rtcore.h>
#define VANTAGE_EMBREE 3
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

#include "vantage/base/error.h"
#include "vantage/geometry/patch.h"

// Embree only walks its tree of boxes, in float around the mesh's centre and a little widened; every facet that it proposes is tested here in
// double. So the hit is exactly the least (range, facet) of all facets, whatever Embree's version or the machine's vector width.

namespace vantage {
namespace {

/// Float error of Embree's boxes and rays, relative to the diagonal of the mesh, with a margin of some ten times.
constexpr double kSlack = 1e-6;

template <int Dim>
using Corners = std::array<Vec<Dim>, static_cast<std::size_t>(Dim)>;

/// Weights of a facet's corners at the place where the line meets it, unnormalised, from the corners' offsets across the line.
/// The sign of each is right or zero (a rounded product is monotone), so neighbours never both miss on their shared edge or corner.
std::array<double, 2> weights(const std::array<Vec<1>, 2>& v) { return {v[1][0], -v[0][0]}; }
std::array<double, 3> weights(const std::array<Vec<2>, 3>& v) {
  const auto cross = [](const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; };
  return {cross(v[1], v[2]), cross(v[2], v[0]), cross(v[0], v[1])};
}

/// A ray, sheared so that it runs along its longest axis (Woop, Benthin, Wald 2013, in double).
template <int Dim>
class ShearedRay {
 public:
  ShearedRay(const Vec<Dim>& origin, const Vec<Dim>& direction) : origin_(origin) {
    direction.cwiseAbs().maxCoeff(&along_);
    depth_ = 1.0 / direction[along_];
    for (int a = 0, next = 0; a < Dim; ++a) {
      if (a == along_) continue;
      across_[next] = a;
      shear_[next++] = direction[a] / direction[along_];
    }
  }
  /// Where the ray's line meets the facet [m]; NaN if it does not, or runs within the facet's plane.
  [[nodiscard]] double range(const Corners<Dim>& corners) const {
    std::array<Vec<Dim - 1>, Dim> offsets;
    Vec<Dim> depths;
    for (int i = 0; i < Dim; ++i) {
      const Vec<Dim> v = corners[i] - origin_;
      for (int k = 0; k < Dim - 1; ++k) offsets[i][k] = v[across_[k]] - shear_[k] * v[along_];
      depths[i] = v[along_] * depth_;
    }
    const auto w = weights(offsets);
    if (std::any_of(w.begin(), w.end(), [](double x) { return x < 0.0; }) && std::any_of(w.begin(), w.end(), [](double x) { return x > 0.0; }))
      return kNaN;
    double sum = 0.0, weighted = 0.0;
    for (int i = 0; i < Dim; ++i) {
      sum += w[i];
      weighted += w[i] * depths[i];
    }
    return sum == 0.0 ? kNaN : std::clamp(weighted / sum, depths.minCoeff(), depths.maxCoeff());
  }

 private:
  static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  Vec<Dim> origin_;
  int along_ = 0;
  double depth_ = 1.0;
  std::array<int, Dim - 1> across_{};
  Vec<Dim - 1> shear_;
};

/// The part [first, second] of the ray's parameter that lies in the box; first > second if none.
template <int Dim>
std::array<double, 2> clip(const Box<Dim>& box, const Vec<Dim>& origin, const Vec<Dim>& direction, double max_range) {
  double enter = 0.0, leave = max_range;
  for (int a = 0; a < Dim; ++a) {
    if (direction[a] == 0.0) {
      if (!(origin[a] >= box.low[a] && origin[a] <= box.high[a])) return {1.0, 0.0};
      continue;
    }
    const double s = (box.low[a] - origin[a]) / direction[a], t = (box.high[a] - origin[a]) / direction[a];
    enter = std::max(enter, std::min(s, t));
    leave = std::min(leave, std::max(s, t));
  }
  return {enter, leave};
}

#if VANTAGE_EMBREE == 4
using QueryContext = RTCRayQueryContext;
void intersect(RTCScene scene, QueryContext& context, RTCRayHit& ray) {
  rtcInitRayQueryContext(&context);
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  rtcIntersect1(scene, &ray, &arguments);
}
#else
using QueryContext = RTCIntersectContext;
void intersect(RTCScene scene, QueryContext& context, RTCRayHit& ray) {
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &ray);
}
#endif

/// Embree hands the context back to `test_facet`, which finds the rest behind it.
template <int Dim>
struct Search {
  QueryContext context;  // First, so that a pointer to it is a pointer to the search.
  ShearedRay<Dim> ray;
  typename RayCaster<Dim>::Hit best;
  double max_range;
  double entry;  ///< Where Embree's ray starts on ours [m].
};

template <int Dim>
struct NearestSearch {
  Vec<Dim> point;
  double best;   ///< [m]
  double extra;  ///< Added to Embree's radius for its float error [m].
  const std::vector<Corners<Dim>>& facets;
};

template <class Pointer, auto release>
struct Release {
  using pointer = Pointer;
  void operator()(Pointer p) const { release(p); }
};
template <class Pointer, auto release>
using Handle = std::unique_ptr<void, Release<Pointer, release>>;

void throw_device_error(RTCError error, const char* message) {
  if (error == RTC_ERROR_NONE) return;
  const bool memory = error == RTC_ERROR_OUT_OF_MEMORY;
  throw Error(memory ? ErrorCode::memory : ErrorCode::bad_input,
              std::string("ray casting: ") + (message ? message : "Embree cannot build the scene"));
}

template <int Dim>
void check(const Mesh<Dim>& mesh) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    require(mesh.vertices[i].allFinite(), "vertex " + std::to_string(i) + " of the mesh is not finite");
  for (std::size_t i = 0; i < mesh.facets.size(); ++i)
    for (const std::uint32_t v : mesh.facets[i])
      require(v < mesh.vertices.size(), "facet " + std::to_string(i) + " of the mesh names vertex " + std::to_string(v));
}

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
struct RayCaster<Dim>::Impl {
  explicit Impl(const Mesh<Dim>& mesh) {
    check(mesh);
    facets.reserve(mesh.facets.size());
    for (const auto& facet : mesh.facets) {
      Corners<Dim>& corners = facets.emplace_back();
      std::transform(facet.begin(), facet.end(), corners.begin(), [&](std::uint32_t v) { return mesh.vertices[v]; });
      for (const Vec<Dim>& corner : corners) bounds.extend(corner);
    }
    if (!facets.empty()) build();
  }

  void build();
  /// Place relative to the centre; axes that the world lacks are 0.
  [[nodiscard]] std::array<float, 3> local(const Vec<Dim>& p) const {
    std::array<float, 3> q{};
    for (int a = 0; a < Dim; ++a) q[a] = static_cast<float>(p[a] - center[a]);
    return q;
  }

  static void facet_bounds(const RTCBoundsFunctionArguments* arguments);
  static void test_facet(const RTCIntersectFunctionNArguments* arguments);
  static bool near_facet(RTCPointQueryFunctionArguments* arguments);

  std::vector<Corners<Dim>> facets;  ///< Unshared corners: one stretch of memory a test.
  Box<Dim> bounds;
  Vec<Dim> center = Vec<Dim>::Zero();
  double slack = 0.0;  ///< [m]
  Handle<RTCDevice, &rtcReleaseDevice> device;
  Handle<RTCScene, &rtcReleaseScene> scene;
};

template <int Dim>
  requires SpatialDim<Dim>
void RayCaster<Dim>::Impl::build() {
  center = bounds.center();
  slack = std::max(kSlack * bounds.size().norm(), 1e-30);
#ifdef __SANITIZE_THREAD__
  device.reset(rtcNewDevice("threads=1"));  // The thread sanitizer does not see how oneTBB's threads, which ask for our facets, wait for each other.
#else
  device.reset(rtcNewDevice(nullptr));
#endif
  if (!device) throw_device_error(rtcGetDeviceError(nullptr), "Embree does not start");
  scene.reset(rtcNewScene(device.get()));
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(facets.size()));
  rtcSetGeometryUserData(geometry, this);
  rtcSetGeometryBoundsFunction(geometry, &facet_bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, &test_facet);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene.get());
  throw_device_error(rtcGetDeviceError(device.get()), nullptr);
}

template <int Dim>
  requires SpatialDim<Dim>
void RayCaster<Dim>::Impl::facet_bounds(const RTCBoundsFunctionArguments* arguments) {
  const Impl& self = *static_cast<const Impl*>(arguments->geometryUserPtr);
  Box<Dim> box;
  for (const Vec<Dim>& corner : self.facets[arguments->primID]) box.extend(corner);
  const std::array<float, 3> low = self.local(box.low.array() - self.slack), high = self.local(box.high.array() + self.slack);
  RTCBounds& out = *arguments->bounds_o;
  const auto thickness = [](int axis) { return axis < Dim ? 0.0F : 1.0F; };  // A plane world stands around z = 0.
  out.lower_x = low[0], out.lower_y = low[1], out.lower_z = low[2] - thickness(2);
  out.upper_x = high[0], out.upper_y = high[1], out.upper_z = high[2] + thickness(2);
}

template <int Dim>
  requires SpatialDim<Dim>
void RayCaster<Dim>::Impl::test_facet(const RTCIntersectFunctionNArguments* arguments) {
  const Impl& self = *static_cast<const Impl*>(arguments->geometryUserPtr);
  Search<Dim>& search = *reinterpret_cast<Search<Dim>*>(arguments->context);
  const double range = search.ray.range(self.facets[arguments->primID]);
  if (!(range >= 0.0 && range <= search.max_range)) return;
  Hit& best = search.best;
  if (range > best.range || (range == best.range && arguments->primID > best.facet)) return;
  best = {range, arguments->primID};
  // Boxes that could hold an equal range stay open.
  RTCRayHit& ray = *reinterpret_cast<RTCRayHit*>(arguments->rayhit);
  ray.ray.tfar = std::min(ray.ray.tfar, static_cast<float>(range - search.entry + 2.0 * self.slack));
  ray.hit.geomID = 0;
}

template <int Dim>
  requires SpatialDim<Dim>
bool RayCaster<Dim>::Impl::near_facet(RTCPointQueryFunctionArguments* arguments) {
  NearestSearch<Dim>& search = *static_cast<NearestSearch<Dim>*>(arguments->userPtr);
  Patch<Dim> patch;
  std::copy_n(search.facets[arguments->primID].begin(), Dim, patch.vertices.begin());
  patch.count = Dim;
  const double d = vantage::distance(patch, search.point);
  if (!(d < search.best)) return false;
  search.best = d;
  arguments->query->radius = std::min(arguments->query->radius, static_cast<float>(d + search.extra));
  return true;
}

template <int Dim>
  requires SpatialDim<Dim>
RayCaster<Dim>::RayCaster(const Mesh<Dim>& mesh) : impl_(std::make_unique<Impl>(mesh)) {}
template <int Dim>
  requires SpatialDim<Dim>
RayCaster<Dim>::~RayCaster() = default;
template <int Dim>
  requires SpatialDim<Dim>
RayCaster<Dim>::RayCaster(RayCaster&&) noexcept = default;
template <int Dim>
  requires SpatialDim<Dim>
RayCaster<Dim>& RayCaster<Dim>::operator=(RayCaster&&) noexcept = default;

template <int Dim>
  requires SpatialDim<Dim>
typename RayCaster<Dim>::Hit RayCaster<Dim>::cast(const Vec<Dim>& origin, const Vec<Dim>& direction, double max_range) const {
  if (!impl_->scene) return {};
  // Embree's ray starts where ours enters the mesh's box: its float error then follows the mesh's size, not the origin's distance.
  const auto [enter, leave] = clip(impl_->bounds.grown(4.0 * impl_->slack), origin, direction, max_range);
  if (!(enter <= leave)) return {};
  Search<Dim> search{{}, ShearedRay<Dim>(origin, direction), {}, max_range, enter};
  const std::array<float, 3> start = impl_->local(origin + enter * direction);
  std::array<float, 3> along{};
  for (int a = 0; a < Dim; ++a) along[a] = static_cast<float>(direction[a]);
  RTCRayHit ray{};
  ray.ray.org_x = start[0], ray.ray.org_y = start[1], ray.ray.org_z = start[2];
  ray.ray.dir_x = along[0], ray.ray.dir_y = along[1], ray.ray.dir_z = along[2];
  ray.ray.tfar = static_cast<float>(leave - enter + 2.0 * impl_->slack);
  ray.ray.mask = 0xffffffff;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  intersect(impl_->scene.get(), search.context, ray);
  return search.best;
}

template <int Dim>
  requires SpatialDim<Dim>
double RayCaster<Dim>::distance(const Vec<Dim>& p, double cap) const {
  if (!impl_->scene) return cap;
  const std::array<float, 3> q = impl_->local(p);
  const double extra = 4.0 * impl_->slack + 1e-6 * (p - impl_->center).norm();
  NearestSearch<Dim> search{p, cap, extra, impl_->facets};
  RTCPointQuery query{q[0], q[1], q[2], 0.0F, static_cast<float>(cap + extra)};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(impl_->scene.get(), &query, &context, &Impl::near_facet, &search);
  return search.best;
}

template class RayCaster<2>;
template class RayCaster<3>;

}  // namespace vantage

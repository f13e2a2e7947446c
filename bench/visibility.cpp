// SPDX-License-Identifier: Apache-2.0
// Which nodes of a lattice one viewpoint sees, beside rays (docs/3-visibility.md):
//   bench_visibility --json visibility.json
// One viewpoint in `town`, a cube of 128 m cut into 128^3, 256^3 and 512^3 nodes. Drawing the depth image and classifying the nodes are timed apart;
// the peers ask one ray a node on the scene's triangles (Embree) or on the voxels of the same points (OctoMap, a sample, scaled up).
#include <fmt/format.h>
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#define VANTAGE_EMBREE 4
#else
#include <embree3/rtcore.h>
#define VANTAGE_EMBREE 3
#endif
#ifdef VANTAGE_OCTOMAP
#include <octomap/OcTree.h>
#endif

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/base/random.h"
#include "vantage/surface/surface.h"
#include "vantage/visibility/depth_pyramid.h"
#include "vantage/visibility/occluder.h"
#include "vantage/visibility/seen_from.h"
#include "vantage/visibility/visibility.h"
#include "vantage/world/lidar.h"
#include "vantage/world/scene.h"

namespace vantage {
namespace {

using Json = nlohmann::json;

struct Settings {
  std::string scene = "town", json;
  std::vector<int> nodes{128, 256, 512};
  double side = 128.0;  ///< Of the cube of nodes [m].
  int repeats = 9, threads = 1, peer_nodes = 256, sample = 4000;
};

/// Median CPU seconds of a few runs.
template <class Work>
double seconds(int repeats, Work&& work) {
  std::vector<double> times;
  const auto now = [] {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  };
  for (int i = 0; i < repeats; ++i) {
    const double begin = now();
    work();
    times.push_back(now() - begin);
  }
  std::nth_element(times.begin(), times.begin() + repeats / 2, times.end());
  return times[static_cast<std::size_t>(repeats / 2)];
}

/// What the machine can do on the threads asked for.
struct Machine {
  double read = 0.0;     ///< [bytes/s], from memory.
  double add = 0.0;      ///< Additions and multiplications in double [1/s].
  double divide = 0.0;   ///< Divisions in double [1/s].
};

[[gnu::target("avx2"), gnu::noinline]] void arithmetic(double* x, bool divide) {
  constexpr int kLanesHere = 32, kTurns = 1 << 20;
  double v[kLanesHere];
  std::copy_n(x, kLanesHere, v);
  for (int t = 0; t < kTurns; ++t)
    if (divide)
      for (double& a : v) a = 1.5 / a;
    else
      for (double& a : v) a = a * 0.999 + 0.001;
  std::copy_n(v, kLanesHere, x);
}

Machine measure_machine() {
  Machine m;
  std::vector<std::uint64_t> data(std::size_t{1} << 26, 1);
  volatile std::uint64_t keep = 0;
  m.read = static_cast<double>(data.size() * 8) / seconds(5, [&] {
             std::uint64_t sums[8] = {};
             for (std::size_t i = 0; i < data.size(); i += 8)
               for (std::size_t k = 0; k < 8; ++k) sums[k] += data[i + k];
             for (const std::uint64_t s : sums) keep = keep + s;
           });
  std::vector<double> x(32, 1.25);
  m.add = 64.0 * (1 << 20) / seconds(5, [&] { arithmetic(x.data(), false); });
  m.divide = 32.0 * (1 << 20) / seconds(5, [&] { arithmetic(x.data(), true); });
  return m;
}

/// One scanned scene: the map after a few scans, and the viewpoint's own.
struct World {
  Scene<3> scene;
  Scan<3> scan;
  std::vector<Vec<3>> points;
  std::vector<Patch<3>> patches;
  double eta = 0.1;
};

World make_world(const Settings& settings) {
  World world{std::get<Scene<3>>(make_scene(settings.scene)), {}, {}, {}, 0.1};
  world.eta = world.scene.eta;
  LidarOptions options;
  options.pattern.max_range = world.scene.range;
  SimulatedLidar<3> lidar(world.scene.mesh, options);
  SurfaceOptions surface;
  surface.eta = world.eta;
  HausdorffTree<3> tree(world.scene.domain, surface);
  for (const double shift : {-40.0, -20.0, 20.0, 0.0}) {
    world.scan = lidar.scan(world.scene.start + shift * Vec<3>::UnitX(), 0);
    const std::vector<Vec<3>> points = hit_points(world.scan);
    tree.insert(points, SurfaceSensor<3>{world.scan.origin, world.scan.pattern.step});
    world.points.insert(world.points.end(), points.begin(), points.end());
  }
  world.patches = tree.patches();
  return world;
}

/// A cube of n^3 nodes about the viewpoint, most of it above the ground.
Grid<3> cube(const World& world, const Settings& settings, int n) {
  Grid<3> window{settings.side / n, Index<3>::Zero(), Index<3>::Constant(n)};
  window.first = window.nearest(world.scan.origin) - Index<3>(n / 2, n / 2, n / 16);
  return window;
}

/// Share of sampled nodes whose answer is not that of an exact ray through the widened patches, and whether each of them lies within the stated
/// angle: the ray through its pixel's centre gives its answer.
Json exact_rays(const World& world, const Grid<3>& window, int sample) {
  const DepthImage<3> image = depth_image<3>(world.patches, world.scan, window, world.eta, {.range_image = false});
  std::vector<Occluder<3>> occluders;
  for (const Patch<3>& patch : world.patches) occluders.emplace_back(patch, world.scan.origin);
  const double far = world.scan.pattern.max_range, tolerance = std::sqrt(2.0) / image.resolution();
  Random random(1);
  int differ = 0, beyond = 0, asked = 0;
  while (asked < sample) {
    const Vec<3> offset = window.position(static_cast<std::size_t>(random.below(window.size()))) - world.scan.origin;
    const double range = offset.norm();
    if (range > far || range == 0.0) continue;
    ++asked;
    const auto first = [&](const Vec<3>& direction) {
      double least = far;
      for (const Occluder<3>& occluder : occluders) least = std::min(least, occluder.range(direction, world.eta));
      return least;
    };
    const bool seen = sees<3>(image, far, offset);
    if (seen == (range <= first(offset / range))) continue;
    ++differ;
    const Vec<3> center = image.direction(image.pixel(offset));
    const bool within = (offset / range - center).norm() <= tolerance && seen == (range <= static_cast<double>(static_cast<float>(first(center))));
    beyond += within ? 0 : 1;
  }
  return {{"nodes_asked", asked}, {"differ_share", static_cast<double>(differ) / asked}, {"beyond_tolerance", beyond}, {"tolerance_deg", degrees(tolerance)}};
}

Json classify(const World& world, const Settings& settings, int n) {
  const Grid<3> window = cube(world, settings, n);
  const Viewpoint<3> view{world.scan.origin, world.scan.pattern.max_range};
  const DepthImage<3> image = depth_image<3>(world.patches, world.scan, window, world.eta);
  const auto blank = [&] { return DepthImage<3>(image.resolution(), static_cast<float>(view.max_range)); };
  const double fill = seconds(settings.repeats, [&] { (void)blank(); });
  const double ranges = seconds(settings.repeats, [&] {
    DepthImage<3> drawn = blank();
    draw_ranges(drawn, world.scan);
  });
  const double image_time = seconds(settings.repeats, [&] { (void)depth_image<3>(world.patches, world.scan, window, world.eta); });
  const double blocks = seconds(settings.repeats, [&] { (void)seen_from(image, view, window); });
  std::size_t pyramid_bytes = 0;
  const double pyramid = seconds(settings.repeats, [&] { pyramid_bytes = DepthPyramid<3>(image).bytes(); });
  const SeenSet<3> set = seen_from(image, view, window);
  std::vector<std::uint8_t> every(window.size());
  const double each = seconds(std::min(settings.repeats, 3), [&] {
    parallel_for(window.size(), 1 << 14, [&](std::size_t i) { every[i] = sees<3>(image, view.max_range, window.position(i) - view.origin) ? 1 : 0; });
  });
  std::size_t differ = 0;
  for (std::size_t i = 0; i < window.size(); ++i) differ += set.at(window.local(i)) != (every[i] != 0) ? 1 : 0;
  const auto image_bytes = image.size() * sizeof(float);
  return {{"nodes", n},
          {"resolution", image.resolution()},
          {"ranges_s", ranges - fill},
          {"patches_s", image_time - ranges},
          {"image_s", image_time},
          {"classify_s", blocks},
          {"pyramid_s", pyramid},
          {"each_node_s", each},
          {"differ_from_each", differ},
          {"seen_share", static_cast<double>(set.count()) / static_cast<double>(window.size())},
          {"mixed_share", static_cast<double>(set.mixed()) / static_cast<double>(set.blocks().size())},
          {"mixed_blocks", set.mixed()},
          {"image_bytes", image_bytes},
          {"pyramid_bytes", pyramid_bytes},
          {"set_bytes", set.bytes()},
          // Least traffic: the image read, the pyramid written and read, the set written. Least work: per opened node two divisions and 16 others.
          {"floor_bytes", image_bytes + 2 * pyramid_bytes + set.bytes()},
          {"floor_divisions", 2 * set.mixed() * SeenSet<3>::kNodes},
          {"floor_operations", 16 * set.mixed() * SeenSet<3>::kNodes}};
}

// ---- Peers -------------------------------------------------------------------------------------------------------------------------------------

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

Json peer(const std::string& name, double time, double asked, double nodes) {
  return {{"name", name}, {"seconds", time * nodes / asked}, {"share_asked", asked / nodes}};
}

Json peers(const World& world, const Settings& settings) {
  const Grid<3> window = cube(world, settings, settings.peer_nodes / 16 * 16);
  const auto nodes = static_cast<double>(window.size());
  const Vec<3>& origin = world.scan.origin;
  Json out = Json::array();
  const EmbreeWorld embree(world.scene.mesh);
  out.push_back(peer("Embree, packets of 16", seconds(3, [&] { (void)embree.visible(origin, window, true); }), nodes, nodes));
  out.push_back(peer("Embree, one ray a node", seconds(1, [&] { (void)embree.visible(origin, window, false); }), nodes, nodes));
#ifdef VANTAGE_OCTOMAP
  octomap::OcTree tree(window.spacing);
  const auto narrow = [](const Vec<3>& p) { return octomap::point3d(static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])); };
  for (const Vec<3>& p : world.points) tree.setNodeValue(narrow(p), tree.getProbHitLog(), true);
  tree.updateInnerOccupancy();
  Random random(2);
  std::vector<Vec<3>> sample;
  for (int i = 0; i < 20000; ++i) sample.push_back(window.position(static_cast<std::size_t>(random.below(window.size()))));
  const double time = seconds(1, [&] {
    octomap::point3d end;
    for (const Vec<3>& p : sample)
      if (const double range = (p - origin).norm(); range > 0.0) (void)tree.castRay(narrow(origin), narrow(p - origin), end, true, range);
  });
  out.push_back(peer("OctoMap castRay", time, static_cast<double>(sample.size()), nodes));
#endif
  return out;
}

// ---- Tables ------------------------------------------------------------------------------------------------------------------------------------

void print_rows(const Json& rows, const Machine& m) {
  fmt::print("{:>6} {:>5} {:>9} {:>9} {:>9} {:>9} {:>9} {:>8} {:>8} {:>8} {:>9} {:>9} {:>9}\n", "nodes", "res", "ranges", "patches", "classify", "(pyramid)",
             "each node", "differ", "seen", "mixed", "set MB", "x memory", "x compute");
  for (const Json& r : rows) {
    const double memory = r["floor_bytes"].get<double>() / m.read;
    const double compute = r["floor_divisions"].get<double>() / m.divide + r["floor_operations"].get<double>() / m.add;
    const double time = r["classify_s"].get<double>();
    fmt::print("{:>6} {:>5} {:>9.4f} {:>9.4f} {:>9.4f} {:>9.4f} {:>9.4f} {:>8} {:>7.1f}% {:>7.1f}% {:>9.2f} {:>9.1f} {:>9.1f}\n",
               fmt::format("{}^3", r["nodes"].get<int>()), r["resolution"].get<int>(), r["ranges_s"].get<double>(), r["patches_s"].get<double>(), time,
               r["pyramid_s"].get<double>(), r["each_node_s"].get<double>(), r["differ_from_each"].get<std::size_t>(),
               100.0 * r["seen_share"].get<double>(), 100.0 * r["mixed_share"].get<double>(), 1e-6 * r["set_bytes"].get<double>(), time / memory,
               time / compute);
  }
}

int run(const Settings& settings) {
  const ThreadLimit limit(settings.threads);
  const World world = make_world(settings);
  const Machine m = measure_machine();
  fmt::print("{}: {} patches from 4 scans, side {} m, range {} m; CPU seconds, medians of {}, {} thread(s)\n", settings.scene, world.patches.size(),
             settings.side, world.scan.pattern.max_range, settings.repeats, settings.threads);
  fmt::print("this machine, one thread: reads {:.1f} GB/s, {:.1f} G additions and multiplications/s, {:.2f} G divisions/s (double)\n\n", 1e-9 * m.read,
             1e-9 * m.add, 1e-9 * m.divide);
  Json out{{"scene", settings.scene}, {"patches", world.patches.size()}, {"side_m", settings.side}, {"threads", settings.threads}};
  out["machine"] = {{"read_bytes_s", m.read}, {"add_s", m.add}, {"divide_s", m.divide}};
  out["rows"] = Json::array();
  for (const int n : settings.nodes) out["rows"].push_back(classify(world, settings, n));
  print_rows(out["rows"], m);
  const Json& first = out["rows"].front();
  const Json& last = out["rows"].back();
  if (first != last) {
    out["exponent"] = std::log(last["classify_s"].get<double>() / first["classify_s"].get<double>()) /
                      std::log(last["nodes"].get<double>() / first["nodes"].get<double>());
    fmt::print("\nclassify grows with the nodes along an edge to the power {:.2f}\n", out["exponent"].get<double>());
  }
  out["exact"] = exact_rays(world, cube(world, settings, settings.peer_nodes), settings.sample);
  fmt::print("exact rays against patches, {} nodes: {:.2f} % differ, {} of them by more than half a pixel ({:.2f} deg)\n\n",
             out["exact"]["nodes_asked"].get<int>(), 100.0 * out["exact"]["differ_share"].get<double>(), out["exact"]["beyond_tolerance"].get<int>(),
             out["exact"]["tolerance_deg"].get<double>());
  out["peers"] = peers(world, settings);
  double ours = 0.0;
  for (const Json& r : out["rows"])
    if (r["nodes"] == settings.peer_nodes) ours = r["classify_s"].get<double>();
  fmt::print("{:<24} {:>9} {:>9}\n", fmt::format("{}^3 nodes", settings.peer_nodes), "CPU s", "ratio");
  if (ours > 0.0) fmt::print("{:<24} {:>9.4f} {:>9}\n", "blocks first", ours, 1);
  for (const Json& p : out["peers"])
    fmt::print("{:<24} {:>9.3f} {:>9.1f}{}\n", p["name"].get<std::string>(), p["seconds"].get<double>(), ours > 0.0 ? p["seconds"].get<double>() / ours : 0.0,
               p["share_asked"].get<double>() < 1.0 ? fmt::format("  ({:.2f} % of the nodes, scaled up)", 100.0 * p["share_asked"].get<double>()) : "");
  if (!settings.json.empty()) std::ofstream(settings.json) << out.dump(2) << "\n";
  return 0;
}

}  // namespace
}  // namespace vantage

int main(int argc, char** argv) {
  vantage::Settings settings;
  CLI::App app("Visibility of a lattice's nodes beside rays");
  app.add_option("--scene", settings.scene, "a built-in 3D scene or a mesh file")->capture_default_str();
  app.add_option("--nodes", settings.nodes, "nodes along each edge")->delimiter(',')->capture_default_str();
  app.add_option("--side", settings.side, "of the cube [m]")->capture_default_str();
  app.add_option("--repeats", settings.repeats, "runs of which the median is taken")->capture_default_str();
  app.add_option("--threads", settings.threads, "at most")->capture_default_str();
  app.add_option("--peer-nodes", settings.peer_nodes, "nodes along each edge for the peers")->capture_default_str();
  app.add_option("--sample", settings.sample, "nodes asked by exact rays")->capture_default_str();
  app.add_option("--json", settings.json, "write all figures to this file");
  CLI11_PARSE(app, argc, argv);
  try {
    return vantage::run(settings);
  } catch (const vantage::Error& e) {
    fmt::print(stderr, "bench_visibility: {}\n", e.what());
    return 2;
  }
}

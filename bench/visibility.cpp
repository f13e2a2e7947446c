// SPDX-License-Identifier: Apache-2.0
// Which nodes of a lattice one viewpoint sees, beside rays (docs/3-visibility.md):
//   bench_visibility --json visibility.json
// One viewpoint in `town`, a cube of 128 m cut into 128^3, 256^3 and 512^3 nodes. Drawing the depth image and classifying the nodes are timed apart;
// the peers ask one ray a node on the scene's triangles (Embree) or on the voxels of the same points (OctoMap, a sample, scaled up).
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/base/random.h"
#include "vantage/surface/surface.h"
#include "vantage/visibility/depth_pyramid.h"
#include "vantage/visibility/lanes.h"
#include "vantage/visibility/occluder.h"
#include "vantage/visibility/seen_from.h"
#include "vantage/visibility/visibility.h"
#include "vantage/world/lidar.h"
#include "vantage/world/scene.h"
#include "visibility_peers.h"

namespace vantage {
namespace {

using bench::seconds;
using Json = nlohmann::json;

struct Settings {
  std::string scene = "town", json;
  std::vector<int> nodes{128, 256, 512};
  double side = 128.0;  ///< Of the cube of nodes [m].
  int repeats = 9, threads = 1, peer_nodes = 256, sample = 4000;
};

/// What the machine can do on the threads asked for.
struct Machine {
  double read = 0.0;    ///< [bytes/s], from memory.
  double add = 0.0;     ///< Additions and multiplications in double [1/s].
  double divide = 0.0;  ///< Divisions in double [1/s].
};

/// 2^20 turns of 32 independent chains, each an addition and a multiplication, or a division.
VANTAGE_LANES void turn(double* x, bool divide) {
  constexpr int kChains = 32, kTurns = 1 << 20;
  double v[kChains];
  std::copy_n(x, kChains, v);
  for (int t = 0; t < kTurns; ++t)
    if (divide)
      for (double& a : v) a = 1.5 / a;
    else
      for (double& a : v) a = a * 0.999 + 0.001;
  std::copy_n(v, kChains, x);
}
void arithmetic_anywhere(double* x, bool divide) { turn(x, divide); }
#if VANTAGE_WIDE
VANTAGE_AVX2 void arithmetic_wide(double* x, bool divide) { turn(x, divide); }
const auto arithmetic = has_avx2() ? &arithmetic_wide : &arithmetic_anywhere;
#else
const auto arithmetic = &arithmetic_anywhere;
#endif

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
  const AnyScene any = make_scene(settings.scene);
  require(std::holds_alternative<Scene<3>>(any), settings.scene + ": must be a scene in 3D");
  World world{std::get<Scene<3>>(any), {}, {}, {}, 0.1};
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
  return {{"nodes_asked", asked},
          {"differ_share", static_cast<double>(differ) / asked},
          {"beyond_tolerance", beyond},
          {"tolerance_deg", degrees(tolerance)}};
}

/// Pixels in the rectangles around the patches: those that are tested.
std::size_t pixels_near(const World& world, const DepthImage<3>& image) {
  std::size_t sum = 0;
  for (const Patch<3>& patch : world.patches)
    for (int face = 0; face < 6; ++face) {
      const Box<3> box = patch.bounds();
      const auto area = image.rectangle(face, Box<3>{box.low - world.scan.origin, box.high - world.scan.origin}.grown(world.eta));
      if (!area.empty()) sum += static_cast<std::size_t>((area.high - area.low).prod());
    }
  return sum;
}

Json kernel(const std::string& name, double time, std::size_t bytes, std::size_t operations, std::size_t divisions) {
  return {{"name", name}, {"seconds", time}, {"bytes", bytes}, {"operations", operations}, {"divisions", divisions}};
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
  const std::size_t image_bytes = image.size() * sizeof(float), opened = set.mixed() * SeenSet<3>::kNodes;
  return {{"nodes", n},
          {"resolution", image.resolution()},
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
          {"kernels",
           // Least traffic and work: the image written and read back; 30 operations and 1.5 divisions a pixel for its ray (in float, so half of them
           // count); 20 operations for each pixel near a patch. Then the image read, the pyramid written and read, the set written; two divisions
           // and 16 operations for each node of an opened block.
           {kernel("ranges", ranges - fill, 2 * image_bytes + 4 * world.scan.ranges.size(), 30 * image.size(), 3 * image.size() / 2),
            kernel("patches", image_time - ranges, 2 * image_bytes + world.patches.size() * sizeof(Patch<3>), 20 * pixels_near(world, image), 0),
            kernel("classify", blocks, image_bytes + 2 * pyramid_bytes + set.bytes(), 16 * opened, 2 * opened)}}};
}

/// Bounds on the share of the nodes that are seen, from coarse to fine, and the time until then; the last line is node by node.
Json coarse_to_fine(const World& world, const Settings& settings, int n) {
  const Grid<3> window = cube(world, settings, n);
  const Viewpoint<3> view{world.scan.origin, world.scan.pattern.max_range};
  const DepthImage<3> image = depth_image<3>(world.patches, world.scan, window, world.eta);
  const DepthPyramid<3> pyramid(image);
  const auto share = [&](std::size_t nodes) { return static_cast<double>(nodes) / static_cast<double>(window.size()); };
  Json rows = Json::array();
  for (int steps = 0; steps < 5; ++steps) {
    std::optional<GradualView<3>> answer;
    const double time = seconds(settings.repeats, [&] {
      answer.emplace(pyramid, view, window);
      for (int k = 0; k < steps; ++k) answer->refine();
    });
    rows.push_back({{"side", answer->side()}, {"low", share(answer->seen_at_least())}, {"high", share(answer->seen_at_most())}, {"seconds", time}});
  }
  std::size_t seen = 0;
  const double time = seconds(settings.repeats, [&] { seen = seen_from(image, view, window).count(); });
  rows.push_back({{"side", 1}, {"low", share(seen)}, {"high", share(seen)}, {"seconds", time}});
  return rows;
}

// ---- Tables ------------------------------------------------------------------------------------------------------------------------------------

void print_rows(const Json& rows) {
  fmt::print("{:>6} {:>5} {:>8} {:>9} {:>9} {:>9} {:>6} {:>7} {:>7} {:>9} {:>7}\n", "nodes", "res", "image", "classify", "(pyramid)", "each node",
             "differ", "seen", "opened", "image MB", "set MB");
  for (const Json& r : rows)
    fmt::print("{:>6} {:>5} {:>8.4f} {:>9.4f} {:>9.4f} {:>9.4f} {:>6} {:>6.1f}% {:>6.1f}% {:>9.2f} {:>7.2f}\n",
               fmt::format("{}^3", r["nodes"].get<int>()), r["resolution"].get<int>(), r["image_s"].get<double>(), r["classify_s"].get<double>(),
               r["pyramid_s"].get<double>(), r["each_node_s"].get<double>(), r["differ_from_each"].get<std::size_t>(),
               100.0 * r["seen_share"].get<double>(), 100.0 * r["mixed_share"].get<double>(),
               1e-6 * (r["image_bytes"].get<double>() + r["pyramid_bytes"].get<double>()), 1e-6 * r["set_bytes"].get<double>());
}

/// How many times longer than moving the bytes, or than the arithmetic, takes at the machine's measured rates.
void print_kernels(const Json& rows, const Machine& m) {
  fmt::print("{:>6} {:<9} {:>8} {:>8} {:>8} {:>8} {:>9} {:>10}\n", "nodes", "kernel", "CPU s", "MB", "M ops", "M div", "x memory", "x compute");
  for (const Json& r : rows)
    for (const Json& k : r["kernels"]) {
      const double time = k["seconds"], bytes = k["bytes"], operations = k["operations"], divisions = k["divisions"];
      fmt::print("{:>6} {:<9} {:>8.4f} {:>8.1f} {:>8.1f} {:>8.1f} {:>9.1f} {:>10.1f}\n", fmt::format("{}^3", r["nodes"].get<int>()),
                 k["name"].get<std::string>(), time, 1e-6 * bytes, 1e-6 * operations, 1e-6 * divisions, time / (bytes / m.read),
                 time / (operations / m.add + divisions / m.divide));
    }
}

int run(const Settings& settings) {
  const ThreadLimit limit(settings.threads);
  const World world = make_world(settings);
  const Machine m = measure_machine();
  fmt::print("{}: {} patches from 4 scans, side {} m, range {} m; CPU seconds, medians of {}, {} thread(s)\n", settings.scene, world.patches.size(),
             settings.side, world.scan.pattern.max_range, settings.repeats, settings.threads);
  fmt::print("this machine, one thread: reads {:.1f} GB/s, {:.1f} G additions and multiplications/s, {:.2f} G divisions/s (double)\n\n",
             1e-9 * m.read, 1e-9 * m.add, 1e-9 * m.divide);
  Json out{{"scene", settings.scene}, {"patches", world.patches.size()}, {"side_m", settings.side}, {"threads", settings.threads}};
  out["machine"] = {{"read_bytes_s", m.read}, {"add_s", m.add}, {"divide_s", m.divide}};
  out["rows"] = Json::array();
  for (const int n : settings.nodes) out["rows"].push_back(classify(world, settings, n));
  print_rows(out["rows"]);
  const Json& first = out["rows"].front();
  const Json& last = out["rows"].back();
  if (first != last) {
    out["exponent"] = std::log(last["classify_s"].get<double>() / first["classify_s"].get<double>()) /
                      std::log(last["nodes"].get<double>() / first["nodes"].get<double>());
    fmt::print("\nclassify grows with the nodes along an edge to the power {:.2f}\n", out["exponent"].get<double>());
  }
  fmt::print("\n");
  print_kernels(out["rows"], m);
  const int most = *std::max_element(settings.nodes.begin(), settings.nodes.end());
  out["coarse"] = coarse_to_fine(world, settings, most);
  fmt::print("\ncoarse first, {}^3 nodes: bounds on the share seen\n{:>6} {:>9} {:>9} {:>9}\n", most, "cubes", "at least", "at most", "CPU s");
  for (const Json& r : out["coarse"])
    fmt::print("{:>6} {:>8.2f}% {:>8.2f}% {:>9.5f}\n", r["side"].get<int>(), 100.0 * r["low"].get<double>(), 100.0 * r["high"].get<double>(),
               r["seconds"].get<double>());
  out["exact"] = exact_rays(world, cube(world, settings, settings.peer_nodes), settings.sample);
  fmt::print("\nexact rays against patches, {} nodes: {:.2f} % differ, {} of them by more than half a pixel ({:.2f} deg)\n\n",
             out["exact"]["nodes_asked"].get<int>(), 100.0 * out["exact"]["differ_share"].get<double>(), out["exact"]["beyond_tolerance"].get<int>(),
             out["exact"]["tolerance_deg"].get<double>());
  out["peers"] = Json::array();
  const Grid<3> window = cube(world, settings, settings.peer_nodes / 16 * 16);
  for (const bench::PeerTime& peer : bench::visibility_peers(world.scene.mesh, world.points, world.scan.origin, window))
    out["peers"].push_back({{"name", peer.name}, {"seconds", peer.seconds}, {"share_asked", peer.share_asked}});
  double ours = 0.0;
  for (const Json& r : out["rows"])
    if (r["nodes"] == settings.peer_nodes) ours = r["classify_s"].get<double>();
  fmt::print("{:<24} {:>9} {:>9}\n", fmt::format("{}^3 nodes", settings.peer_nodes), "CPU s", "ratio");
  if (ours > 0.0) fmt::print("{:<24} {:>9.4f} {:>9}\n", "blocks first", ours, 1);
  for (const Json& p : out["peers"])
    fmt::print(
        "{:<24} {:>9.3f} {:>9.1f}{}\n", p["name"].get<std::string>(), p["seconds"].get<double>(),
        ours > 0.0 ? p["seconds"].get<double>() / ours : 0.0,
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
  app.add_option("--nodes", settings.nodes, "nodes along each edge")->delimiter(',')->capture_default_str()->check(CLI::PositiveNumber);
  app.add_option("--side", settings.side, "of the cube [m]")->capture_default_str()->check(CLI::PositiveNumber);
  app.add_option("--repeats", settings.repeats, "runs of which the median is taken")->capture_default_str()->check(CLI::PositiveNumber);
  app.add_option("--threads", settings.threads, "at most")->capture_default_str();
  app.add_option("--peer-nodes", settings.peer_nodes, "nodes along each edge for the peers")->capture_default_str()->check(CLI::PositiveNumber);
  app.add_option("--sample", settings.sample, "nodes asked by exact rays")->capture_default_str()->check(CLI::PositiveNumber);
  app.add_option("--json", settings.json, "write all figures to this file");
  CLI11_PARSE(app, argc, argv);
  try {
    return vantage::run(settings);
  } catch (const std::exception& e) {
    fmt::print(stderr, "bench_visibility: {}\n", e.what());
    return 2;
  }
}

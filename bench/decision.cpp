// SPDX-License-Identifier: Apache-2.0
// One decision of the planner, whole and in its stages, and beside OctoMap information gain where it is found (docs/5-planner.md):
//   bench_decision --nodes 60,128,256 --scans 5
//   bench_decision --voxel 0.5 --views 1000
// `town` is explored by a few scans on a lattice of about n^3 nodes; the last scan's decision is timed. Wall and CPU seconds.
#include <fmt/format.h>
#include <time.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "decision_peer.h"
#include "program.h"
#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/base/random.h"
#include "vantage/belief/belief.h"
#include "vantage/field/distance.h"
#include "vantage/planner/candidates.h"
#include "vantage/planner/plain_sum.h"
#include "vantage/planner/planner.h"
#include "vantage/planner/safe_path.h"
#include "vantage/scan/fill.h"
#include "vantage/surface/surface.h"
#include "vantage/visibility/visibility.h"
#include "vantage/world/lidar.h"
#include "vantage/world/scene.h"

namespace vantage::bench {
namespace {

struct Settings {
  std::vector<int> nodes{60, 128, 256};
  double voxel = 0.0;
  int scans = 5, threads = 0, views = 0;
  std::string scene = "town";
};

double cpu_seconds() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

template <class Work>
auto timed(const std::string& stage, Work&& work) {
  const auto begin = std::chrono::steady_clock::now();
  const double cpu = cpu_seconds();
  auto result = work();
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  fmt::print("| {:<28} | {:8.4f} | {:8.4f} |\n", stage, wall, cpu_seconds() - cpu);
  std::fflush(stdout);
  return result;
}

/// The loop up to the planner.
class Run {
 public:
  Run(const Scene<3>& scene, double voxel)
      : scene_(scene),
        lidar_(scene.mesh, lidar_options(scene)),
        surface_(scene.domain, surface_options(scene)),
        belief(window_over(scene.domain, voxel), scene.eta) {}

  /// phi of a scan from `place`, and the walls between its rays.
  void scan(const Vec<3>& place, int number) {
    const Scan<3> scan = lidar_.scan(place, number);
    Box<3> reach;
    reach.extend(scan.origin);
    const Grid<3>& window = belief.view().window();
    const Grid<3> near = intersection(window_over(reach.grown(scan.pattern.max_range), window.spacing), window);
    (void)surface_.insert(hit_points(scan), SurfaceSensor<3>{scan.origin, scan.pattern.step});
    const std::vector<Patch<3>> patches = surface_.patches(near.bounds().grown(2.0 * near.spacing + scene_.eta));
    const SeenSet<3> seen = seen_by<3>(patches, scan, near, scene_.eta);
    belief.unite(seen, distance_to_patches<3>(patches, near, belief.known_cap()), fill_between_rays(scan, 0.5 * window.spacing));
  }

 private:
  static LidarOptions lidar_options(const Scene<3>& scene) {
    LidarOptions o;
    o.pattern.max_range = scene.range;
    return o;
  }
  static SurfaceOptions surface_options(const Scene<3>& scene) {
    SurfaceOptions o;
    o.eta = scene.eta;
    return o;
  }

  const Scene<3>& scene_;
  SimulatedLidar<3> lidar_;
  HausdorffTree<3> surface_;

 public:
  Belief<3> belief;
};

/// Eq. (1) without line of sight at the candidates: term by term, in blocks of several terms, and by the tree.
void plain_sums(const BeliefView<3>& view, std::span<const BoundaryFace<3>> faces, const RayMarch<3>& march, std::span<const std::size_t> nodes) {
  PlannerOptions options;
  options.line_of_sight = false;
  const auto elements = boundary_elements<3>(view, faces, options);
  const auto at_all = [&](auto&& metric) {
    std::vector<double> values(nodes.size());
    parallel_for(nodes.size(), 1, [&](std::size_t i) { values[i] = metric(view.window().position(nodes[i])); });
    return values;
  };
  const std::vector<double> slow =
      timed("plain sum, term by term", [&] { return at_all([&](const Vec<3>& z) { return boundary_metric<3>(elements, march, z, options); }); });
  const double largest = *std::max_element(slow.begin(), slow.end());
  for (const double angle : {0.0, 0.2}) {
    options.tree_angle = angle;
    const auto sum = timed("plain sum, build", [&] { return PlainSum<3>(elements, march, options); });
    const std::vector<double> fast = timed(angle > 0.0 ? "plain sum, tree of 0.2 rad" : "plain sum, in blocks",
                                           [&] { return at_all([&](const Vec<3>& z) { return sum.at(z); }); });
    double worst = 0.0;
    for (std::size_t i = 0; i < slow.size(); ++i) worst = std::max(worst, std::abs(fast[i] - slow[i]));
    fmt::print("  {} terms at {} places, largest difference {:.1e} of the largest sum\n", elements.size(), nodes.size(), worst / largest);
  }
}

/// The stages of one decision, each by itself.
void stages(const BeliefView<3>& view, OpeningModel<3> opening, std::span<const Vec<3>> visited, const PlannerOptions& options, double range) {
  const Vec<3> here = visited.back();
  const auto grid = timed("blocks to march through", [&] { return MarchGrid<3>(view.state); });
  timed("opening", [&] { return opening.update(view, here, range, &grid), 0; });
  const double opacity = options.lambda_factor * timed("opacity", [&] { return measured_opacity(view); });
  const auto reachable = timed("reachable", [&] { return reachable_nodes(view, here, options.clearance); });
  const auto medial = timed("medial", [&] { return medial_nodes<3>(view, reachable, visited, options); });
  const RayMarch<3> march(view, opening.openness(), {opacity, range, 0.0, nullptr, &grid});
  const auto limit = static_cast<std::size_t>(options.candidates);
  const auto nodes = timed("candidates", [&] { return choose_candidates<3>(medial, opening.faces(), march, view.window(), limit, 1); });
  const auto look = [&](std::size_t count, std::int64_t rays) {
    const auto directions = spread_directions<3>(static_cast<std::size_t>(rays), 1);
    std::vector<double> volumes(count);
    parallel_for(count, 1, [&](std::size_t i) { volumes[i] = march.look(view.window().position(nodes[i]), directions).volume; });
    return volumes;
  };
  const auto volumes = timed("first look", [&] { return look(nodes.size(), options.rays); });
  (void)timed("second look",
              [&] { return look(std::min<std::size_t>(nodes.size(), static_cast<std::size_t>(options.refine)), options.refine_rays); });
  if (nodes.empty()) return;
  plain_sums(view, opening.faces(), march, nodes);
  const std::size_t best = nodes[static_cast<std::size_t>(std::max_element(volumes.begin(), volumes.end()) - volumes.begin())];
  const std::size_t first = first_node<3>(view, here, [&](std::size_t node) { return reachable[node] != 0; });
  (void)timed("path", [&] { return safe_path(reachable, first, best, here).size(); });
  (void)timed("verdict", [&] { return assess<3>(view, opening.faces(), reachable, {opacity, range, 0.0}).unseen.size(); });
  std::size_t seen = 0;
  for (const NodeState s : view.state.values) seen += s == NodeState::seen;
  fmt::print("{} faces, {} medial, {} candidates; {:.1f} % of the nodes seen\n", opening.faces().size(), medial.size(), nodes.size(),
             100.0 * static_cast<double>(seen) / static_cast<double>(view.window().size()));
}

void row(const Scene<3>& scene, double voxel, const Settings& settings) {
  Run run(scene, voxel);
  const Grid<3>& window = run.belief.view().window();
  fmt::print("\n`{}`, h = {:.3g} m, {} x {} x {} nodes\n\n| stage                        |   wall s |    CPU s |\n", scene.name, voxel,
             window.extent[0], window.extent[1], window.extent[2]);
  PlannerOptions options;
  options.clearance = scene.clearance;
  Planner<3> planner(options, scene.range, 1);
  OpeningModel<3> opening(OpeningModel<3>::Rule::learned);
  std::vector<Vec<3>> visited;
  Vec<3> place = scene.start;
  double before = 0.0;
  for (int k = 0; k < settings.scans; ++k) {
    run.scan(place, k);
    visited.push_back(place);
    const double now = run.belief.seen_volume();
    const auto choose = [&] { return planner.choose(run.belief.view(), place, now - before); };
    const bool last = k + 1 == settings.scans;
    const Decision<3> decision = last ? timed("choose", choose) : choose();
    before = now;
    if (!last) {
      const MarchGrid<3> grid(run.belief.view().state);
      opening.update(run.belief.view(), place, scene.range, &grid);
      if (decision.found) place = decision.position;
      continue;
    }
    const auto peer = [&](double clearance) { return reachable_nodes(run.belief.view(), place, clearance); };
    (void)timed("assess", [&] { return planner.assess(run.belief.view()).seen_fraction; });
    stages(run.belief.view(), opening, visited, options, scene.range);
    if (settings.views > 0) {
      const auto reachable = peer(options.clearance);
      const auto medial = medial_nodes<3>(run.belief.view(), reachable, visited, options);
      Random random(1);
      std::vector<Vec<3>> views;
      for (int v = 0; v < settings.views && !medial.empty(); ++v) views.push_back(window.position(medial[random.below(medial.size())]));
      const std::optional<PeerChoice> choice = octomap_choice(run.belief.view(), views, scene.range);
      if (!choice) {
        fmt::print("OctoMap was not found.\n");
        return;
      }
      fmt::print("| {:<28} | {:>8} | {:8.4f} |\n| {:<28} | {:>8} | {:8.4f} |\n", fmt::format("OctoMap, {} views", views.size()), "", choice->cpu,
                 "  and beyond the first unknown", "", choice->cpu_volume);
      const auto gain = [&](const Vec<3>& at) {  // What a scan there truly shows.
        Run copy(scene, voxel);
        for (std::size_t i = 0; i < visited.size(); ++i) copy.scan(visited[i], static_cast<int>(i));
        const double first = copy.belief.seen_volume();
        copy.scan(at, static_cast<int>(visited.size()));
        return copy.belief.seen_volume() - first;
      };
      fmt::print("True new volume [m^3]: vantage {:.0f}, most unknown rays {:.0f}, most unknown volume {:.0f}\n", gain(decision.position),
                 gain(views[choice->most_rays]), gain(views[choice->most_volume]));
    }
  }
}

int run(int argc, char** argv) {
  Settings s;
  CLI::App app("One decision: time by stage, beside OctoMap information gain.");
  app.add_option("--scene", s.scene, "in 3D");
  app.add_option("--nodes", s.nodes, "cube roots of the numbers of nodes")->delimiter(',');
  app.add_option("--voxel", s.voxel, "lattice spacing instead [m]");
  app.add_option("--scans", s.scans, "before the decision")->check(CLI::Range(1, 999));
  app.add_option("--threads", s.threads, "0: all");
  app.add_option("--views", s.views, "of OctoMap, 4,050 rays each; 0: none");
  CLI11_PARSE(app, argc, argv);
  const auto scene = std::get<Scene<3>>(make_scene(s.scene));
  const ThreadLimit limit(s.threads);
  const double volume = scene.domain.size().prod();
  if (s.voxel > 0.0)
    row(scene, s.voxel, s);
  else
    for (const int n : s.nodes) row(scene, std::cbrt(volume) / n, s);
  return 0;
}

}  // namespace
}  // namespace vantage::bench

int main(int argc, char** argv) {
  return vantage::bench::guarded("bench_decision", [&] { return vantage::bench::run(argc, argv); });
}

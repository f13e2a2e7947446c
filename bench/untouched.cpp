// SPDX-License-Identifier: Apache-2.0
// How many candidates of a decision could keep what the last one found of them (docs/adr/0015-candidates-are-looked-at-anew.md)?
//   bench_untouched --scenes planar,office,town
// Explores the scenes and counts, at every step, the candidates of which no ray passes a node that the last scan changed, up to known surface.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>

#include "program.h"
#include "vantage/audit/trial.h"
#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/planner/ray_march.h"
#include "vantage/world/lidar.h"
#include "vantage/world/scene.h"

namespace vantage::bench {
namespace {

struct Tally {
  std::int64_t candidates = 0, untouched = 0, rays = 0, untouched_rays = 0;
};

/// Of the rays from a node those that pass no node whose state differs between two steps.
template <int Dim>
std::int64_t untouched_rays(const Field<Dim, NodeState>& before, const Field<Dim, NodeState>& now, std::size_t node, double range) {
  const Grid<Dim>& grid = now.window;
  std::int64_t count = 0;
  for (const Vec<Dim>& direction : spread_directions<Dim>(rays_in<Dim>(PlannerOptions{}.rays), 1)) {
    bool touched = false;
    for (double t = 0.0; t < range && !touched; t += 0.5 * grid.spacing) {
      const Index<Dim> at = grid.nearest(Vec<Dim>(grid.position(node) + t * direction));
      if (!grid.inside(at)) break;
      touched = before.at(at) != now.at(at);
      if (now.at(at) == NodeState::obstacle) break;
    }
    count += touched ? 0 : 1;
  }
  return count;
}

template <int Dim>
Tally explore(const Scene<Dim>& scene) {
  const TrialOptions options = trial_options(scene);
  SimulatedLidar<Dim> lidar(scene.mesh, options.lidar);
  Explorer<Dim> explorer(lidar, scene.domain, scene.start, options.explore);
  Tally tally;
  Field<Dim, NodeState> before;
  while (!explorer.finished()) {
    explorer.step();
    const Field<Dim, NodeState> now = explorer.states();
    const Field<Dim> metric = explorer.metric();  // A number where a candidate was looked at.
    std::vector<std::size_t> nodes;
    for (std::size_t i = 0; i < metric.values.size(); ++i)
      if (!std::isnan(metric[i])) nodes.push_back(i);
    std::vector<std::int64_t> rays(nodes.size());
    if (!before.values.empty())
      parallel_for(nodes.size(), 1, [&](std::size_t i) { rays[i] = untouched_rays<Dim>(before, now, nodes[i], scene.range); });
    const auto all = static_cast<std::int64_t>(rays_in<Dim>(PlannerOptions{}.rays));
    for (const std::int64_t untouched : before.values.empty() ? std::vector<std::int64_t>{} : rays) {
      ++tally.candidates;
      tally.untouched += untouched == all ? 1 : 0;
      tally.rays += all;
      tally.untouched_rays += untouched;
    }
    before = now;
  }
  return tally;
}

int run(int argc, char** argv) {
  std::vector<std::string> scenes{"planar", "blocks", "office", "town2d", "floor", "patio", "town"};
  CLI::App app("Share of the candidates and of their rays that a scan leaves as they were.");
  app.add_option("--scenes", scenes, "built-in")->delimiter(',');
  CLI11_PARSE(app, argc, argv);
  fmt::print("| {:<10} | {:>10} | {:>11} | {:>11} |\n|---|--:|--:|--:|\n", "", "candidates", "untouched", "their rays");
  for (const std::string& name : scenes) {
    const Tally t = std::visit([](const auto& scene) { return explore(scene); }, make_scene(name));
    const auto percent = [](std::int64_t part, std::int64_t whole) { return 100.0 * static_cast<double>(part) / static_cast<double>(whole); };
    fmt::print("| {:<10} | {:>10} | {:>9.0f} % | {:>9.0f} % |\n", name, t.candidates, percent(t.untouched, t.candidates),
               percent(t.untouched_rays, t.rays));
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace
}  // namespace vantage::bench

int main(int argc, char** argv) {
  return vantage::bench::guarded("bench_untouched", [&] { return vantage::bench::run(argc, argv); });
}

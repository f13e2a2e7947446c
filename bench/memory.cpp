// SPDX-License-Identifier: Apache-2.0
// Memory of a map that the same places are scanned for again and again, 88 scans (10 million points) a round, every round a little beside the last.
#include <fmt/format.h>
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <ctime>

#include "cloud.h"
#include "vantage/base/random.h"
#include "vantage/surface/surface.h"
#include "vantage/world/lidar.h"

namespace {

using namespace vantage;

constexpr std::size_t kScans = 88;
constexpr double kBeside = 0.5;    // Of the scanner, at most, along each axis [m].
constexpr double kVehicle = 2.15;  // Nearer returns are left out [m].

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double held_bytes() {
  const auto info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Memory of the surface stage, round after round over one scene.");
  double eta = 0.4;
  std::vector<double> sides{0.0, 0.1};
  int rounds = 10;
  app.add_option("--eta", eta, "[m]")->check(CLI::Range(0.01, 10.0));
  app.add_option("--quantise", sides, "surface.quantise, one map each [m]")->check(CLI::Range(0.0, 1.0));
  app.add_option("--rounds", rounds, "of 88 scans")->check(CLI::Range(1, 100));
  CLI11_PARSE(app, argc, argv);

  const auto scene = std::get<Scene<3>>(make_scene("town"));
  const std::vector<Vec<3>> places = bench::stations(scene, kScans);
  fmt::print("| quantise [m] | points | MB | bytes a point | primitives | CPU of the round [s] |\n| ---: | ---: | ---: | ---: | ---: | ---: |\n");
  LidarOptions options;
  options.pattern.min_range = kVehicle;
  SimulatedLidar<3> lidar(scene.mesh, options);
  for (const double side : sides) {
    const double before = held_bytes();
    HausdorffTree<3> tree(scene.domain, {.eta = eta, .quantise = side});
    Random random(1);
    for (int round = 0; round < rounds; ++round) {
      double seconds = 0.0;
      for (const Vec<3>& place : places) {
        const Vec<3> from = place + kBeside * Vec<3>(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
        const std::vector<Vec<3>> hits = hit_points(lidar.scan(from, round));
        const double start = cpu_seconds();
        tree.insert(hits);
        seconds += cpu_seconds() - start;
      }
      const double bytes = held_bytes() - before;
      const SurfaceStatistics s = tree.statistics();
      fmt::print("| {} | {} | {:.1f} | {:.1f} | {} | {:.1f} |\n", side, s.points, bytes / 1e6, bytes / static_cast<double>(s.points),
                 s.fits + s.segments + s.loose_points, seconds);
      std::fflush(stdout);
    }
  }
  return 0;
}

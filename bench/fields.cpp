// SPDX-License-Identifier: Apache-2.0
// Distance and belief: time, bytes moved, errors, beside SciPy and OpenVDB where they are (docs/4-belief.md):
//   bench_distance --sizes 128,256,512 --threads 1,2 --json figures.json
// Medians of `--repeat` runs. Floor: the bytes that must move at the bandwidth measured in the same run.
#include "fields.h"
#include "program.h"

#include <fmt/format.h>
#include <time.h>

#include <CLI/CLI.hpp>
#include <array>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/base/random.h"
#include "vantage/belief/belief.h"
#include "vantage/field/distance.h"
#include "vantage/field/narrow_band.h"
#include "vantage/field/redistance.h"
#include "vantage/field/stencil.h"
#include "vantage/scan/fill.h"
#include "vantage/surface/surface.h"
#include "vantage/visibility/visibility.h"
#include "vantage/world/lidar.h"
#include "vantage/world/scene.h"

namespace vantage::bench {

double cpu_seconds() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

namespace {

using Set = Field<3, std::uint8_t>;

struct Settings {
  std::vector<int> sizes{128, 256, 512}, threads{1, 2};
  int repeat = 5, scans = 5;
  std::string scene = "town", json;
  double voxel = 0.5;
  bool peers = true, kernels = true, step = true, growth = false;
};

struct Seconds {
  double cpu, wall;
};

/// Medians.
template <class Work>
Seconds timed(int repeat, Work&& work) {
  std::vector<double> cpu, wall;
  for (int r = 0; r < repeat; ++r) {
    const auto begin = std::chrono::steady_clock::now();
    const double begin_cpu = cpu_seconds();
    work();
    cpu.push_back(cpu_seconds() - begin_cpu);
    wall.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  const auto median = [](std::vector<double>& v) {
    std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
    return v[v.size() / 2];
  };
  return {median(cpu), median(wall)};
}

Set empty_set(int n) { return Set(Grid<3>{1.0, Index<3>::Zero(), Index<3>::Constant(n)}); }

double from_center(const Set& set, std::size_t i) {
  return (set.window.position(i) - 0.5 * (set.window.extent.cast<double>() - Vec<3>::Ones())).norm();
}

Set ball(int n, double radius) {
  Set set = empty_set(n);
  for (std::size_t i = 0; i < set.values.size(); ++i) set[i] = from_center(set, i) < radius;
  return set;
}

/// Thin upright walls on a floor, as a town's.
Set walls(int n) {
  Set set = empty_set(n);
  Random random(1);
  for (int k = 0; k < 40; ++k) {
    Index<3> low, size;
    for (int a = 0; a < 3; ++a) {
      low[a] = a == 2 ? 0 : static_cast<int>(random.uniform() * n);
      size[a] = a == k % 2 ? 1 : static_cast<int>(random.uniform(0.05, 0.25) * n);
    }
    const Grid<3> wall = intersection(Grid<3>{1.0, low, size}, set.window);
    for (std::size_t i = 0; i < wall.size(); ++i) set.at(wall.local(i) + wall.first) = 1;
  }
  for (std::size_t i = 0; i < set.window.stride(2); ++i) set[i] = 1;
  return set;
}

Set points(int n) {
  Set set = empty_set(n);
  Random random(2);
  for (int k = 0; k < 1000; ++k) set[static_cast<std::size_t>(random.uniform() * static_cast<double>(set.values.size()))] = 1;
  return set;
}

/// Bytes a second of copying arrays that no cache holds, reads and writes both counted.
double bandwidth(int threads) {
  const ThreadLimit limit(threads);
  std::vector<float> from(1 << 26, 1.0F), to(from.size());
  const auto copy = [&] {
    parallel_chunks(from.size(), 1 << 20, [&](std::size_t begin, std::size_t end) {
      std::copy(from.begin() + static_cast<std::ptrdiff_t>(begin), from.begin() + static_cast<std::ptrdiff_t>(end),
                to.begin() + static_cast<std::ptrdiff_t>(begin));
    });
  };
  return 8.0 * static_cast<double>(from.size()) / timed(5, copy).cpu;
}

struct Kernel {
  std::string name;
  double bytes;  ///< A node: set read, result zeroed and written, squares written once and read once (the second axis runs in the cache).
  std::function<void(const Set&)> run;
};

void kernels(const Settings& s, nlohmann::json& json) {
  const std::vector<Kernel> all{{"to a set, exact, no cap", 1 + 4 + 4 + 4 + 4, [](const Set& set) { (void)distance_to_set(set); }},
                                {"signed, cap 32 h", 1 + 2 + 2 + 2 + 4 + 4, [](const Set& set) { (void)signed_distance(set, 32.0); }},
                                {"narrow band, 4 h, sparse", 1, [](const Set& set) { (void)narrow_band(set, 4.0); }},
                                {"nearest sites", 1 + 8 + 8 + 16, [](const Set& set) { (void)nearest_sites(set); }}};
  const std::vector<std::pair<std::string, std::function<Set(int)>>> sets{
      {"ball", [](int n) { return ball(n, 0.3 * n); }}, {"walls", walls}, {"1,000 points", points}};
  for (const int threads : s.threads) {
    const double speed = bandwidth(threads);
    fmt::print("\n{} thread(s); copying {:.1f} GB a CPU second\n\n| transform | set | n | CPU s | wall s | exponent | floor s | of the floor |\n",
               threads, speed * 1e-9);
    fmt::print("| --- | --- | --: | --: | --: | --: | --: | --: |\n");
    const ThreadLimit limit(threads);
    for (const Kernel& kernel : all)
      for (const auto& [set_name, make] : sets) {
        double last = 0.0;
        for (const int n : s.sizes) {
          const Set set = make(n);
          const Seconds t = timed(s.repeat, [&] { kernel.run(set); });
          const double floor = kernel.bytes * static_cast<double>(set.values.size()) / speed;
          const std::string exponent = last > 0.0 ? fmt::format("{:.2f}", std::log2(t.cpu / last)) : "";
          last = t.cpu;
          fmt::print("| {} | {} | {} | {:.4f} | {:.4f} | {} | {:.4f} | {:.1f} |\n", kernel.name, set_name, n, t.cpu, t.wall, exponent, floor,
                     t.cpu / floor);
          json["kernels"].push_back(
              {{"kernel", kernel.name}, {"set", set_name}, {"n", n}, {"threads", threads}, {"cpu_s", t.cpu}, {"wall_s", t.wall}, {"floor_s", floor}});
        }
      }
  }
}

double worst_error(const Field<3>& d, const Set& set, double radius) {
  double worst = 0.0;
  for (std::size_t i = 0; i < d.values.size(); ++i) worst = std::max(worst, std::abs(static_cast<double>(d[i]) - (radius - from_center(set, i))));
  return worst;
}

/// CPU seconds of SciPy's transform of the same ball, if Python has it.
std::optional<double> scipy(int n) {
  const std::string script = fmt::format(
      "import numpy as np, time\nfrom scipy.ndimage import distance_transform_edt as edt\nx = np.arange({0}) - {0} / 2 + 0.5\n"
      "a = (x[:, None, None] ** 2 + x[None, :, None] ** 2 + x[None, None, :] ** 2) >= (0.3 * {0}) ** 2\n"
      "t = time.process_time()\nedt(a)\nprint(time.process_time() - t)\n",
      n);
  FILE* pipe = popen(fmt::format("python3 -c '{}' 2>/dev/null", script).c_str(), "r");
  double seconds = 0.0;
  const bool there = pipe != nullptr && std::fscanf(pipe, "%lf", &seconds) == 1;
  if (pipe != nullptr) pclose(pipe);
  return there ? std::optional(seconds) : std::nullopt;
}

void peers(const Settings& s, nlohmann::json& json) {
  fmt::print("\nBeside others, a ball of radius 0.3 n, CPU seconds, largest error against the closed form [steps]\n\n");
  for (const int n : s.sizes) {
    if (n > 256) continue;
    const double radius = 0.3 * n;
    const Set set = ball(n, radius);
    const ThreadLimit limit(1);
    const double plain = timed(s.repeat, [&] { (void)distance_to_set(set); }).cpu;
    const double both = timed(s.repeat, [&] { (void)signed_distance(set, 10.0 * n); }).cpu;
    fmt::print("* n = {}: to a set {:.4f}, signed without cap {:.4f}, error {:.3f}\n", n, plain, both,
               worst_error(signed_distance(set, 10.0 * n), set, radius));
    const auto put = [&](const std::string& name, double seconds, double ours, const std::string& error) {
      fmt::print("  {}: {:.3f}, {:.0f} times ours{}\n", name, seconds, seconds / ours, error);
      json["peers"].push_back({{"name", name}, {"n", n}, {"cpu_s", seconds}, {"ours_cpu_s", ours}});
    };
    if (const auto seconds = scipy(n)) put("SciPy distance_transform_edt", *seconds, plain, "");
#ifdef VANTAGE_OPENVDB_DISTANCE
    const PeerDistance vdb = openvdb_fog_to_sdf(set, radius);
    put(vdb.name, vdb.cpu, both, fmt::format(", error {:.3f}", vdb.error));
#endif
  }
}

/// Errors of redistancing and of normals against closed forms.
template <class Truth>
void accuracy(const std::string& name, nlohmann::json& json, Truth&& truth) {
  for (const int n : {32, 64, 128}) {
    Field<3> phi(Grid<3>{2.0 / n, Index<3>::Constant(-n / 2), Index<3>::Constant(n + 1)});
    Set inside(phi.window);
    for (std::size_t i = 0; i < phi.values.size(); ++i) {
      const Vec<3> p = phi.window.position(i);
      phi[i] = static_cast<float>(truth(p) * (1.5 + p[0]) * (2.0 + p[1]));
      inside[i] = phi[i] > 0.0F;
    }
    const Field<3> d = redistance(phi), bits = smooth(signed_distance(inside, 1.0), 1);
    double worst = 0.0;
    std::array<double, 2> angle{};
    double count = 0.0;
    for (std::size_t i = 0; i < phi.values.size(); ++i) {
      const Index<3> at = phi.window.local(i);
      const Vec<3> p = phi.window.position(i);
      if (std::abs(truth(p)) > 4.0 * phi.window.spacing || (p.cwiseAbs().array() > 0.8).any() || p.head<2>().norm() < 0.15) continue;
      worst = std::max(worst, std::abs(static_cast<double>(d[i]) - truth(p)));
      Vec<3> normal;
      for (int a = 0; a < 3; ++a) normal[a] = truth(p + 1e-5 * Vec<3>::Unit(a)) - truth(p - 1e-5 * Vec<3>::Unit(a));
      const auto off = [&](const Field<3>& f) {
        return std::acos(std::clamp(gradient(f, at).normalized().dot(normal.normalized()), -1.0, 1.0)) * 180.0 / kPi;
      };
      angle[0] += off(d);
      angle[1] += off(bits);
      count += 1.0;
    }
    fmt::print("| {} | {} | {:.4f} | {:.3f} | {:.2f} | {:.2f} |\n", name, n, worst, worst / phi.window.spacing, angle[0] / count, angle[1] / count);
    json["accuracy"].push_back(
        {{"shape", name}, {"n", n}, {"error", worst}, {"normal_deg", angle[0] / count}, {"normal_of_bits_deg", angle[1] / count}});
  }
}

void accuracies(nlohmann::json& json) {
  fmt::print(
      "\nRedistancing within 4 steps of the surface, side 2, n steps\n\n| shape | n | largest error | in steps | normal off, mean deg | of a binary "
      "set |\n");
  fmt::print("| --- | --: | --: | --: | --: | --: |\n");
  accuracy("sphere", json, [](const Vec<3>& p) { return 0.6 - p.norm(); });
  accuracy("plane", json, [](const Vec<3>& p) { return p.dot(Vec<3>(0.48, 0.6, 0.64)) - 0.1; });
  accuracy("cone", json,
           [](const Vec<3>& p) { return 0.8 * p.head<2>().norm() - 0.6 * (p[2] + 0.4); });  // Sides only; the tip lies outside what counts.
}

/// The stages of a step before the planner, and what they have made so far.
class Walk {
 public:
  Walk(const Scene<3>& scene, double voxel)
      : scene_(scene),
        window_(window_over(scene.domain, voxel)),
        surface_(scene.domain, surface_options(scene)),
        lidar_(scene.mesh, LidarOptions{}),
        belief_(window_, scene.eta, scene.clearance) {}

  /// CPU seconds of the stages: surface, visibility, distance, belief.
  std::array<double, 4> step(const Vec<3>& place) {
    const Scan<3> scan = lidar_.scan(place, static_cast<int>(visited_.size()));
    visited_.push_back(place);
    Box<3> reach;
    reach.extend(scan.origin);
    const Grid<3> near = intersection(window_over(reach.grown(scan.pattern.max_range), window_.spacing), window_);
    std::vector<Patch<3>> patches;
    SeenSet<3> seen(near);
    Field<3> known;
    const Seconds insert = timed(1, [&] { (void)surface_.insert(hit_points(scan), SurfaceSensor<3>{scan.origin, scan.pattern.step}); });
    const Seconds see = timed(1, [&] {
      patches = surface_.patches(near.bounds().grown(2.0 * near.spacing + scene_.eta));
      seen = seen_by<3>(patches, scan, near, scene_.eta);
    });
    const Seconds measure = timed(1, [&] { known = distance_to_patches<3>(patches, near, belief_.known_cap()); });
    const Seconds unite = timed(1, [&] { belief_.unite(seen, known, fill_between_rays(scan, 0.5 * window_.spacing)); });
    return {insert.cpu, see.cpu, measure.cpu, unite.cpu};
  }

  /// The clear place at the scanner's height that is farthest from all scans so far, within `reach` of `center`.
  [[nodiscard]] Vec<3> next(const Vec<3>& center, double reach) const {
    Vec<3> place = center;
    double farthest = 0.0;
    for (std::size_t i = 0; i < window_.size(); i += 37) {
      const Vec<3> p = window_.position(i);
      if (std::abs(p[2] - scene_.start[2]) > 0.6 || (p - center).norm() > reach || !belief_.view().seen(i)) continue;
      if (static_cast<double>(belief_.view().known_distance[i]) < belief_.known_cap()) continue;
      double nearest = kInfinity;
      for (const Vec<3>& v : visited_) nearest = std::min(nearest, (p - v).norm());
      if (nearest > farthest) farthest = nearest, place = p;
    }
    return place;
  }
  [[nodiscard]] const Belief<3>& belief() const { return belief_; }

 private:
  [[nodiscard]] static SurfaceOptions surface_options(const Scene<3>& scene) {
    SurfaceOptions options;
    options.eta = scene.eta;
    return options;
  }

  Scene<3> scene_;
  Grid<3> window_;
  HausdorffTree<3> surface_;
  SimulatedLidar<3> lidar_;
  Belief<3> belief_;
  std::vector<Vec<3>> visited_;
};

double sum_of(const std::array<double, 4>& stages) { return stages[0] + stages[1] + stages[2] + stages[3]; }

/// Stages of a step, walking through a scene; then what the belief keeps.
void steps(const Settings& s, nlohmann::json& json) {
  const auto scene = std::get<Scene<3>>(make_scene(s.scene));
  Walk walk(scene, s.voxel);
  const Grid<3> window = walk.belief().view().window();
  fmt::print(
      "\n`{}`, h = {} m, {} x {} x {} nodes; CPU s\n\n| scan | surface | visibility | distance | belief | sum | faces | kept MB | view MB |\n| --: | "
      "--: | --: | --: | --: | --: | --: | --: | --: |\n",
      s.scene, s.voxel, window.extent[0], window.extent[1], window.extent[2]);
  Vec<3> place = scene.start;
  std::vector<double> sums;
  for (int k = 0; k < s.scans; ++k, place = walk.next(place, 60.0)) {
    const std::array<double, 4> cpu = walk.step(place);
    sums.push_back(sum_of(cpu));
    const double kept = static_cast<double>(walk.belief().kept_bytes()) * 1e-6, view = 9e-6 * static_cast<double>(window.size());
    fmt::print("| {} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {} | {:.2f} | {:.0f} |\n", k, cpu[0], cpu[1], cpu[2], cpu[3], sums.back(),
               walk.belief().view().boundary.size(), kept, view);
    json["steps"].push_back({{"surface_cpu_s", cpu[0]},
                             {"visibility_cpu_s", cpu[1]},
                             {"distance_cpu_s", cpu[2]},
                             {"belief_cpu_s", cpu[3]},
                             {"kept_mb", kept},
                             {"view_mb", view}});
  }
  std::nth_element(sums.begin(), sums.begin() + static_cast<std::ptrdiff_t>(sums.size() / 2), sums.end());
  fmt::print("\nmedian of the sums: {:.3f} CPU s\n", sums[sums.size() / 2]);
}

/// `tiles` x `tiles` copies of a scene side by side.
Scene<3> tiled(const Scene<3>& scene, int tiles) {
  Scene<3> out = scene;
  out.mesh = {};
  for (int t = 0; t < tiles * tiles; ++t) {
    const Vec<3> shift(scene.domain.size()[0] * (t % tiles), scene.domain.size()[1] * (t / tiles), 0.0);
    const auto first = static_cast<std::uint32_t>(out.mesh.vertices.size());
    for (const Vec<3>& v : scene.mesh.vertices) out.mesh.vertices.push_back(v + shift);
    for (auto facet : scene.mesh.facets) {
      for (auto& corner : facet) corner += first;
      out.mesh.facets.push_back(facet);
    }
  }
  for (int a = 0; a < 2; ++a) out.domain.high[a] = scene.domain.low[a] + scene.domain.size()[a] * tiles;
  return out;
}

/// Does a step cost more where the map is larger? A scene 2 x 2 and 4 x 4 times, all of it scanned; then the same scans around the middle of either,
/// whose surroundings are alike.
void growth(const Settings& s, nlohmann::json& json) {
  const auto scene = std::get<Scene<3>>(make_scene(s.scene));
  constexpr int kScans = 4, kMeasured = 7;
  std::array<std::vector<double>, 2> sums;
  fmt::print("\n`{}` repeated, {} scans in each copy, then {} in the middle; CPU s of the steps before the planner\n\n", s.scene, kScans, kMeasured);
  for (const int tiles : {2, 4}) {
    const Scene<3> map = tiled(scene, tiles);
    Walk walk(map, s.voxel);
    for (int t = 0; t < tiles * tiles; ++t) {
      Vec<3> place = scene.start + Vec<3>(scene.domain.size()[0] * (t % tiles), scene.domain.size()[1] * (t / tiles), 0.0);
      for (int k = 0; k < kScans; ++k, place = walk.next(place, 60.0)) (void)walk.step(place);
    }
    Vec<3> middle = map.domain.center();
    middle[2] = scene.start[2];
    std::vector<double>& mine = sums[tiles == 2 ? 0 : 1];
    for (int k = 0; k < kMeasured; ++k) mine.push_back(sum_of(walk.step(walk.next(middle, 40.0))));
    fmt::print("{0} x {0}: {1} nodes, {2:.3f}\n", tiles, walk.belief().view().window().size(), fmt::join(mine, " "));
  }
  std::vector<double> ratios;
  for (std::size_t k = 0; k < kMeasured; ++k) ratios.push_back(sums[1][k] / sums[0][k]);
  std::nth_element(ratios.begin(), ratios.begin() + kMeasured / 2, ratios.end());
  fmt::print("median ratio {:.3f}\n", ratios[kMeasured / 2]);
  json["growth_ratio"] = ratios[kMeasured / 2];
}

int run(int argc, char** argv) {
  Settings s;
  CLI::App app("Distance and belief: time, bytes, errors");
  app.add_option("--sizes", s.sizes, "nodes along a side")->delimiter(',');
  app.add_option("--threads", s.threads, "threads")->delimiter(',');
  app.add_option("--repeat", s.repeat, "runs of which the median counts")->check(CLI::Range(1, 99));
  app.add_option("--scans", s.scans, "scans of the steps")->check(CLI::Range(1, 999));
  app.add_option("--scene", s.scene, "scene of the steps");
  app.add_option("--voxel", s.voxel, "lattice spacing of the steps [m]");
  app.add_option("--json", s.json, "figures to this file");
  app.add_flag("!--no-peers", s.peers, "without SciPy and OpenVDB");
  app.add_flag("!--no-kernels", s.kernels, "without the transforms");
  app.add_flag("!--no-step", s.step, "without the steps");
  app.add_flag("--growth", s.growth, "steps in a map, and in one four times larger");
  CLI11_PARSE(app, argc, argv);
  nlohmann::json json;
  if (s.kernels) kernels(s, json);
  if (s.peers) peers(s, json);
  if (s.kernels) accuracies(json);
  if (s.step) steps(s, json);
  if (s.growth) growth(s, json);
  if (!s.json.empty()) std::ofstream(s.json) << json.dump(2) << "\n";
  return 0;
}

}  // namespace
}  // namespace vantage::bench

int main(int argc, char** argv) {
  return vantage::bench::guarded("bench_distance", [&] { return vantage::bench::run(argc, argv); });
}

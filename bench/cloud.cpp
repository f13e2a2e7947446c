// SPDX-License-Identifier: Apache-2.0
#include "cloud.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include <deque>
#include <map>

#include "binary.h"
#include "distance.h"
#include "vantage/base/error.h"
#include "vantage/base/random.h"
#include "vantage/geometry/ray_caster.h"
#include "vantage/world/lidar.h"

namespace vantage::bench {
namespace {

constexpr double kStep = 2.0;        ///< Between places looked at [m].
constexpr double kClearance = 1.0;   ///< Of a place to surfaces [m].
constexpr double kMargin = 10.0;     ///< Of a place to the sides of the domain [m].
constexpr double kCarrier = 2.15;    ///< Nearer returns are taken for the vehicle's own and left out, as road data sets do [m].
constexpr double kDensity = 2000.0;  ///< Of the places on thin things [1/m^2].
constexpr double kObserved = 0.1;    ///< From a measured point [m].

/// The places of a walk from the start, in the order in which they are reached.
std::vector<Vec<3>> walk(const Scene<3>& scene) {
  const RayCaster<3> caster(scene.mesh);
  const Vec<3> up = Vec<3>::UnitZ();
  const auto free = [&](const Vec<3>& p) {
    const bool inside = p[0] > scene.domain.low[0] + kMargin && p[1] > scene.domain.low[1] + kMargin && p[0] < scene.domain.high[0] - kMargin &&
                        p[1] < scene.domain.high[1] - kMargin;
    return inside && caster.cast(p, up).range == kInfinity && caster.distance(p, kClearance) >= kClearance;
  };
  std::map<std::array<int, 2>, bool> seen{{{0, 0}, true}};
  std::vector<Vec<3>> places;
  std::deque<std::array<int, 2>> front{{0, 0}};
  const auto place = [&](const std::array<int, 2>& at) { return Vec<3>(scene.start + kStep * Vec<3>(at[0], at[1], 0.0)); };
  for (; !front.empty(); front.pop_front()) {
    const std::array<int, 2> at = front.front();
    const Vec<3> here = place(at);
    places.push_back(here);
    for (const auto& [dx, dy] : {std::array{1, 0}, std::array{-1, 0}, std::array{0, 1}, std::array{0, -1}}) {
      const std::array<int, 2> next{at[0] + dx, at[1] + dy};
      if (seen.contains(next)) continue;
      if (!free(place(next)) || caster.cast(here, Vec<3>(dx, dy, 0.0), kStep).range < kStep) continue;
      seen[next] = true;
      front.push_back(next);
    }
  }
  return places;
}

}  // namespace

void Cloud::add(const Vec<3>& origin, std::span<const Vec<3>> hits) {
  origins.push_back(origin);
  points.insert(points.end(), hits.begin(), hits.end());
  first.push_back(points.size());
}

std::vector<Vec<3>> stations(const Scene<3>& scene, std::size_t count) {
  const std::vector<Vec<3>> places = walk(scene);
  require(places.size() >= count, fmt::format("{} scans: only {} places to scan from in {}", count, places.size(), scene.name));
  std::vector<double> gap(places.size(), kInfinity);
  std::vector<Vec<3>> chosen{places.front()};
  while (chosen.size() < count) {
    std::size_t best = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      gap[i] = std::min(gap[i], (places[i] - chosen.back()).squaredNorm());
      if (gap[i] > gap[best]) best = i;
    }
    chosen.push_back(places[best]);
  }
  return chosen;
}

Cloud scan_scene(const Scene<3>& scene, std::size_t count) {
  LidarOptions options;
  options.pattern.min_range = kCarrier;
  SimulatedLidar<3> lidar(scene.mesh, options);
  Cloud cloud;
  cloud.domain = scene.domain;
  for (const Vec<3>& place : stations(scene, count)) {
    std::vector<Vec<3>> hits = hit_points(lidar.scan(place, static_cast<int>(cloud.scans())));
    std::erase_if(hits, [&](const Vec<3>& p) { return !scene.domain.contains(p); });
    cloud.add(place, hits);
  }
  return cloud;
}

std::vector<Vec<3>> observed_places(const Scene<3>& scene, const char* kind, std::span<const Vec<3>> points) {
  Random random(2026);
  std::vector<Vec<3>> places;
  for (const Scene<3>::Part& part : scene.parts) {
    if (part.name != kind) continue;
    for (std::uint32_t f = part.first; f < part.first + part.count; ++f) {
      const auto& [i, j, k] = scene.mesh.facets[f];
      const Vec<3> a = scene.mesh.vertices[i], u = scene.mesh.vertices[j] - a, v = scene.mesh.vertices[k] - a;
      const auto count = static_cast<int>(0.5 * u.cross(v).norm() * kDensity + random.uniform());
      for (int n = 0; n < count; ++n) {
        double s = random.uniform(), t = random.uniform();
        if (s + t > 1.0) s = 1.0 - s, t = 1.0 - t;
        places.emplace_back(a + s * u + t * v);
      }
    }
  }
  const std::vector<double> gaps = distances(Nearest(pieces(points)), places, 2.0 * kObserved);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (gaps[i] <= kObserved) places[kept++] = places[i];
  places.resize(kept);
  return places;
}

void save(const Cloud& cloud, const std::filesystem::path& path) {
  std::ofstream file(path, std::ios::binary);
  put(file, std::vector{cloud.domain.low, cloud.domain.high});
  put(file, cloud.origins);
  put(file, cloud.first);
  put(file, cloud.points);
  file.close();
  require(static_cast<bool>(file), path.string() + ": cannot be written");
}

Cloud load(const std::filesystem::path& path, std::size_t scans) {
  std::ifstream file(path, std::ios::binary);
  Cloud cloud;
  const auto corners = get<Vec<3>>(file, 2);
  cloud.origins = get<Vec<3>>(file, scans);
  cloud.first = get<std::size_t>(file, scans + 1);
  require(file && corners.size() == 2 && cloud.first.size() == cloud.scans() + 1, path.string() + ": not a cloud");
  cloud.points = get<Vec<3>>(file, cloud.first.back());
  cloud.domain = {corners[0], corners[1]};
  require(static_cast<bool>(file), path.string() + ": cut off");
  return cloud;
}

}  // namespace vantage::bench

// SPDX-License-Identifier: Apache-2.0
// Bytes of the exchanged map beside Draco's and OctoMap's at the same largest error (docs/9-exchange.md):
//   bench_exchange --eta 0.093 --scene town RUN/scans/*.ply
// whole: all scans at once; scan by scan: the sum over deltas (peers: over each scan coded alone); facade: only the points within eta of steep
// facets of the scene, and bytes a square metre of those facets that points lie on.
#include <fmt/format.h>
#ifdef VANTAGE_DRACO
#include <draco/compression/encode.h>
#include <draco/point_cloud/point_cloud_builder.h>
#endif
#ifdef VANTAGE_OCTOMAP
#include <octomap/OcTree.h>
#endif

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <chrono>
#include <sstream>
#include <unordered_set>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/exchange/publisher.h"
#include "vantage/session/clouds.h"
#include "vantage/world/scene.h"

namespace vantage {
namespace {

using Points = std::vector<Vec<3>>;

struct Size {
  double bytes = 0.0, seconds = 0.0, error = 0.0;
  std::int64_t primitives = 0;
};

template <class Work>
Size timed(Work&& work) {
  const auto begin = std::chrono::steady_clock::now();
  Size size = work();
  size.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return size;
}

Size ours(const std::vector<Points>& scans, double eta) {
  return timed([&] {
    Publisher<3> publisher("bench", eta);
    ExchangeMap map;
    for (const Points& scan : scans) map.add(publisher.publish(scan));
    const MapCertificate errors = certificate(map);
    Size size{static_cast<double>(map.bytes().size()), 0.0, std::max(errors.data_to_surface, errors.surface_to_data)};
    for (const auto& entry : map.entries()) size.primitives += static_cast<std::int64_t>(entry.delta.counts.planes + entry.delta.counts.cells);
    return size;
  });
}

/// Side of cubes whose corners are `eta` from their centre: the coarsest lattice that rounds points by no more.
double cube_side(double eta) { return 2.0 * eta / std::sqrt(3.0); }

#ifdef VANTAGE_DRACO
/// k-d tree coding, best compression, on exactly that lattice; `once`: points that fall together are one.
Size draco_size(const std::vector<Points>& scans, double eta, bool once) {
  return timed([&] {
    Size size;
    size.error = eta;
    for (const Points& scan : scans) {
      Box<3> box;
      for (const Vec<3>& p : scan) box.extend(p);
      const double step = cube_side(eta);
      int bits = 1;
      while (((1 << bits) - 1) * step < box.size().maxCoeff()) ++bits;
      std::vector<std::array<float, 3>> points;
      std::unordered_set<std::string> seen;
      for (const Vec<3>& p : scan) {
        std::array<std::int32_t, 3> cell;
        for (int a = 0; a < 3; ++a) cell[static_cast<std::size_t>(a)] = static_cast<std::int32_t>(std::floor((p[a] - box.low[a]) / step + 0.5));
        if (once && !seen.insert(std::string(reinterpret_cast<const char*>(cell.data()), sizeof cell)).second) continue;
        points.push_back({static_cast<float>(p[0] - box.low[0]), static_cast<float>(p[1] - box.low[1]), static_cast<float>(p[2] - box.low[2])});
      }
      draco::PointCloudBuilder builder;
      builder.Start(static_cast<std::uint32_t>(points.size()));
      const int id = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
      builder.SetAttributeValuesForAllPoints(id, points.data(), 0);
      const auto cloud = builder.Finalize(false);
      draco::Encoder encoder;
      encoder.SetSpeedOptions(0, 0);
      encoder.SetEncodingMethod(draco::POINT_CLOUD_KD_TREE_ENCODING);
      const float origin[3] = {0.0F, 0.0F, 0.0F};
      encoder.SetAttributeExplicitQuantization(draco::GeometryAttribute::POSITION, bits, 3, origin, static_cast<float>(step * ((1 << bits) - 1)));
      draco::EncoderBuffer buffer;
      require(encoder.EncodePointCloudToBuffer(*cloud, &buffer).ok(), "Draco refuses the cloud");
      size.bytes += static_cast<double>(buffer.size());
      size.primitives += static_cast<std::int64_t>(points.size());
    }
    return size;
  });
}
#endif

#ifdef VANTAGE_OCTOMAP
/// Occupied voxels only, written as .bt; `solid`: a voxel claims all of its cube, else its centre.
Size octomap_size(const std::vector<Points>& scans, double eta, bool solid) {
  return timed([&] {
    Size size;
    size.error = eta;
    for (const Points& scan : scans) {
      octomap::OcTree tree(solid ? eta / std::sqrt(3.0) : cube_side(eta));
      for (const Vec<3>& p : scan)
        tree.setNodeValue(octomap::point3d(static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])), tree.getProbHitLog(), true);
      tree.updateInnerOccupancy();
      std::stringstream out;
      require(solid ? tree.writeBinary(out) : tree.writeBinaryConst(out), "OctoMap cannot write");
      size.bytes += static_cast<double>(out.str().size());
      size.primitives += static_cast<std::int64_t>(tree.getNumLeafNodes());
    }
    return size;
  });
}
#endif

/// The steep facets of a scene, and places spread over them.
struct Facade {
  std::vector<Patch<3>> facets;
  Points samples;  ///< Centres of about kSample-sized pieces.
  std::vector<double> areas;
};

constexpr double kSample = 0.25;  ///< [m]
constexpr double kSteep = 0.2;    ///< Largest vertical part of a facade's unit normal.
constexpr double kSeen = 0.5;     ///< A piece counts as seen with a point so near [m].

Facade facade(const Scene<3>& scene) {
  Facade out;
  for (const auto& facet : scene.mesh.facets) {
    const Vec<3>&a = scene.mesh.vertices[facet[0]], &b = scene.mesh.vertices[facet[1]], &c = scene.mesh.vertices[facet[2]];
    const Vec<3> normal = (b - a).cross(c - a);
    const double area = 0.5 * normal.norm();
    if (!(area > 0.0) || std::abs(normal[2]) > kSteep * normal.norm()) continue;
    Patch<3> patch;
    patch.count = 3;
    patch.vertices[0] = a, patch.vertices[1] = b, patch.vertices[2] = c;
    out.facets.push_back(patch);
    const int n = std::max(1, static_cast<int>(std::ceil(std::max({(b - a).norm(), (c - a).norm(), (c - b).norm()}) / kSample)));
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < 2 * (n - i) - 1; ++j) {  // n^2 similar triangles.
        const bool up = j % 2 == 0;
        const double u = (i + (up ? 1.0 : 2.0) / 3.0) / n, v = (j / 2 + (up ? 1.0 : 2.0) / 3.0) / n;
        out.samples.push_back(a + u * (b - a) + v * (c - a));
        out.areas.push_back(area / (static_cast<double>(n) * n));
      }
  }
  return out;
}

using Cells = std::unordered_set<std::uint64_t>;
template <class Visit>
void around(const Vec<3>& p, double side, Visit&& visit) {
  for (int k = 0; k < 27; ++k) {
    std::uint64_t key = 0;
    for (int a = 0, rest = k; a < 3; ++a, rest /= 3)
      key = key << 21U | (static_cast<std::uint64_t>(std::floor(p[a] / side) + rest % 3 - 1 + (1 << 20)) & 0x1fffffU);
    visit(key, k == 13);
  }
}

/// The points within eta of a facet of the facade, scan by scan.
std::vector<Points> near_facade(const std::vector<Points>& scans, const Facade& facade, double eta) {
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> facets;
  std::size_t sample = 0;
  for (std::size_t f = 0; f < facade.facets.size(); ++f) {
    double area = measure(facade.facets[f]);
    for (; sample < facade.samples.size() && area > 1e-12 * measure(facade.facets[f]) + 0.5 * facade.areas[sample]; ++sample) {
      area -= facade.areas[sample];
      around(facade.samples[sample], kSeen, [&](std::uint64_t key, bool) {
        std::vector<std::size_t>& list = facets[key];
        if (list.empty() || list.back() != f) list.push_back(f);
      });
    }
  }
  std::vector<Points> out;
  for (const Points& scan : scans) {
    out.emplace_back();
    for (const Vec<3>& p : scan)
      around(p, kSeen, [&](std::uint64_t key, bool own) {
        const auto found = own ? facets.find(key) : facets.end();
        if (found != facets.end() &&
            std::any_of(found->second.begin(), found->second.end(), [&](std::size_t f) { return distance(facade.facets[f], p) <= eta; }))
          out.back().push_back(p);
      });
  }
  return out;
}

double seen_area(const std::vector<Points>& scans, const Facade& facade) {
  Cells cells;
  for (const Points& scan : scans)
    for (const Vec<3>& p : scan)
      around(p, kSeen, [&](std::uint64_t key, bool own) {
        if (own) cells.insert(key);
      });
  double area = 0.0;
  for (std::size_t i = 0; i < facade.samples.size(); ++i) {
    bool seen = false;
    around(facade.samples[i], kSeen, [&](std::uint64_t key, bool) { seen = seen || cells.contains(key); });
    area += seen ? facade.areas[i] : 0.0;
  }
  return area;
}

Points joined(const std::vector<Points>& scans) {
  Points all;
  for (const Points& scan : scans) all.insert(all.end(), scan.begin(), scan.end());
  return all;
}

void rows(const std::string& what, const std::vector<Points>& scans, double eta, double area) {
  double points = 0.0;
  for (const Points& scan : scans) points += static_cast<double>(scan.size());
  const auto row = [&](const char* who, const Size& size) {
    fmt::print("{:<14} {:<26} {:>10.0f} {:>8.4f} {:>8.1f} {:>9} {:>8.4f} {:>8.2f}", what, who, size.bytes, size.bytes / points,
               size.bytes / 1000.0 / static_cast<double>(scans.size()), size.primitives, size.error, size.seconds);
    fmt::print("{}\n", area > 0.0 ? fmt::format(" {:>7.1f}", size.bytes / area) : "");
    std::fflush(stdout);
  };
  row("vantage", ours(scans, eta));
#ifdef VANTAGE_DRACO
  row("Draco", draco_size(scans, eta, false));
  row("Draco, equal points once", draco_size(scans, eta, true));
#endif
#ifdef VANTAGE_OCTOMAP
  row("OctoMap .bt, centres", octomap_size(scans, eta, false));
  row("OctoMap .bt, cubes", octomap_size(scans, eta, true));
#endif
}

}  // namespace
}  // namespace vantage

int main(int argc, char** argv) {
  using namespace vantage;
  std::vector<std::string> clouds;
  std::string scene;
  double eta = 0.093;
  CLI::App app("Bytes of exchanged maps.");
  app.add_option("CLOUD", clouds, "point clouds or run folders, a scan each")->required();
  app.add_option("--eta", eta, "largest error [m]")->check(CLI::Range(1e-3, 10.0));
  app.add_option("--scene", scene, "the scene they were taken in, for the facade");
  CLI11_PARSE(app, argc, argv);
  try {
    const ThreadLimit one(1);
    std::vector<Points> scans;
    const std::vector<std::filesystem::path> paths(clouds.begin(), clouds.end());
    AnyScans read = read_scans(paths);
    require(read.index() == 1, "the scans are not of space");
    for (auto& scan : std::get<1>(read)) scans.push_back(std::move(scan.points));
    fmt::print("{} scans, eta {} m, one thread\n{:<14} {:<26} {:>10} {:>8} {:>8} {:>9} {:>8} {:>8} {:>7}\n", scans.size(), eta, "", "", "bytes",
               "a point", "kB/scan", "leaves", "error m", "seconds", "B/m2");
    rows("whole", {joined(scans)}, eta, 0.0);
    rows("scan by scan", scans, eta, 0.0);
    if (!scene.empty()) {
      const AnyScene any = make_scene(scene);
      const Facade walls = facade(std::get<Scene<3>>(any));
      const std::vector<Points> facade_scans = near_facade(scans, walls, eta);
      const double area = seen_area(facade_scans, walls);
      fmt::print("facade: {:.0f} m2 seen, {} points\n", area, joined(facade_scans).size());
      rows("facade, whole", {joined(facade_scans)}, eta, area);
      rows("facade, scans", facade_scans, eta, area);
    }
  } catch (const Error& error) {
    fmt::print(stderr, "bench_exchange: {}\n", error.what());
    return static_cast<int>(error.code());
  }
  return 0;
}

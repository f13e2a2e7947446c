// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/table1.h"

#include <fmt/format.h>

#include "vantage/audit/certificate.h"
#include "vantage/base/error.h"
#include "vantage/world/scene.h"

namespace vantage {
namespace {

enum class Region { domain, everything };

/// What is scanned for a pair of rows.
struct Case {
  Table1Row printed;
  Region region;
  std::vector<Vec<3>> stations;  ///< [m]
};

/// The stations are where explorations of the scenes went; the last three of the patio stand where people would.
std::vector<Case> cases() {
  return {{{.domain = "patio",
            .rules = "paper",
            .scans = 16,
            .points = 1769061,
            .eta = 0.02,
            .depth = 7,
            .nodes = 2721,
            .leaves = 2381,
            .fits = 1370,
            .hausdorff = 0.0344},
           Region::domain,
           {{9.8, 4.4, 1.6},
            {0.67, 17.0, 7.67},
            {6.33, 20.0, 1.67},
            {20.0, 11.33, 2.67},
            {4.33, 1.67, 5.0},
            {11.0, 18.67, 2.33},
            {19.33, 9.33, 5.0},
            {12.67, 8.67, 5.33},
            {0.0, 15.33, 2.33},
            {16.0, 8.0, 5.67},
            {15.0, 11.0, 2.67},
            {2.67, 3.67, 1.33},
            {17.33, 11.67, 5.33},
            {18.3, 2.2, 1.6},
            {2.9, 10.0, 1.6},
            {10.2, 12.6, 1.6}}},
          {{.domain = "church",
            .rules = "paper",
            .scans = 11,
            .points = 1896786,
            .eta = 0.004,
            .depth = 10,
            .nodes = 83769,
            .leaves = 73298,
            .fits = 11099,
            .hausdorff = 0.1357},
           Region::everything,
           {{4.0, 22.0, 2.0},
            {36.5, 14.0, 10.5},
            {28.5, 41.0, 16.0},
            {48.5, 29.5, 4.0},
            {30.5, 30.0, 2.0},
            {7.5, 44.5, 8.0},
            {23.0, 26.0, 3.5},
            {5.5, 1.0, 16.5},
            {42.0, 27.0, 10.5},
            {13.0, 25.5, 11.0},
            {25.5, 50.0, 1.0}}}};
}

void tell(Observer* observer, const std::string& what) {
  if (observer == nullptr) return;
  observer->stage(what);
  if (observer->stop_requested()) throw Error(ErrorCode::interrupted, "stopped at " + what);
}

/// The hits of all stations.
std::vector<Vec<3>> scanned(const Case& wanted, SimulatedLidar<3> sensor, Observer* observer) {
  std::vector<Vec<3>> points;
  for (std::size_t i = 0; i < wanted.stations.size(); ++i) {
    tell(observer, fmt::format("{}: scan {} of {}", wanted.printed.domain, i + 1, wanted.stations.size()));
    const std::vector<Vec<3>> hits = hit_points(sensor.scan(wanted.stations[i], static_cast<int>(i)));
    points.insert(points.end(), hits.begin(), hits.end());
  }
  return points;
}

/// The cube of interest as the tree makes it, and the points in it.
struct Input {
  Box<3> cube;
  std::vector<Vec<3>> points;
  [[nodiscard]] double side() const { return cube.size()[0]; }
};

Input input_of(const Case& wanted, const Scene<3>& scene, const std::vector<Vec<3>>& points) {
  Box<3> box = scene.domain;
  if (wanted.region == Region::everything) {
    box = {};
    for (const Vec<3>& p : points) box.extend(p);
  }
  const Vec<3> half = Vec<3>::Constant(0.5 * box.size().maxCoeff());
  Input input{{box.center() - half, box.center() + half}, {}};
  for (const Vec<3>& p : points)
    if (input.cube.contains(p)) input.points.push_back(p);
  return input;
}

/// One reconstruction, and what an exhaustive look at it finds.
Table1Row reconstructed(const Case& wanted, const Input& input, bool paper, std::vector<Patch<3>>& patches, Observer* observer) {
  Table1Row row = wanted.printed;
  row.rules = fmt::format("surface.paper = {}", paper);
  tell(observer, fmt::format("{}: surface, {}", row.domain, row.rules));
  HausdorffTree<3> tree(input.cube, {.eta = row.eta * input.side(), .paper = paper});
  tree.insert(input.points);
  const SurfaceStatistics s = tree.statistics();
  patches = tree.patches();
  const CertificateReport truth = check_certificate<3>(input.points, patches, {s.eta, s.data_to_surface, s.surface_to_data, !paper}, observer);
  row.points = s.points;
  row.side = input.side();
  row.depth = s.depth;
  row.nodes = s.nodes;
  row.leaves = s.leaves;
  row.fits = s.fits;
  row.segments = s.segments;
  row.loose_points = s.loose_points;
  row.hausdorff = std::max(truth.data_to_surface.max, truth.surface_to_data_low) / input.side();
  row.certified = s.certified() / input.side();
  return row;
}

std::string grouped(std::int64_t value) {
  std::string text = std::to_string(value);
  for (auto at = static_cast<std::ptrdiff_t>(text.size()) - 3; at > 0; at -= 3) text.insert(static_cast<std::size_t>(at), ",");
  return text;
}

}  // namespace

Table1 make_table1(const LidarOptions& sensor, Observer* observer) {
  Table1 table;
  for (const Case& wanted : cases()) {
    const auto scene = std::get<Scene<3>>(make_scene(wanted.printed.domain));
    const Input input = input_of(wanted, scene, scanned(wanted, SimulatedLidar<3>(scene.mesh, sensor), observer));
    table.rows.push_back(wanted.printed);
    Table1::Surface surface{wanted.printed.domain, scene.domain, {}};
    for (const bool paper : {true, false}) table.rows.push_back(reconstructed(wanted, input, paper, surface.patches, observer));
    table.surfaces.push_back(std::move(surface));
  }
  return table;
}

std::string table1_as_markdown(const std::vector<Table1Row>& rows) {
  std::string out =
      "| domain | rules | scans | points | side of the cube | η, cube = 1 | η | depth | nodes | leaves | fits | segments | points kept | Hausdorff "
      "(global), cube = 1 | Hausdorff (global) |\n|" +
      [] {
        std::string dashes;
        for (int i = 0; i < 15; ++i) dashes += i < 2 ? " --- |" : " ---: |";
        return dashes;
      }() +
      "\n";
  const auto metres = [](double share, double side) { return side > 0.0 ? fmt::format("{:.3g} m", share * side) : "?"; };
  for (const Table1Row& r : rows) {
    const bool printed = r.rules == "paper";
    out += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |", r.domain, printed ? "the paper's table" : "`" + r.rules + "`",
                       r.scans, grouped(r.points), metres(1.0, r.side), r.eta, metres(r.eta, r.side), r.depth, grouped(r.nodes), grouped(r.leaves),
                       grouped(r.fits));
    out += fmt::format(" {} | {} | {:.4f} | {} |\n", printed ? "" : grouped(r.segments), printed ? "" : grouped(r.loose_points), r.hausdorff,
                       metres(r.hausdorff, r.side));
  }
  return out;
}

}  // namespace vantage

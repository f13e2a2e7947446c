// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "paper_site.h"
#include "paper_views.h"
#include "vantage/base/random.h"
#include "vantage/geometry/ray_caster.h"
#include "vantage/report/solids.h"
#include "vantage/report/unseen_faces.h"

using namespace vantage;

namespace {

constexpr int kPlaces = 4000;  ///< Looked at of each kind of thing.

/// Distances in order.
struct Spread {
  std::vector<double> values;  ///< [m]

  [[nodiscard]] double quantile(double q) const {
    return values.empty() ? 0.0 : values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
  }
  [[nodiscard]] double mean() const {
    double sum = 0.0;
    for (const double v : values) sum += v;
    return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
  }
};

/// From the known part of the level surface to the true one.
Spread to_truth(const LevelSurface& surface, const RayCaster<3>& truth) {
  std::vector<bool> known(surface.vertices.size(), false);
  for (const auto& quad : surface.quads)
    for (const std::uint32_t corner : quad.corners) known[corner] = known[corner] || quad.known;
  Spread spread;
  for (std::size_t i = 0; i < known.size(); ++i)
    if (known[i]) spread.values.push_back(truth.distance(surface.vertices[i]));
  std::ranges::sort(spread.values);
  return spread;
}

/// A kind of thing and how much of its surface in the domain was found.
struct Kind {
  std::string name;
  double found = 0.0;  ///< Share with an obstacle node within h [1].
  double apart = 0.0;  ///< Share with a seen node within 3 h [1].
  int places = 0;
};

bool is_near(const Field<3, NodeState>& state, NodeState wanted, const Vec<3>& p, int cells) {
  const Grid<3>& grid = state.window;
  const Index<3> centre = grid.nearest(p);
  const int side = 2 * cells + 1;
  for (int code = 0; code < side * side * side; ++code) {
    const Index<3> node = centre + Index<3>(code % side - cells, code / side % side - cells, code / side / side - cells);
    if (grid.inside(node) && state.at(node) == wanted && (grid.position(node) - p).norm() <= cells * grid.spacing) return true;
  }
  return false;
}

/// Places drawn evenly over the kind's surface in the domain.
Kind found_of(const Scene<3>& scene, const std::string& name, const Field<3, NodeState>& state) {
  const Scene<3>::Part& part = *std::find_if(scene.parts.begin(), scene.parts.end(), [&](const auto& p) { return p.name == name; });
  std::vector<double> area{0.0};
  const auto corner = [&](std::uint32_t facet, std::size_t k) -> const Vec<3>& { return scene.mesh.vertices[scene.mesh.facets[facet][k]]; };
  for (std::uint32_t f = part.first; f < part.first + part.count; ++f)
    area.push_back(area.back() + 0.5 * (corner(f, 1) - corner(f, 0)).cross(corner(f, 2) - corner(f, 0)).norm());
  Random random(1);
  Kind kind{name, 0.0, 0.0, 0};
  int found = 0, apart = 0;
  for (int k = 0; k < kPlaces; ++k) {
    const double wanted = random.uniform(0.0, area.back());
    double u = random.uniform(0.0, 1.0), v = random.uniform(0.0, 1.0);
    if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
    const auto at = std::upper_bound(area.begin() + 1, area.end() - 1, wanted) - area.begin() - 1;
    const std::uint32_t facet = part.first + static_cast<std::uint32_t>(at);
    const Vec<3> p = corner(facet, 0) + u * (corner(facet, 1) - corner(facet, 0)) + v * (corner(facet, 2) - corner(facet, 0));
    if (p.z() < 0.0 || !scene.domain.contains(p)) continue;
    ++kind.places;
    found += is_near(state, NodeState::obstacle, p, 1) ? 1 : 0;
    apart += is_near(state, NodeState::seen, p, 3) ? 1 : 0;
  }
  kind.found = static_cast<double>(found) / std::max(kind.places, 1);
  kind.apart = static_cast<double>(apart) / std::max(kind.places, 1);
  return kind;
}

Image picture(const PaperPlace<3>& place, const SiteRun& ours) {
  const Camera camera = view_camera(place.scene(), place.scene().domain, {80.0, 18.0, 860, 560});
  Board board;
  board.title = "Fig. 6 again: the patio, close up";
  board.note =
      fmt::format("below: the border of what {} scans have seen, on a lattice of {:.2f} m", ours.map.stations.size(), ours.map.state.window.spacing);
  board.rows = {{"", {{on_plate(scene_picture(place.scene(), place.scene().domain, camera)), "the scene"}}},
                {"", {{on_plate(visibility_picture(ours.map.psi, ours.map.state, camera)), "coarse reconstruction from the visibility"}}}};
  board.legend = {{Key::Sign::area, kClay, "obstacle, wider than the thing by η", {}},
                  {Key::Sign::area, kUnseenColour, "shadow boundary that is left", {}}};
  return board_image(board);
}

}  // namespace

PaperItem paper_fig6(const PaperSetup& setup, Observer& observer) {
  const PaperSite site = patio_site("fig6", setup.quick);
  const PaperPlace<3> place(site.scene, site.settings, setup);
  const SiteRun ours = explore_site(site, place, observer);
  const Spread spread = to_truth(level_surface(ours.map.psi, ours.map.state), place.trial().truth());
  PaperItem item;
  item.json = site_json(site, place, {ours});
  item.json["surface_to_truth_m"] = {{"mean", spread.mean()}, {"p95", spread.quantile(0.95)}, {"max", spread.quantile(1.0)}};
  item.json["found"] = Json::array();
  std::vector<std::vector<std::string>> rows;
  for (const auto& [name, words] :
       {std::pair{"tree", "trees, trunk and crown"}, std::pair{"column", "columns and posts"}, std::pair{"furniture", "tables and benches"},
        std::pair{"wall", "low walls"}, std::pair{"house", "building, its rooms too"}}) {
    const Kind kind = found_of(place.scene(), name, ours.map.state);
    item.json["found"].push_back({{"kind", name}, {"share", kind.found}, {"apart", kind.apart}, {"places", kind.places}});
    rows.push_back({words, fmt::format("{:.1f} %", 100.0 * kind.found), fmt::format("{:.1f} %", 100.0 * kind.apart)});
  }
  item.text = fmt::format(
                  "Fig. 6, the patio rebuilt from the visibility alone (the border of what {} scans have seen; h = {:.2f} m, η = 0.4 m). From it to "
                  "the true surface:\n"
                  "mean {:.2f} m, 95 % within {:.2f} m, at most {:.2f} m. The paper: \"even at this resolution the visibility algorithm is able to "
                  "discern tree trunks,\n"
                  "columns and the tables\". Share of the true surface with an obstacle node\n"
                  "within h (found), and with seen space within 3 h (so that it stands apart):\n\n",
                  ours.map.stations.size(), ours.map.state.window.spacing, spread.mean(), spread.quantile(0.95), spread.quantile(1.0)) +
              markdown({"", "found", "stands apart"}, rows);
  if (setup.pictures) item.add_picture("fig6.png", picture(place, ours));
  item.add_texts("fig6");
  return item;
}

// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "paper_site.h"
#include "paper_views.h"
#include "vantage/report/solids.h"
#include "vantage/report/unseen_faces.h"

using namespace vantage;

namespace {

Image picture(const PaperPlace<3>& place, const SiteRun& ours) {
  const Box<3>& domain = place.scene().domain;
  const Camera camera = view_camera(place.scene(), domain, {66.0, 34.0, 455, 400});
  const SiteMap& map = ours.map;
  Board board;
  board.title = "Fig. 5 again: the patio";
  board.note = fmt::format("{} scans, {} of what can be seen; lattice {} x {} x {}, {:.2f} m; η = 0.4 m, 0.02 of the side", map.stations.size(),
                           fmt::format("{:.1f} %", 100.0 * ours.seen_after(std::ssize(map.stations))), map.state.window.extent.x(),
                           map.state.window.extent.y(), map.state.window.extent.z(), map.state.window.spacing);
  board.rows = {
      {"",
       {{on_plate(scene_picture(place.scene(), domain, camera)), "the scene"},
        {with_stations(visibility_picture(map.psi, map.state, camera), map.stations, camera), "integrated visibility: the border of what was seen"}}},
      {"",
       {{on_plate(points_picture(map.hits, domain, camera)),
         fmt::format("{} points, coloured by height", grouped(ours.points(std::ssize(map.stations), domain)))},
        {on_plate(patches_picture(map.patches, domain, camera)), fmt::format("coarse reconstruction: {} fits", grouped(map.surface.fits))}}}};
  board.legend = {{Key::Sign::pin, {}, "vantage point", {}},
                  {Key::Sign::area, kClay, "obstacle", {}},
                  {Key::Sign::area, kUnseenColour, "shadow boundary", {}},
                  {Key::Sign::ramp, {}, fmt::format("{:.0f} m", domain.high.z()), "height: 0", ColourMap::viridis, 0.2}};
  return board_image(board);
}

}  // namespace

PaperItem paper_fig5(const PaperSetup& setup, Observer& observer) {
  const PaperSite site = patio_site("fig5", setup.quick);
  const PaperPlace<3> place(site.scene, site.settings, setup);
  const std::vector<SiteRun> runs = explore_site_by_all(site, place, observer);
  const SiteRun& ours = runs[paper_formulas().size() - 1];
  PaperItem item;
  item.json = site_json(site, place, runs);
  item.json["surface"] = vantage::to_json(ours.map.surface);
  item.text = fmt::format(
                  "Fig. 5, the patio within 20 m, a 60^3 grid (h = {:.2f} m), η = 0.4 m (0.02 of the side), half-degree scans of 80 m. \"Scans in "
                  "all\": until the\n"
                  "planner stops by itself. Falsely seen: called seen though no reachable place sees it, after {} scans.\n\n",
                  ours.map.state.window.spacing, site.scans) +
              site_table(site, place, runs);
  if (setup.pictures) item.add_picture("fig5.png", picture(place, ours));
  item.add_texts("fig5");
  return item;
}

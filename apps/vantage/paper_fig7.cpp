// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "paper_site.h"
#include "paper_views.h"
#include "vantage/report/solids.h"
#include "vantage/report/unseen_faces.h"
#include "vantage/surface/surface.h"

using namespace vantage;

namespace {

constexpr double kEta = 0.004;  ///< In units of the cube (Table I).

/// Everything that was scanned, rebuilt, as the paper did as a post-process.
struct Rebuilt {
  Box<3> cube;
  SurfaceStatistics statistics;
  std::vector<Patch<3>> patches;
};

Rebuilt rebuilt(const std::vector<std::vector<Vec<3>>>& hits) {
  Box<3> box;
  for (const auto& scan : hits)
    for (const Vec<3>& p : scan) box.extend(p);
  const Vec<3> half = Vec<3>::Constant(0.5 * box.size().maxCoeff());
  Rebuilt result{{box.center() - half, box.center() + half}, {}, {}};
  HausdorffTree<3> tree(result.cube, {.eta = kEta * result.cube.size()[0]});
  for (const auto& scan : hits) tree.insert(scan);
  result.statistics = tree.statistics();
  result.patches = tree.patches();
  return result;
}

Image picture(const PaperPlace<3>& place, const SiteRun& ours, const Rebuilt& surface) {
  const Box<3>& domain = place.scene().domain;
  const Box<3> around = domain.grown(15.0).intersection(place.scene().mesh.bounds());
  const Camera near = view_camera(place.scene(), domain, {66.0, 36.0, 415, 420});
  const Camera far = view_camera(place.scene(), around, {66.0, 36.0, 2 * near.width() + 14, 900});
  Board board;
  board.title = "Fig. 7 again: church and houses";
  board.note = fmt::format("{} scans, {} points; visibility on a lattice of {:.2f} m within 50 m", ours.map.stations.size(),
                           grouped(surface.statistics.points), ours.map.state.window.spacing);
  board.rows = {
      {"",
       {{on_plate(scene_picture(place.scene(), domain, near)), "the scene"},
        {with_stations(visibility_picture(ours.map.psi, ours.map.state, near), ours.map.stations, near), "what was seen, and from where"}}},
      {"",
       {{on_plate(patches_picture(surface.patches, around, far)), fmt::format("rebuilt from all points, also those outside: {} fits, η = {:.2f} m",
                                                                              grouped(surface.statistics.fits), surface.statistics.eta)}}}};
  board.legend = {{Key::Sign::pin, {}, "vantage point", {}},
                  {Key::Sign::area, kClay, "obstacle, surface", {}},
                  {Key::Sign::area, kUnseenColour, "shadow boundary: beyond it nothing was seen", {}}};
  return board_image(board);
}

}  // namespace

PaperItem paper_fig7(const PaperSetup& setup, Observer& observer) {
  const PaperSite site = church_site("fig7", setup.quick);
  const PaperPlace<3> place(site.scene, site.settings, setup);
  const std::vector<SiteRun> runs = explore_site_by_all(site, place, observer);
  const SiteRun& ours = runs[paper_formulas().size() - 1];
  observer.stage("fig7: surface from all points");
  const Rebuilt surface = rebuilt(ours.map.hits);
  const SurfaceStatistics& s = surface.statistics;
  PaperItem item;
  item.json = site_json(site, place, runs);
  item.json["surface"] = vantage::to_json(s);
  item.text = fmt::format(
                  "Fig. 7, church and houses within 50 m, a 60^3 grid (h = {:.2f} m), η = 0.2 m (0.004 of the side), half-degree scans of 80 m. "
                  "Falsely seen: called\n"
                  "seen though no reachable place sees it, after {} scans.\n\n",
                  ours.map.state.window.spacing, site.scans) +
              site_table(site, place, runs) +
              fmt::format(
                  "\nRebuilt from all that ours scanned in {} scans, as the paper did: {} points (paper: {}), cube of {:.0f} m, η = {:.2f} m: {} "
                  "nodes, {} leaves, "
                  "{} fits\n(paper: 83,769, 73,298, 11,099), certified within {:.2f} m. `vantage paper table1` has the table.\n",
                  ours.map.stations.size(), grouped(s.points), grouped(site.points), surface.cube.size()[0], s.eta, grouped(s.nodes),
                  grouped(s.leaves), grouped(s.fits), s.certified());
  if (setup.pictures) item.add_picture("fig7.png", picture(place, ours, surface));
  item.add_texts("fig7");
  return item;
}

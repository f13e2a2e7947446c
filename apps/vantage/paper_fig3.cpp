// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "paper_views.h"
#include "vantage/geometry/angle.h"

using namespace vantage;

namespace {

constexpr std::int64_t kMostScans = 12;
constexpr int kSymmetries = 8;  ///< Mirrors of the three axes: what an even ring and the box have in common.
constexpr int kDraws = 400;

Vec<3> mirrored(const Vec<3>& p, const Vec<3>& centre, int symmetry) {
  Vec<3> q = p;
  for (int a = 0; a < 3; ++a)
    if ((symmetry >> a & 1) != 0) q[a] = 2.0 * centre[a] - p[a];
  return q;
}

/// How far the set is from its image: the mean distance from a mirrored place to the nearest of the set [m].
double defect(std::span<const Vec<3>> places, const Vec<3>& centre, int symmetry) {
  double sum = 0.0;
  for (const Vec<3>& p : places) {
    const Vec<3> image = mirrored(p, centre, symmetry);
    double nearest = kInfinity;
    for (const Vec<3>& q : places) nearest = std::min(nearest, (image - q).norm());
    sum += nearest;
  }
  return sum / static_cast<double>(places.size());
}

/// The symmetry that the places keep best, and how well.
struct Symmetry {
  int which = 1;
  double defect = kInfinity;  ///< [m]
};

Symmetry best_symmetry(std::span<const Vec<3>> places, const Vec<3>& centre) {
  Symmetry best;
  for (int s = 1; s < kSymmetries; ++s)
    if (const double d = defect(places, centre, s); d < best.defect) best = {s, d};
  return best;
}

std::string name_of(int symmetry) {
  std::string axes;
  for (int a = 0; a < 3; ++a)
    if ((symmetry >> a & 1) != 0) axes += "xyz"[a];
  return axes;
}

/// The same of places drawn at random, the first at the start: the mean of the best.
double chance(const PaperPlace<3>& place, std::size_t count, const Vec<3>& centre) {
  const std::vector<Vec<3>> pool = place.trial().starts(static_cast<std::int64_t>(count - 1) * kDraws, 1);
  double sum = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::vector<Vec<3>> places{place.scene().start};
    const auto first = pool.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(draw) * (count - 1));
    places.insert(places.end(), first, first + static_cast<std::ptrdiff_t>(count - 1));
    sum += best_symmetry(places, centre).defect;
  }
  return sum / kDraws;
}

/// One formula in one ring.
struct Result {
  PaperRun<3> run;
  std::vector<Vec<3>> places;  ///< Up to 99 %.
  Symmetry symmetry;
  double chance = 0.0;  ///< [m]
};

/// All formulas in a ring of so many cylinders.
struct Ring {
  int cylinders = 0;
  std::vector<Result> results;
};

Ring explored(const PaperPlace<3>& place, int cylinders, Observer& observer) {
  const Vec<3> centre = place.scene().domain.center();
  Ring ring{cylinders, {}};
  for (const PaperFormula& formula : paper_formulas()) {
    Result result;
    result.run =
        explore_place(place, formula.variant, {kMostScans, 0.99, fmt::format("fig3: {} cylinders, {}", cylinders, formula.variant.name)}, observer);
    result.places = stations_of(result.run);
    result.symmetry = best_symmetry(result.places, centre);
    result.chance = chance(place, result.places.size(), centre);
    ring.results.push_back(std::move(result));
  }
  return ring;
}

Image stations_view(const PaperPlace<3>& place, const Result& result, const Camera& camera) {
  return with_stations(scene_picture(place.scene(), place.scene().domain, camera), result.places, camera);
}

Image picture(const PaperPlace<3>& place, const Ring& ring) {
  const Box<3>& domain = place.scene().domain;
  const auto outline = corners(domain);
  const Camera above = Camera::map(domain, {300, 300, 14.0}), bird = Camera::bird(domain, outline, radians(66.0), radians(38.0), {300, 300, 4.0});
  Board board;
  board.title = fmt::format("Fig. 3 again: {} cylinders in a ring", ring.cylinders);
  board.note = "vantage points until 99 % is seen; 0 is the start, in the middle";
  board.rows = {{"bird's view", {}}, {fmt::format("from above, {:.0f} m x {:.0f} m", domain.size().x(), domain.size().y()), {}}};
  for (std::size_t f = 0; f < ring.results.size(); ++f) {
    board.rows[0].tiles.push_back({stations_view(place, ring.results[f], bird), {}});
    board.rows[1].tiles.push_back({stations_view(place, ring.results[f], above), paper_formulas()[f].label});
  }
  board.legend = {{Key::Sign::pin, {}, "vantage point with the number of its scan", {}}, {Key::Sign::area, {128, 158, 190}, "cylinder", {}}};
  return board_image(board);
}

Json to_json(const Ring& ring, std::size_t f) {
  const Result& result = ring.results[f];
  Json json{{"cylinders", ring.cylinders},
            {"formula", paper_formulas()[f].variant.name},
            {"label", paper_formulas()[f].label},
            {"n99", count_json(result.run.scans_to(0.99))},
            {"coverage", result.run.coverage},
            {"symmetry", {{"mirrors", name_of(result.symmetry.which)}, {"defect_m", result.symmetry.defect}, {"chance_m", result.chance}}},
            {"vantage", Json::array()}};
  for (const Vec<3>& p : result.places) json["vantage"].push_back(vantage::to_json<3>(p));
  return json;
}

std::string table(const std::vector<Ring>& rings) {
  std::vector<std::string> header{"E"};
  for (const Ring& ring : rings) header.push_back(fmt::format("{} cylinders", ring.cylinders));
  std::vector<std::vector<std::string>> rows;
  for (std::size_t f = 0; f < paper_formulas().size(); ++f) {
    std::vector<std::string> row{paper_formulas()[f].label};
    for (const Ring& ring : rings) {
      const Result& r = ring.results[f];
      row.push_back(fmt::format("{}; {:.1f} m ({:.1f} m)", count_text(r.run.scans_to(0.99)), r.symmetry.defect, r.chance));
    }
    rows.push_back(row);
  }
  return "Fig. 3, upright cylinders in a ring (`pipes:symmetric=1`), start in the middle: scans to 99 %; then asymmetry, how far on average a "
         "vantage point's mirror\n"
         "image is from the nearest vantage point, by the mirrors that fit best; in brackets the same of places drawn at random. The paper has no "
         "number: \"notice\n"
         "also the symmetry of the planned vantage point locations\".\n\n" +
         markdown(header, rows);
}

}  // namespace

PaperItem paper_fig3(const PaperSetup& setup, Observer& observer) {
  constexpr std::array<int, 4> kRings{4, 6, 8, 12};
  PaperItem item;
  item.json = {{"figure", "fig3"}, {"scene", "pipes:symmetric=1"}, {"paper", Json::object()}, {"rows", Json::array()}};
  std::vector<Ring> rings;
  for (const int cylinders : std::span(kRings).first(setup.quick ? 1 : kRings.size())) {
    const std::string scene = fmt::format("pipes:cylinders={},symmetric=1", cylinders);
    const PaperPlace<3> place(scene, {{"explore.grid", setup.quick ? "30" : "60", ""}, {"scene.start", "10,10,5", ""}}, setup);
    rings.push_back(explored(place, cylinders, observer));
    for (std::size_t f = 0; f < paper_formulas().size(); ++f) item.json["rows"].push_back(to_json(rings.back(), f));
    if (setup.pictures && cylinders == kRings[0]) item.add_picture("fig3.png", picture(place, rings.back()));
  }
  item.text = table(rings);
  item.add_texts("fig3");
  return item;
}

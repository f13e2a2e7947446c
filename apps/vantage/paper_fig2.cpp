// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "paper_run.h"
#include "vantage/report/board.h"
#include "vantage/report/maps.h"
#include "vantage/report/plot.h"

using namespace vantage;

namespace {

constexpr std::int64_t kMostScans = 20;
constexpr std::size_t kColumns = 5;
constexpr PictureFrame kPanel{276, 276, 9.0};
constexpr Rgb kOutline{29, 95, 214};
constexpr double kDarkest = 0.16;  ///< Of the colours of E.

/// A state of the run in the picture.
struct Moment {
  Snapshot<2> snapshot;
  std::vector<Patch<2>> surface;
};

std::vector<Vec<2>> on_map(std::span<const Vec<2>> places, const Camera& camera) {
  std::vector<Vec<3>> flat;
  for (const Vec<2>& p : places) flat.emplace_back(p.x(), p.y(), 0.0);
  return on_canvas(flat, camera);
}

/// On white, with a line around the domain and the marks.
Image marked(const Image& image, const Snapshot<2>& snapshot, const Camera& camera) {
  Canvas canvas(image.width, image.height, {255, 255, 255});
  canvas.lay(image, 0, 0);
  const double left = 9.0, right = camera.width() - 9.0, top = 9.0, bottom = camera.height() - 9.0;
  canvas.stroke(std::array<Vec<2>, 5>{Vec<2>(left, top), Vec<2>(right, top), Vec<2>(right, bottom), Vec<2>(left, bottom), Vec<2>(left, top)}, 1.0,
                kSoftInk);
  for (const Vec<2>& p : on_map(snapshot.vantage, camera)) draw_diamond(canvas, p, 7.0);
  const std::array<Vec<2>, 1> next{snapshot.next};
  if (snapshot.has_next) draw_cross(canvas, on_map(next, camera)[0], 8.0);
  return canvas.image();
}

/// Upper row: the obstacles' outlines as far as they are known.
Image known_panel(const Moment& moment) {
  const Camera camera = Camera::map(map_box(moment.snapshot.state.window), kPanel);
  StateColours colours = kLightStates;
  colours.obstacle = mix(colours.obstacle, colours.seen, 0.7);
  Canvas canvas(state_map(moment.snapshot.state, camera, colours));
  for (const Patch<2>& patch : moment.surface) canvas.stroke(on_map(patch.corners(), camera), 2.4, kOutline);
  return marked(canvas.image(), moment.snapshot, camera);
}

/// Lower row: E.
Image metric_panel(const Moment& moment) {
  const Camera camera = Camera::map(map_box(moment.snapshot.state.window), kPanel);
  Image image = state_map(moment.snapshot.state, camera, kDarkStates);
  lay_over(image, metric_map(moment.snapshot.metric, moment.snapshot.state, camera));
  return marked(image, moment.snapshot, camera);
}

Image steps_picture(const PaperFormula& formula, const PaperRun<2>& run, const std::vector<Moment>& moments) {
  Board board;
  board.title = "Fig. 2 again: " + formula.label;
  board.note = fmt::format("99 % of what can be seen after {} scans", count_text(run.scans_to(0.99)));
  if (!run.scans_to(0.99)) board.note = fmt::format("{:.1f} % of what can be seen after {} scans", 100.0 * run.coverage.back(), run.coverage.size());
  board.rows = {{"known", {}}, {"E", {}}};
  // The first ones, and the last.
  for (std::size_t k = 0; k < std::min(kColumns, moments.size()); ++k) {
    const bool last = k + 1 == kColumns;
    const Moment& moment = last ? moments.back() : moments[k];
    const auto scan = static_cast<std::size_t>(moment.snapshot.step);
    board.rows[0].tiles.push_back({known_panel(moment), {}});
    board.rows[1].tiles.push_back(
        {metric_panel(moment), fmt::format("{} scan{}: {:.1f} % seen", scan + 1, scan == 0 ? "" : "s", 100.0 * run.coverage[scan])});
  }
  board.legend = {{Key::Sign::line, kOutline, "outline rebuilt from the scans", {}},
                  {Key::Sign::diamond, {}, "vantage points", {}},
                  {Key::Sign::cross, {}, "arg max E: next", {}},
                  {Key::Sign::hatch, kLightStates.unseen, "unseen", {}},
                  {Key::Sign::ramp, {}, "largest", "E: 0", ColourMap::inferno, kDarkest}};
  return board_image(board);
}

/// What one formula does over all layouts.
struct Tally {
  std::vector<PaperRun<2>> runs;

  [[nodiscard]] std::int64_t reached(double share) const {
    return std::count_if(runs.begin(), runs.end(), [&](const auto& run) { return run.scans_to(share).has_value(); });
  }
  /// Mean number of scans; a run that never gets there counts as the most it may take.
  [[nodiscard]] double mean(double share) const {
    double sum = 0.0;
    for (const auto& run : runs) sum += static_cast<double>(run.scans_to(share).value_or(kMostScans));
    return sum / static_cast<double>(runs.size());
  }
  /// Mean share seen after so many scans.
  [[nodiscard]] double seen_after(std::size_t scans) const {
    double sum = 0.0;
    for (const auto& run : runs) sum += run.coverage[std::min(scans, run.coverage.size()) - 1];
    return sum / static_cast<double>(runs.size());
  }
};

Json to_json(const PaperFormula& formula, const Tally& tally) {
  Json json{{"formula", formula.variant.name},   {"label", formula.label},       {"layouts", tally.runs.size()},
            {"n95_mean", tally.mean(0.95)},      {"n99_mean", tally.mean(0.99)}, {"reached_95", tally.reached(0.95)},
            {"reached_99", tally.reached(0.99)}, {"coverage", Json::array()}};
  for (const auto& run : tally.runs) json["coverage"].push_back(run.coverage);
  return json;
}

Image coverage_picture(const std::vector<Tally>& tallies) {
  Board board;
  board.title = "Fig. 2 again: what is left after so many scans";
  board.note = fmt::format("mean over {} layouts of five blobs", tallies[0].runs.size());
  Plot plot{"", "scans", "not seen yet, of what can be seen [%]", true, 0.01, 100.0};
  for (std::size_t f = 0; f < tallies.size(); ++f) {
    PlotLine line{paper_formulas()[f].colour, PlotLine::Style::line, {}, {}};
    for (std::size_t scans = 1; scans <= 12; ++scans) {
      line.x.push_back(static_cast<double>(scans));
      line.y.push_back(std::max(100.0 * (1.0 - tallies[f].seen_after(scans)), 0.01));
    }
    plot.lines.push_back(std::move(line));
    board.legend.push_back({Key::Sign::line, paper_formulas()[f].colour, paper_formulas()[f].label, {}});
  }
  board.rows = {{"", {{plot_image(plot, 860, 440), {}}}}};
  return board_image(board);
}

std::string table(const std::vector<Tally>& tallies) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t f = 0; f < tallies.size(); ++f) {
    const Tally& tally = tallies[f];
    const auto reach = [&](double share) { return fmt::format("{:.1f} ({} of {})", tally.mean(share), tally.reached(share), tally.runs.size()); };
    rows.push_back({paper_formulas()[f].label, fmt::format("{:.1f} %", 100.0 * tally.seen_after(5)), reach(0.95), reach(0.99)});
  }
  return "Fig. 2, the step-by-step run in the plane (`planar`, 100 x 100 nodes, scans of 0.5 degrees). Mean scans over the layouts; in brackets the "
         "runs that got\n" +
         fmt::format("there, the others count as {}. The paper prints no number; its picture ends with the plane seen.\n\n", kMostScans) +
         markdown({"E", "seen after 5 scans", "scans to 95 %", "scans to 99 %"}, rows);
}

}  // namespace

PaperItem paper_fig2(const PaperSetup& setup, Observer& observer) {
  PaperItem item;
  std::vector<Tally> tallies(paper_formulas().size());
  const int layouts = setup.quick ? 1 : 10;
  for (int layout = 1; layout <= layouts; ++layout) {
    const PaperPlace<2> place(fmt::format("planar:seed={}", layout), {}, setup);
    for (std::size_t f = 0; f < tallies.size(); ++f) {
      const PaperFormula& formula = paper_formulas()[f];
      const bool drawn = layout == 1 && setup.pictures;
      std::vector<Moment> moments;
      std::function<void(const Explorer<2>&)> keep;
      if (drawn)
        keep = [&](const Explorer<2>& explorer) {
          const bool fresh = !explorer.snapshots().empty() && (moments.empty() || explorer.snapshots().back().step > moments.back().snapshot.step);
          if (fresh) moments.push_back({explorer.snapshots().back(), explorer.surface().patches()});
        };
      const PaperLimits limits{kMostScans, 2.0, fmt::format("fig2: layout {} of {}, {}", layout, layouts, formula.variant.name)};
      tallies[f].runs.push_back(explore_place(place, formula.variant, limits, observer, keep));
      if (drawn) item.add_picture(fmt::format("fig2-{}.png", formula.variant.name), steps_picture(formula, tallies[f].runs.back(), moments));
    }
  }
  item.json = {{"figure", "fig2"}, {"scene", "planar"}, {"paper", Json::object()}, {"rows", Json::array()}};
  for (std::size_t f = 0; f < tallies.size(); ++f) item.json["rows"].push_back(to_json(paper_formulas()[f], tallies[f]));
  item.text = table(tallies);
  if (setup.pictures) item.add_picture("fig2.png", coverage_picture(tallies));
  item.add_texts("fig2");
  return item;
}

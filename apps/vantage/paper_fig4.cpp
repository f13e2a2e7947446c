// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "paper_run.h"
#include "vantage/report/board.h"
#include "vantage/report/plot.h"

using namespace vantage;

namespace {

constexpr std::int64_t kMostScans = 16;
constexpr double kEnough = 0.99;

/// What one formula needs for so many cylinders.
struct Need {
  int cylinders = 0;
  std::vector<std::optional<std::int64_t>> scans;  ///< Per layout.

  [[nodiscard]] double mean() const {
    double sum = 0.0;
    for (const auto& n : scans) sum += static_cast<double>(n.value_or(kMostScans));
    return sum / static_cast<double>(scans.size());
  }
};

/// Least squares of y over x.
struct Line {
  double slope = 0.0, intercept = 0.0, r2 = 0.0;
};

Line fit(const std::vector<Need>& needs) {
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0, syy = 0.0;
  for (const Need& need : needs) {
    const double x = need.cylinders, y = need.mean();
    n += 1.0, sx += x, sy += y, sxx += x * x, sxy += x * y, syy += y * y;
  }
  const double vx = sxx - sx * sx / n, vy = syy - sy * sy / n, cov = sxy - sx * sy / n;
  Line line;
  line.slope = cov / vx;
  line.intercept = (sy - line.slope * sx) / n;
  line.r2 = vy > 0.0 ? cov * cov / (vx * vy) : 1.0;
  return line;
}

/// One formula over all scenes, and how its metric decays in the largest.
struct Series {
  std::vector<Need> needs;
  std::vector<double> decay;     ///< Largest metric after each scan over that after the first [1].
  std::vector<double> coverage;  ///< In that run [1].
  Line line;
};

/// max E, or for the default, whose terms are divided by their own maxima, the largest expected new volume.
double metric_of(const StepRecord<3>& step, const std::string& variant) { return variant == "default" ? step.expected_volume : step.next_score; }

std::vector<double> decay_of(const PaperRun<3>& run, const std::string& variant) {
  std::vector<double> values;
  for (const auto& step : run.steps) values.push_back(metric_of(step, variant) / metric_of(run.steps.front(), variant));
  return values;
}

Json to_json(const PaperFormula& formula, const Series& series) {
  Json json{{"formula", formula.variant.name},
            {"label", formula.label},
            {"slope", series.line.slope},
            {"intercept", series.line.intercept},
            {"r2", series.line.r2},
            {"scans", Json::array()},
            {"decay", series.decay},
            {"coverage", series.coverage}};
  for (const Need& need : series.needs) {
    Json row{{"cylinders", need.cylinders}, {"mean", need.mean()}, {"layouts", Json::array()}};
    for (const auto& scans : need.scans) row["layouts"].push_back(count_json(scans));
    json["scans"].push_back(row);
  }
  return json;
}

Tile decay_tile(const std::vector<Series>& all, int cylinders) {
  Plot plot{fmt::format("decay of the metric, {} cylinders", cylinders), "scans", "max E over its value after the first scan", true, 5e-4, 2.0};
  for (std::size_t f = 0; f < all.size(); ++f) {
    PlotLine line{paper_formulas()[f].colour, PlotLine::Style::line, {}, {}};
    for (std::size_t k = 0; k < std::min<std::size_t>(all[f].decay.size(), 16); ++k) {
      line.x.push_back(static_cast<double>(k + 1));
      line.y.push_back(all[f].decay[k]);
    }
    plot.lines.push_back(std::move(line));
  }
  return {plot_image(plot, 640, 460), {}};
}

Tile scans_tile(const std::vector<Series>& all) {
  Plot plot{"scans until 99 % is seen", "cylinders", "scans, mean over the layouts"};
  double most = 4.0;
  for (std::size_t f = 0; f < all.size(); ++f) {
    PlotLine dots{paper_formulas()[f].colour, PlotLine::Style::dots, {}, {}}, line{paper_formulas()[f].colour, PlotLine::Style::dashed, {}, {}};
    for (const Need& need : all[f].needs) {
      dots.x.push_back(need.cylinders);
      dots.y.push_back(need.mean());
      most = std::max(most, need.mean());
    }
    for (const double x : {dots.x.front(), dots.x.back()}) {
      line.x.push_back(x);
      line.y.push_back(all[f].line.intercept + all[f].line.slope * x);
    }
    plot.lines.push_back(std::move(line));
    plot.lines.push_back(std::move(dots));
  }
  plot.high = most;
  return {plot_image(plot, 640, 460), {}};
}

Image picture(const std::vector<Series>& all, int cylinders) {
  Board board;
  board.title = "Fig. 4 again: cylinders in open space";
  board.note =
      fmt::format("E of the default: the expected new volume. Runs that do not reach 99 % count as {} scans. Dashed: least squares", kMostScans);
  board.rows = {{"", {decay_tile(all, cylinders), scans_tile(all)}}};
  for (std::size_t f = 0; f < all.size(); ++f) {
    const auto& [variant, label, colour] = paper_formulas()[f];
    board.legend.push_back(
        {Key::Sign::line, colour, fmt::format("{}: {:.2f} scans a cylinder, R² {:.2f}", label, all[f].line.slope, all[f].line.r2), {}});
  }
  return board_image(board);
}

std::string table(const std::vector<Series>& all, std::size_t layouts) {
  std::vector<std::string> header{"E"};
  for (const Need& need : all[0].needs) header.push_back(std::to_string(need.cylinders));
  for (const char* name : {"scans a cylinder", "R²", "E after 5 scans / E after 1"}) header.emplace_back(name);
  std::vector<std::vector<std::string>> rows;
  for (std::size_t f = 0; f < all.size(); ++f) {
    std::vector<std::string> row{paper_formulas()[f].label};
    for (const Need& need : all[f].needs) row.push_back(fmt::format("{:.1f}", need.mean()));
    row.push_back(fmt::format("{:.2f}", all[f].line.slope));
    row.push_back(fmt::format("{:.2f}", all[f].line.r2));
    row.push_back(fmt::format("{:.3f}", all[f].decay[std::min<std::size_t>(4, all[f].decay.size() - 1)]));
    rows.push_back(row);
  }
  return fmt::format(
             "Fig. 4, cylinders in open space (`pipes`). Scans until 99 % of what can be seen is seen, by the number of cylinders, mean of {} "
             "layout{}; runs\n"
             "that do not get there count as {}. The paper prints no slope: \"the number of vantage points needed seem to grow linearly\".\n\n",
             layouts, layouts == 1 ? "" : "s", kMostScans) +
         markdown(header, rows);
}

}  // namespace

PaperItem paper_fig4(const PaperSetup& setup, Observer& observer) {
  const int most = setup.quick ? 3 : 12, layouts = setup.quick ? 1 : 3;
  std::vector<Series> all(paper_formulas().size());
  for (Series& series : all)
    for (int n = 1; n <= most; ++n) series.needs.push_back({n, {}});
  for (int layout = 1; layout <= layouts; ++layout) {
    for (int n = most; n >= 1; --n) {
      const PaperPlace<3> place(fmt::format("pipes:cylinders={},seed={}", n, layout), {{"explore.grid", setup.quick ? "30" : "60", ""}}, setup);
      const bool decays = n == most && layout == 1;
      for (std::size_t f = 0; f < all.size(); ++f) {
        const Variant& variant = paper_formulas()[f].variant;
        const PaperLimits limits{kMostScans, decays ? 2.0 : kEnough,
                                 fmt::format("fig4: layout {} of {}, {} cylinders, {}", layout, layouts, n, variant.name)};
        const PaperRun<3> run = explore_place(place, variant, limits, observer);
        all[f].needs[static_cast<std::size_t>(n - 1)].scans.push_back(run.scans_to(kEnough));
        if (!decays) continue;
        all[f].decay = decay_of(run, variant.name);
        all[f].coverage = run.coverage;
      }
    }
  }
  PaperItem item;
  item.json = {{"figure", "fig4"}, {"scene", "pipes"}, {"paper", {{"growth", "linear"}}}, {"rows", Json::array()}};
  for (std::size_t f = 0; f < all.size(); ++f) {
    all[f].line = fit(all[f].needs);
    item.json["rows"].push_back(to_json(paper_formulas()[f], all[f]));
  }
  item.text = table(all, static_cast<std::size_t>(layouts));
  if (setup.pictures) item.add_picture("fig4.png", picture(all, most));
  item.add_texts("fig4");
  return item;
}

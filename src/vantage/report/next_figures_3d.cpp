// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "vantage/field/distance.h"
#include "vantage/planner/regions.h"
#include "vantage/report/maps.h"
#include "vantage/report/overlay.h"
#include "vantage/report/pictures_3d.h"
#include "vantage/report/solids.h"
#include "vantage/report/text.h"
#include "vantage/report/unseen_faces.h"

namespace vantage {

namespace {

constexpr double kNameGap = 22.0;  ///< Between names of unseen regions; of two nearer ones the larger keeps its own [pixels].

constexpr double kLetter = 8.0;  ///< Width of one of them, at most [pixels].
constexpr double kReach = 0.5;   ///< Of a zone beyond what was met, as a share of its longest side: what lies farther off is cut.

/// A region's name stands where it is.
struct Named {
  Vec<3> place;
  std::string text;
};

/// How deep the nodes of the layer at the height of the cut lie in the unseen and in the picture [m].
Field<2> depth_in_layer(const Field<3, NodeState>& state, std::int32_t layer) {
  const Grid<3>& grid = state.window;
  Field<2, std::uint8_t> known(Grid<2>{grid.spacing, grid.first.head<2>(), grid.extent.head<2>()});
  for (std::size_t i = 0; i < known.values.size(); ++i) {
    Index<3> node;
    node << known.window.local(i), layer;
    const bool border = (node.array().head<2>() == 0).any() || (node.array().head<2>() + 1 == grid.extent.array().head<2>()).any();
    known[i] = border || state.at(node) != NodeState::unseen;
  }
  return distance_to_set(known);
}

/// Of every unseen region, by its number, the node that lies deepest in it at the height of the cut, where its hatching is broadest; if it does not
/// reach there, that nearest to its middle.
std::vector<Vec<3>> middles_of(const Field<3, NodeState>& state, const Regions<3>& regions, double cut, std::vector<Box<3>>& boxes) {
  std::vector<Vec<3>> middle(regions.count(), Vec<3>::Zero()), best = middle;
  std::vector<double> count(regions.count()), least(regions.count(), kInfinity);
  boxes.assign(regions.count(), {});
  const auto for_nodes = [&](const auto& body) {
    for (std::size_t r = 0; r < regions.rows(); ++r)
      for (const auto& run : regions.row(r))
        for (std::uint32_t k = run.begin; k < run.end; ++k)
          body(static_cast<std::size_t>(run.region), state.window.position(r * regions.row_length() + k));
  };
  for_nodes([&](std::size_t id, const Vec<3>& p) {
    middle[id] += p;
    count[id] += 1.0;
    boxes[id].extend(p);
  });
  for (std::size_t id = 0; id < middle.size(); ++id) middle[id] /= count[id];
  const Grid<3>& grid = state.window;
  const std::int32_t layer = std::clamp(grid.nearest(Vec<3>(0.0, 0.0, cut)).z(), 0, grid.extent.z() - 1);
  const Field<2> depth = depth_in_layer(state, layer);
  for_nodes([&](std::size_t id, const Vec<3>& p) {
    const Index<3> node = grid.nearest(p);
    const double rank = node.z() == layer ? -static_cast<double>(depth.at(node.head<2>())) : (p - middle[id]).norm();
    if (rank < least[id]) least[id] = rank, best[id] = p;
  });
  return best;
}

/// The largest unseen regions with their numbers in the table and why they are unseen.
std::vector<Named> named_regions(const ReportInput<3>& input, double cut) {
  std::vector<Named> names;
  if (input.state.window.size() == 0 || input.verdict.unseen.empty()) return names;
  const Regions<3> regions(input.state.window, [&](std::size_t first, std::span<std::uint8_t> row) {
    for (std::size_t k = 0; k < row.size(); ++k) row[k] = input.state[first + k] == NodeState::unseen;
  });
  std::vector<Box<3>> boxes;
  const std::vector<Vec<3>> middles = middles_of(input.state, regions, cut, boxes);
  const double h = input.state.window.spacing;
  for (std::size_t k = 0; k < std::min(kTaggedRegions, input.verdict.unseen.size()); ++k) {
    const UnseenRegion<3>& region = input.verdict.unseen[k];
    const auto same = [&](const Box<3>& box) {
      return (box.grown(0.5 * h).low - region.box.low).norm() + (box.grown(0.5 * h).high - region.box.high).norm() < 0.5 * h;
    };
    const auto found = std::find_if(boxes.begin(), boxes.end(), same);
    const Vec<3> place = found != boxes.end() ? middles[static_cast<std::size_t>(found - boxes.begin())] : region.box.center();
    names.push_back({place, fmt::format("unseen {}: {}", k + 1, region.reason)});
  }
  return names;
}

std::string names_overlay(const std::vector<Named>& names, const Camera& camera) {
  std::string texts;
  std::vector<Vec<2>> taken;
  for (const Named& name : names)
    for (Vec<2> p : on_picture<3>(std::vector<Vec<3>>{name.place}, camera)) {
      // Inside of the picture with all of its letters; what lies outside of the picture is named at the edge.
      const double half = 6.0 + 0.5 * kLetter * static_cast<double>(name.text.size());
      p.x() = std::clamp(p.x(), half, std::max(half, camera.width() - half));
      p.y() = std::clamp(p.y(), kNameGap, std::max(kNameGap, camera.height() - 0.5 * kNameGap));
      if (std::any_of(taken.begin(), taken.end(),
                      [&](const Vec<2>& q) { return std::abs(q.y() - p.y()) < kNameGap && std::abs(q.x() - p.x()) < 200.0; }))
        continue;
      taken.push_back(p);
      texts += fmt::format(R"(<text class="unseen" x="{:.1f}" y="{:.1f}">{}</text>)", p.x(), p.y(), escaped(name.text));
    }
  return texts;
}

std::string outline_path(const std::vector<Vec<2>>& ring, double z, const Camera& camera) {
  std::vector<Vec<3>> corners;
  for (const Vec<2>& p : ring) corners.emplace_back(p.x(), p.y(), z);
  const std::vector<Vec<2>> pixels = on_picture<3>(corners, camera);
  std::string d;
  if (pixels.size() == ring.size())  // None behind the lens.
    for (const Vec<2>& p : pixels) d += fmt::format("{}{:.1f} {:.1f}", d.empty() ? "M" : "L", p.x(), p.y());
  return d.empty() ? d : d + "Z";
}

/// Zones as areas at their foot, or in space as the walls between foot and top too.
std::string zones_overlay(const std::vector<Zone>& zones, const char* kind, const Box<3>& box, const Camera& camera, bool in_plan) {
  std::string all;
  for (const Zone& zone : zones) {
    const double low = std::max(zone.low, box.low.z()), high = std::min(zone.high, box.high.z());
    std::string foot, sides;
    for (const auto& ring : zone.rings) {
      foot += outline_path(ring, low, camera);
      if (in_plan || high <= low) continue;
      sides += outline_path(ring, high, camera);
      for (const Vec<2>& p : ring) {
        const std::vector<Vec<2>> ends = on_picture<3>(std::vector<Vec<3>>{{p.x(), p.y(), low}, {p.x(), p.y(), high}}, camera);
        if (ends.size() == 2) sides += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", ends[0].x(), ends[0].y(), ends[1].x(), ends[1].y());
      }
    }
    if (!foot.empty()) all += fmt::format(R"(<path class="zone {}" d="{}"/>)", kind, foot);
    if (!sides.empty()) all += fmt::format(R"(<path class="zone sides {}" d="{}"/>)", kind, sides);
  }
  return all;
}

std::string tour_overlay(std::span<const Vec<2>> path) {
  std::string d;
  for (const Vec<2>& p : path) d += fmt::format("{}{:.1f} {:.1f}", d.empty() ? "M" : "L", p.x(), p.y());
  return d.empty() ? d : fmt::format(R"(<path class="way casing" d="{0}"/><path class="way tour" d="{0}"/>)", d);
}

/// Scans so far, zones, the tour, the way to the best place, and all places with their ranks.
std::string plan_overlay(const ReportInput<3>& input, const Box<3>& box, const Camera& camera, bool in_plan) {
  std::vector<Vec<3>> scans;
  std::vector<int> numbers;
  for (const StepRecord<3>& step : input.steps)
    if (camera.in_front(step.vantage)) scans.push_back(step.vantage), numbers.push_back(step.scan);
  std::string tags;
  for (std::size_t k = input.next.size(); k-- > 0;) {  // The best one on top.
    const std::vector<Vec<3>> place{input.next[k].position};
    for (const Vec<2>& pixel : on_picture<3>(place, camera)) tags += tag_overlay(pixel, fmt::format("{}", k + 1));
  }
  const std::string tour = input.plan.order.size() > 1 ? tour_overlay(on_picture<3>(input.plan.tour, camera)) : std::string();
  return zones_overlay(input.plan.must_see, "see", box, camera, in_plan) + zones_overlay(input.plan.keep_out, "out", box, camera, in_plan) + tour +
         path_overlay(on_picture<3>(input.next.front().path, camera)) + station_overlay(on_picture<3>(scans, camera), numbers) + tags;
}

std::string plan_legend(const ReportInput<3>& input) {
  std::string legend =
      legend_entry("rank", "", "place to scan from, by rank") + legend_entry("dot", "", "scan, by number") + legend_entry("line", "", "way to 1");
  if (input.plan.order.size() > 1) legend += legend_entry("dashes", "", "tour past all of them");
  if (!input.plan.keep_out.empty()) legend += legend_entry("zone out", "", "kept out of");
  if (!input.plan.must_see.empty()) legend += legend_entry("zone see", "", "to be seen");
  return legend + legend_entry("hatch", css(kUnseenColour), "unseen");
}

/// Hatches what is unseen at the height of the cut.
void hatch_unseen(Image& image, const Field<3, NodeState>& state, const Camera& camera, double height) {
  if (state.window.size() == 0) return;
  parallel_for(static_cast<std::size_t>(image.height), 16, [&](std::size_t row) {
    for (int x = 0; x < image.width; ++x) {
      const int y = static_cast<int>(row);
      const Vec<2> p = camera.ground(x + 0.5, y + 0.5);
      const Index<3> node = state.window.nearest({p.x(), p.y(), height});
      const bool opaque = image.pixel(x, y)[3] > 0;
      if ((x + y) % 9 < (opaque ? 2 : 3) && state.window.inside(node) && state.at(node) == NodeState::unseen) image.set(x, y, kUnseenColour);
    }
  });
}

std::string tour_text(const ReportInput<3>& input) {
  if (input.plan.order.size() < 2) return {};
  std::string order;
  double length = 0.0;
  for (const std::size_t k : input.plan.order) order += fmt::format("{}{}", order.empty() ? "" : ", ", k + 1);
  for (std::size_t i = 1; i < input.plan.tour.size(); ++i) length += (input.plan.tour[i] - input.plan.tour[i - 1]).norm();
  return fmt::format(" For several stations before the next question, the tour goes {}: {}.", order, quantity(length, "m"));
}

}  // namespace

std::vector<Box<3>> next_parts(const ReportInput<3>& input, const Box<3>& contents) {
  std::vector<Box<3>> parts;
  if (input.next.empty()) return parts;
  for (const RankedPlace<3>& place : input.next) parts.push_back({place.position, place.position});
  for (std::size_t k = 0; k < std::min(kTaggedRegions, input.verdict.unseen.size()); ++k) parts.push_back(input.verdict.unseen[k].box);
  const Box<3> reach = contents.grown(kReach * contents.size().maxCoeff());
  for (const std::vector<Zone>* zones : {&input.plan.keep_out, &input.plan.must_see})
    for (const Zone& zone : *zones) {
      const Box<2> flat = zone.bounds();
      const Box<3> whole{{flat.low.x(), flat.low.y(), std::max(zone.low, contents.low.z())},
                         {flat.high.x(), flat.high.y(), std::min(zone.high, contents.high.z())}};
      if (const Box<3> near = whole.intersection(reach); !near.empty()) parts.push_back(near);
    }
  return parts;
}

std::vector<Figure> next_figures(const ReportInput<3>& input, const Box<3>& box, const Camera& bird) {
  if (input.next.empty() || input.steps.empty()) return {};
  const Camera camera = Camera::map(box, map_frame(input.picture_width));
  const double cut = plan_height(input), floor = height_range(input).first;
  const std::vector<Named> names = named_regions(input, cut);
  Raster raster(camera);
  draw_plan(raster, input.patches, {input.domain, {floor - 1.0, floor}, Colours::clay}, {cut, 0.5 * input.state.window.spacing});
  const RankedPlace<3>& best = input.next.front();
  Figure plan{"next", "The next places on the map", {}, plan_legend(input) + legend_entry("line", css(kSection), "wall at the cut"), {}};
  plan.caption = fmt::format("1, at {}, is the best place: it would show about {} that no scan has seen.{} The plan is cut at a height of {}.",
                             place_text<3>(best.position), quantity(best.new_volume, "m³"), tour_text(input), height_text(cut));
  Image image = resolved(raster, {0.0});
  hatch_unseen(image, input.state, camera, cut);
  plan.panels.push_back({std::move(image),
                         plan_overlay(input, box, camera, true) + names_overlay(names, camera) +
                             scale_overlay(1.0 / camera.pixel_size(1.0), camera.width(), camera.height()),
                         "Plan of the place with the scans so far, the places to scan from next, the tour past them, and what is unseen.",
                         {}});

  Raster surfaces(bird), unseen(bird);
  draw_patches(surfaces, input.patches, {input.domain, height_range(input), Colours::clay});
  if (input.state.window.size() > 0) draw_unseen(unseen, input.state, false);
  Figure space{"next-space", "The next places in space", {}, plan_legend(input), {}};
  space.caption =
      "The same from above, with the border of the unseen, which shows through the surfaces; what lies above the seen is left out. Numbers of unseen "
      "regions are those of the table.";
  space.panels.push_back({unseen_image(surfaces, unseen),
                          plan_overlay(input, box, bird, false) + names_overlay(names, bird),
                          "Bird's view of the places to scan from next, the tour past them, and the unseen space.",
                          {}});
  std::vector<Figure> figures;
  figures.push_back(std::move(plan));
  figures.push_back(std::move(space));
  return figures;
}

}  // namespace vantage

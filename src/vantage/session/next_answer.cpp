// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/next_answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "vantage/base/error.h"
#include "vantage/session/next_notes.h"
#include "vantage/session/next_zones.h"
#include "vantage/survey/tour.h"

namespace vantage {
namespace {

template <int Dim>
Json ranked_json(const RankedPlace<Dim>& place) {
  return {{"vantage", to_json<Dim>(place.position)}, {"score", place.score},          {"new_volume_m3", place.new_volume},
          {"added_volume_m3", place.added_volume},   {"new_area_m2", place.new_area}, {"overlap", place.overlap},
          {"path_m", length_of<Dim>(place.path)},    {"mended_m2", place.mended}};
}

/// What was only seen too flat; null without a limit.
template <int Dim>
Json flat_json(const NextAnswer<Dim>& answer) {
  if (answer.limit >= 90.0) return {};
  Json regions = Json::array();
  for (const FlatRegion<Dim>& region : answer.flat.regions)
    regions.push_back({{"area_m2", region.area},
                       {"incidence_deg", degrees(region.incidence)},
                       {"box", {to_json<Dim>(region.box.low), to_json<Dim>(region.box.high)}}});
  return {{"limit_deg", answer.limit}, {"area_m2", answer.flat.area}, {"regions", regions}};
}

/// Ranks from 1 in the order of the walk.
template <int Dim>
Json tour_json(const NextTour<Dim>& tour) {
  Json order = Json::array(), path = Json::array();
  for (const std::size_t station : tour.order) order.push_back(station + 1);
  for (const Vec<Dim>& p : tour.path) path.push_back(to_json<Dim>(p));
  return {{"order", order}, {"path_m", tour.length}, {"path", path}};
}

}  // namespace

template <int Dim>
NextAnswer<Dim> next_answer(const Explorer<Dim>& explorer, const NextOptions& options, const std::function<Scan<Dim>(int)>& scan,
                            std::vector<std::string>& notes) {
  RankRequest<Dim> request;
  FlatSurface<Dim> flat;
  request.count = options.count;
  request.apart = options.apart > 0.0 ? options.apart : std::max(1.0, 4.0 * explorer.window().spacing);
  request.overlap = options.overlap;
  request.planned = places_of<Dim>(options.planned);
  request.among = places_of<Dim>(options.among);
  const std::vector<Zone> closed = zones_of<Dim>(options.keep_out, "--keep-out");
  const std::size_t left_out = std::erase_if(request.among, [&](const Vec<Dim>& p) {
    return std::any_of(closed.begin(), closed.end(), [&](const Zone& zone) { return zone.template contains<Dim>(p); });
  });
  require(request.among.size() + left_out == 0 || !request.among.empty(), "every place lies where --keep-out forbids it", "--among");
  if (left_out > 0) notes.push_back(fmt::format("{} of the places of --among lie where --keep-out forbids them.", left_out));
  if (options.incidence < 90.0) {
    Incidence<Dim> incidence(explorer.view());
    for (std::size_t k = 0; k < explorer.steps().size(); ++k) incidence.add(scan(static_cast<int>(k)));
    request.least_cosine = sin_cos(radians(options.incidence))[1];
    flat = incidence.flatter(request.least_cosine);
    request.mend = flat.pieces;
  }
  if (!request.among.empty() && options.apart == 0.0) request.apart = 0.0;  // Somebody else has spread them.
  NextAnswer<Dim> answer{explorer.rank(request), {}, explorer.verdict(), std::move(flat), options.incidence};
  std::vector<Vec<Dim>> stations;
  for (const RankedPlace<Dim>& place : answer.ranked) stations.push_back(place.position);
  answer.tour = tour_past<Dim>(explorer.reachable(), explorer.steps().back().vantage, stations);
  Verdict<Dim>& verdict = answer.verdict;
  if (!answer.ranked.empty()) {
    const char* unit = std::array{"m²", "m³"}[Dim - 2];
    if (!verdict.complete)
      verdict.reason = fmt::format("Unseen space remains: the best place would show about {} {}.", amount_text(answer.ranked[0].new_volume), unit);
    for (UnseenRegion<Dim>& region : verdict.unseen)
      if (region.reason == "below the threshold") region.reason = "not looked at yet";
  } else if (verdict.reason.starts_with("The limit") || verdict.reason.starts_with("The exploration")) {
    verdict.reason = "Unseen space remains, but no place is left that shows enough of it and has what was asked for.";
  }
  return answer;
}

template <int Dim>
NextPlan<Dim> next_plan(const NextAnswer<Dim>& answer, const NextOptions& options) {
  NextPlan<Dim> plan{answer.tour.order, answer.tour.path, {}, {}, answer.flat.regions, answer.flat.area};
  plan.keep_out = zones_of<Dim>(options.keep_out, "--keep-out");
  plan.must_see = zones_of<Dim>(options.must_see, "--must-see");
  return plan;
}

template <int Dim>
Json answer_json(const NextAnswer<Dim>& answer, const Explorer<Dim>& explorer) {
  Json ranked = Json::array(), path = Json::array();
  for (const RankedPlace<Dim>& place : answer.ranked) ranked.push_back(ranked_json(place));
  if (!answer.ranked.empty())
    for (const Vec<Dim>& p : answer.ranked[0].path) path.push_back(to_json<Dim>(p));
  const bool any = !answer.ranked.empty();
  return {{"vantage", any ? ranked[0]["vantage"] : Json()},
          {"score", any ? Json(answer.ranked[0].score) : Json()},
          {"ranked", ranked},
          {"unseen_m3", answer.verdict.unseen_volume},
          {"path", path},
          {"verdict", to_json(answer.verdict)},
          {"tour", tour_json(answer.tour)},
          {"flat", flat_json(answer)},
          {"dim", Dim},
          {"scans", explorer.steps().size()},
          {"seen_m3", explorer.steps().back().seen_volume},
          {"voxel_m", explorer.window().spacing}};
}

template <int Dim>
std::string next_csv(const NextAnswer<Dim>& answer) {
  std::string out = "rank,x,y,z,score,new_volume_m3,added_volume_m3,new_area_m2,overlap,path_m,mended_m2\n";
  int rank = 0;
  for (const RankedPlace<Dim>& p : answer.ranked) {
    Vec<3> at = Vec<3>::Zero();
    at.template head<Dim>() = p.position;
    out += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", ++rank, at[0], at[1], at[2], p.score, p.new_volume, p.added_volume, p.new_area,
                       p.overlap, length_of<Dim>(p.path), p.mended);
  }
  return out;
}

#define VANTAGE_INSTANTIATE(D)                                                                                                                  \
  template NextAnswer<D> next_answer<D>(const Explorer<D>&, const NextOptions&, const std::function<Scan<D>(int)>&, std::vector<std::string>&); \
  template NextPlan<D> next_plan<D>(const NextAnswer<D>&, const NextOptions&);                                                                  \
  template Json answer_json<D>(const NextAnswer<D>&, const Explorer<D>&);                                                                       \
  template std::string next_csv<D>(const NextAnswer<D>&);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage

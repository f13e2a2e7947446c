// SPDX-License-Identifier: Apache-2.0
#include "vantage/survey/survey.h"

#include <fmt/format.h>

#include <algorithm>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/cover/bound.h"
#include "vantage/survey/links.h"
#include "vantage/survey/tour.h"

namespace vantage {
namespace {

void enter(Observer* observer, const std::string& stage) {
  if (observer == nullptr) return;
  observer->stage(stage);
  if (observer->stop_requested()) throw Error(ErrorCode::interrupted, "stopped at " + stage);
}

template <int Dim>
Reference<Dim> reference_of(const Scene<Dim>& scene, const RayCaster<Dim>& truth, const SurveyOptions& options) {
  const ReferenceOptions reference{.voxel = 2.0 * options.voxel, .eta = scene.eta, .clearance = options.clearance, .range = options.range};
  return make_reference(truth, scene.domain, scene.start, reference);
}

/// The smallest of the choices found: greedy, and greedy by the prices of the bound, which are high where few candidates help; both searched on.
Choice few_stations(const CoverProblem& problem, CoverBound& bound, const SurveyOptions& options) {
  const std::int64_t work = options.effort * 1'000'000;
  const auto seed = static_cast<std::uint64_t>(options.seed);
  std::array<Choice, 2> found;
  found[0] = improved(problem, greedy_cover(problem));
  bound = cover_bound(problem, found[0].size());
  if (bound.candidates >= found[0].size()) return found[0];
  found[1] = improved(problem, greedy_cover(problem, bound.prices));
  parallel_for(found.size(), 1, [&](std::size_t k) { found[k] = weighted_search(problem, found[k], seed, work); });
  return found[found[1].size() < found[0].size() ? 1 : 0];
}

/// Shares of all demands seen at least once.
std::vector<double> greedy_curve(const CoverProblem& problem) {
  CoverProblem once = problem;
  std::fill(once.need.begin(), once.need.end(), 1U);
  std::vector<bool> seen(once.need.size());
  std::size_t count = 0;
  std::vector<double> curve;
  for (const std::size_t c : greedy_cover(once)) {
    for (const std::uint32_t i : once.sets[c])
      if (!seen[i]) seen[i] = true, ++count;
    curve.push_back(static_cast<double>(count) / static_cast<double>(seen.size()));
  }
  return curve;
}

/// Fills in what depends on the chosen stations.
template <int Dim>
class Assembler {
 public:
  Assembler(Survey<Dim>& survey, const SightLines<Dim>& lines, const Links& links) : survey_(survey), lines_(lines), links_(links) {}

  void add_stations(const Choice& order) {
    count_.assign(lines_.demands.size(), 0);
    for (std::size_t k = 0; k < order.size(); ++k) survey_.stations.push_back(station(order, k));
    std::size_t met = 0, thin = 0;
    for (std::size_t i = 0; i < count_.size(); ++i) {
      met += count_[i] >= lines_.problem.need[i] ? 1 : 0;
      thin += lines_.problem.need[i] < static_cast<std::uint32_t>(survey_.options.cover) ? 1 : 0;
    }
    const auto all = static_cast<double>(std::max<std::size_t>(count_.size(), 1));
    survey_.share = static_cast<double>(met) / all;
    survey_.thin = static_cast<double>(thin) / all;
    survey_.linked = links_.in_order(order);
    survey_.seen.assign(lines_.demands.begin(), lines_.demands.begin() + static_cast<std::ptrdiff_t>(lines_.walls));
    for (std::size_t i = 0; i < lines_.walls; ++i) survey_.times.push_back(static_cast<std::uint8_t>(std::min<std::uint32_t>(count_[i], 255)));
  }

 private:
  Station<Dim> station(const Choice& order, std::size_t k) {
    Station<Dim> station{lines_.candidates[order[k]]};
    for (const std::uint32_t i : lines_.problem.sets[order[k]]) {
      if (i < lines_.walls) station.sees += lines_.each, station.adds += count_[i] == 0 ? lines_.each : 0.0;
      ++count_[i];
    }
    for (std::size_t earlier = 0; earlier < k; ++earlier) {
      const double share = links_.overlap(order[earlier], order[k]);
      if (station.partner >= 0 && share <= station.overlap) continue;
      station.overlap = share;
      station.partner = static_cast<int>(earlier);
    }
    return station;
  }

  Survey<Dim>& survey_;
  const SightLines<Dim>& lines_;
  const Links& links_;
  std::vector<std::uint32_t> count_;
};

/// The order of the tour: the start is place 0 of the table and no station.
template <int Dim>
Choice ordered(const Choice& chosen, const SightLines<Dim>& lines, const Links& links, const Survey<Dim>& survey) {
  std::vector<Vec<Dim>> places{lines.ways.start};
  for (const std::size_t c : chosen) places.push_back(lines.candidates[c]);
  const auto stations = [&](const std::vector<std::size_t>& order) {
    Choice choice;
    for (std::size_t k = 1; k < order.size(); ++k) choice.push_back(chosen[order[k] - 1]);
    return choice;
  };
  const bool ruled = survey.options.overlap > 0.0;
  const Choice roots = ruled ? links.roots(chosen) : Choice();
  const OrderRule rule = [&](const std::vector<std::size_t>& order) {
    const Choice visits = stations(order);
    const bool begins = visits.empty() || roots.empty() || std::find(roots.begin(), roots.end(), visits[0]) != roots.end();
    return begins && links.in_order(visits);
  };
  return stations(tour(travel_table<Dim>(survey.reachable, places), survey.options.come_back, ruled ? rule : OrderRule()));
}

template <int Dim>
std::vector<std::vector<Vec<Dim>>> legs_through(const Survey<Dim>& survey, const Vec<Dim>& start) {
  std::vector<Vec<Dim>> stops{start};
  for (const auto& station : survey.stations) stops.push_back(station.place);
  if (survey.options.come_back) stops.push_back(start);
  std::vector<std::vector<Vec<Dim>>> legs(stops.size() - 1);
  parallel_for(legs.size(), 1, [&](std::size_t k) { legs[k] = way_between<Dim>(survey.reachable, stops[k], stops[k + 1]); });
  return legs;
}

/// x,y,z whatever the dimension.
template <int Dim>
std::string in_space(const Vec<Dim>& p) {
  Vec<3> q = Vec<3>::Zero();
  q.template head<Dim>() = p;
  return fmt::format("{},{},{}", q[0], q[1], q[2]);
}

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
double Survey<Dim>::length() const {
  double sum = 0.0;
  for (const auto& leg : legs) sum += length_of<Dim>(leg);
  return sum;
}

template <int Dim>
Survey<Dim> make_survey(const Scene<Dim>& scene, const SurveyOptions& options, Observer* observer) {
  check_options(options, "survey");
  Survey<Dim> survey;
  survey.options = options;
  enter(observer, "places");
  const RayCaster<Dim> truth(scene.mesh);
  const Reference<Dim> reference = reference_of(scene, truth, options);
  enter(observer, "lines of sight");
  const SightLines<Dim> lines = find_sight_lines(scene, truth, reference, options);
  enter(observer, "stations");
  CoverBound bound;
  const Links links(lines.problem, lines.walls, options.overlap);
  Choice chosen = few_stations(lines.problem, bound, options);
  if (options.overlap > 0.0) chosen = links.joined(std::move(chosen));
  if (options.overlap > 0.0 && links.connected(chosen))
    chosen = improved(lines.problem, std::move(chosen), [&](const Choice& choice) { return links.connected(choice); });
  survey.bound = bound.value;
  survey.at_least = static_cast<std::int64_t>(bound.candidates);
  survey.candidates = static_cast<std::int64_t>(lines.candidates.size());
  survey.demands = static_cast<std::int64_t>(lines.demands.size());
  survey.wall = lines.each * static_cast<double>(lines.walls);
  survey.greedy = greedy_curve(lines.problem);
  enter(observer, "tour");
  survey.reachable = lines.ways.nodes;
  Assembler<Dim>(survey, lines, links).add_stations(ordered(chosen, lines, links, survey));
  survey.legs = legs_through(survey, lines.ways.start);
  return survey;
}

template <int Dim>
std::string stations_as_csv(const Survey<Dim>& survey) {
  std::string out = "id,x,y,z,sees,adds,overlap,partner\n";
  for (std::size_t k = 0; k < survey.stations.size(); ++k) {
    const Station<Dim>& s = survey.stations[k];
    out += fmt::format("{},{},{},{},{},{}\n", k, in_space<Dim>(s.place), s.sees, s.adds, s.overlap, s.partner);
  }
  return out;
}

template <int Dim>
std::string path_as_csv(const Survey<Dim>& survey) {
  std::string out = "leg,x,y,z\n";
  for (std::size_t k = 0; k < survey.legs.size(); ++k)
    for (const Vec<Dim>& p : survey.legs[k]) out += fmt::format("{},{}\n", k, in_space<Dim>(p));
  return out;
}

#define VANTAGE_INSTANTIATE(D)                                                         \
  template struct Survey<D>;                                                           \
  template Survey<D> make_survey<D>(const Scene<D>&, const SurveyOptions&, Observer*); \
  template std::string stations_as_csv<D>(const Survey<D>&);                           \
  template std::string path_as_csv<D>(const Survey<D>&);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage

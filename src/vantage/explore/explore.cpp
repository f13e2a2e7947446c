// SPDX-License-Identifier: Apache-2.0
#include "vantage/explore/explore.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "vantage/base/error.h"
#include "vantage/belief/belief.h"
#include "vantage/field/distance.h"
#include "vantage/planner/planner.h"
#include "vantage/scan/fill.h"

namespace vantage {
namespace {

double length(std::span<const auto> path) {
  double sum = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) sum += (path[i] - path[i - 1]).norm();
  return sum;
}

/// Tells the observer which stage runs and takes its time.
class Stopwatch {
 public:
  Stopwatch(Observer* observer, std::map<std::string, double>& seconds) : observer_(observer), seconds_(seconds) {}
  template <class Work>
  auto operator()(const std::string& stage, Work&& work) {
    if (observer_ != nullptr) observer_->stage(stage);
    const auto begin = std::chrono::steady_clock::now();
    struct Stop {
      double& total;
      std::chrono::steady_clock::time_point begin;
      ~Stop() { total += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); }
    } stop{seconds_[stage], begin};
    return work();
  }

 private:
  Observer* observer_;
  std::map<std::string, double>& seconds_;
};

/// Kept for the pictures: the first few steps, then ever rarer.
bool worth_keeping(std::size_t scans) { return scans <= 4 || (scans & (scans - 1)) == 0; }

}  // namespace

void describe(ExploreOptions& o, const OptionVisitor& visit) {
  visit("voxel", o.voxel, "m", Range{1e-4, 1e3}, "lattice spacing h; doors should be three of them wide");
  visit("max_scans", o.max_scans, "scans", Range{1, 1e6}, "stop after so many, complete or not");
  visit("seed", o.seed, "", Range{0, 9e15}, "of everything random in the planner");
  visit("fill", o.fill, "know flat walls between the rays of a scan (for the belief, never for the surface)");
  visit("snapshots", o.snapshots, "keep cuts through belief and metric for the report");
}

template <int Dim>
  requires SpatialDim<Dim>
struct Explorer<Dim>::Impl {
  Sensor<Dim>& sensor;
  Observer* observer;
  ExploreOptions options;
  Box<Dim> domain;
  Grid<Dim> window;
  HausdorffTree<Dim> surface;
  Belief<Dim> belief;
  Vec<Dim> vantage_point;
  Decision<Dim> decision;
  std::optional<Planner<Dim>> planner;  // Made with the first scan, which tells the sensor's range.
  std::vector<StepRecord<Dim>> steps;
  std::vector<Snapshot<Dim>> snapshots;
  std::vector<Vec<Dim>> path, visited;
  Verdict<Dim> verdict;
  StationRule<Dim> rule;
  std::size_t travelled = 0;  // Corners of the path up to the last scan; the rest is the way to the proposed place.
  bool finished = false;

  static Grid<Dim> lattice(const Box<Dim>& domain, const Vec<Dim>& start, const ExploreOptions& options) {
    check_options(options, "explore");
    require(!domain.empty(), "explore.domain: is empty");
    require(domain.contains(start), fmt::format("start = {}: must lie in the domain {} .. {} [m]", text(start), text(domain.low), text(domain.high)));
    double nodes = 1.0;
    for (int a = 0; a < Dim; ++a) nodes *= std::max(1.0, domain.size()[a] / options.voxel);
    require_memory(nodes, 60.0, fmt::format("explore.voxel = {} m: the lattice of {:.3g} nodes", options.voxel, nodes));
    if (nodes > 2.0e9)
      throw Error(ErrorCode::memory, fmt::format("explore.voxel = {} m: the lattice of {:.3g} nodes exceeds 2e9", options.voxel, nodes));
    return window_over(domain, options.voxel);
  }

  static std::string text(const Vec<Dim>& p) {
    std::string out;
    for (int a = 0; a < Dim; ++a) out += fmt::format("{}{:.6g}", a > 0 ? "," : "", p[a]);
    return out;
  }

  Impl(Sensor<Dim>& s, const Box<Dim>& d, const Vec<Dim>& start, const ExploreOptions& o, Observer* watcher)
      : sensor(s),
        observer(watcher),
        options(o),
        domain(d),
        window(lattice(d, start, o)),
        surface(d, o.surface),
        belief(window, o.surface.eta, o.planner.clearance),
        vantage_point(start) {
    check_options(options.visibility, "visibility");
    check_options(options.planner, "planner");
  }

  /// The part of the lattice that a scan can change.
  Grid<Dim> window_of(const Scan<Dim>& scan) const {
    Box<Dim> reach;
    reach.extend(scan.origin);
    return intersection(window_over(reach.grown(scan.pattern.max_range), window.spacing), window);
  }

  const StepRecord<Dim>& step() {
    StepRecord<Dim> record;
    Stopwatch timed(observer, record.seconds);
    record.scan = static_cast<int>(steps.size());
    record.score = decision.score;
    record.path_length = length(std::span<const Vec<Dim>>(decision.path));
    const double seen_before = steps.empty() ? 0.0 : steps.back().seen_volume;
    const double eta = options.surface.eta;

    const Scan<Dim> scan = timed("scan", [&] { return sensor.scan(vantage_point, record.scan); });  // LIDAR(x_c)
    if (!steps.empty() && scan.origin != decision.position) {                                       // Taken elsewhere than proposed: straight there.
      path.resize(travelled);
      if (path.empty()) path.push_back(visited.back());
      path.push_back(scan.origin);
      record.path_length = (scan.origin - visited.back()).norm();
    }
    const Grid<Dim> near = window_of(scan);
    const SurfaceUpdate<Dim> update =
        timed("surface", [&] { return surface.insert(hit_points(scan), SurfaceSensor<Dim>{scan.origin, scan.pattern.step}); });  // Sec. IV-A
    std::vector<Patch<Dim>> patches;
    const SeenSet<Dim> seen = timed("visibility", [&] {  // Sec. IV-B: phi, its sign and its distance apart
      patches = surface.patches(near.bounds().grown(2.0 * near.spacing + eta));
      return seen_by<Dim>(patches, scan, near, eta, options.visibility);
    });
    timed("belief", [&] {  // psi <- max(psi, phi), redistance
      const std::vector<Vec<Dim>> walls = options.fill ? fill_between_rays(scan, 0.5 * window.spacing) : std::vector<Vec<Dim>>{};
      belief.unite(seen, distance_to_patches<Dim>(patches, near, belief.known_cap()), walls);
    });
    if (!planner) {
      planner.emplace(options.planner, scan.pattern.max_range, static_cast<std::uint64_t>(options.seed));
      planner->know_surface([this] { return surface.patches(); });
      planner->set_rule(rule);
    }
    record.seen_volume = belief.seen_volume();
    record.new_volume = std::max(0.0, record.seen_volume - seen_before);
    decision = timed("planner", [&] { return planner->choose(belief.view(), scan.origin, record.new_volume); });  // arg max E, Eq. (1)
    verdict = timed("verdict", [&] {
      planner->note(belief.view(), scan);
      return planner->assess(belief.view());
    });

    record.vantage = scan.origin;
    record.points = update.points;
    record.next_score = decision.score;
    record.expected_volume = decision.expected_volume;
    record.candidates = decision.candidates;
    record.seen_fraction = verdict.seen_fraction;
    visited.push_back(scan.origin);
    travelled = path.size();
    path.insert(path.end(), decision.found ? decision.path.begin() : decision.path.end(), decision.path.end());
    if (!decision.found && path.empty()) path.push_back(scan.origin);
    steps.push_back(record);
    finished = !decision.found || static_cast<std::int64_t>(steps.size()) >= options.max_scans;
    judge();
    if (options.snapshots && (finished || worth_keeping(steps.size()))) timed("snapshot", [&] { snapshots.push_back(snapshot()); });
    steps.back().seconds = record.seconds;
    vantage_point = decision.position;
    return steps.back();
  }

  void go_to(const Vec<Dim>& place) {
    const Index<Dim> node = window.nearest(place);
    const bool known = planner && window.inside(node) && planner->reachable().at(node) != 0 && window.position(node) == place;
    require(known && !finished, fmt::format("place {}: must be a node that can be reached", text(place)), "explore");
    const std::size_t target = window.linear(node);
    decision.position = place;
    decision.score = 0.0;
    for (const auto& [candidate, score] : decision.scored)
      if (candidate == target) decision.score = static_cast<double>(score);
    decision.path = planner->way_to(place);
    path.resize(travelled);
    path.insert(path.end(), decision.path.begin(), decision.path.end());
    vantage_point = place;
  }

  void judge() {
    using End = typename Decision<Dim>::End;
    constexpr double kComplete = 0.99;  // Of what can be seen, as estimated.
    verdict.end = decision.end;
    constexpr double kSure = 0.9;  // At least.
    const bool looked_through = decision.end == End::nothing_can_open || decision.end == End::below_threshold || decision.end == End::unreachable;
    verdict.complete = looked_through && verdict.seen_fraction >= kComplete && verdict.seen_low >= kSure;
    if (decision.end == End::none)
      for (UnseenRegion<Dim>& region : verdict.unseen)
        if (region.reason == "below the threshold") region.reason = "not looked at yet";
    switch (decision.end) {
      case End::nothing_can_open: verdict.reason = "No reachable place shows anything new."; break;
      case End::below_threshold:
        verdict.reason = fmt::format("The best place would show less than {:g} of the seen volume, twice in a row.", options.planner.stop_volume);
        break;
      case End::idle: verdict.reason = fmt::format("{} scans in a row showed nothing new.", options.planner.idle_limit); break;
      case End::unreachable:
        verdict.reason = verdict.complete
                             ? "No other place to scan from can be reached with the clearance asked for, and nothing more shows from those that can."
                             : "Unseen space remains, but no other place to scan from can be reached with the clearance asked for.";
        break;
      case End::none:
        verdict.reason = finished ? fmt::format("The limit of {} scans is reached.", options.max_scans) : "The exploration is not finished.";
        break;
    }
  }

  Snapshot<Dim> snapshot() const;
};

/// Horizontal cut at the height of the scanner; the metric on every few nodes of it.
template <int Dim>
  requires SpatialDim<Dim>
Snapshot<Dim> Explorer<Dim>::Impl::snapshot() const {
  constexpr std::size_t kPlaces = 4000;
  const BeliefView<Dim> view = belief.view();
  Snapshot<Dim> cut;
  cut.step = static_cast<int>(steps.size()) - 1;
  cut.vantage = visited;
  cut.next = decision.position;
  cut.has_next = decision.found;
  const Index<Dim> level = window.nearest(visited.back()).cwiseMax(0).cwiseMin((window.extent.array() - 1).matrix());
  cut.height = (Dim - 2) * window.position(level)[Dim - 1];
  Grid<2> plane{window.spacing, window.first.template head<2>(), window.extent.template head<2>()};
  cut.state = Field<2, NodeState>(plane);
  for (std::size_t i = 0; i < plane.size(); ++i) {
    Index<Dim> node = level;
    node.template head<2>() = plane.local(i);
    cut.state[i] = view.state.at(node);
  }
  if (!decision.found) return cut;
  std::int32_t stride = 1;
  while (plane.size() / static_cast<std::size_t>(stride * stride) > kPlaces) ++stride;
  Box<2> bounds = plane.bounds();
  cut.metric = Field<2, float>(window_over(bounds, plane.spacing * stride));
  std::vector<Vec<Dim>> places;
  for (std::size_t i = 0; i < cut.metric.values.size(); ++i) {
    Vec<Dim> p = window.position(level);
    p.template head<2>() = cut.metric.window.position(i);
    places.push_back(p);
  }
  const std::vector<double> values = planner->evaluate(view, places);
  for (std::size_t i = 0; i < values.size(); ++i) cut.metric[i] = static_cast<float>(values[i]);
  return cut;
}

template <int Dim>
  requires SpatialDim<Dim>
Explorer<Dim>::Explorer(Sensor<Dim>& sensor, const Box<Dim>& domain, const Vec<Dim>& start, const ExploreOptions& options, Observer* observer)
    : impl_(std::make_unique<Impl>(sensor, domain, start, options, observer)) {}

template <int Dim>
  requires SpatialDim<Dim>
Explorer<Dim>::~Explorer() = default;

template <int Dim>
  requires SpatialDim<Dim>
const StepRecord<Dim>& Explorer<Dim>::step() {
  return impl_->step();
}

template <int Dim>
  requires SpatialDim<Dim>
void Explorer<Dim>::go_to(const Vec<Dim>& place) {
  impl_->go_to(place);
}

template <int Dim>
  requires SpatialDim<Dim>
void Explorer<Dim>::set_rule(StationRule<Dim> rule) {
  impl_->rule = std::move(rule);
}

template <int Dim>
  requires SpatialDim<Dim>
std::vector<RankedPlace<Dim>> Explorer<Dim>::rank(const RankRequest<Dim>& request) const {
  return impl_->planner->rank(impl_->belief.view(), request);
}

template <int Dim>
  requires SpatialDim<Dim>
const Field<Dim, std::uint8_t>& Explorer<Dim>::reachable() const {
  return impl_->planner->reachable();
}

template <int Dim>
  requires SpatialDim<Dim>
BeliefView<Dim> Explorer<Dim>::view() const {
  return impl_->belief.view();
}

template <int Dim>
  requires SpatialDim<Dim>
bool Explorer<Dim>::finished() const {
  return impl_->finished;
}

template <int Dim>
  requires SpatialDim<Dim>
Verdict<Dim> Explorer<Dim>::verdict() const {
  return impl_->verdict;
}

template <int Dim>
  requires SpatialDim<Dim>
const Grid<Dim>& Explorer<Dim>::window() const {
  return impl_->window;
}

template <int Dim>
  requires SpatialDim<Dim>
const std::vector<StepRecord<Dim>>& Explorer<Dim>::steps() const {
  return impl_->steps;
}

template <int Dim>
  requires SpatialDim<Dim>
const std::vector<Snapshot<Dim>>& Explorer<Dim>::snapshots() const {
  return impl_->snapshots;
}

template <int Dim>
  requires SpatialDim<Dim>
const std::vector<Vec<Dim>>& Explorer<Dim>::path() const {
  return impl_->path;
}

template <int Dim>
  requires SpatialDim<Dim>
const HausdorffTree<Dim>& Explorer<Dim>::surface() const {
  return impl_->surface;
}

template <int Dim>
  requires SpatialDim<Dim>
Field<Dim, NodeState> Explorer<Dim>::states() const {
  return impl_->belief.view().state;
}

template <int Dim>
  requires SpatialDim<Dim>
Field<Dim> Explorer<Dim>::psi() const {
  return impl_->belief.view().psi;
}

template <int Dim>
  requires SpatialDim<Dim>
Field<Dim> Explorer<Dim>::metric() const {
  Field<Dim> field(impl_->window, std::numeric_limits<float>::quiet_NaN());
  for (const auto& [node, value] : impl_->decision.scored) field[node] = value;
  return field;
}

template class Explorer<2>;
template class Explorer<3>;

}  // namespace vantage

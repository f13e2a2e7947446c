// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/next_rule.h"

#include <algorithm>
#include <memory>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/planner/candidates.h"
#include "vantage/planner/ground.h"
#include "vantage/session/next_zones.h"

namespace vantage {
namespace {

constexpr double kGroundReach = 6.0;  // Of ground that says how high a scanner stood: below it a scanner sees nothing [m].
constexpr double kWorth = 10.0;       // Of what must be seen [1].

/// What face steps join to the node nearest to `from`.
template <int Dim>
Field<Dim, std::uint8_t> joined(const Field<Dim, std::uint8_t>& nodes, const Vec<Dim>& from) {
  const Grid<Dim>& grid = nodes.window;
  std::size_t first = grid.size();
  double nearest = kInfinity;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const double distance = nodes[i] != 0 ? (grid.position(i) - from).squaredNorm() : kInfinity;
    if (distance < nearest) nearest = distance, first = i;
  }
  Field<Dim, std::uint8_t> found(grid);
  if (first == grid.size()) return found;
  std::vector<std::size_t> queue{first};
  found[first] = 1;
  for (std::size_t k = 0; k < queue.size(); ++k)
    for (int side = 0; side < 2 * Dim; ++side) {
      Index<Dim> next = grid.local(queue[k]);
      next[side / 2] += side % 2 == 0 ? -1 : 1;
      if (!grid.inside(next) || nodes.at(next) == 0 || found.at(next) != 0) continue;
      found.at(next) = 1;
      queue.push_back(grid.linear(next));
    }
  return found;
}

void note_once(std::vector<std::string>& notes, const std::string& note) {
  if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
}

/// The rule while scans come: it learns from them how high the scanner stands.
template <int Dim>
class Rule {
 public:
  Rule(const NextOptions& options, double clearance, bool measured, std::vector<std::string>& notes)
      : options_(options), clearance_(clearance), closed_(zones_of<Dim>(options.keep_out, "--keep-out")), notes_(&notes) {
    using Stand = NextOptions::Stand;
    const bool asked = options.stand == Stand::ground || options.height > 0.0;
    ground_ = asked || (options.stand == Stand::scans && measured);
    must_ = asked;
  }
  [[nodiscard]] bool on_ground() const { return ground_; }

  Field<Dim, std::uint8_t> places(const BeliefView<Dim>& view, const Vec<Dim>& here) {
    scanned_.push_back(here);
    height_ = 0.0;
    if (ground_) return on_ground(view, here);
    return anywhere(view, here);
  }
  /// The scanner's height above the ground below a node, whatever the lattice.
  [[nodiscard]] Vec<Dim> stand(const BeliefView<Dim>& view, const Vec<Dim>& node) const {
    const double ground = height_ > 0.0 ? ground_below(view, node) : -kInfinity;
    Vec<Dim> place = node;
    if (ground > -kInfinity) place[Dim - 1] = ground + height_;
    return place;
  }

 private:
  Field<Dim, std::uint8_t> on_ground(const BeliefView<Dim>& view, const Vec<Dim>& here) {
    const double height = height_at(view);
    if (height < kInfinity) {
      const double slope = sin_cos(radians(options_.slope))[0] / sin_cos(radians(options_.slope))[1];
      const auto is_closed = [&](const Vec<Dim>& p) { return closed(p, view.window().spacing); };
      Field<Dim, std::uint8_t> nodes = walkable_nodes<Dim>(view, here, {height, clearance_, options_.step, slope}, is_closed);
      const bool any = std::find(nodes.values.begin(), nodes.values.end(), 1) != nodes.values.end();
      if (any || must_) {
        height_ = height;
        return nodes;
      }
    }
    require(!must_ || height < kInfinity, "no ground is seen below the scanner: --height says how high it stands");
    note_once(*notes_, "No ground to walk on was found near the last scan: places anywhere in the seen space.");
    return anywhere(view, here);
  }
  Field<Dim, std::uint8_t> anywhere(const BeliefView<Dim>& view, const Vec<Dim>& here) const {
    Field<Dim, std::uint8_t> nodes = reachable_nodes(view, here, clearance_);
    if (closed_.empty()) return nodes;
    parallel_for(nodes.values.size(), 1024, [&](std::size_t i) {
      if (nodes[i] != 0 && closed(nodes.window.position(i), nodes.window.spacing)) nodes[i] = 0;
    });
    return joined(nodes, here);
  }
  /// Whether the node's cell is kept out of: so no line through free cells enters a zone, however narrow it is.
  [[nodiscard]] bool closed(const Vec<Dim>& p, double spacing) const {
    const Box<Dim> cell = Box<Dim>{p, p}.grown(0.5 * spacing);
    return std::any_of(closed_.begin(), closed_.end(), [&](const Zone& zone) { return zone.template meets<Dim>(cell); });
  }
  /// As asked for, or the median of the scans so far, each above the ground as it is known now. What the lattice cannot tell from the first counts as
  /// that: a tripod keeps its height, and small errors of many stations do not add up.
  double height_at(const BeliefView<Dim>& view) const {
    if (options_.height > 0.0) return options_.height;
    std::vector<double> heights = heights_above_ground<Dim>(view, scanned_, kGroundReach);
    std::erase_if(heights, [](double height) { return !(height < kInfinity) || height <= 0.1; });
    if (heights.empty()) return kInfinity;
    for (double& height : heights)
      if (std::abs(height - heights[0]) <= 0.5 * view.window().spacing) height = heights[0];
    std::sort(heights.begin(), heights.end());
    return 0.5 * (heights[heights.size() / 2] + heights[(heights.size() - 1) / 2]);
  }

  NextOptions options_;
  double clearance_;
  std::vector<Zone> closed_;
  std::vector<std::string>* notes_;
  std::vector<Vec<Dim>> scanned_;
  double height_ = 0.0;  // That `places` were found for; 0: they are not on the ground.
  bool ground_ = false, must_ = false;
};

}  // namespace

template <int Dim>
StationRule<Dim> station_rule(const NextOptions& options, double clearance, bool measured, std::vector<std::string>& notes) {
  StationRule<Dim> result;
  const auto rule = std::make_shared<Rule<Dim>>(options, clearance, measured, notes);
  result.all = rule->on_ground();
  if (result.all || !options.keep_out.empty())
    result.places = [rule](const BeliefView<Dim>& view, const Vec<Dim>& here) { return rule->places(view, here); };
  if (result.all) result.stand = [rule](const BeliefView<Dim>& view, const Vec<Dim>& node) { return rule->stand(view, node); };
  if (!options.must_see.empty())
    result.worth = [zones = zones_of<Dim>(options.must_see, "--must-see")](const Vec<Dim>& p) {
      return std::any_of(zones.begin(), zones.end(), [&](const Zone& zone) { return zone.template contains<Dim>(p); }) ? kWorth : 1.0;
    };
  return result;
}

template StationRule<2> station_rule<2>(const NextOptions&, double, bool, std::vector<std::string>&);
template StationRule<3> station_rule<3>(const NextOptions&, double, bool, std::vector<std::string>&);

}  // namespace vantage

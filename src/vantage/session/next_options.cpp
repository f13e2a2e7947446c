// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/next_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "vantage/base/error.h"
#include "vantage/planner/candidates.h"
#include "vantage/planner/ground.h"
#include "vantage/session/suggest.h"

namespace vantage {
namespace {

constexpr double kGroundReach = 6.0;  // Of ground that says how high a scanner stood: below it a scanner sees nothing [m].

std::vector<double> parse_list(const Setting& setting) {
  std::vector<double> numbers;
  double number = 0.0;
  for (std::size_t begin = 0; begin <= setting.value.size() && !setting.value.empty();) {
    const std::size_t end = std::min(setting.value.find(',', begin), setting.value.size());
    Option{"number", &number, "", {}, ""}.parse(setting.value.substr(begin, end - begin), setting.name);
    require(std::isfinite(number), fmt::format("{} = {}: must be finite", setting.name, setting.value), setting.where);
    numbers.push_back(number);
    begin = end + 1;
  }
  return numbers;
}

std::vector<double>* list_of(NextOptions& options, std::string_view name) {
  if (name == "next.domain") return &options.domain;
  if (name == "next.keep_out") return &options.keep_out;
  if (name == "next.must_see") return &options.must_see;
  if (name == "next.among") return &options.among;
  return name == "next.planned" ? &options.planned : nullptr;
}

template <class Options>
void apply_to(Options& options, std::string_view stage, const Setting& setting) {
  std::vector<std::string> names;
  for (Option& option : list_options(options)) {
    names.push_back(fmt::format("{}.{}", stage, option.name));
    if (names.back() == setting.name) return option.parse(setting.value, setting.name);
  }
  require(false, fmt::format("{}: no such option{}", setting.name, did_you_mean(setting.name, names)), setting.where);
}

void apply_one(NextSetup& setup, const Setting& setting) {
  if (std::vector<double>* list = list_of(setup.next, setting.name)) {
    *list = parse_list(setting);
  } else if (setting.name.starts_with("next.")) {
    apply_to(setup.next, "next", setting);
  } else if (setting.name.starts_with("measured.")) {
    apply_to(setup.measured, "measured", setting);
  } else {
    require(!setting.name.starts_with("scene.") && !setting.name.starts_with("sensor."),
            fmt::format("{}: of simulated scans; those of files are set by measured.*", setting.name), setting.where);
    apply(setup.scenario, setting);
    setup.voxel_set = setup.voxel_set || setting.name == "explore.voxel" || setting.name == "explore.grid";
    setup.eta_set = setup.eta_set || setting.name == "surface.eta";
  }
}

template <int Dim>
std::vector<Box<Dim>> boxes_of(std::span<const double> numbers) {
  const std::vector<Vec<Dim>> corners = places_of<Dim>(numbers);
  std::vector<Box<Dim>> boxes;
  for (std::size_t k = 0; k + 1 < corners.size(); k += 2) boxes.push_back({corners[k], corners[k + 1]});
  return boxes;
}

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
      : options_(options), clearance_(clearance), boxes_(boxes_of<Dim>(options.keep_out)), notes_(&notes) {
    using Stand = NextOptions::Stand;
    const bool asked = options.stand == Stand::ground || options.height > 0.0;
    ground_ = asked || (options.stand == Stand::scans && measured);
    must_ = asked;
  }
  [[nodiscard]] bool on_ground() const { return ground_; }

  Field<Dim, std::uint8_t> operator()(const BeliefView<Dim>& view, const Vec<Dim>& here) {
    Field<Dim, std::uint8_t> nodes = ground_ ? on_ground(view, here) : reachable_nodes(view, here, clearance_);
    if (boxes_.empty()) return nodes;
    for (std::size_t i = 0; i < nodes.values.size(); ++i) {
      const Vec<Dim> p = nodes.window.position(i);
      if (std::any_of(boxes_.begin(), boxes_.end(), [&](const Box<Dim>& box) { return box.contains(p); })) nodes[i] = 0;
    }
    return joined(nodes, here);
  }

 private:
  Field<Dim, std::uint8_t> on_ground(const BeliefView<Dim>& view, const Vec<Dim>& here) {
    const double height = height_at(view, here);
    if (height < kInfinity) {
      const double slope = sin_cos(radians(options_.slope))[0] / sin_cos(radians(options_.slope))[1];
      Field<Dim, std::uint8_t> nodes = walkable_nodes<Dim>(view, here, {height, clearance_, options_.step, slope});
      const bool any = std::find(nodes.values.begin(), nodes.values.end(), 1) != nodes.values.end();
      if (any || must_) return nodes;
    }
    require(!must_ || height < kInfinity, "no ground is seen below the scanner: --height says how high it stands");
    note_once(*notes_, "No ground to walk on was found near the last scan: places anywhere in the seen space.");
    return reachable_nodes(view, here, clearance_);
  }
  /// As asked for, or the median of the scans so far.
  double height_at(const BeliefView<Dim>& view, const Vec<Dim>& here) {
    if (options_.height > 0.0) return options_.height;
    const double height = height_above_ground(view, here, kGroundReach);
    if (height < kInfinity && height > 0.1) heights_.push_back(height);
    if (heights_.empty()) return kInfinity;
    std::vector<double> sorted = heights_;
    std::sort(sorted.begin(), sorted.end());
    return sorted[sorted.size() / 2];
  }

  NextOptions options_;
  double clearance_;
  std::vector<Box<Dim>> boxes_;
  std::vector<std::string>* notes_;
  std::vector<double> heights_;
  bool ground_ = false, must_ = false;
};

}  // namespace

void describe(NextOptions& o, const OptionVisitor& visit) {
  visit("count", o.count, "places", Range{1, 100}, "places in the list");
  visit("stand", o.stand, Choices{"scans", "ground", "air"},
        "where the scanner stands: as the scans were taken (a person's: on the ground, if ground is found below), on walkable ground, anywhere");
  visit("height", o.height, "m", Range{0.0, 100.0}, "of the scanner above walkable ground; 0: as the scans were taken");
  visit("slope_deg", o.slope, "deg", Range{0.0, 80.0}, "steepest ground that is walked on");
  visit("step", o.step, "m", Range{0.0, 10.0}, "highest step that is walked over");
  visit("apart", o.apart, "m", Range{0.0, 1e4}, "least distance between places of the list; 0: four cells, 1 m at least");
  visit("overlap", o.overlap, "", Range{0.0, 1.0}, "least share of known surface in view, to register the scan by");
  visit("margin", o.margin, "m", Range{0.0, 1e4}, "of the domain around the points; 0: two cells");
}

NextSetup next_setup(std::span<const Setting> settings) {
  NextSetup setup;
  for (const Setting& setting : settings) {
    try {
      apply_one(setup, setting);
    } catch (const Error& error) {
      if (!error.where().empty()) throw;
      throw Error(error.code(), error.what(), setting.where);
    }
  }
  check_options(setup.next, "next");
  check_options(setup.measured, "measured");
  check_options(setup.scenario.explore.surface, "surface");
  check_options(setup.scenario.explore.planner, "planner");
  return setup;
}

std::string settings_as_toml(std::span<const Setting> settings) {
  std::map<std::string, std::map<std::string, std::string>> stages;
  for (const Setting& setting : settings) {
    const std::size_t dot = setting.name.find('.');
    const std::string stage = setting.name.substr(0, dot);
    if (stage != "measured") stages[stage][setting.name.substr(dot + 1)] = setting.value;
  }
  std::string out = "# What was asked of the next station; given again, an option replaces its line.\n";
  if (!stages.contains("next")) out += "\n[next]\n";
  for (const auto& [stage, values] : stages) {
    out += fmt::format("\n[{}]\n", stage);
    for (const auto& [name, value] : values) out += fmt::format("{} = \"{}\"\n", name, value);
  }
  return out;
}

template <int Dim>
StationRule<Dim> station_rule(const NextOptions& options, double clearance, bool measured, std::vector<std::string>& notes) {
  const auto rule = std::make_shared<Rule<Dim>>(options, clearance, measured, notes);
  if (!rule->on_ground() && options.keep_out.empty()) return {};
  return {[rule](const BeliefView<Dim>& view, const Vec<Dim>& here) { return (*rule)(view, here); }, rule->on_ground()};
}

template <int Dim>
std::vector<Vec<Dim>> places_of(std::span<const double> numbers) {
  std::vector<Vec<Dim>> places;
  for (std::size_t k = 0; k + Dim <= numbers.size(); k += Dim) places.push_back(Eigen::Map<const Vec<Dim>>(&numbers[k]));
  return places;
}

template <int Dim>
void check_lists(const NextOptions& options) {
  const auto check = [](const std::vector<double>& numbers, std::size_t each, const char* name) {
    require(numbers.size() % each == 0, fmt::format("{} numbers: {} each are wanted", numbers.size(), each), name);
    if (each == 2 * Dim)
      for (const Box<Dim>& box : boxes_of<Dim>(numbers)) require(!box.empty(), "the low corner must come first, then the high one", name);
  };
  check(options.domain, 2 * Dim, "--domain");
  require(options.domain.size() <= 2 * Dim, "one box", "--domain");
  check(options.keep_out, 2 * Dim, "--keep-out");
  check(options.must_see, 2 * Dim, "--must-see");
  check(options.among, Dim, "--among");
  check(options.planned, Dim, "--planned");
}

#define VANTAGE_INSTANTIATE(D)                                                                          \
  template StationRule<D> station_rule<D>(const NextOptions&, double, bool, std::vector<std::string>&); \
  template std::vector<Vec<D>> places_of<D>(std::span<const double>);                                   \
  template void check_lists<D>(const NextOptions&);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage

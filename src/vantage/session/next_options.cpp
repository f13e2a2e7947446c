// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/next_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "vantage/base/error.h"
#include "vantage/session/next_zones.h"
#include "vantage/session/suggest.h"

namespace vantage {
namespace {

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
  } else if (setting.name == "next.keep_out") {
    setup.next.keep_out = setting.value;
  } else if (setting.name == "next.must_see") {
    setup.next.must_see = setting.value;
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
  visit("incidence_deg", o.incidence, "deg", Range{1.0, 90.0},
        "largest angle between a ray and the normal of what it meets: flatter, nothing new counts, and known surface is to be seen again; 90: any");
  visit("moved", o.moved, Choices{"keep", "drop"},
        "points that another scan looks through and where no other scan met anything: people, cars, doors");
  visit("moved_gap", o.moved_gap, "m", Range{0.01, 100.0},
        "of moved points: so far from them is what other scans met, at least; more than poses are wrong by");
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
std::vector<Vec<Dim>> places_of(std::span<const double> numbers) {
  std::vector<Vec<Dim>> places;
  for (std::size_t k = 0; k + Dim <= numbers.size(); k += Dim) places.push_back(Eigen::Map<const Vec<Dim>>(&numbers[k]));
  return places;
}

template <int Dim>
void check_lists(const NextOptions& options) {
  const auto check = [](const std::vector<double>& numbers, std::size_t each, const char* name) {
    require(numbers.size() % each == 0, fmt::format("{} numbers: {} each are wanted", numbers.size(), each), name);
  };
  check(options.domain, 2 * Dim, "--domain");
  require(options.domain.size() <= 2 * Dim, "one box", "--domain");
  const std::vector<Vec<Dim>> corners = places_of<Dim>(options.domain);
  require(corners.empty() || !Box<Dim>{corners[0], corners[1]}.empty(), "the low corner must come first, then the high one", "--domain");
  check(options.among, Dim, "--among");
  check(options.planned, Dim, "--planned");
  static_cast<void>(zones_of<Dim>(options.keep_out, "--keep-out"));
  static_cast<void>(zones_of<Dim>(options.must_see, "--must-see"));
}

template <int Dim>
void require_met(const NextOptions& options, const Box<Dim>& domain, std::span<const Setting> settings) {
  const std::pair<const char*, const std::string&> lists[] = {{"next.keep_out", options.keep_out}, {"next.must_see", options.must_see}};
  for (const auto& [name, text] : lists) {
    const auto given = std::find_if(settings.begin(), settings.end(), [&](const Setting& setting) { return setting.name == name; });
    if (given == settings.end()) continue;
    for (const Zone& zone : zones_of<Dim>(text, given->where)) {
      const Vec<2> low = zone.bounds().low, high = zone.bounds().high;
      require(zone.template meets<Dim>(domain),
              fmt::format("the zone from {:g},{:g} to {:g},{:g} lies outside of the domain, {:g} .. {:g}", low.x(), low.y(), high.x(), high.y(),
                          fmt::join(domain.low.data(), domain.low.data() + Dim, ","), fmt::join(domain.high.data(), domain.high.data() + Dim, ",")),
              given->where);
    }
  }
}

#define VANTAGE_INSTANTIATE(D)                                                               \
  template void require_met<D>(const NextOptions&, const Box<D>&, std::span<const Setting>); \
  template std::vector<Vec<D>> places_of<D>(std::span<const double>);                        \
  template void check_lists<D>(const NextOptions&);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#include "vantage/world/scene.h"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <functional>
#include <map>

#include "vantage/base/error.h"
#include "vantage/world/generators.h"
#include "vantage/world/scene_file.h"

namespace vantage {
namespace {

/// Values of a scene's parameters by name; all are whole numbers.
using Values = std::map<std::string, std::int64_t, std::less<>>;

struct Generator {
  SceneInfo info;
  std::function<AnyScene(const Values&)> make;
};

int count_of(const Values& values, std::string_view name) { return static_cast<int>(values.find(name)->second); }
std::uint64_t seed_of(const Values& values) { return static_cast<std::uint64_t>(values.find("seed")->second); }

const std::vector<Generator>& generators() {
  const SceneInfo::Parameter seed{"seed", 1, 0, 4294967295.0, "which of the random layouts"};
  static const std::vector<Generator> all{
      {{"town", 3, "thirty buildings with interiors, a church, trees, cars, poles and wires, 200 x 150 m", {seed}},
       [](const Values& v) { return make_town(seed_of(v)); }},
      {{"patio", 3, "columns, tables, trees and the open edge of a building, 20 x 20 m (Figs. 5, 6)", {seed}},
       [](const Values& v) { return make_patio(seed_of(v)); }},
      {{"church", 3, "a church with tower and columns among houses, 50 x 50 m (Fig. 7)", {seed}},
       [](const Values& v) { return make_church(seed_of(v)); }},
      {{"pipes",
        3,
        "closed cylinders in open space, 20 x 20 x 10 m (Figs. 3, 4)",
        {{"cylinders", 6, 1, 24, "how many"}, {"symmetric", 0, 0, 1, "1: upright, evenly on a circle; 0: along random axes"}, seed}},
       [](const Values& v) { return make_pipes(count_of(v, "cylinders"), count_of(v, "symmetric") != 0, seed_of(v)); }},
      {{"wires",
        3,
        "wires, poles, a fence, a railing and a lattice tower, 40 x 30 m",
        {{"posts", 8, 1, 24, "guyed posts, each with a wire in a direction of its own"},
         {"diameter", 10, 4, 100, "of the thinnest wires [mm]"},
         seed}},
       [](const Values& v) { return make_wires(count_of(v, "posts"), 0.001 * count_of(v, "diameter"), seed_of(v)); }},
      {{"floor", 3, "one storey with corridors, doors and furniture, enclosed, 60 x 40 x 3 m", {{"rooms", 64, 12, 160, "at least so many"}, seed}},
       [](const Values& v) { return make_floor(count_of(v, "rooms"), seed_of(v)); }},
      {{"galleries",
        3,
        "a room-and-pillar mine with rough walls and dead ends, enclosed, 79 x 59 x 3 m",
        {{"columns", 6, 2, 12, "pillars along x"}, {"rows", 4, 2, 12, "pillars along y"}, seed}},
       [](const Values& v) { return make_galleries(count_of(v, "columns"), count_of(v, "rows"), seed_of(v)); }},
      {{"forest", 3, "trees, bushes and boulders on rolling ground, 48 x 36 m", {{"trees", 60, 1, 120, "how many"}, seed}},
       [](const Values& v) { return make_forest(count_of(v, "trees"), seed_of(v)); }},
      {{"planar", 2, "smooth blobs in the open, 20 x 20 m (Fig. 2)", {{"blobs", 5, 1, 12, "how many"}, seed}},
       [](const Values& v) { return make_planar(count_of(v, "blobs"), seed_of(v)); }},
      {{"discs", 2, "discs in the open, 30 x 30 m", {{"discs", 10, 1, 40, "how many"}, seed}},
       [](const Values& v) { return make_discs(count_of(v, "discs"), seed_of(v)); }},
      {{"blocks",
        2,
        "a grid of city blocks and streets, 120 x 100 m",
        {{"columns", 6, 1, 20, "blocks along x"}, {"rows", 5, 1, 20, "blocks along y"}, seed}},
       [](const Values& v) { return make_blocks(count_of(v, "columns"), count_of(v, "rows"), seed_of(v)); }},
      {{"office", 2, "rooms and doors along four corridors, enclosed, 40 x 30 m", {seed}}, [](const Values& v) { return make_office(seed_of(v)); }},
      {{"town2d", 2, "hollow houses with rooms, doors and windows, 120 x 90 m", {{"houses", 15, 1, 60, "how many"}, seed}},
       [](const Values& v) { return make_town2d(count_of(v, "houses"), seed_of(v)); }},
  };
  return all;
}

const Generator* find_generator(std::string_view name) {
  for (const Generator& generator : generators())
    if (generator.info.name == name) return &generator;
  return nullptr;
}

std::string join_names(const auto& items) {
  std::string names;
  for (const auto& item : items) names += (names.empty() ? "" : ", ") + item.name;
  return names;
}

/// `KEY=VALUE` of `spec`, checked against the scene's parameters, into `values`.
void assign(std::string_view spec, std::string_view assignment, const SceneInfo& info, Values& values) {
  const std::size_t equals = assignment.find('=');
  const std::string_view key = assignment.substr(0, equals);
  const auto parameter = std::find_if(info.parameters.begin(), info.parameters.end(), [&](const auto& p) { return p.name == key; });
  require(parameter != info.parameters.end(),
          fmt::format("scene {}: unknown parameter '{}': must be one of {}", info.name, key, join_names(info.parameters)), spec);
  const std::string_view text = equals == std::string_view::npos ? std::string_view() : assignment.substr(equals + 1);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  require(whole && static_cast<double>(value) >= parameter->low && static_cast<double>(value) <= parameter->high,
          fmt::format("scene {}: {} = {}: must be a whole number, {} .. {}", info.name, key, text, parameter->low, parameter->high), spec);
  values.find(key)->second = value;
}

AnyScene generate(const Generator& generator, std::string_view spec) {
  Values values;
  for (const SceneInfo::Parameter& p : generator.info.parameters) values.emplace(p.name, static_cast<std::int64_t>(p.value));
  const std::size_t colon = spec.find(':');
  std::string_view rest = colon == std::string_view::npos ? std::string_view() : spec.substr(colon + 1);
  while (!rest.empty()) {
    const std::size_t comma = rest.find(',');
    assign(spec, rest.substr(0, comma), generator.info, values);
    rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
  }
  return generator.make(values);
}

/// Whether `spec` must be meant as a file.
bool names_file(std::string_view spec) {
  const std::filesystem::path path(spec);
  std::error_code ignored;
  return path.has_extension() || path.has_parent_path() || std::filesystem::exists(path, ignored);
}

/// Built-in scene that a mistyped name most likely means: the one with the longest common beginning, if any.
std::string did_you_mean(std::string_view name) {
  std::size_t longest = 0;
  std::string best;
  for (const SceneInfo& info : scene_list()) {
    const auto [mine, theirs] = std::mismatch(name.begin(), name.end(), info.name.begin(), info.name.end());
    const auto common = static_cast<std::size_t>(mine - name.begin());
    if (common > longest) longest = common, best = info.name;
  }
  return best.empty() ? "" : fmt::format(", did you mean '{}'", best);
}

}  // namespace

const std::vector<SceneInfo>& scene_list() {
  static const std::vector<SceneInfo> list = [] {
    std::vector<SceneInfo> infos;
    for (const Generator& generator : generators()) infos.push_back(generator.info);
    return infos;
  }();
  return list;
}

AnyScene make_scene(std::string_view spec, const SceneFileOptions& options) {
  const std::string_view name = spec.substr(0, spec.find(':'));
  const Generator* generator = find_generator(name);
  require(!generator || options.ground == -kInfinity, "scene.ground: of mesh files; a built-in scene has its own", std::string(name));
  require(!generator || options.detail < 0.0, "scene.detail: of city models (CityJSON, CityGML); a built-in scene has no levels", std::string(name));
  if (generator) return generate(*generator, spec);
  if (names_file(spec)) return load_scene_file(spec, options);
  throw Error(ErrorCode::bad_input, fmt::format("scene '{}': neither a file nor one of {}{}", name, join_names(scene_list()), did_you_mean(name)));
}

}  // namespace vantage

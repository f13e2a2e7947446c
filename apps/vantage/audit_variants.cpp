// SPDX-License-Identifier: Apache-2.0
#include "audit_variants.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "vantage/audit/information_gain.h"
#include "vantage/base/error.h"
#include "vantage/session/suggest.h"

using vantage::require;
using vantage::Setting;

namespace {

/// What the reference and the oracles are made for: the same for all variants.
constexpr std::string_view kShared[] = {"explore.voxel", "explore.grid", "surface.eta", "planner.clearance", "sensor.range"};

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    if (end > begin) parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

std::vector<Setting> settings_of(const std::string& text, const std::string& where) {
  std::vector<Setting> settings;
  for (const std::string& part : split(text)) settings.push_back(vantage::parse_setting(part, where));
  return settings;
}

Variant variant(const std::string& name, const std::string& what, const std::string& settings) {
  return {name, what, settings_of(settings, name), false};
}

bool playable(const Variant& variant) { return !variant.information_gain || vantage::has_octomap(); }

void check(const Variant& variant) {
  vantage::Scenario scratch;
  for (const Setting& setting : variant.settings) {
    apply(scratch, setting);
    require(std::find(std::begin(kShared), std::end(kShared), setting.name) == std::end(kShared) && !setting.name.starts_with("scene."),
            fmt::format("{}: must be the same for all variants, so --set", setting.name), setting.where);
  }
}

/// NAME=stage.option=value,...
Variant own_variant(const std::string& text) {
  const std::size_t equals = text.find('=');
  require(equals != std::string::npos && equals > 0, text + ": must be NAME=stage.option=value,…", "--variant");
  Variant own{text.substr(0, equals), text.substr(equals + 1), settings_of(text.substr(equals + 1), "--variant"), false};
  const auto plain = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-'; };
  require(std::all_of(own.name.begin(), own.name.end(), plain), own.name + ": a name must be letters, digits, _ and -", "--variant");
  return own;
}

void add(std::vector<Variant>& chosen, const Variant& variant, const std::string& where) {
  const bool repeated = std::any_of(chosen.begin(), chosen.end(), [&](const Variant& v) { return v.name == variant.name; });
  require(!repeated, variant.name + ": named twice", where);
  check(variant);
  chosen.push_back(variant);
}

}  // namespace

const std::vector<Variant>& built_in_variants() {
  static const std::vector<Variant> all{
      variant("default", "the planner as it stands", ""),
      variant("optimistic", "volume in sight if all that is unseen were empty (the authors' follow-up)",
              "planner.lambda_factor=0,planner.solid_angle_weight=0,planner.learned=false"),
      variant("sight", "Eq. (1) repaired, with line of sight, tau = 1", "planner.metric=boundary"),
      variant("repaired", "Eq. (1) repaired, without line of sight", "planner.metric=boundary,planner.line_of_sight=false"),
      variant("printed", "Eq. (1) and the candidates by the letter of the paper's listing",
              "planner.metric=boundary,planner.elements=printed,planner.facing=behind,planner.mask=none,planner.normalise=false,"
              "planner.line_of_sight=false,planner.printed_curvature=true"),
      variant("nearest", "the nearest frontier", "planner.metric=nearest"),
      variant("count", "where most faces of the frontier are in view", "planner.metric=count"),
      variant("random", "any medial node", "planner.metric=random"),
      {"octomap", "information gain: most unknown voxels of an OctoMap along the rays (needs OctoMap)", {}, true},
  };
  return all;
}

std::vector<Variant> chosen_variants(const std::string& names, const std::vector<std::string>& own) {
  const std::vector<Variant>& all = built_in_variants();
  std::vector<Variant> chosen;
  if (names == "all") std::copy_if(all.begin(), all.end(), std::back_inserter(chosen), [](const Variant& v) { return !v.information_gain; });
  const bool listed = names != "all" && names != "none";
  for (const std::string& name : listed ? split(names) : std::vector<std::string>{}) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const Variant& v) { return v.name == name; });
    std::vector<std::string> known{"all", "none"};
    for (const Variant& v : all) known.push_back(v.name);
    require(found != all.end(), fmt::format("{}: must be of {}{}", name, fmt::join(known, ", "), vantage::did_you_mean(name, known)), "--variants");
    require(playable(*found), name + ": this build has no OctoMap (liboctomap-dev)", "--variants");
    add(chosen, *found, "--variants");
  }
  for (const std::string& text : own) add(chosen, own_variant(text), "--variant");
  return chosen;
}

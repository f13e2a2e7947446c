// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/scenario_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace vantage {
namespace {

std::string in_quotes(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

/// A point, so that a real number stays one.
std::string real(const std::string& text) { return text.find_first_of(".en") == std::string::npos ? text + ".0" : text; }

/// A value that TOML reads back as what it is.
std::string toml_value(const Option& option) {
  const std::string text = option.text();
  if (std::holds_alternative<Option::Choice>(option.value)) return in_quotes(text);
  return std::holds_alternative<double*>(option.value) || std::holds_alternative<Option::Angle>(option.value) ? real(text) : text;
}

}  // namespace

std::string scenario_as_toml(Scenario scenario, bool documented) {
  std::string out = "[scene]\n";
  if (documented) out += "# Built-in name with parameters (vantage scene --list), mesh files joined by +, or a 2D map\n";
  out += fmt::format("name = {}\n", in_quotes(scenario.scene));
  if (documented) out += "# First vantage point [m]\n";
  const auto list = [](const std::vector<double>& values) {
    std::vector<std::string> texts;
    for (const double v : values) texts.push_back(real(fmt::format("{}", v)));
    return fmt::format("[{}]", fmt::join(texts, ", "));
  };
  out += fmt::format("start = {}\n", list(scenario.start));
  std::string current = "scene";
  for (const Option& option : list_options(scenario)) {
    const std::string stage = option.name.substr(0, option.name.find('.'));
    if (stage != current) out += fmt::format("\n[{}]\n", stage);
    current = stage;
    if (documented) out += fmt::format("# {} ({})\n", option.doc, option.allowed());
    out += fmt::format("{} = {}\n", option.name.substr(stage.size() + 1), toml_value(option));
  }
  // The planner's table is the last one; its list of boxes is no single value.
  if (documented) out += "# The paper's weighting w: low corner, high corner [m] and weight (0 .. 1e6) of boxes, one after the other; 1 elsewhere\n";
  return out + fmt::format("weights = {}\n", list(scenario.explore.planner.weights));
}

}  // namespace vantage

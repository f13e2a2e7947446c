// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <toml++/toml.h>
#include <algorithm>

#include "vantage/base/error.h"
#include "vantage/io/atomic_file.h"
#include "vantage/session/scenario_file.h"

namespace vantage {
namespace {

std::string value_text(const toml::node& node, const std::string& name, const std::string& place) {
  if (const auto* v = node.as_string()) return v->get();
  if (const auto* v = node.as_boolean()) return v->get() ? "true" : "false";
  if (const auto* v = node.as_integer()) return fmt::format("{}", v->get());
  if (const auto* v = node.as_floating_point()) return fmt::format("{}", v->get());
  if (const auto* v = node.as_array()) {
    std::vector<std::string> items;
    for (const toml::node& item : *v) items.push_back(value_text(item, name, place));
    return fmt::format("{}", fmt::join(items, ","));
  }
  throw Error(ErrorCode::bad_input, fmt::format("{}: must be a number, a word, true or false, or a list of numbers", name), place);
}

/// Parts of a scene's name that are files beside the scenario become paths to them.
std::string beside(const std::filesystem::path& folder, const std::string& scene) {
  std::string out;
  for (std::size_t begin = 0; begin <= scene.size();) {
    const std::size_t end = std::min(scene.find('+', begin), scene.size());
    const std::string part = scene.substr(begin, end - begin);
    out += (begin > 0 ? "+" : "") + (std::filesystem::is_regular_file(folder / part) ? (folder / part).string() : part);
    begin = end + 1;
  }
  return out;
}

void add_table(std::string_view stage, const toml::table& table, const std::filesystem::path& path, std::vector<Setting>& settings) {
  for (const auto& [key, node] : table) {
    Setting setting{fmt::format("{}.{}", stage, key.str()), "", fmt::format("{}:{}", path.string(), key.source().begin.line)};
    setting.value = value_text(node, setting.name, setting.where);
    if (setting.name == "scene.name") setting.value = beside(path.parent_path(), setting.value);
    settings.push_back(std::move(setting));
  }
}

int line_of(const Setting& setting) { return std::stoi(setting.where.substr(setting.where.rfind(':') + 1)); }

}  // namespace

std::vector<Setting> read_scenario(const std::filesystem::path& path) { return parse_scenario(read_file(path), path); }

std::vector<Setting> parse_scenario(std::string_view text, const std::filesystem::path& path) {
  std::vector<Setting> settings;
  try {
    const toml::table root = toml::parse(text, path.string());
    for (const auto& [key, node] : root) {
      const std::string place = fmt::format("{}:{}", path.string(), key.source().begin.line);
      if (!node.is_table()) throw Error(ErrorCode::bad_input, fmt::format("{}: must stand in a table, say [explore]", key.str()), place);
      add_table(key.str(), *node.as_table(), path, settings);
    }
  } catch (const toml::parse_error& error) {
    throw Error(ErrorCode::bad_input, std::string(error.description()), fmt::format("{}:{}", path.string(), error.source().begin.line));
  }
  std::stable_sort(settings.begin(), settings.end(), [](const Setting& a, const Setting& b) { return line_of(a) < line_of(b); });
  return settings;
}

}  // namespace vantage

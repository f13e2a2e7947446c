// SPDX-License-Identifier: Apache-2.0
// CityJSON 1.0, 1.1 and 2.0 (cityjson.org/specs): surfaces of all city objects, templates placed; semantics, textures and attributes are not needed.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "vantage/base/error.h"
#include "vantage/io/json_text.h"
#include "vantage/io/polygons.h"
#include "vantage/io/text.h"

namespace vantage {
namespace {

using Json = nlohmann::json;
using Transform = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

/// A place in the file, as a JSON pointer says it.
struct Place {
  const Place* up = nullptr;
  std::string key;

  [[nodiscard]] std::string text() const {
    if (!up) return {};
    std::string escaped;
    for (const char c : printable(key, 80)) escaped += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
    return up->text() + "/" + escaped;
  }
  [[nodiscard]] Place operator/(std::string_view member) const { return {this, std::string(member)}; }
  [[nodiscard]] Place operator/(std::size_t index) const { return {this, std::to_string(index)}; }
};

/// How deep the surfaces of a kind of geometry lie in its boundaries; 0: it has none.
int depth_of(std::string_view kind) {
  if (kind == "MultiSurface" || kind == "CompositeSurface") return 1;
  if (kind == "Solid") return 2;
  return kind == "MultiSolid" || kind == "CompositeSolid" ? 3 : 0;
}

class CityJson {
 public:
  CityJson(const Json& root, const std::string& name, double detail) : root_(root), name_(name), detail_(detail) {}

  Polygons read() {
    const Place place;
    if (!root_.is_object() || root_.value("type", Json()) != "CityJSON") fail(place, "not a CityJSON file: lacks \"type\": \"CityJSON\"");
    read_transform(place);
    shared_ = read_vertices(member(root_, "vertices", place), place / "vertices", scale_, shift_);
    const Place objects = place / "CityObjects";
    const Json& all = member(root_, "CityObjects", place);
    if (!all.is_object()) fail(objects, "must be an object");
    for (const auto& [id, object] : all.items()) choose(id, object, objects / id);
    leave_to_parts(all);
    for (const auto& [id, object] : all.items())
      if (const auto found = level_.find(id); found != level_.end()) add_object(object, found->second, objects / id);
    return std::move(out_);
  }

 private:
  /// Vertices in `out_`.
  struct Vertices {
    std::size_t first = 0, count = 0;
  };

  [[noreturn]] void fail(const Place& place, const std::string& message) const {
    throw Error(ErrorCode::bad_input, message, place.up ? fmt::format("{}:{}", name_, place.text()) : name_);
  }
  [[nodiscard]] const Json& member(const Json& object, const char* key, const Place& place) const {
    const auto found = object.is_object() ? object.find(key) : object.end();
    if (!object.is_object() || found == object.end()) fail(place, fmt::format("lacks \"{}\"", key));
    return *found;
  }
  [[nodiscard]] std::string text(const Json& value) const { return printable(value.dump(-1, ' ', true, Json::error_handler_t::replace)); }
  [[nodiscard]] double number(const Json& value, const Place& place) const {
    if (!value.is_number()) fail(place, fmt::format("{}: must be a number", text(value)));
    const auto x = value.get<double>();
    if (!std::isfinite(x)) fail(place, "must be finite");
    return x;
  }
  template <std::size_t N>
  [[nodiscard]] std::array<double, N> numbers(const Json& value, const Place& place) const {
    if (!value.is_array() || value.size() != N) fail(place, fmt::format("{}: must be {} numbers", text(value), N));
    std::array<double, N> x;
    for (std::size_t i = 0; i < N; ++i) x[i] = number(value[i], place / i);
    return x;
  }
  [[nodiscard]] const Json& array(const Json& value, const Place& place) const {
    if (!value.is_array()) fail(place, fmt::format("{}: must be an array", text(value)));
    return value;
  }
  [[nodiscard]] std::size_t index(const Json& value, std::size_t count, const Place& place) const {
    if (!value.is_number_integer() || value.get<double>() < 0.0 || value.get<double>() >= static_cast<double>(count))
      fail(place, fmt::format("{}: must be 0 .. {}", text(value), static_cast<std::int64_t>(count) - 1));
    return value.get<std::size_t>();
  }

  void read_transform(const Place& place) {
    if (!root_.contains("transform")) return;
    const Json& transform = root_["transform"];
    scale_ = numbers<3>(member(transform, "scale", place / "transform"), place / "transform" / "scale");
    shift_ = numbers<3>(member(transform, "translate", place / "transform"), place / "transform" / "translate");
  }

  Vertices read_vertices(const Json& values, const Place& place, const std::array<double, 3>& scale, const std::array<double, 3>& shift) {
    const Vertices range{out_.vertices.size(), array(values, place).size()};
    out_.vertices.reserve(range.first + range.count);
    for (std::size_t i = 0; i < range.count; ++i) {
      const auto v = numbers<3>(values[i], place / i);
      out_.vertices.push_back({v[0] * scale[0] + shift[0], v[1] * scale[1] + shift[1], v[2] * scale[2] + shift[2]});
      if (!out_.vertices.back().allFinite()) fail(place / i, "must be finite");
    }
    return range;
  }

  /// The levels of an object's geometries that have surfaces; "2.2" or 2.
  [[nodiscard]] double level(const Json& geometry, const Place& place) const {
    const auto found = geometry.find("lod");
    if (found == geometry.end()) return 0.0;
    if (found->is_number()) return number(*found, place / "lod");
    const auto value = found->is_string() ? leading_number(found->get_ref<const std::string&>()) : std::nullopt;
    if (!value || !std::isfinite(*value)) fail(place / "lod", fmt::format("{}: must be a level of detail", text(*found)));
    return *value;
  }
  [[nodiscard]] std::string kind(const Json& geometry, const Place& place) const {
    const Json& type = member(geometry, "type", place);
    if (!type.is_string()) fail(place / "type", fmt::format("{}: must be a string", text(type)));
    return type.get<std::string>();
  }
  [[nodiscard]] const Json& template_of(const Json& geometry, const Place& place) const {
    const Place root, at = root / "geometry-templates";
    const Json& templates = array(member(member(root_, "geometry-templates", root), "templates", at), at / "templates");
    return templates[index(member(geometry, "template", place), templates.size(), place / "template")];
  }
  /// Level of a geometry that has surfaces, with its place.
  [[nodiscard]] std::optional<double> level_of_surfaces(const Json& geometry, const Place& place) const {
    const std::string type = kind(geometry, place);
    if (type != "GeometryInstance") return depth_of(type) > 0 ? std::optional(level(geometry, place)) : std::nullopt;
    const Json& model = template_of(geometry, place);
    return depth_of(kind(model, place / "template")) > 0 ? std::optional(level(model, place / "template")) : std::nullopt;
  }

  void choose(const std::string& id, const Json& object, const Place& place) {
    if (!object.is_object()) fail(place, "must be an object");
    const auto found = object.find("geometry");
    if (found == object.end() || found->is_null()) return;
    const Place at = place / "geometry";
    std::vector<double> levels;
    for (std::size_t i = 0; i < array(*found, at).size(); ++i)
      if (const auto level = level_of_surfaces((*found)[i], at / i)) levels.push_back(*level);
    if (!levels.empty()) level_[id] = chosen_detail(levels, detail_);
  }

  void leave_to_parts(const Json& objects) {
    std::vector<std::string> shown_by_parts;
    for (const auto& [id, object] : objects.items()) {
      const auto mine = level_.find(id);
      const Json type = object.value("type", Json()), parents = object.value("parents", Json::array());
      if (mine == level_.end() || !type.is_string() || !type.get_ref<const std::string&>().ends_with("Part") || !parents.is_array()) continue;
      for (const Json& parent : parents) {
        const auto theirs = parent.is_string() ? level_.find(parent.get<std::string>()) : level_.end();
        if (theirs != level_.end() && theirs->second < mine->second) shown_by_parts.push_back(theirs->first);
      }
    }
    for (const std::string& id : shown_by_parts) level_.erase(id);
  }

  void add_object(const Json& object, double level, const Place& place) {
    const Json& geometries = object["geometry"];
    for (std::size_t i = 0; i < geometries.size(); ++i) {
      const Place geometry = place / "geometry", at = geometry / i;
      if (level_of_surfaces(geometries[i], at) != level) continue;
      if (kind(geometries[i], at) == "GeometryInstance")
        add_instance(geometries[i], at);
      else
        add_surfaces(member(geometries[i], "boundaries", at), depth_of(kind(geometries[i], at)), shared_, at / "boundaries");
    }
  }

  /// A template by its matrix, moved to the one vertex of its boundaries.
  void add_instance(const Json& geometry, const Place& place) {
    const Place at = place / "boundaries";
    const Json& boundaries = array(member(geometry, "boundaries", place), at);
    if (boundaries.size() != 1) fail(at, fmt::format("{}: must be one vertex", text(boundaries)));
    const Vec<3> origin = out_.vertices[shared_.first + index(boundaries[0], shared_.count, at / std::size_t{0})];
    const auto matrix = numbers<16>(member(geometry, "transformationMatrix", place), place / "transformationMatrix");
    const Transform transform = Eigen::Map<const Transform>(matrix.data());
    const Json& model = template_of(geometry, place);
    const Place root, templates = root / "geometry-templates";
    const Json& vertices = member(root_["geometry-templates"], "vertices-templates", templates);
    require_memory(static_cast<double>(out_.vertices.size() + array(vertices, templates).size()), 64.0, name_);
    const Vertices own = read_vertices(vertices, templates / "vertices-templates", {1, 1, 1}, {0, 0, 0});
    for (std::size_t i = own.first; i < own.first + own.count; ++i) {
      Vec<3>& v = out_.vertices[i];
      v = transform.topLeftCorner<3, 3>() * v + transform.topRightCorner<3, 1>() + origin;
      if (!v.allFinite()) fail(place / "transformationMatrix", "moves a vertex to where it is not finite");
    }
    const Place of_template = place / "template";
    add_surfaces(member(model, "boundaries", of_template), depth_of(kind(model, of_template)), own, of_template / "boundaries");
  }

  void add_surfaces(const Json& boundaries, int depth, Vertices vertices, const Place& place) {
    for (std::size_t i = 0; i < array(boundaries, place).size(); ++i) {
      if (depth > 1)
        add_surfaces(boundaries[i], depth - 1, vertices, place / i);
      else
        add_surface(boundaries[i], vertices, place / i);
    }
  }

  void add_surface(const Json& rings, Vertices vertices, const Place& place) {
    for (std::size_t r = 0; r < array(rings, place).size(); ++r) {
      const Place at = place / r;
      if (r > 0) out_.holes.push_back(out_.corners.size());
      for (std::size_t i = 0; i < array(rings[r], at).size(); ++i)
        out_.corners.push_back(static_cast<std::int64_t>(vertices.first + index(rings[r][i], vertices.count, at / i)));
    }
    out_.close_polygon();
  }

  const Json& root_;
  const std::string& name_;
  double detail_;
  std::array<double, 3> scale_{1.0, 1.0, 1.0}, shift_{0.0, 0.0, 0.0};
  Vertices shared_;                      ///< Of all objects.
  std::map<std::string, double> level_;  ///< Of each object that is shown.
  Polygons out_;
};

}  // namespace

SceneGraph parse_cityjson(std::string_view bytes, const std::string& name, double detail) {
  try {
    const Json root = parse_json(bytes, name);
    return {CityJson(root, name, detail).read(), 'z', 1.0};
  } catch (const Json::exception& error) {
    throw Error(ErrorCode::bad_input, printable(error.what(), 120), name);
  }
}

}  // namespace vantage

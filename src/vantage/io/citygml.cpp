// SPDX-License-Identifier: Apache-2.0
// CityGML 1.0 to 3.0: every polygon of the chosen level of detail, whatever the namespaces are called (OGC 12-019, 20-010; GML 3.1, 3.2).
#include <fmt/format.h>

#include <pugixml.hpp>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>

#include "vantage/base/error.h"
#include "vantage/io/polygons.h"
#include "vantage/io/text.h"

namespace vantage {
namespace {

using Node = pugi::xml_node;
using Transform = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

constexpr int kDeepestLinks = 100;
constexpr int kUp = 16;                  ///< Elements around a list of positions that may say its dimension.
constexpr double kBytesPerByte = 16.0;   ///< Of memory for one of text, about.
constexpr double kImplicitBytes = 64.0;  ///< Of memory for a corner of a placed template.

std::string_view local(std::string_view name) { return name.substr(name.find(':') + 1); }
std::string_view local(Node node) { return local(std::string_view(node.name())); }
std::string_view attribute(Node node, std::string_view name) {
  for (const pugi::xml_attribute& a : node.attributes())
    if (local(std::string_view(a.name())) == name) return a.value();
  return {};
}
Node child(Node node, std::string_view name) {
  for (Node c : node.children())
    if (local(c) == name) return c;
  return {};
}

bool is_polygon(std::string_view name) { return name == "Polygon" || name == "PolygonPatch" || name == "Triangle" || name == "Rectangle"; }
/// `lod2Solid` and its like.
bool is_level(std::string_view name) { return name.size() > 4 && name.starts_with("lod") && name[3] >= '0' && name[3] <= '4'; }
/// Properties by which a building has walls and a wall windows.
bool is_boundary(std::string_view name) { return name == "boundedBy" || name == "opening" || name == "boundary" || name == "fillingSurface"; }

/// Goes through all below `top`, which may end the way down at a node by returning false.
template <class Visit>
void walk(Node top, Visit&& visit) {
  Node node = top;
  while (node) {
    if (visit(node) && node.first_child()) {
      node = node.first_child();
      continue;
    }
    while (node != top && !node.next_sibling()) node = node.parent();
    if (node == top) return;
    node = node.next_sibling();
  }
}

class CityGml {
 public:
  CityGml(Node root, const std::string& name, double detail) : root_(root), name_(name), detail_(detail) {}

  Polygons read() {
    index();
    choose();
    for (const Property& property : properties_)
      if (const auto level = level_.find(property.owner.internal_object()); level != level_.end() && level->second == property.level)
        add_all(property.node, as_it_is_);
    for (const Node& polygon : free_) add(polygon, as_it_is_);
    return std::move(out_);
  }

 private:
  using Key = const void*;
  /// One geometry of a city object.
  struct Property {
    Node owner, node;
    double level;
  };
  /// What is put where: each polygon and each link once.
  struct Placing {
    Transform transform = Transform::Identity();
    bool of_template = false;
    std::set<Key> added, followed;
  };

  [[noreturn]] void fail(Node node, const std::string& message) const {
    throw Error(ErrorCode::bad_input, message, node.offset_debug() >= 0 ? fmt::format("{}:{}", name_, node.offset_debug()) : name_);
  }

  /// The city object that a geometry belongs to: walls and windows are parts of theirs.
  static Node owner_of(Node property) {
    Node owner = property.parent();
    while (is_boundary(local(owner.parent()))) owner = owner.parent().parent();
    return owner;
  }

  void index() {
    walk(root_, [&](Node node) {
      if (const std::string_view id = attribute(node, "id"); !id.empty()) by_id_.try_emplace(id, node);
      return true;
    });
    walk(root_, [&](Node node) {
      const std::string_view name = local(node);
      if (is_level(name)) properties_.push_back({owner_of(node), node, static_cast<double>(name[3] - '0')});
      if (is_polygon(name)) free_.push_back(node);
      return !is_level(name) && !is_polygon(name) && name != "extent";  // The extent of a relief is its outline, no surface.
    });
  }

  void choose() {
    std::map<Key, std::vector<double>> present;
    std::erase_if(properties_, [&](const Property& p) { return !has_surface(p.node); });
    for (const Property& p : properties_) present[p.owner.internal_object()].push_back(p.level);
    for (const auto& [owner, levels] : present) level_[owner] = chosen_detail(levels, detail_);
    std::vector<Key> shown_by_parts;
    for (const Property& p : properties_) {
      const Key whole = p.owner.parent().parent().internal_object();
      const auto theirs = level_.find(whole);
      if (local(p.owner).ends_with("Part") && theirs != level_.end() && theirs->second < level_[p.owner.internal_object()])
        shown_by_parts.push_back(whole);
    }
    for (const Key whole : shown_by_parts) level_.erase(whole);
  }

  static bool has_surface(Node property) {
    bool found = false;
    walk(property, [&](Node node) {
      found = found || is_polygon(local(node)) || !attribute(node, "href").empty();
      return !found;
    });
    return found;
  }

  /// The polygons below a node and those that it links to.
  void add_all(Node top, Placing& placing) {
    walk(top, [&](Node node) {
      if (is_polygon(local(node))) {
        add(node, placing);
        return false;
      }
      if (local(node) == "ImplicitGeometry") {
        if (placing.of_template) fail(node, "a template within a template");
        add_implicit(node);
        return false;
      }
      follow(node, placing);
      return true;
    });
  }

  void follow(Node node, Placing& placing) {
    const std::string_view href = attribute(node, "href");
    if (!href.starts_with('#')) return;  // What lies in other files is not read.
    const auto target = by_id_.find(href.substr(1));
    if (target == by_id_.end() || !placing.followed.insert(target->second.internal_object()).second) return;
    if (++links_ > kDeepestLinks) fail(node, fmt::format("links lead on to links, more than {} in a row", kDeepestLinks));
    add_all(target->second, placing);
    --links_;
  }

  /// A template by its matrix, moved to its reference point.
  void add_implicit(Node node) {
    Placing placing;
    placing.of_template = true;
    if (const Node matrix = child(node, "transformationMatrix")) {
      const std::vector<double> m = numbers(matrix);
      if (m.size() != 16) fail(matrix, fmt::format("{} numbers: a matrix has 16", m.size()));
      placing.transform = Eigen::Map<const Transform>(m.data());
    }
    if (const Node position = child(child(child(node, "referencePoint"), "Point"), "pos")) {
      const std::vector<double> p = numbers(position);
      if (p.size() != 3) fail(position, fmt::format("{} numbers: a position has 3", p.size()));
      placing.transform.topRightCorner<3, 1>() += Vec<3>(p[0], p[1], p[2]);
    }
    if (const Node geometry = child(node, "relativeGMLGeometry")) add_all(geometry, placing);
  }

  void add(Node polygon, Placing& placing) {
    if (!placing.added.insert(polygon.internal_object()).second) return;
    if (out_.corners.size() > room_) {
      room_ = 2 * out_.corners.size();
      require_memory(static_cast<double>(room_), kImplicitBytes, name_);
    }
    const Node outline = child(polygon, "exterior") ? child(polygon, "exterior") : child(polygon, "outerBoundaryIs");
    if (!outline) return;
    add_ring(child(outline, "LinearRing"), placing.transform);
    for (Node inner : polygon.children()) {
      if (local(inner) != "interior" && local(inner) != "innerBoundaryIs") continue;
      out_.holes.push_back(out_.corners.size());
      add_ring(child(inner, "LinearRing"), placing.transform);
    }
    out_.close_polygon();
  }

  void add_ring(Node ring, const Transform& transform) {
    std::vector<Vec<3>> places;
    for (Node part : ring.children()) {
      const std::string_view name = local(part);
      if (name == "posList" || name == "pos" || name == "coordinates") add_positions(part, places);
      if (name == "pointProperty" || name == "pointRep") add_positions(child(child(part, "Point"), "pos"), places);
    }
    if (places.size() > 1 && places.front() == places.back()) places.pop_back();  // A ring ends where it began.
    for (const Vec<3>& p : places) {
      out_.corners.push_back(static_cast<std::int64_t>(out_.vertices.size()));
      out_.vertices.push_back(transform.topLeftCorner<3, 3>() * p + transform.topRightCorner<3, 1>());
      if (!out_.vertices.back().allFinite()) fail(ring, "a position is not finite");
    }
  }

  void add_positions(Node list, std::vector<Vec<3>>& places) const {
    const std::vector<double> values = numbers(list);
    const std::string_view dimension = dimension_of(list);
    if (dimension != "3") fail(list, fmt::format("positions of {} numbers: must be 3", printable(dimension)));
    if (values.size() % 3 != 0) fail(list, fmt::format("{} numbers: positions have 3 each", values.size()));
    for (std::size_t i = 0; i < values.size(); i += 3) places.push_back({values[i], values[i + 1], values[i + 2]});
  }
  [[nodiscard]] std::string_view dimension_of(Node list) const {
    Node node = list;
    for (int up = 0; up < kUp && node && node != root_; ++up, node = node.parent())
      for (const char* key : {"srsDimension", "dimension"})
        if (const std::string_view value = attribute(node, key); !value.empty()) return value;
    return "3";
  }

  [[nodiscard]] std::vector<double> numbers(Node node) const {
    std::vector<double> values;
    std::string text = node.text().get();
    if (local(node) == "coordinates") std::replace(text.begin(), text.end(), ',', ' ');
    std::string_view rest = text;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
      const auto value = leading_number(word);
      if (!value || !std::isfinite(*value)) fail(node, fmt::format("'{}': must be a finite number", printable(word)));
      values.push_back(*value);
    }
    return values;
  }

  Node root_;
  const std::string& name_;
  double detail_;
  std::unordered_map<std::string_view, Node> by_id_;
  std::vector<Property> properties_;
  std::vector<Node> free_;       ///< Polygons of no level: relief.
  std::map<Key, double> level_;  ///< Of each object that is shown.
  Placing as_it_is_;
  Polygons out_;
  std::size_t room_ = 1 << 20;
  int links_ = 0;
};

}  // namespace

SceneGraph parse_citygml(std::string_view bytes, const std::string& name, double detail) {
  require_memory(static_cast<double>(bytes.size()), kBytesPerByte, name);
  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_buffer(bytes.data(), bytes.size());
  if (!result)
    throw Error(ErrorCode::bad_input, fmt::format("not well-formed XML: {}", result.description()), fmt::format("{}:{}", name, result.offset));
  const Node root = document.document_element();
  require(local(root) == "CityModel", fmt::format("not a CityGML file: it begins with <{}>, not with a CityModel", printable(root.name())), name);
  return {CityGml(root, name, detail).read(), 'z', 1.0};
}

}  // namespace vantage

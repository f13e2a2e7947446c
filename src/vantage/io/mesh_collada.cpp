// SPDX-License-Identifier: Apache-2.0
// COLLADA 1.4/1.5: geometry, nodes, unit and up axis. Read here because assimp 5.2.5 takes units and axes for something else and dies of
// indices out of range.
#include <fmt/format.h>

#include <pugixml.hpp>

#include <algorithm>
#include <unordered_map>

#include <Eigen/Geometry>

#include "vantage/base/error.h"
#include "vantage/geometry/angle.h"
#include "vantage/io/polygons.h"
#include "vantage/io/text.h"

namespace vantage {
namespace {

using Node = pugi::xml_node;
using Transform = Eigen::Matrix4d;

constexpr int kDeepest = 200;                ///< Nested nodes.
constexpr std::size_t kMostNodes = 1000000;  ///< Instances counted out.

std::vector<double> numbers(const char* text) {
  std::vector<double> values;
  std::string_view rest = text;
  for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) values.push_back(leading_number(word).value_or(kInfinity));
  return values;
}

std::vector<std::int64_t> integers(const char* text) {
  std::vector<std::int64_t> values;
  std::string_view rest = text;
  for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) values.push_back(leading_integer(word).value_or(-1));
  return values;
}

class Collada {
 public:
  Collada(Node root, const std::string& name) : root_(root), name_(name) {
    for (const auto& found : root.select_nodes("//*[@id]")) by_id_.try_emplace(found.node().attribute("id").value(), found.node());
  }

  Polygons read() {
    Node scene = target(root_.child("scene").child("instance_visual_scene"), "url");
    if (!scene) scene = root_.child("library_visual_scenes").child("visual_scene");
    if (!scene) fail("has no <visual_scene>");
    for (Node node : scene.children("node")) place(node, Transform::Identity(), 0);
    return std::move(out_);
  }

 private:
  /// A geometry in its own frame.
  struct Shape {
    std::vector<Vec<3>> vertices;
    std::vector<std::int64_t> corners;
    std::vector<std::size_t> ends;
  };

  [[noreturn]] void fail(const std::string& message) const { throw Error(ErrorCode::bad_input, message, name_); }

  /// What an attribute such as url="#id" points at; nothing for other files.
  [[nodiscard]] Node target(Node from, const char* attribute) const {
    const std::string url = from.attribute(attribute).value();
    const auto found = url.starts_with('#') ? by_id_.find(url.substr(1)) : by_id_.end();
    return found == by_id_.end() ? Node() : found->second;
  }

  [[nodiscard]] Transform transform(Node step) const {
    const std::vector<double> v = numbers(step.text().get());
    const std::string_view kind = step.name();
    Transform t = Transform::Identity();
    const auto need = [&](std::size_t count) {
      if (v.size() < count) fail(fmt::format("<{}> holds {} numbers: must be {}", kind, v.size(), count));
    };
    if (kind == "matrix" || kind == "bind_shape_matrix") {
      need(16);
      t = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(v.data());
    } else if (kind == "translate") {
      need(3);
      t.topRightCorner<3, 1>() = Vec<3>(v[0], v[1], v[2]);
    } else if (kind == "scale") {
      need(3);
      t.diagonal().head<3>() = Vec<3>(v[0], v[1], v[2]);
    } else if (kind == "rotate") {
      need(4);
      const Vec<3> axis = Vec<3>(v[0], v[1], v[2]).normalized();
      const auto [s, c] = sin_cos(radians(v[3]));
      Eigen::Matrix3d cross;
      cross << 0, -axis[2], axis[1], axis[2], 0, -axis[0], -axis[1], axis[0], 0;
      t.topLeftCorner<3, 3>() += s * cross + (1.0 - c) * cross * cross;
    }
    return t;
  }

  void place(Node node, const Transform& parent, int depth) {
    if (depth > kDeepest || ++nodes_ > kMostNodes) fail("nodes contain themselves, or far too many others");
    Transform here = parent;
    for (Node child : node.children()) {
      const std::string_view kind = child.name();
      if (kind == "instance_geometry")
        place_shape(target(child, "url"), here);
      else if (kind == "instance_controller")
        place_skin(target(child, "url").child("skin"), here);
      else if (kind == "instance_node")
        place(target(child, "url"), here, depth + 1);
      else if (kind == "node")
        place(child, here, depth + 1);
      else
        here = here * transform(child);
    }
  }

  void place_skin(Node skin, const Transform& here) {
    const Node bind = skin.child("bind_shape_matrix");
    place_shape(target(skin, "source"), bind ? Transform(here * transform(bind)) : here);
  }

  void place_shape(Node geometry, const Transform& here) {
    if (!geometry.child("mesh")) return;
    const auto [entry, fresh] = shapes_.try_emplace(geometry.attribute("id").value());
    if (fresh) entry->second = read_shape(geometry.child("mesh"));
    const Shape& shape = entry->second;
    const auto first = static_cast<std::int64_t>(out_.vertices.size());
    const std::size_t corner = out_.corners.size();
    if (corner + shape.corners.size() > room_) {
      room_ = 2 * (corner + shape.corners.size());
      require_memory(static_cast<double>(room_), 64.0, name_);
    }
    for (const Vec<3>& v : shape.vertices) out_.vertices.push_back(here.topLeftCorner<3, 3>() * v + here.topRightCorner<3, 1>());
    const auto count = static_cast<std::int64_t>(shape.vertices.size());
    for (const std::int64_t i : shape.corners) out_.corners.push_back(i >= 0 && i < count ? first + i : -1);
    for (const std::size_t end : shape.ends) out_.ends.push_back(corner + end);
  }

  [[nodiscard]] Shape read_shape(Node mesh) const {
    Shape shape;
    for (Node primitive : mesh.children()) read_primitive(primitive, shape);
    return shape;
  }

  void read_primitive(Node primitive, Shape& shape) const {
    const std::string_view kind = primitive.name();
    const bool strips = kind == "tristrips", fans = kind == "trifans";
    if (!(kind == "triangles" || kind == "polylist" || kind == "polygons" || strips || fans)) return;
    std::int64_t step = 1, offset = -1;
    Node vertices;
    for (Node input : primitive.children("input")) {
      const std::int64_t at = leading_integer(input.attribute("offset").value()).value_or(0);
      if (at < 0 || at > 1000) fail(fmt::format("<input offset=\"{}\">: must be 0 .. 1000", at));
      step = std::max(step, at + 1);
      if (std::string_view(input.attribute("semantic").value()) == "VERTEX") offset = at, vertices = target(input, "source");
    }
    if (offset < 0) return;
    const auto first = static_cast<std::int64_t>(shape.vertices.size());
    read_positions(vertices, shape.vertices);
    const std::vector<std::int64_t> lengths = integers(primitive.child("vcount").text().get());
    for (Node p : primitive.children("p")) {
      std::vector<std::int64_t> corners;
      const std::vector<std::int64_t> all = integers(p.text().get());
      for (auto i = static_cast<std::size_t>(offset); i < all.size(); i += static_cast<std::size_t>(step))
        corners.push_back(all[i] < 0 ? -1 : first + all[i]);
      if (kind == "polylist")
        add_polygons(corners, lengths, shape);
      else if (kind == "polygons")
        add_polygons(corners, {static_cast<std::int64_t>(corners.size())}, shape);
      else
        add_triangles(corners, strips ? 'S' : fans ? 'F' : 'T', shape);
    }
  }

  void add_polygons(const std::vector<std::int64_t>& corners, const std::vector<std::int64_t>& lengths, Shape& shape) const {
    std::size_t begin = 0;
    for (const std::int64_t length : lengths) {
      if (length < 0 || static_cast<std::size_t>(length) > corners.size() - begin) fail("<polylist>: more corners in <vcount> than in <p>");
      shape.corners.insert(shape.corners.end(), corners.begin() + static_cast<std::ptrdiff_t>(begin),
                           corners.begin() + static_cast<std::ptrdiff_t>(begin) + length);
      shape.ends.push_back(shape.corners.size());
      begin += static_cast<std::size_t>(length);
    }
  }

  static void add_triangles(const std::vector<std::int64_t>& corners, char kind, Shape& shape) {
    for (std::size_t i = 2; i < corners.size(); i += kind == 'T' ? 3 : 1) {
      shape.corners.insert(shape.corners.end(), {corners[kind == 'F' ? 0 : i - 2], corners[i - 1], corners[i]});
      shape.ends.push_back(shape.corners.size());
    }
  }

  /// Appends the positions that a <vertices> names.
  void read_positions(Node vertices, std::vector<Vec<3>>& out) const {
    Node source;
    for (Node input : vertices.children("input"))
      if (std::string_view(input.attribute("semantic").value()) == "POSITION") source = target(input, "source");
    const std::vector<double> values = numbers(source.child("float_array").text().get());
    const Node accessor = source.child("technique_common").child("accessor");
    const std::int64_t stride = accessor.attribute("stride").as_llong(3), offset = accessor.attribute("offset").as_llong(0);
    if (stride < 2 || stride > 1000 || offset < 0) fail(fmt::format("<accessor stride=\"{}\" offset=\"{}\">: not positions", stride, offset));
    const std::int64_t used = std::min<std::int64_t>(stride, 3), size = static_cast<std::int64_t>(values.size());
    for (std::int64_t i = offset; i <= size - used; i += stride) {
      Vec<3> v = Vec<3>::Zero();
      for (std::int64_t a = 0; a < used; ++a) v[a] = values[static_cast<std::size_t>(i + a)];
      out.push_back(v);
    }
  }

  Node root_;
  const std::string& name_;
  std::unordered_map<std::string, Node> by_id_;
  std::unordered_map<std::string, Shape> shapes_;
  Polygons out_;
  std::size_t nodes_ = 0, room_ = 1 << 20;
};

}  // namespace

SceneGraph parse_collada(std::string_view bytes, const std::string& name) {
  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_buffer(bytes.data(), bytes.size());
  if (!result)
    throw Error(ErrorCode::bad_input, fmt::format("not well-formed XML: {}", result.description()), fmt::format("{}:{}", name, result.offset));
  const Node root = document.child("COLLADA"), asset = root.child("asset");
  require(root, "not a COLLADA file: lacks <COLLADA>", name);
  SceneGraph graph;
  const char* meters = asset.child("unit").attribute("meter").as_string("1");
  graph.unit = leading_number(meters).value_or(0.0);
  require(graph.unit > 0.0 && graph.unit < 1e9, fmt::format("<unit meter=\"{}\">: must be > 0", printable(meters)), name);
  const std::string_view up = asset.child("up_axis").text().as_string("Y_UP");
  graph.up = up.starts_with('Z') ? 'z' : up.starts_with('X') ? 'x' : 'y';
  graph.polygons = Collada(root, name).read();
  return graph;
}

}  // namespace vantage

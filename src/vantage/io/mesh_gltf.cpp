// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 and GLB: triangles of the scene's nodes. Read here because assimp 5.2.5 believes counts and offsets and reads past its buffers.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include <unordered_map>

#include <Eigen/Geometry>

#include "vantage/base/error.h"
#include "vantage/io/gltf_file.h"
#include "vantage/io/polygons.h"
#include "vantage/io/text.h"

namespace vantage {
namespace {

using Part = GltfFile::Part;
using Transform = Eigen::Matrix4d;

constexpr int kDeepest = 200;        ///< Nested nodes.
constexpr double kBytesEach = 32.0;  ///< Of memory for a vertex or a corner.

/// A mesh in its own frame.
struct Shape {
  std::vector<Vec<3>> vertices;
  std::vector<std::int64_t> corners;  ///< Of triangles; -1: names no vertex.
};

class GltfScene {
 public:
  GltfScene(GltfFile& file, const std::string& name) : file_(file), name_(name), placed_(file.size(file.root(), "nodes"), false) {}

  Polygons read() {
    for (std::size_t i = 0; i < file_.size(file_.root(), "extensionsRequired"); ++i) {
      const Part needed = file_.at(file_.root(), "extensionsRequired", i);
      const std::string extension = needed.json->is_string() ? needed.json->get<std::string>() : "";
      if (extension.ends_with("compression") || extension.ends_with("gpu_instancing")) file_.fail(printable(extension) + ": is not read");
    }
    for (const std::uint64_t node : roots()) place(node, Transform::Identity(), 0);
    return std::move(out_);
  }

 private:
  /// Of the scene that is shown; without one, the nodes that are no children.
  [[nodiscard]] std::vector<std::uint64_t> roots() const {
    const Part root = file_.root();
    if (file_.size(root, "scenes") > 0) return file_.indices(file_.at(root, "scenes", file_.whole(root, "scene", 0)), "nodes");
    std::vector<bool> child(placed_.size(), false);
    for (std::size_t i = 0; i < child.size(); ++i)
      for (const std::uint64_t c : file_.indices(file_.at(root, "nodes", i), "children"))
        if (c < child.size()) child[c] = true;
    std::vector<std::uint64_t> out;
    for (std::size_t i = 0; i < child.size(); ++i)
      if (!child[i]) out.push_back(i);
    return out;
  }

  void place(std::uint64_t index, const Transform& parent, int depth) {
    const Part node = file_.at(file_.root(), "nodes", index);
    if (placed_[index]) file_.fail(fmt::format("{} has two parents, or nodes contain themselves", node.place));
    if (depth > kDeepest) file_.fail(fmt::format("nodes nest deeper than {}", kDeepest));
    placed_[index] = true;
    const Transform here = parent * transform(node);
    if (GltfFile::has(node, "mesh")) add(shape(file_.whole(file_.element(node, "mesh"))), here);
    for (const std::uint64_t child : file_.indices(node, "children")) place(child, here, depth + 1);
  }

  [[nodiscard]] Transform transform(const Part& node) const {
    Transform t = Transform::Identity();
    if (file_.fetch(node, "matrix", 16, t.data())) return t;
    Vec<3> shift = Vec<3>::Zero(), scale = Vec<3>::Ones();
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
    file_.fetch(node, "translation", 3, shift.data());
    file_.fetch(node, "scale", 3, scale.data());
    if (file_.fetch(node, "rotation", 4, turn.coeffs().data())) turn.normalize();  // x, y, z, w, as Eigen keeps them.
    t.topLeftCorner<3, 3>() = turn.toRotationMatrix() * scale.asDiagonal();
    t.topRightCorner<3, 1>() = shift;
    return t;
  }

  /// Before so many vertices and corners are kept.
  void grow(std::size_t count) {
    held_ += count;
    if (held_ <= room_) return;
    room_ = 2 * held_;
    require_memory(static_cast<double>(room_), kBytesEach, name_);
  }

  void add(const Shape& shape, const Transform& here) {
    grow(shape.vertices.size() + shape.corners.size());
    const auto first = static_cast<std::int64_t>(out_.vertices.size());
    for (const Vec<3>& v : shape.vertices) out_.vertices.push_back(here.topLeftCorner<3, 3>() * v + here.topRightCorner<3, 1>());
    for (std::size_t i = 0; i < shape.corners.size(); ++i) {
      out_.corners.push_back(shape.corners[i] < 0 ? -1 : first + shape.corners[i]);
      if (i % 3 == 2) out_.close_polygon();
    }
  }

  const Shape& shape(std::uint64_t index) {
    const auto [entry, fresh] = shapes_.try_emplace(index);
    if (!fresh) return entry->second;
    const Part mesh = file_.at(file_.root(), "meshes", index);
    for (std::size_t i = 0; i < file_.size(mesh, "primitives"); ++i) read_primitive(file_.at(mesh, "primitives", i), entry->second);
    return entry->second;
  }

  void read_primitive(const Part& primitive, Shape& shape) {
    const std::uint64_t mode = file_.whole(primitive, "mode", 4);  // Triangles, a strip or a fan of them; the others are points and lines.
    if (mode < 4 || mode > 6 || !GltfFile::has(primitive, "attributes")) return;
    const Part attributes = file_.element(primitive, "attributes");
    if (!GltfFile::has(attributes, "POSITION")) return;
    const std::vector<double> places = file_.values(file_.whole(file_.element(attributes, "POSITION")), "VEC3");
    std::vector<double> corners;
    if (GltfFile::has(primitive, "indices"))
      corners = file_.values(file_.whole(file_.element(primitive, "indices")), "SCALAR");
    else
      for (std::size_t i = 0; i < places.size() / 3; ++i) corners.push_back(static_cast<double>(i));
    grow(places.size() / 3 + (mode == 4 ? 1 : 3) * corners.size());
    const auto first = static_cast<std::int64_t>(shape.vertices.size());
    for (std::size_t i = 0; i < places.size(); i += 3) shape.vertices.emplace_back(places[i], places[i + 1], places[i + 2]);
    const auto corner = [&](std::size_t i) {
      const bool inside = corners[i] >= 0.0 && corners[i] < static_cast<double>(places.size() / 3);
      return inside ? first + static_cast<std::int64_t>(corners[i]) : -1;
    };
    for (std::size_t i = 2; i < corners.size(); i += mode == 4 ? 3 : 1) {
      const bool odd = mode == 5 && i % 2 == 1;  // Every other triangle of a strip turns the other way.
      const std::size_t a = mode == 6 ? 0 : i - 2;
      shape.corners.insert(shape.corners.end(), {corner(odd ? i - 1 : a), corner(odd ? a : i - 1), corner(i)});
    }
  }

  GltfFile& file_;
  const std::string& name_;
  std::vector<bool> placed_;
  std::unordered_map<std::uint64_t, Shape> shapes_;
  Polygons out_;
  std::size_t held_ = 0, room_ = 1 << 20;
};

}  // namespace

SceneGraph parse_gltf(std::string_view bytes, const std::string& name) {
  GltfFile file(bytes, name);
  SceneGraph graph;
  graph.polygons = GltfScene(file, name).read();
  return graph;
}

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
// glTF and GLB by assimp. It believes counts and follows cycles, so those are looked at before.
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <nlohmann/json.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "vantage/base/error.h"
#include "vantage/io/polygons.h"
#include "vantage/io/text.h"

namespace vantage {
namespace {

constexpr int kDeepest = 200;  ///< Nested nodes.

[[noreturn]] void fail(const std::string& message, const std::string& name) { throw Error(ErrorCode::bad_input, message, name); }

using Transform = Eigen::Matrix<double, 3, 4>;

Transform to_eigen(const aiMatrix4x4& m) {
  Transform t;
  for (unsigned r = 0; r < 3; ++r)
    for (unsigned c = 0; c < 4; ++c) t(r, c) = static_cast<double>(m[r][c]);
  return t;
}

Transform multiply(const Transform& a, const Transform& b) {
  Transform t;
  t.leftCols<3>() = a.leftCols<3>() * b.leftCols<3>();
  t.col(3) = a.leftCols<3>() * b.col(3) + a.col(3);
  return t;
}

void append(const aiMesh& mesh, const Transform& transform, Polygons& out) {
  const auto first = static_cast<std::int64_t>(out.vertices.size());
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    const aiVector3D& v = mesh.mVertices[i];
    out.vertices.push_back(transform.leftCols<3>() * Vec<3>(v.x, v.y, v.z) + transform.col(3));
  }
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    for (unsigned k = 0; k < mesh.mFaces[f].mNumIndices; ++k) {
      const unsigned corner = mesh.mFaces[f].mIndices[k];
      out.corners.push_back(corner < mesh.mNumVertices ? first + corner : -1);
    }
    out.close_polygon();
  }
}

void append(const aiScene& scene, const aiNode& node, const Transform& parent, Polygons& out) {
  const Transform transform = multiply(parent, to_eigen(node.mTransformation));
  for (unsigned i = 0; i < node.mNumMeshes; ++i) append(*scene.mMeshes[node.mMeshes[i]], transform, out);
  for (unsigned i = 0; i < node.mNumChildren; ++i) append(scene, *node.mChildren[i], transform, out);
}

Polygons collect(const Assimp::Importer& importer, const aiScene* scene, const std::string& name) {
  if (!scene || !scene->mRootNode) fail(printable(importer.GetErrorString(), 200), name);
  Polygons polygons;
  append(*scene, *scene->mRootNode, Transform::Identity(), polygons);
  return polygons;
}

/// The JSON of a glTF file, or of a GLB's first chunk.
std::string_view json_part(std::string_view bytes, const std::string& name) {
  if (!bytes.starts_with("glTF")) return bytes;
  const auto u32 = [&](std::size_t at) {
    std::size_t value = 0;
    for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
  };
  if (bytes.size() < 20 || u32(8) > bytes.size() || u32(12) > bytes.size() - 20) fail("GLB header: lengths exceed the file, or cut short", name);
  return bytes.substr(20, u32(12));
}

void check_gltf(const nlohmann::json& json, std::size_t file_size, const std::string& name) {
  if (!json.is_object() || !json.contains("asset")) fail("not a glTF file: lacks 'asset'", name);
  double bytes = static_cast<double>(file_size);
  for (const auto& buffer : json.value("buffers", nlohmann::json::array())) bytes += buffer.value("byteLength", 0.0);
  for (const auto& accessor : json.value("accessors", nlohmann::json::array()))
    if (const double count = accessor.value("count", 0.0); !(count >= 0.0 && count <= bytes))
      fail(fmt::format("accessor count {} exceeds the file", count), name);
  for (const auto& mesh : json.value("meshes", nlohmann::json::array()))
    if (!mesh.value("primitives", nlohmann::json::array()).is_array()) fail("mesh primitives are not an array", name);
}

/// Depth-first over the nodes' children; throws for a cycle.
void check_gltf_nodes(const nlohmann::json& json, const std::string& name) {
  const auto nodes = json.value("nodes", nlohmann::json::array());
  std::vector<int> parents(nodes.size(), 0);
  for (const auto& node : nodes)
    for (const auto& child : node.value("children", nlohmann::json::array())) {
      const auto index = child.get<std::size_t>();
      if (index >= nodes.size()) fail(fmt::format("node child {}: must be 0 .. {}", index, nodes.size()), name);
      if (++parents[index] > 1) fail(fmt::format("node {} has two parents", index), name);
    }
  // With one parent at most, the nodes that no root reaches form cycles; one of them alone has no root.
  std::vector<std::pair<std::size_t, int>> open;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (parents[i] == 0) open.emplace_back(i, 0);
  std::size_t reached = 0;
  while (!open.empty()) {
    const auto [index, depth] = open.back();
    open.pop_back();
    ++reached;
    if (depth > kDeepest) fail(fmt::format("nodes nest deeper than {}", kDeepest), name);
    for (const auto& child : nodes[index].value("children", nlohmann::json::array())) open.emplace_back(child.get<std::size_t>(), depth + 1);
  }
  if (reached != nodes.size()) fail("nodes contain themselves", name);
}

}  // namespace

SceneGraph parse_gltf(std::string_view bytes, const std::string& name) {
  try {
    require_shallow_json(json_part(bytes, name), name);
    const nlohmann::json json = nlohmann::json::parse(json_part(bytes, name));
    check_gltf(json, bytes.size(), name);
    check_gltf_nodes(json, name);
  } catch (const nlohmann::json::exception& e) {
    fail(printable(e.what(), 200), name);
  }
  Assimp::Importer importer;
  SceneGraph graph;
  graph.polygons = collect(importer, importer.ReadFile(name, 0), name);
  return graph;
}

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/glb.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "vantage/io/bytes.h"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;
using Vec3f = Eigen::Vector3f;

constexpr int kFloat = 5126, kUnsignedByte = 5121;
constexpr int kPoints = 0, kLines = 1, kLineStrip = 3, kTriangles = 4;

struct Primitive {
  int mode = kPoints;
  int material = 0;
  std::vector<Vec3f> positions, normals;
};

template <int Dim>
Vec<3> in_space(const Vec<Dim>& p) {
  Vec<3> q = Vec<3>::Zero();
  q.head<Dim>() = p;
  return q;
}

/// Heights from low to high: slate, teal, sand, brick.
std::array<std::uint8_t, 4> color_of(double height) {
  constexpr double kStops[4][3] = {{62, 78, 104}, {66, 139, 138}, {222, 196, 140}, {190, 94, 70}};
  const double t = std::clamp(height, 0.0, 1.0) * 3.0;
  const int i = std::min(static_cast<int>(t), 2);
  std::array<std::uint8_t, 4> color{0, 0, 0, 255};
  for (std::size_t k = 0; k < 3; ++k) color[k] = static_cast<std::uint8_t>(kStops[i][k] + (t - i) * (kStops[i + 1][k] - kStops[i][k]) + 0.5);
  return color;
}

/// Collects accessors over one buffer.
class Buffer {
 public:
  int add(const std::vector<Vec3f>& vectors, bool with_bounds) {
    const int accessor = begin(vectors.size(), kFloat, "VEC3");
    Vec3f low = Vec3f::Constant(std::numeric_limits<float>::infinity()), high = -low;
    for (const Vec3f& v : vectors) {
      for (int a = 0; a < 3; ++a) put<float>(bytes, v[a]);
      low = low.cwiseMin(v);
      high = high.cwiseMax(v);
    }
    end();
    if (with_bounds) accessors.back().update({{"min", {low[0], low[1], low[2]}}, {"max", {high[0], high[1], high[2]}}});
    return accessor;
  }
  int add(const std::vector<std::array<std::uint8_t, 4>>& colors) {
    const int accessor = begin(colors.size(), kUnsignedByte, "VEC4");
    accessors.back()["normalized"] = true;
    for (const auto& color : colors)
      for (const std::uint8_t c : color) put(bytes, c);
    end();
    return accessor;
  }

  std::string bytes;
  Json accessors = Json::array(), views = Json::array();

 private:
  int begin(std::size_t count, int component, const char* type) {
    accessors.push_back({{"bufferView", views.size()}, {"componentType", component}, {"count", count}, {"type", type}});
    views.push_back({{"buffer", 0}, {"byteOffset", bytes.size()}});
    return static_cast<int>(accessors.size()) - 1;
  }
  void end() { views.back()["byteLength"] = bytes.size() - views.back()["byteOffset"].get<std::size_t>(); }
};

Json material(const char* name, std::array<double, 3> color) {
  return {{"name", name},
          {"doubleSided", true},
          {"pbrMetallicRoughness", {{"baseColorFactor", {color[0], color[1], color[2], 1.0}}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.9}}}};
}

void add_polygon(Primitive& triangles, std::span<const Vec3f> corners) {
  Vec3f normal = Vec3f::Zero();
  for (std::size_t k = 2; k < corners.size(); ++k) normal += (corners[k - 1] - corners[0]).cross(corners[k] - corners[0]);
  const float length = normal.norm();
  normal = length > 0.0F ? Vec3f(normal / length) : Vec3f::UnitZ();
  for (std::size_t k = 2; k < corners.size(); ++k)
    for (const std::size_t c : {std::size_t{0}, k - 1, k}) {
      triangles.positions.push_back(corners[c]);
      triangles.normals.push_back(normal);
    }
}

Json write_primitive(const Primitive& primitive, Buffer& buffer, float low, float high) {
  Json attributes = {{"POSITION", buffer.add(primitive.positions, true)}};
  if (!primitive.normals.empty()) attributes["NORMAL"] = buffer.add(primitive.normals, false);
  if (primitive.mode != kLineStrip) {
    std::vector<std::array<std::uint8_t, 4>> colors;
    for (const Vec3f& p : primitive.positions) colors.push_back(color_of(static_cast<double>((p[2] - low) / std::max(high - low, 1e-6F))));
    attributes["COLOR_0"] = buffer.add(colors);
  }
  return {{"attributes", attributes}, {"mode", primitive.mode}, {"material", primitive.material}};
}

std::string pack(const Json& json, std::string binary) {
  std::string text = json.dump();
  text.append((4 - text.size() % 4) % 4, ' ');
  binary.append((4 - binary.size() % 4) % 4, '\0');
  std::string out = "glTF";
  put<std::uint32_t>(out, 2);
  put<std::uint32_t>(out, static_cast<std::uint32_t>(12 + 8 + text.size() + (binary.empty() ? 0 : 8 + binary.size())));
  put<std::uint32_t>(out, static_cast<std::uint32_t>(text.size()));
  out += "JSON" + text;
  if (binary.empty()) return out;
  put<std::uint32_t>(out, static_cast<std::uint32_t>(binary.size()));
  return out + std::string("BIN\0", 4) + binary;
}

}  // namespace

template <int Dim>
std::string surface_as_glb(std::span<const Patch<Dim>> patches, std::span<const Vec<Dim>> path) {
  Box<3> box;
  for (const Patch<Dim>& patch : patches)
    for (const Vec<Dim>& corner : patch.corners()) box.extend(in_space<Dim>(corner));
  for (const Vec<Dim>& p : path) box.extend(in_space<Dim>(p));
  const Vec<3> center = box.empty() ? Vec<3>::Zero().eval() : box.center();
  const auto local = [&](const Vec<Dim>& p) { return Vec3f((in_space<Dim>(p) - center).template cast<float>()); };

  Primitive by_rank[4] = {{kPoints, 0, {}, {}}, {kLines, 0, {}, {}}, {kTriangles, 0, {}, {}}, {kLineStrip, 1, {}, {}}};
  for (const Patch<Dim>& patch : patches) {
    std::vector<Vec3f> corners;
    for (const Vec<Dim>& corner : patch.corners()) corners.push_back(local(corner));
    Primitive& primitive = by_rank[patch.rank()];
    if (patch.rank() == 2)
      add_polygon(primitive, corners);
    else
      primitive.positions.insert(primitive.positions.end(), corners.begin(), corners.end());
  }
  for (const Vec<Dim>& p : path) by_rank[3].positions.push_back(local(p));

  Buffer buffer;
  Json primitives = Json::array();
  const float half_height = box.empty() ? 0.0F : static_cast<float>(0.5 * box.size()[2]);
  for (const Primitive& primitive : by_rank)
    if (primitive.positions.size() > static_cast<std::size_t>(primitive.mode == kLineStrip))
      primitives.push_back(write_primitive(primitive, buffer, -half_height, half_height));
  // A quarter turn about x brings z up; glTF's own up axis is y.
  Json node = {
      {"name", "surface"}, {"rotation", {-0.7071067811865476, 0.0, 0.0, 0.7071067811865476}}, {"translation", {center[0], center[2], -center[1]}}};
  Json json = {{"asset", {{"version", "2.0"}, {"generator", "vantage"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};
  if (!primitives.empty()) {
    node["mesh"] = 0;
    json["meshes"] = Json::array({{{"primitives", primitives}}});
    json["materials"] = Json::array({material("surface", {1.0, 1.0, 1.0}), material("path", {0.95, 0.55, 0.1})});
    json["accessors"] = buffer.accessors;
    json["bufferViews"] = buffer.views;
    json["buffers"] = Json::array({{{"byteLength", (buffer.bytes.size() + 3) / 4 * 4}}});
  }
  json["nodes"] = Json::array({node});
  return pack(json, std::move(buffer.bytes));
}

template std::string surface_as_glb<2>(std::span<const Patch<2>>, std::span<const Vec<2>>);
template std::string surface_as_glb<3>(std::span<const Patch<3>>, std::span<const Vec<3>>);

}  // namespace vantage

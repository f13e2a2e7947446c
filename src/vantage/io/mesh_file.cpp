// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/mesh_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstring>
#include <iterator>

#include <Eigen/Geometry>

#include "vantage/base/error.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/polygons.h"

namespace vantage {
namespace {

static_assert(std::endian::native == std::endian::little, "binary files are written as they lie in memory");

struct Parser {
  std::string_view extension;
  SceneGraph (*parse)(std::string_view bytes, const std::string& name, double detail);
};

template <Polygons (*parse)(std::string_view, const std::string&)>
SceneGraph plain(std::string_view bytes, const std::string& name, double) {
  return {parse(bytes, name), 'z', 1.0};  // These formats state neither.
}

template <SceneGraph (*parse)(std::string_view, const std::string&)>
SceneGraph nodes(std::string_view bytes, const std::string& name, double) {
  return parse(bytes, name);
}

constexpr std::array<Parser, 9> kParsers{{{".obj", plain<parse_obj>},
                                          {".ply", plain<parse_ply>},
                                          {".stl", plain<parse_stl>},
                                          {".off", plain<parse_off>},
                                          {".dae", nodes<parse_collada>},
                                          {".gltf", nodes<parse_gltf>},
                                          {".glb", nodes<parse_gltf>},
                                          {".json", parse_cityjson},
                                          {".gml", parse_citygml}}};

std::string extension_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

const Parser* find_parser(const std::filesystem::path& path) {
  const auto found = std::find_if(kParsers.begin(), kParsers.end(), [&](const Parser& p) { return p.extension == extension_of(path); });
  return found == kParsers.end() ? nullptr : &*found;
}

/// Rotation that brings the axis `up` to z.
Eigen::Matrix3d upright(char up) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  if (up == 'y') m << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  if (up == 'x') m << 0, -1, 0, 0, 0, -1, 1, 0, 0;  // By way of y up, as COLLADA lays its axes.
  return m;
}

template <class T>
void append(std::string& out, const T& value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

Vec<3> in_space(const Vec<2>& p) { return {p[0], p[1], 0.0}; }
Vec<3> in_space(const Vec<3>& p) { return p; }

void append_ply_facet(std::string& out, const Mesh<2>::Facet& f) { append(out, f); }
void append_ply_facet(std::string& out, const Mesh<3>::Facet& f) {
  append(out, std::uint8_t{3});
  append(out, f);
}
std::string_view ply_facets(const Mesh<2>&) { return "element edge {}\nproperty uint vertex1\nproperty uint vertex2\n"; }
std::string_view ply_facets(const Mesh<3>&) { return "element face {}\nproperty list uchar uint vertex_indices\n"; }
char obj_facet(const Mesh<2>&) { return 'l'; }
char obj_facet(const Mesh<3>&) { return 'f'; }

template <int Dim>
std::string ply_bytes(const Mesh<Dim>& mesh) {
  std::string out = fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n",
                                mesh.vertices.size());
  out += fmt::format(fmt::runtime(ply_facets(mesh)), mesh.facets.size()) + "end_header\n";
  for (const Vec<Dim>& v : mesh.vertices) append(out, std::array<double, 3>{in_space(v)[0], in_space(v)[1], in_space(v)[2]});
  for (const auto& facet : mesh.facets) append_ply_facet(out, facet);
  return out;
}

template <int Dim>
std::string obj_bytes(const Mesh<Dim>& mesh) {
  std::string out;
  for (const Vec<Dim>& v : mesh.vertices) fmt::format_to(std::back_inserter(out), "v {} {} {}\n", in_space(v)[0], in_space(v)[1], in_space(v)[2]);
  for (const auto& facet : mesh.facets) {
    out += obj_facet(mesh);
    for (const std::uint32_t v : facet) fmt::format_to(std::back_inserter(out), " {}", v + 1);
    out += '\n';
  }
  return out;
}

std::string stl_bytes(const Mesh<2>&, const std::string& name) {
  throw Error(ErrorCode::bad_input, "STL holds triangles only: must be .ply or .obj for a plane scene", name);
}
std::string stl_bytes(const Mesh<3>& mesh, const std::string&) {
  std::string out(80, ' ');
  append(out, static_cast<std::uint32_t>(mesh.facets.size()));
  for (const auto& f : mesh.facets) {
    const Vec<3>&a = mesh.vertices[f[0]], &b = mesh.vertices[f[1]], &c = mesh.vertices[f[2]];
    const Vec<3> cross = (b - a).cross(c - a);
    const Vec<3> normal = cross.norm() > 0.0 ? Vec<3>(cross.normalized()) : Vec<3>(Vec<3>::Zero());
    for (const Vec<3>& v : {normal, a, b, c})
      for (int k = 0; k < 3; ++k) append(out, static_cast<float>(v[k]));
    append(out, std::uint16_t{0});
  }
  return out;
}

}  // namespace

double chosen_detail(std::span<const double> present, double detail) {
  const double least = *std::min_element(present.begin(), present.end());
  double best = least;
  for (const double level : present)
    if (detail < 0.0 || level <= detail) best = std::max(best, level);
  return best;
}

bool is_mesh_file(const std::filesystem::path& path) { return find_parser(path) != nullptr; }

std::string mesh_extensions() {
  std::string all;
  for (const Parser& parser : kParsers) all.append(all.empty() ? "" : ", ").append(parser.extension);
  return all;
}

Mesh<3> read_mesh(const std::filesystem::path& path, const MeshFileOptions& options) { return parse_mesh(read_file(path), path, options); }

Mesh<3> parse_mesh(std::string_view bytes, const std::filesystem::path& path, const MeshFileOptions& options) {
  const std::string name = path.string();
  const Parser* parser = find_parser(path);
  require(parser, fmt::format("not a mesh file: its name must end in {}", mesh_extensions()), name);
  require(!bytes.empty(), "is empty", name);
  require(options.unit == 0.0 || (options.unit > 0.0 && options.unit < 1e9), fmt::format("unit = {}: must be > 0 [m]", options.unit));
  SceneGraph graph = parser->parse(bytes, name, options.detail);
  using Up = MeshFileOptions::Up;
  const char up = options.up == Up::y ? 'y' : options.up == Up::z ? 'z' : graph.up;
  const Eigen::Matrix3d placed = upright(up) * (options.unit > 0.0 ? options.unit : graph.unit);
  if (!placed.isIdentity(0.0))
    for (Vec<3>& v : graph.polygons.vertices) v = placed * v;
  return triangles(graph.polygons, name);
}

template <int Dim>
void write_mesh(const std::filesystem::path& path, const Mesh<Dim>& mesh) {
  const std::string extension = extension_of(path);
  require(extension == ".ply" || extension == ".obj" || extension == ".stl", "cannot write such a mesh: the name must end in .ply, .obj or .stl",
          path.string());
  write_file(path, extension == ".ply" ? ply_bytes(mesh) : extension == ".obj" ? obj_bytes(mesh) : stl_bytes(mesh, path.string()));
}

template void write_mesh<2>(const std::filesystem::path&, const Mesh<2>&);
template void write_mesh<3>(const std::filesystem::path&, const Mesh<3>&);

}  // namespace vantage

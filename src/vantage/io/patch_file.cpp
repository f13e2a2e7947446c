// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/patch_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "vantage/base/error.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/bytes.h"
#include "vantage/io/ply_file.h"

namespace vantage {
namespace {

constexpr std::string_view kPlaneComment = "dim 2";
constexpr const char* kErrorProperties = "property float data_to_surface\nproperty float surface_to_data\n";

template <int Dim>
void put_corners(std::string& out, const Patch<Dim>& patch) {
  for (const Vec<Dim>& corner : patch.corners())
    for (int a = 0; a < 3; ++a) put<double>(out, a < Dim ? corner[a] : 0.0);
}

template <int Dim>
void put_indices(std::string& out, const Patch<Dim>& patch, std::int32_t first) {
  if (patch.rank() == 2) put<std::uint8_t>(out, static_cast<std::uint8_t>(patch.count));
  for (std::int32_t k = 0; k < patch.count; ++k) put<std::int32_t>(out, first + k);
  put<float>(out, patch.data_to_surface);
  put<float>(out, patch.surface_to_data);
}

float error_at(const Ply::Element& element, std::string_view name, std::size_t row) {
  const Ply::Property* property = element.find(name);
  return property == nullptr || property->count_type ? 0.0F : static_cast<float>(property->values[row]);
}

/// Builds patches out of the vertices of one file.
template <int Dim>
class PatchReader {
 public:
  PatchReader(const Ply& ply, std::string_view where) : where_(where) {
    const Ply::Element* vertex = ply.find("vertex");
    const Ply::Property* axes[3] = {vertex->find("x"), vertex->find("y"), vertex->find("z")};
    for (std::size_t i = 0; i < vertex->count; ++i) {
      Vec<Dim> corner;
      for (int a = 0; a < Dim; ++a) corner[a] = axes[a]->values[i];
      vertices_.push_back(corner);
    }
    used_.resize(vertices_.size(), false);
  }

  void add_faces(const Ply::Element& faces) {
    const Ply::Property* list = faces.find("vertex_indices");
    if (list == nullptr) list = faces.find("vertex_index");
    require(list != nullptr && list->count_type, "faces without the list vertex_indices", where_);
    for (std::size_t i = 0; i < faces.count; ++i)
      add(faces, i, {list->values.data() + list->row_start[i], list->row_start[i + 1] - list->row_start[i]}, 3);
  }
  void add_edges(const Ply::Element& edges) {
    const Ply::Property *a = edges.find("vertex1"), *b = edges.find("vertex2");
    require(a != nullptr && b != nullptr && !a->count_type && !b->count_type, "edges without vertex1 and vertex2", where_);
    for (std::size_t i = 0; i < edges.count; ++i) {
      const double ends[] = {a->values[i], b->values[i]};
      add(edges, i, ends, 2);
    }
  }
  /// Points with errors of their own; other files may call something else a point.
  void add_points(const Ply::Element& points) {
    const Ply::Property* vertex = points.find("vertex");
    if (vertex == nullptr || vertex->count_type) return;
    for (std::size_t i = 0; i < points.count; ++i) add(points, i, {&vertex->values[i], 1}, 1);
  }
  /// Vertices that belong to nothing else stand for themselves.
  void add_other_points() {
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      if (used_[i]) continue;
      require(vertices_[i].allFinite(), fmt::format("vertex {}: coordinates must be finite", i), where_);
      patches_.push_back(point_patch<Dim>(vertices_[i]));
    }
  }
  [[nodiscard]] std::vector<Patch<Dim>> take() { return std::move(patches_); }

 private:
  void add(const Ply::Element& element, std::size_t row, std::span<const double> indices, std::size_t fewest) {
    const std::string name = fmt::format("{} {}", element.name, row);
    require(indices.size() >= fewest && indices.size() <= Patch<Dim>::kMaxVertices,
            fmt::format("{}: {} corners: must be {} .. {}", name, indices.size(), fewest, static_cast<int>(Patch<Dim>::kMaxVertices)), where_);
    Patch<Dim> patch;
    for (const double index : indices) {
      require(index >= 0.0 && index < static_cast<double>(vertices_.size()), fmt::format("{}: vertex {} of {}", name, index, vertices_.size()),
              where_);
      const auto i = static_cast<std::size_t>(index);
      require(vertices_[i].allFinite(), fmt::format("vertex {}: coordinates must be finite", i), where_);
      used_[i] = true;
      patch.vertices[static_cast<std::size_t>(patch.count++)] = vertices_[i];
    }
    patch.data_to_surface = error_at(element, "data_to_surface", row);
    patch.surface_to_data = error_at(element, "surface_to_data", row);
    patches_.push_back(patch);
  }

  std::string_view where_;
  std::vector<Vec<Dim>> vertices_;
  std::vector<bool> used_;
  std::vector<Patch<Dim>> patches_;
};

template <int Dim>
std::vector<Patch<Dim>> patches_of(const Ply& ply, std::string_view where) {
  PatchReader<Dim> reader(ply, where);
  if (const Ply::Element* faces = ply.find("face")) {
    require(Patch<Dim>::kMaxVertices > 2 || faces->count == 0, "faces in a plane file", where);
    if (faces->count > 0) reader.add_faces(*faces);
  }
  if (const Ply::Element* edges = ply.find("edge"); edges != nullptr && edges->count > 0) reader.add_edges(*edges);
  if (const Ply::Element* points = ply.find("point"); points != nullptr) reader.add_points(*points);
  reader.add_other_points();
  return reader.take();
}

bool is_axis(const Ply::Property* property) { return property != nullptr && !property->count_type; }

}  // namespace

template <int Dim>
std::string patches_as_ply(std::span<const Patch<Dim>> patches) {
  std::string vertices, by_rank[3];
  std::size_t counts[3] = {0, 0, 0};
  std::int32_t next = 0;
  for (const Patch<Dim>& patch : patches) {
    put_corners(vertices, patch);
    put_indices(by_rank[patch.rank()], patch, next);
    ++counts[patch.rank()];
    next += patch.count;
  }
  std::string out = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment dim {}\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n", Dim,
      next);
  out += fmt::format("element face {}\nproperty list uchar int vertex_indices\n{}", counts[2], kErrorProperties);
  out += fmt::format("element edge {}\nproperty int vertex1\nproperty int vertex2\n{}", counts[1], kErrorProperties);
  out += fmt::format("element point {}\nproperty int vertex\n{}end_header\n", counts[0], kErrorProperties);
  return out + vertices + by_rank[2] + by_rank[1] + by_rank[0];
}

AnyPatches parse_patches(std::string_view bytes, std::string_view where) {
  const Ply ply = parse_ply_columns(bytes, where, [](std::string_view, std::string_view) { return true; });
  const Ply::Element* vertex = ply.find("vertex");
  require(vertex != nullptr && is_axis(vertex->find("x")) && is_axis(vertex->find("y")), "no vertices with x and y", where);
  const bool plane = std::find(ply.comments.begin(), ply.comments.end(), kPlaneComment) != ply.comments.end();
  if (plane) return patches_of<2>(ply, where);
  require(is_axis(vertex->find("z")), "vertices without z", where);
  return patches_of<3>(ply, where);
}

AnyPatches read_patches(const std::filesystem::path& path) { return parse_patches(read_file(path), path.string()); }

template std::string patches_as_ply<2>(std::span<const Patch<2>>);
template std::string patches_as_ply<3>(std::span<const Patch<3>>);

}  // namespace vantage

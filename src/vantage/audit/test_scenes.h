// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "vantage/geometry/mesh.h"

namespace vantage::test {

/// Appends the parallelepiped face with corner `at` and edges `edges`, as one segment or two triangles.
inline void add_face(Mesh<2>& mesh, const Vec<2>& at, const std::vector<Vec<2>>& edges) {
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {at, at + edges[0]});
  mesh.facets.push_back({n, n + 1});
}
inline void add_face(Mesh<3>& mesh, const Vec<3>& at, const std::vector<Vec<3>>& edges) {
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {at, at + edges[0], at + edges[0] + edges[1], at + edges[1]});
  mesh.facets.insert(mesh.facets.end(), {{n, n + 1, n + 2}, {n, n + 2, n + 3}});
}

/// The side of a box whose outward normal is along `axis`, at its low or high end.
template <int Dim>
void add_side(Mesh<Dim>& mesh, const Box<Dim>& box, int axis, bool high) {
  std::vector<Vec<Dim>> edges;
  for (int a = 0; a < Dim; ++a)
    if (a != axis) edges.push_back(box.size()[a] * Vec<Dim>::Unit(a));
  add_face(mesh, high ? Vec<Dim>(box.low + box.size()[axis] * Vec<Dim>::Unit(axis)) : box.low, edges);
}

template <int Dim>
void add_box(Mesh<Dim>& mesh, const Box<Dim>& box) {
  for (int a = 0; a < Dim; ++a)
    for (const bool high : {false, true}) add_side(mesh, box, a, high);
}

template <int Dim>
Box<Dim> cube(double low, double high) {
  return {Vec<Dim>::Constant(low), Vec<Dim>::Constant(high)};
}

/// The place (x, y), at height 4 in 3D.
template <int Dim>
Vec<Dim> place(double x, double y) {
  Vec<Dim> p = Vec<Dim>::Constant(4.0);
  p[0] = x;
  p[1] = y;
  return p;
}

/// Two rooms, side 0.3 .. 7.7, with a thin wall at x = 4.1 between them that leaves open what lies above y = `gap`.
template <int Dim>
Mesh<Dim> two_rooms(double gap) {
  Mesh<Dim> mesh;
  Box<Dim> room = cube<Dim>(0.3, 7.7);
  add_box(mesh, room);
  room.low[0] = 4.1;
  room.high[1] = gap;
  add_side(mesh, room, 0, false);
  return mesh;
}

/// Boxes of size 1.3 at every third metre of a square of size 9, floating in 3D.
template <int Dim>
Mesh<Dim> pillars() {
  Mesh<Dim> mesh;
  for (const double x : {1.1, 4.2, 7.1}) {
    for (const double y : {0.9, 3.8, 7.2}) {
      Box<Dim> box = cube<Dim>(1.0, 2.3);
      box.low[0] = x, box.low[1] = y;
      box.high[0] = x + 1.3, box.high[1] = y + 1.3;
      add_box(mesh, box);
    }
  }
  return mesh;
}

}  // namespace vantage::test

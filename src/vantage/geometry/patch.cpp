// SPDX-License-Identifier: Apache-2.0
#include "vantage/geometry/patch.h"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

/// Nearest place of the triangle abc to p, with inner products only (after Ericson, Real-Time Collision Detection, 5.1.5).
template <int Dim>
Vec<Dim> closest_on_triangle(const Vec<Dim>& a, const Vec<Dim>& b, const Vec<Dim>& c, const Vec<Dim>& p) {
  const Vec<Dim> ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  const Vec<Dim> bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + d1 / (d1 - d3) * ab;
  const Vec<Dim> cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  const double sum = va + vb + vc;
  if (!(sum > 0.0)) return a;  // A sliver: its edges were tried above.
  return a + vb / sum * ab + vc / sum * ac;
}

template <int Dim>
Vec<Dim> closest_on_segment(const Vec<Dim>& a, const Vec<Dim>& b, const Vec<Dim>& p) {
  const Vec<Dim> ab = b - a;
  const double length2 = ab.squaredNorm();
  return length2 > 0.0 ? Vec<Dim>(a + std::clamp(ab.dot(p - a) / length2, 0.0, 1.0) * ab) : a;
}

/// Parameters of the nearest places of `p + s u` (0 <= s <= s_max) and `q + t v` (0 <= t <= 1).
template <int Dim>
std::array<double, 2> nearest_parameters(const Vec<Dim>& p, const Vec<Dim>& u, double s_max, const Vec<Dim>& q, const Vec<Dim>& v) {
  const Vec<Dim> r = p - q;
  const double a = u.squaredNorm(), e = v.squaredNorm(), f = v.dot(r);
  if (!(a > 0.0)) return {0.0, e > 0.0 ? std::clamp(f / e, 0.0, 1.0) : 0.0};
  const double c = u.dot(r);
  if (!(e > 0.0)) return {std::clamp(-c / a, 0.0, s_max), 0.0};
  const double b = u.dot(v), denominator = a * e - b * b;
  double s = denominator > 1e-14 * a * e ? std::clamp((b * f - c * e) / denominator, 0.0, s_max) : 0.0;
  double t = (b * s + f) / e;
  if (t < 0.0 || t > 1.0) {
    t = std::clamp(t, 0.0, 1.0);
    s = std::clamp((b * t - c) / a, 0.0, s_max);
  }
  return {s, t};
}

template <int Dim>
double segment_distance(const Vec<Dim>& a, const Vec<Dim>& b, const Vec<Dim>& c, const Vec<Dim>& d) {
  const auto [s, t] = nearest_parameters<Dim>(a, b - a, 1.0, c, d - c);
  return (a + s * (b - a) - c - t * (d - c)).norm();
}

}  // namespace

template <int Dim>
Patch<Dim> point_patch(const Vec<Dim>& p) {
  Patch<Dim> patch;
  patch.vertices[0] = p;
  patch.count = 1;
  return patch;
}

template <int Dim>
Patch<Dim> segment_patch(const Vec<Dim>& a, const Vec<Dim>& b) {
  Patch<Dim> patch;
  patch.vertices[0] = a;
  patch.vertices[1] = b;
  patch.count = 2;
  return patch;
}

template <int Dim>
double measure(const Patch<Dim>& patch) {
  if (patch.count < Dim) return 0.0;
  const auto& v = patch.vertices;
  if (patch.count == 2) return (v[1] - v[0]).norm();
  double area = 0.0;
  for (int i = 1; i + 1 < patch.count; ++i) {
    const Vec<Dim> ab = v[i] - v[0], ac = v[i + 1] - v[0];
    area += 0.5 * std::sqrt(std::max(0.0, ab.squaredNorm() * ac.squaredNorm() - ab.dot(ac) * ab.dot(ac)));
  }
  return area;
}

template <int Dim>
Vec<Dim> normal(const Patch<Dim>& patch) {
  // The axis that sticks out most from the patch's span, made perpendicular to it.
  Eigen::Matrix<double, Dim, 2> basis = Eigen::Matrix<double, Dim, 2>::Zero();
  const auto& v = patch.vertices;
  if (patch.count >= 2) {
    for (int i = 1; i < patch.count; ++i)
      if ((v[i] - v[0]).squaredNorm() > basis.col(0).squaredNorm()) basis.col(0) = v[i] - v[0];
    if (basis.col(0).squaredNorm() > 0.0) basis.col(0).normalize();
    for (int i = 1; i < patch.count && patch.count >= 3; ++i) {
      const Vec<Dim> e = v[i] - v[0];
      const Vec<Dim> rest = e - basis.col(0) * basis.col(0).dot(e);
      if (rest.squaredNorm() > basis.col(1).squaredNorm()) basis.col(1) = rest;
    }
    if (basis.col(1).squaredNorm() > 0.0) basis.col(1).normalize();
  }
  Vec<Dim> best = Vec<Dim>::Zero();
  for (int axis = 0; axis < Dim; ++axis) {
    Vec<Dim> n = Vec<Dim>::Unit(axis);
    n -= basis * (basis.transpose() * n);
    if (n.squaredNorm() > best.squaredNorm() + 1e-12) best = n;
  }
  return best.normalized();
}

template <int Dim>
Vec<Dim> closest_point(const Patch<Dim>& patch, const Vec<Dim>& p) {
  const auto& v = patch.vertices;
  if (patch.count <= 1) return v[0];
  if (patch.count == 2) return closest_on_segment<Dim>(v[0], v[1], p);
  Vec<Dim> best = v[0];
  for (int i = 1; i + 1 < patch.count; ++i) {
    const Vec<Dim> q = closest_on_triangle<Dim>(v[0], v[i], v[i + 1], p);
    if ((q - p).squaredNorm() < (best - p).squaredNorm()) best = q;
  }
  return best;
}

template <int Dim>
double distance_to_segment(const Patch<Dim>& patch, const Vec<Dim>& a, const Vec<Dim>& b) {
  const auto& v = patch.vertices;
  double best = std::min(distance(patch, a), distance(patch, b));
  for (int i = 0; i < patch.count; ++i) best = std::min(best, segment_distance<Dim>(a, b, v[i], v[(i + 1) % patch.count]));
  if (patch.count >= 3) {
    const double length = (b - a).norm();
    if (length > 0.0)
      if (const auto range = ray_range<Dim>(patch, a, (b - a) / length, 0.0); range && *range <= length) return 0.0;
  }
  return best;
}

template <int Dim>
std::optional<double> ray_range(const Patch<Dim>& patch, const Vec<Dim>& origin, const Vec<Dim>& direction, double margin) {
  const auto& v = patch.vertices;
  if (patch.count >= 3) {
    const Vec<Dim> n = normal(patch);
    const double slope = n.dot(direction), height = n.dot(v[0] - origin);
    if (slope == 0.0) return std::nullopt;
    const double t = height / slope;
    if (!(t >= 0.0)) return std::nullopt;
    const Vec<Dim> q = origin + t * direction;
    if (distance(patch, q) <= margin + 1e-9 * (1.0 + t)) return t;
    return std::nullopt;
  }
  const Vec<Dim> along = patch.count == 2 ? Vec<Dim>(v[1] - v[0]) : Vec<Dim>(Vec<Dim>::Zero());
  const auto [s, t] = nearest_parameters<Dim>(origin, direction, kInfinity, v[0], along);
  if ((origin + s * direction - v[0] - t * along).norm() <= margin + 1e-12 * (1.0 + s)) return s;
  return std::nullopt;
}

#define VANTAGE_INSTANTIATE(D)                                                           \
  template Patch<D> point_patch<D>(const Vec<D>&);                                       \
  template Patch<D> segment_patch<D>(const Vec<D>&, const Vec<D>&);                      \
  template double measure<D>(const Patch<D>&);                                           \
  template Vec<D> normal<D>(const Patch<D>&);                                            \
  template Vec<D> closest_point<D>(const Patch<D>&, const Vec<D>&);                      \
  template double distance_to_segment<D>(const Patch<D>&, const Vec<D>&, const Vec<D>&); \
  template std::optional<double> ray_range<D>(const Patch<D>&, const Vec<D>&, const Vec<D>&, double);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#include "vantage/report/raster.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>

namespace vantage {

namespace {

/// Twice the signed area of a, b, (x, y).
double side(const Projected& a, const Projected& b, double x, double y) { return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x); }

/// Samples whose centres lie in [low, high], cut to [0, count).
std::pair<int, int> covered(double low, double high, int count) {
  const double first = std::max(std::ceil(low - 0.5), 0.0);
  const double last = std::min(std::floor(high - 0.5), count - 1.0);
  return last < first ? std::pair(0, -1) : std::pair(static_cast<int>(first), static_cast<int>(last));
}

}  // namespace

Raster::Raster(const Camera& camera)
    : camera_(camera),
      width_(kSamples * camera.width()),
      height_(kSamples * camera.height()),
      cells_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), kEmpty) {}

float Raster::distance(int x, int y) const { return std::bit_cast<float>(static_cast<std::uint32_t>(at(x, y) >> 32)); }

Rgb Raster::colour(int x, int y) const {
  const std::uint64_t cell = at(x, y);
  return {static_cast<std::uint8_t>(cell >> 16), static_cast<std::uint8_t>(cell >> 8), static_cast<std::uint8_t>(cell)};
}

Projected Raster::sample(const Vec<3>& p) const {
  const Projected q = camera_.project(p);
  return {q.x * kSamples, q.y * kSamples, q.depth};
}

void Raster::put(int x, int y, double depth, Rgb colour) {
  // Bits of positive floats are ordered like their values, so the least key is the nearest surface, whoever comes first.
  const auto distance = static_cast<float>(std::max(camera_.distance(depth), 0.0));
  const std::uint64_t key = static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(distance)) << 32 | static_cast<std::uint64_t>(colour.r) << 16 |
                            static_cast<std::uint64_t>(colour.g) << 8 | colour.b;
  std::atomic_ref<std::uint64_t> cell(cells_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)]);
  std::uint64_t held = cell.load(std::memory_order_relaxed);
  while (key < held && !cell.compare_exchange_weak(held, key, std::memory_order_relaxed)) {
  }
}

void Raster::point(const Vec<3>& p, double radius, Rgb colour) {
  if (!camera_.in_front(p)) return;
  const Projected q = sample(p);
  const double reach = std::max(radius * kSamples, 0.71);
  const auto [x0, x1] = covered(q.x - reach, q.x + reach, width_);
  const auto [y0, y1] = covered(q.y - reach, q.y + reach, height_);
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const double dx = x + 0.5 - q.x, dy = y + 0.5 - q.y;
      if (dx * dx + dy * dy <= reach * reach) put(x, y, q.depth, colour);
    }
  }
}

void Raster::segment(const Vec<3>& a, const Vec<3>& b, double width, Rgb colour) {
  if (!camera_.in_front(a) || !camera_.in_front(b)) return;
  const Projected p = sample(a), q = sample(b);
  const double length = std::sqrt((q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y));
  const double reach = std::max(0.5 * width * kSamples, 0.71);
  const double along_x = length > 0.0 ? (q.x - p.x) / length * reach : reach, along_y = length > 0.0 ? (q.y - p.y) / length * reach : 0.0;
  const Projected p0{p.x - along_y, p.y + along_x, p.depth}, p1{p.x + along_y, p.y - along_x, p.depth};
  const Projected q0{q.x - along_y, q.y + along_x, q.depth}, q1{q.x + along_y, q.y - along_x, q.depth};
  triangle(p0, p1, q0, colour);
  triangle(p1, q1, q0, colour);
  point(a, 0.5 * width, colour);
  point(b, 0.5 * width, colour);
}

void Raster::polygon(std::span<const Vec<3>> corners, Rgb colour) {
  if (corners.size() < 3 || !std::all_of(corners.begin(), corners.end(), [this](const Vec<3>& p) { return camera_.in_front(p); })) return;
  const Projected first = sample(corners[0]);
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) triangle(first, sample(corners[k]), sample(corners[k + 1]), colour);
  Vec<3> centre = Vec<3>::Zero();
  for (const Vec<3>& p : corners) centre += p;
  const Projected q = sample(centre / static_cast<double>(corners.size()));
  if (q.x >= 0.0 && q.y >= 0.0 && q.x < width_ && q.y < height_) put(static_cast<int>(q.x), static_cast<int>(q.y), q.depth, colour);
}

void Raster::triangle(const Projected& a, const Projected& b, const Projected& c, Rgb colour) {
  const double area = side(a, b, c.x, c.y);
  if (!(std::abs(area) > 1e-12)) return;
  const auto [x0, x1] = covered(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), width_);
  const auto [y0, y1] = covered(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}), height_);
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const double u = side(b, c, x + 0.5, y + 0.5) / area, v = side(c, a, x + 0.5, y + 0.5) / area, w = 1.0 - u - v;
      if (u >= 0.0 && v >= 0.0 && w >= 0.0) put(x, y, u * a.depth + v * b.depth + w * c.depth, colour);
    }
  }
}

}  // namespace vantage

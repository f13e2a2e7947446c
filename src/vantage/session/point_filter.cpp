// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/point_filter.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "vantage/base/parallel.h"

namespace vantage {
namespace {

constexpr int kLongestVeil = 3;    // Mixed pixels in a row.
constexpr int kNextNeighbour = 2;  // A neighbour is at most so many rays away.
constexpr std::size_t kChunk = 256;

/// The points in the cells of an image of directions.
class DirectionImage {
 public:
  DirectionImage(const std::vector<Vec<3>>& points, const Pose<3>& pose, double step)
      : step_(step), columns_(std::max(3, static_cast<int>(std::lround(2.0 * kPi / step)))), rows_(static_cast<int>(kPi / step) + 2) {
    const std::size_t n = points.size();
    local_.resize(n);
    cell_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      local_[i] = pose.world_from_sensor.transpose() * (points[i] - pose.position);
      cell_[i] = cell_of(local_[i]);
    }
    first_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
    for (const std::size_t cell : cell_) ++first_[cell + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    members_.resize(n);
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < n; ++i) members_[next[cell_[i]]++] = static_cast<std::uint32_t>(i);
  }

  [[nodiscard]] const Vec<3>& at(std::size_t i) const { return local_[i]; }
  [[nodiscard]] double step() const { return step_; }

  /// Of the points in the nearest cell that has some, along a row (axis 0) or column, the one nearest in range.
  [[nodiscard]] std::optional<std::size_t> neighbour(std::size_t i, int axis, int side) const {
    const int column = static_cast<int>(cell_[i]) / rows_, row = static_cast<int>(cell_[i]) % rows_;
    for (int k = 1; k <= kNextNeighbour; ++k) {
      std::optional<std::size_t> best;
      visit(column + (axis == 0 ? k * side : 0), row + (axis == 1 ? k * side : 0), [&](std::size_t j) {
        if (!best || gap(i, j) < gap(i, *best)) best = j;
      });
      if (best) return best;
    }
    return std::nullopt;
  }

  /// How many others lie within `radius` of point i, no more than `enough` counted, and those not `out`.
  [[nodiscard]] std::int64_t count_around(std::size_t i, double radius, std::int64_t enough, const std::vector<std::uint8_t>& out) const {
    const int column = static_cast<int>(cell_[i]) / rows_, row = static_cast<int>(cell_[i]) % rows_;
    const Vec<3>& p = local_[i];
    const double range = p.norm(), flat = std::max(p.head<2>().norm() - radius, 1e-9);
    const int high = static_cast<int>(radius / (range * step_)) + 1, wide = static_cast<int>(std::min(radius / (flat * step_) + 1.0, 0.5 * columns_));
    std::int64_t found = 0;
    for (int r = -high; r <= high && found < enough; ++r)
      for (int c = -wide; c <= std::min(wide, columns_ - 1 - wide) && found < enough; ++c)
        visit(column + c, row + r,
              [&](std::size_t j) { found += j != i && out[j] == 0 && (local_[j] - p).squaredNorm() <= radius * radius ? 1 : 0; });
    return found;
  }

 private:
  [[nodiscard]] double gap(std::size_t i, std::size_t j) const { return std::abs(local_[i].norm() - local_[j].norm()); }
  [[nodiscard]] std::size_t cell_of(const Vec<3>& p) const {
    const double azimuth = angle_of(p[1], p[0]), elevation = angle_of(p[2], p.head<2>().norm());
    const int column = static_cast<int>(std::floor((azimuth + kPi) * columns_ / (2.0 * kPi) + 0.5)) % columns_;
    const int row = std::clamp(static_cast<int>(std::floor((elevation + 0.5 * kPi) / step_ + 0.5)), 0, rows_ - 1);
    return static_cast<std::size_t>(column) * static_cast<std::size_t>(rows_) + static_cast<std::size_t>(row);
  }
  template <class Visit>
  void visit(int column, int row, Visit&& each) const {
    if (row < 0 || row >= rows_) return;
    const std::size_t cell =
        static_cast<std::size_t>((column % columns_ + columns_) % columns_) * static_cast<std::size_t>(rows_) + static_cast<std::size_t>(row);
    for (std::uint32_t k = first_[cell]; k < first_[cell + 1]; ++k) each(members_[k]);
  }

  double step_;
  int columns_, rows_;
  std::vector<Vec<3>> local_;
  std::vector<std::size_t> cell_;
  std::vector<std::uint32_t> first_, members_;
};

class MixedPixels {
 public:
  MixedPixels(const DirectionImage& image, const FilterOptions& options) : image_(image), jump_(options.jump) { cosine_ = sin_cos(options.angle)[1]; }

  [[nodiscard]] bool operator()(std::size_t i) const { return (in_veil(i, 0) && !goes_on(i, 1)) || (in_veil(i, 1) && !goes_on(i, 0)); }

 private:
  [[nodiscard]] double range(std::size_t i) const { return image_.at(i).norm(); }
  /// 1: j lies behind i along a steep line, -1: before it, 0: neither.
  [[nodiscard]] int steep(std::size_t i, std::size_t j) const {
    const double difference = range(j) - range(i);
    if (std::abs(difference) < jump_) return 0;
    const Vec<3> line = image_.at(j) - image_.at(i);
    if (std::abs(line.dot(image_.at(i))) < cosine_ * line.norm() * range(i)) return 0;
    return difference > 0.0 ? 1 : -1;
  }
  /// Steep steps from i on to one side, all deeper or all less deep, as far as one more than a veil is long.
  [[nodiscard]] int steps(std::size_t i, int axis, int side, int way) const {
    int count = 0;
    for (std::size_t here = i; count <= kLongestVeil; ++count) {
      const auto next = image_.neighbour(here, axis, side);
      if (!next || steep(here, *next) != way) break;
      here = *next;
    }
    return count;
  }
  [[nodiscard]] bool in_veil(std::size_t i, int axis) const {
    const auto before = image_.neighbour(i, axis, -1), after = image_.neighbour(i, axis, 1);
    if (!before || !after) return false;
    const int way = steep(i, *after);
    if (way == 0 || steep(i, *before) != -way) return false;
    return steps(i, axis, -1, -way) + steps(i, axis, 1, way) <= kLongestVeil + 1;
  }
  [[nodiscard]] bool goes_on(std::size_t i, int axis) const {
    for (const int side : {-1, 1}) {
      const auto next = image_.neighbour(i, axis, side);
      if (!next) return false;
      const double difference = std::abs(range(*next) - range(i)), line = (image_.at(*next) - image_.at(i)).norm();
      if (difference > jump_ && difference > 0.71 * line) return false;  // Steeper than 45 degrees.
    }
    return true;
  }

  const DirectionImage& image_;
  double jump_, cosine_ = 1.0;
};

}  // namespace

void describe(FilterOptions& o, const OptionVisitor& visit) {
  visit("filter", o.what, Choices{"none", "mixed", "isolated", "both"},
        "points left out: mixed pixels between a nearer and a farther surface, isolated ones, both");
  visit.angle("filter_angle_deg", o.angle, Range{0.1, 45.0}, "of mixed pixels: between the ray and the lines to both neighbours, at most");
  visit("filter_jump", o.jump, "m", Range{0.0, 100.0}, "of mixed pixels: difference in range to both neighbours, at least");
  visit("filter_neighbours", o.neighbours, "points", Range{1, 100}, "a point with fewer around it is isolated");
  visit("filter_radius", o.radius, "", Range{1.0, 20.0}, "of what is around a point, in distances between rays at its range");
}

FilterReport filter_points(std::vector<Vec<3>>& points, const Pose<3>& pose, double step, const FilterOptions& options) {
  using What = FilterOptions::What;
  FilterReport report{static_cast<std::int64_t>(points.size()), 0, 0};
  if (options.what == What::none || points.empty()) return report;
  const DirectionImage image(points, pose, step);
  std::vector<std::uint8_t> out(points.size(), 0), isolated(points.size(), 0);
  if (options.what != What::isolated) {
    const MixedPixels mixed(image, options);
    parallel_for(points.size(), kChunk, [&](std::size_t i) { out[i] = mixed(i) ? 1 : 0; });
    report.mixed = std::count(out.begin(), out.end(), 1);
  }
  if (options.what != What::mixed) {
    parallel_for(points.size(), kChunk, [&](std::size_t i) {
      const double radius = options.radius * step * image.at(i).norm();
      isolated[i] = out[i] == 0 && image.count_around(i, radius, options.neighbours, out) < options.neighbours ? 1 : 0;
    });
    report.isolated = std::count(isolated.begin(), isolated.end(), 1);
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (out[i] == 0 && isolated[i] == 0) points[kept++] = points[i];
  points.resize(kept);
  return report;
}

}  // namespace vantage

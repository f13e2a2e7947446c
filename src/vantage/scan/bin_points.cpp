// SPDX-License-Identifier: Apache-2.0
#include "vantage/scan/bin_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "vantage/base/error.h"

namespace vantage {
namespace {

constexpr double kSteps[] = {0.1, 0.125, 0.15, 0.18, 0.2, 0.225, 0.25, 0.3, 0.36, 0.4, 0.45, 0.5, 0.6, 0.75, 0.9,
                             1.0, 1.25,  1.35, 1.5,  1.8, 2.0,   2.5,  3.0, 3.6,  4.0, 5.0,  6.0, 7.5, 10.0};  // [deg]
constexpr int kReach = 4;             // From hit to hit across a gap that they close [rays at the horizon].
constexpr double kMetricReach = 4.0;  // The same where points are sparse in angle [their spacing]: clouds thinned to even spacing are, close by.
constexpr int kFarthest = 40;         // No gap is looked across farther than this [rays].
constexpr double kWideGap = 15;       // Azimuths without hits that lie outside of the field of view [deg].
constexpr int kFewHits[] = {1, 3};    // An elevation with fewer does not widen the field of view; in the plane there is one only.
constexpr double kOffLine = 4.0;      // From the middle of its column or row a hit of an organised scan may lie [rays],
constexpr double kOffAngle = 3.0;     // or so far, if that is more [deg];
constexpr double kAstray = 0.1;       // of so large a share of hits that lie farther off, the columns and rows say nothing.
constexpr float kEmpty = -1.0F;       // While it is not decided.

/// Direction and distance of a point.
struct Polar {
  double azimuth, elevation, range;
};

template <int Dim>
Polar polar(const Vec<Dim>& p) {
  const double flat = p.template head<2>().norm();
  double up = 0.0;
  for (int a = 2; a < Dim; ++a) up = p[a];
  return {angle_of(p[1], p[0]), angle_of(up, flat), p.norm()};
}

/// Median distance of a point to the nearest other one; 0 if there is none [m].
template <int Dim>
double spacing_of(std::span<const Vec<Dim>> points, double guess) {
  constexpr std::size_t kSamples = 1000;
  const std::size_t stride = std::max<std::size_t>(1, points.size() / kSamples);
  const auto cell_of = [](const Vec<Dim>& p, double side) {
    std::array<std::int64_t, 3> cell{};
    for (int a = 0; a < Dim; ++a) cell[static_cast<std::size_t>(a)] = static_cast<std::int64_t>(std::floor(p[a] / side));
    return cell;
  };
  for (double side = guess; side < 1e3 * guess; side *= 2.0) {
    std::vector<std::pair<std::array<std::int64_t, 3>, std::size_t>> cells;
    for (std::size_t i = 0; i < points.size(); ++i) cells.emplace_back(cell_of(points[i], side), i);
    std::sort(cells.begin(), cells.end());
    std::vector<double> nearest;
    for (std::size_t i = 0; i < points.size(); i += stride) {
      double least = side * side;  // Farther ones may lie outside of the cells around.
      const std::array<std::int64_t, 3> home = cell_of(points[i], side);
      for (std::int64_t x = -1; x <= 1; ++x)
        for (std::int64_t y = -1; y <= 1; ++y) {
          const std::array<std::int64_t, 3> low{home[0] + x, home[1] + y, home[2] - 1};
          for (auto at = std::lower_bound(cells.begin(), cells.end(), std::pair(low, std::size_t{0})); at != cells.end(); ++at) {
            if (at->first[0] != low[0] || at->first[1] != low[1] || at->first[2] > home[2] + 1) break;
            if (at->second != i) least = std::min(least, (points[at->second] - points[i]).squaredNorm());
          }
        }
      nearest.push_back(std::sqrt(least));
    }
    const auto middle = nearest.begin() + static_cast<std::ptrdiff_t>(nearest.size() / 2);
    std::nth_element(nearest.begin(), middle, nearest.end());
    if (*middle < 0.999 * side) return *middle;
  }
  return 0.0;
}

/// The image's rays, turned so that the points lie in the middle of theirs.
template <int Dim>
struct Image {
  ScanPattern pattern;
  double turn = 0.0;  ///< Of the image about the third axis [rad].
  int columns = 0, rows = 0;

  Image(std::span<const Polar> points, double step) {
    pattern.step = step;
    columns = pattern.columns();
    double highest = 0.0, sine = 0.0, cosine = 0.0, level = 0.0;
    for (const Polar& p : points) {
      highest = std::max(highest, std::abs(p.elevation));
      const auto [s, c] = sin_cos(p.azimuth * columns);
      sine += s;
      cosine += c;
      level += sin_cos(p.elevation * (2.0 * kPi / step))[1];
    }
    turn = angle_of(sine, cosine) / columns;
    // Rays on the horizon, or half a step off it.
    const int odd = level >= 0.0 ? 1 : 0;
    const auto most = static_cast<int>(std::floor(kPi / step + 1e-6)) + 1;
    const auto least = static_cast<int>(std::ceil(radians(1.0) / step)) + 1;
    rows = 2 * static_cast<int>(std::ceil(highest / step + 0.5 * (1 - odd) - 1e-3)) + odd;
    rows = std::max(std::min(rows, most), least);
    if (rows % 2 != odd) rows += rows < most ? 1 : -1;
    pattern.vertical_fov = std::min((rows - 1) * step, kPi);
    rows = pattern.template rows<Dim>();
  }
  [[nodiscard]] int column(const Polar& p) const {
    const auto c = static_cast<int>(std::floor((p.azimuth - turn + kPi) * columns / (2.0 * kPi) + 0.5));
    return ((c % columns) + columns) % columns;
  }
  [[nodiscard]] int row(const Polar& p) const {
    return std::clamp(static_cast<int>(std::floor(p.elevation / pattern.step + 0.5 * (rows - 1) + 0.5)), 0, rows - 1);
  }
  [[nodiscard]] std::size_t index(int c, int r) const { return static_cast<std::size_t>(((c % columns) + columns) % columns * rows + r); }
};

template <int Dim>
std::vector<Polar> directions_of(std::span<const Vec<Dim>> points) {
  std::vector<Polar> all;
  all.reserve(points.size());
  for (const Vec<Dim>& p : points) all.push_back(polar<Dim>(p));
  return all;
}

/// Whether more than half of the rays with a hit have at most one neighbour without.
template <int Dim>
bool is_full(std::span<const Polar> points, double step) {
  const Image<Dim> image(points, step);
  std::vector<std::uint8_t> hit(static_cast<std::size_t>(image.columns) * static_cast<std::size_t>(image.rows));
  for (const Polar& p : points) hit[image.index(image.column(p), image.row(p))] = 1;
  std::int64_t hits = 0, full = 0;
  for (int c = 0; c < image.columns; ++c)
    for (int r = 0; r < image.rows; ++r) {
      if (hit[image.index(c, r)] == 0) continue;
      int empty = 0;
      for (int dc = -1; dc <= 1; ++dc)
        for (int dr = -(Dim - 2); dr <= Dim - 2; ++dr) empty += r + dr >= 0 && r + dr < image.rows && hit[image.index(c + dc, r + dr)] == 0 ? 1 : 0;
      ++hits;
      full += empty <= Dim - 2 ? 1 : 0;
    }
  return 2 * full > hits;
}

/// How well the azimuths stand in columns of the image: 1 in the middle of each, 0 anywhere.
double in_columns(std::span<const Polar> points, double step) {
  ScanPattern pattern;
  pattern.step = step;
  double sine = 0.0, cosine = 0.0;
  for (const Polar& p : points) {
    const auto [s, c] = sin_cos(p.azimuth * pattern.columns());
    sine += s;
    cosine += c;
  }
  return std::sqrt(sine * sine + cosine * cosine) / static_cast<double>(points.size());
}

template <int Dim>
double estimate(std::span<const Polar> points) {
  constexpr double kAlike = 1.35, kInColumns = 0.5;
  double best = 0.0, first = 0.0, most = kInColumns;
  for (const double degrees : kSteps) {
    const double step = radians(degrees);
    if (first > 0.0 && step > kAlike * first) break;
    if (first == 0.0 && !is_full<Dim>(points, step)) continue;
    if (first == 0.0) first = best = step;
    // A regular scan's own step is the one that its columns keep; a slightly smaller one is nearly full, too.
    if (const double share = in_columns(points, step); share > most) most = share, best = step;
  }
  return best > 0.0 ? best : radians(kSteps[std::size(kSteps) - 1]);
}

/// Fills the image from the points.
template <int Dim>
class Binner {
 public:
  Binner(std::span<const Polar> points, const BinOptions& options, double step, double spacing)
      : points_(points),
        options_(options),
        spacing_(spacing),
        image_(points, step),
        ranges_(static_cast<std::size_t>(image_.columns * image_.rows), kEmpty) {
    for (const Polar& p : points) {
      float& range = ranges_[image_.index(image_.column(p), image_.row(p))];
      const auto here = static_cast<float>(p.range);
      range = range == kEmpty ? here : std::min(range, here);
    }
    report_.step = step;
  }

  void run(const std::optional<RayOrder>& order) {
    report_.hit = std::count_if(ranges_.begin(), ranges_.end(), [](float r) { return r != kEmpty; });
    find_view();
    report_.ordered = order && take_order(*order);
    close_gaps();
    for (int c = 0; c < image_.columns; ++c)
      for (int r = 0; r < image_.rows; ++r) decide(c, r, report_.ordered);
  }

  [[nodiscard]] const Image<Dim>& image() const { return image_; }
  std::vector<float>& ranges() { return ranges_; }
  [[nodiscard]] const BinReport& report() const { return report_; }

 private:
  /// Rows and columns that hits cover.
  void find_view() {
    std::vector<int> in_row(static_cast<std::size_t>(image_.rows)), in_column(static_cast<std::size_t>(image_.columns));
    for (int c = 0; c < image_.columns; ++c)
      for (int r = 0; r < image_.rows; ++r)
        if (ranges_[image_.index(c, r)] != kEmpty) ++in_row[static_cast<std::size_t>(r)], ++in_column[static_cast<std::size_t>(c)];
    low_ = image_.rows;
    high_ = -1;
    for (int r = 0; r < image_.rows; ++r)
      if (in_row[static_cast<std::size_t>(r)] >= kFewHits[Dim - 2]) low_ = std::min(low_, r), high_ = r;
    report_.lowest = (Dim - 2) * image_.pattern.elevation(std::min(low_, image_.rows - 1));
    report_.highest = (Dim - 2) * image_.pattern.elevation(std::max(high_, 0));
    covered_.assign(in_column.size(), 1);
    const auto wide = static_cast<int>(radians(kWideGap) / image_.pattern.step);
    for (int c = 0; c < image_.columns; ++c) {
      int gap = 0;
      while (gap < image_.columns && in_column[static_cast<std::size_t>((c + gap) % image_.columns)] == 0) ++gap;
      if (gap > std::max(wide, 3))
        for (int k = 0; k < gap; ++k) covered_[static_cast<std::size_t>((c + k) % image_.columns)] = 0;
      c += gap;
    }
  }

  /// Of angles.
  struct Mean {
    double sine = 0.0, cosine = 0.0;
    int count = 0;
    void add(double angle) {
      const auto [s, c] = sin_cos(angle);
      sine += s, cosine += c, ++count;
    }
    [[nodiscard]] double angle() const { return angle_of(sine, cosine); }
    /// How far an angle is off [rad].
    [[nodiscard]] double off(double angle) const {
      const auto [s, c] = sin_cos(angle - this->angle());
      return std::abs(angle_of(s, c));
    }
  };

  /// The rays that came back empty: where the hits of their column and of their row lie. False, and nothing taken, where hits do not lie there: the
  /// lines are not those of a scanner, or go over the zenith, or the scanner stood at a slant that the pose does not tell.
  bool take_order(const RayOrder& order) {
    std::vector<Mean> azimuth(static_cast<std::size_t>(order.columns)), elevation(static_cast<std::size_t>(order.rows));
    const auto at = [&](int c, int r) {
      return order.point[static_cast<std::size_t>(c) * static_cast<std::size_t>(order.rows) + static_cast<std::size_t>(r)];
    };
    const auto valid = [&](std::int32_t i) { return i >= 0 && static_cast<std::size_t>(i) < points_.size(); };
    for (int c = 0; c < order.columns; ++c)
      for (int r = 0; r < order.rows; ++r)
        if (const std::int32_t i = at(c, r); valid(i)) {
          azimuth[static_cast<std::size_t>(c)].add(points_[static_cast<std::size_t>(i)].azimuth);
          elevation[static_cast<std::size_t>(r)].add(points_[static_cast<std::size_t>(i)].elevation);
        }
    std::int64_t hits = 0, astray = 0;
    const double most = std::max(kOffLine * image_.pattern.step, radians(kOffAngle));
    for (int c = 0; c < order.columns; ++c)
      for (int r = 0; r < order.rows; ++r)
        if (const std::int32_t i = at(c, r); valid(i)) {
          const Polar& p = points_[static_cast<std::size_t>(i)];
          const double width = sin_cos(p.elevation)[1];
          ++hits;
          astray +=
              width * azimuth[static_cast<std::size_t>(c)].off(p.azimuth) > most || elevation[static_cast<std::size_t>(r)].off(p.elevation) > most;
        }
    if (static_cast<double>(astray) > kAstray * static_cast<double>(hits)) return false;
    for (int c = 0; c < order.columns; ++c)
      for (int r = 0; r < order.rows; ++r) {
        const Mean &a = azimuth[static_cast<std::size_t>(c)], &e = elevation[static_cast<std::size_t>(r)];
        if (at(c, r) != -1 || a.count == 0 || e.count == 0) continue;
        const Polar ray{a.angle(), e.angle(), 0.0};
        float& range = ranges_[image_.index(image_.column(ray), image_.row(ray))];
        if (range == kEmpty) range = kNoReturn;
      }
    return true;
  }

  /// Range between two hits, one on each side: of the plane through them if they are alike, else of the nearer; kEmpty if one is missing.
  [[nodiscard]] float between(int c, int r, int dc, int dr, double width) const {
    const int most = std::min(static_cast<int>(farthest_ / width), image_.columns / 4);
    const auto side = [&](int sign, int& steps) {
      for (steps = 1; steps <= most; ++steps) {
        const int row = r + sign * steps * dr;
        if (row < 0 || row >= image_.rows) return kEmpty;
        const float range = ranges_[image_.index(c + sign * steps * dc, row)];
        if (range != kEmpty) return range;
      }
      return kEmpty;
    };
    int left = 0, right = 0;
    const float a = side(-1, left), b = side(1, right);
    if (!(std::isfinite(a) && std::isfinite(b)) || a == kEmpty || b == kEmpty) return kEmpty;
    const float least = std::min(a, b);
    const double gap = (left + right) * width;
    if (gap > kReach && gap * image_.pattern.step * static_cast<double>(least) > kMetricReach * spacing_) return kEmpty;
    if (std::max(a, b) > 1.2F * least) return least;
    const auto w = static_cast<float>(left) / static_cast<float>(left + right);
    return 1.0F / ((1.0F - w) / a + w / b);
  }

  /// Range in the middle of hits in all four quadrants around, no farther than the spacing of the points explains; kEmpty if there are none.
  [[nodiscard]] float surrounded(int c, int r, double width) const {
    for (int half = 1; half <= static_cast<int>(farthest_) / 2; half *= 2) {
      const int across = std::min(static_cast<int>(half / width), image_.columns / 4);
      unsigned quadrants = 0;
      double least = kInfinity, most = 0.0, inverse = 0.0;
      int hits = 0;
      for (int dr = std::max(-half, -r); dr <= std::min(half, image_.rows - 1 - r); ++dr)
        for (int dc = -across; dc <= across; ++dc) {
          const auto range = static_cast<double>(ranges_[image_.index(c + dc, r + dr)]);
          if (dc == 0 || dr == 0 || !(range > 0.0 && range < kInfinity)) continue;
          quadrants |= 1U << ((dc > 0 ? 1 : 0) + (dr > 0 ? 2 : 0));
          least = std::min(least, range);
          most = std::max(most, range);
          inverse += 1.0 / range;
          ++hits;
        }
      if (2 * half * image_.pattern.step * least > kMetricReach * spacing_) continue;
      if (quadrants == 15U) return static_cast<float>(most > 1.5 * least ? least : hits / inverse);
    }
    return kEmpty;
  }

  void close_gaps() {
    std::vector<double> near;
    for (const Polar& p : points_) near.push_back(p.range);
    const auto low = near.begin() + static_cast<std::ptrdiff_t>(near.size() / 100);
    std::nth_element(near.begin(), low, near.end());
    farthest_ =
        std::clamp(std::ceil(kMetricReach * spacing_ / (*low * image_.pattern.step)), static_cast<double>(kReach), static_cast<double>(kFarthest));
    std::vector<float> closed = ranges_;
    for (int r = 0; r < image_.rows; ++r) {
      const double cosine = sin_cos((Dim - 2) * image_.pattern.elevation(r))[1];
      const double width = std::max(cosine, 1e-2);
      for (int c = 0; c < image_.columns; ++c) {
        float& range = closed[image_.index(c, r)];
        if (range != kEmpty) continue;
        const float across = between(c, r, 0, 1, 1.0), around = between(c, r, 1, 0, width);
        range = across == kEmpty ? around : around == kEmpty ? across : std::min(across, around);
        if (range == kEmpty) range = surrounded(c, r, width);
        report_.between += range != kEmpty ? 1 : 0;
      }
    }
    ranges_ = std::move(closed);
  }

  void decide(int c, int r, bool ordered) {
    float& range = ranges_[image_.index(c, r)];
    if (range != kEmpty) {
      report_.empty += range == kNoReturn ? 1 : 0;
      return;
    }
    const bool inside = r >= low_ && r <= high_ && covered_[static_cast<std::size_t>(c)] != 0;
    ++(inside && !ordered ? report_.empty : report_.outside);
    range = inside && options_.no_return_free && !ordered ? kNoReturn : kNoData;
  }

  std::span<const Polar> points_;
  const BinOptions& options_;
  double spacing_, farthest_ = kReach;
  Image<Dim> image_;
  std::vector<float> ranges_;
  std::vector<std::uint8_t> covered_;
  int low_ = 0, high_ = 0;
  BinReport report_;
};

/// The image's own turn, then the sensor's.
template <int Dim>
Eigen::Matrix<double, Dim, Dim> turned(const Eigen::Matrix<double, Dim, Dim>& world_from_sensor, double angle) {
  const auto [s, c] = sin_cos(angle);
  Eigen::Matrix<double, Dim, Dim> turn = Eigen::Matrix<double, Dim, Dim>::Identity();
  turn(0, 0) = turn(1, 1) = c;
  turn(0, 1) = -s;
  turn(1, 0) = s;
  return world_from_sensor * turn;
}

/// Indices of an order after some points have been left out.
std::vector<std::int32_t> renumbered(const RayOrder& order, std::span<const std::int32_t> place) {
  std::vector<std::int32_t> all(order.point.begin(), order.point.end());
  for (std::int32_t& i : all)
    if (i >= 0) i = static_cast<std::size_t>(i) < place.size() ? place[static_cast<std::size_t>(i)] : -2;
  return all;
}

}  // namespace

template <int Dim>
double estimate_step(std::span<const Vec<Dim>> points) {
  return estimate<Dim>(directions_of<Dim>(points));
}

template <int Dim>
BinnedScan<Dim> bin_points(std::span<const Vec<Dim>> points, const Pose<Dim>& pose, const BinOptions& options, const std::optional<RayOrder>& order) {
  BinnedScan<Dim> out;
  std::vector<Polar> kept;
  std::vector<std::int32_t> place(points.size(), -2);
  std::int64_t near = 0, far = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Polar p = polar<Dim>(Vec<Dim>(pose.world_from_sensor.transpose() * (points[i] - pose.position)));
    if (!(p.range > 0.0) || p.range < options.min_range || p.range > options.max_range) {
      ++(p.range > options.max_range ? far : near);
      continue;
    }
    place[i] = static_cast<std::int32_t>(kept.size());
    kept.push_back(p);
    out.scan.points.push_back(points[i]);
  }
  require(!kept.empty(), fmt::format("no point lies between {:g} and {:g} m from the scanner", options.min_range, options.max_range));
  const double step = options.step > 0.0 ? options.step : estimate<Dim>(kept);
  std::vector<double> ranges;
  for (const Polar& p : kept) ranges.push_back(p.range);
  std::nth_element(ranges.begin(), ranges.begin() + static_cast<std::ptrdiff_t>(ranges.size() / 2), ranges.end());
  const double guess = std::max(0.5 * step * ranges[ranges.size() / 2], 1e-6);
  Binner<Dim> binner(kept, options, step, spacing_of<Dim>(out.scan.points, guess));
  std::optional<RayOrder> rays;
  std::vector<std::int32_t> numbers;
  if (order) {
    numbers = renumbered(*order, place);
    rays = RayOrder{order->columns, order->rows, numbers};
  }
  binner.run(rays);
  out.report = binner.report();
  out.report.points = static_cast<std::int64_t>(kept.size());
  out.report.near = near;
  out.report.far = far;
  out.scan.origin = pose.position;
  out.scan.world_from_sensor = turned<Dim>(pose.world_from_sensor, binner.image().turn);
  out.scan.pattern = binner.image().pattern;
  out.scan.pattern.min_range = options.min_range;
  out.scan.pattern.max_range = options.max_range;
  out.scan.ranges = std::move(binner.ranges());
  return out;
}

#define VANTAGE_INSTANTIATE(D)                               \
  template double estimate_step<D>(std::span<const Vec<D>>); \
  template BinnedScan<D> bin_points<D>(std::span<const Vec<D>>, const Pose<D>&, const BinOptions&, const std::optional<RayOrder>&);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage

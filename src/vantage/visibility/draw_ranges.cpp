// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "vantage/base/parallel.h"
#include "vantage/visibility/depth_image.h"
#include "vantage/visibility/lanes.h"

namespace vantage {
namespace {

constexpr double kAngleError = 2e-5;  ///< Of quick_angle() of directions rounded to float, with a margin of some four times [rad].

/// angle_of() in float, error below 2e-7 (Abramowitz and Stegun 4.4.49).
VANTAGE_LANES float quick_angle(float y, float x) {
  const float ax = x < 0.0F ? -x : x, ay = y < 0.0F ? -y : y, big = ax > ay ? ax : ay, small = ax > ay ? ay : ax;
  const float z = small / (big > 1e-30F ? big : 1e-30F), z2 = z * z;
  float sum = 0.0028662257F;
  sum = sum * z2 - 0.0161657367F;
  sum = sum * z2 + 0.0429096138F;
  sum = sum * z2 - 0.0752896400F;
  sum = sum * z2 + 0.1065626393F;
  sum = sum * z2 - 0.1420889944F;
  sum = sum * z2 + 0.1999355085F;
  sum = sum * z2 - 0.3333314528F;
  float angle = z + z * z2 * sum;
  angle = ay > ax ? 1.57079632679F - angle : angle;
  angle = x < 0.0F ? 3.14159265359F - angle : angle;
  return y < 0.0F ? -angle : angle;
}

/// What a run of directions needs to find its columns and rows, in the sensor frame.
struct Guess {
  std::array<float, 3> base, along;  ///< Of the run; the third is the height, 0 in the plane.
  float first, step;                 ///< Of the run.
  float columns, rows;               ///< Per radian.
  float column, row;                 ///< Straight ahead.
  float column_error, row_error;
};

/// Twice the column and row, rounded down; `unsure` where rounding leaves that open.
struct Places {
  Lanes<std::int32_t> column, row, unsure;
};

/// How far a number above zero is from the nearest whole one.
VANTAGE_LANES float off_whole(float x) {
  const float up = x + 0.5F;
  const float off = x - static_cast<float>(static_cast<std::int32_t>(up));
  return off < 0.0F ? -off : off;
}

VANTAGE_LANES void guess(const Guess& g, Places& out) {
  for (int k = 0; k < kLanes; ++k) {
    const float w = g.first + static_cast<float>(k) * g.step;
    const float x = g.base[0] + w * g.along[0], y = g.base[1] + w * g.along[1], z = g.base[2] + w * g.along[2];
    const float flat2 = x * x + y * y, flat = __builtin_sqrtf(flat2);
    const float c = 2.0F * (quick_angle(y, x) * g.columns + g.column), r = 2.0F * (quick_angle(z, flat) * g.rows + g.row);
    const float dc = off_whole(c), dr = off_whole(r);
    out.column[k] = static_cast<std::int32_t>(c);
    out.row[k] = static_cast<std::int32_t>(r);
    // Without a branch, for the vectors.
    out.unsure[k] = static_cast<std::int32_t>(dc < g.column_error) | static_cast<std::int32_t>(dr < g.row_error) |
                    static_cast<std::int32_t>(flat2 < 0.02F * (flat2 + z * z));
  }
}

void guess_anywhere(const Guess& g, Places& out) { guess(g, out); }
#if VANTAGE_WIDE
VANTAGE_AVX2 void guess_wide(const Guess& g, Places& out) { guess(g, out); }
const auto best_guess = has_avx2() ? &guess_wide : &guess_anywhere;
#else
const auto best_guess = &guess_anywhere;
#endif

/// Free range along a ray for the nodes near it.
float free_range(float range, double max_range) {
  if (std::isnan(range)) return 0.0F;
  return std::isinf(range) ? static_cast<float>(max_range) : range;
}

/// The free ranges of a scan: between the rays, the least of the 2 x 2 around (2D: 2).
template <int Dim>
class FreeRanges {
 public:
  explicit FreeRanges(const Scan<Dim>& scan)
      : sensor_from_world_(scan.world_from_sensor.transpose()),
        step_(scan.pattern.step),
        wraps_(scan.pattern.full_circle()),
        columns_(scan.pattern.columns()),
        rows_(scan.pattern.template rows<Dim>()) {
    const auto across = static_cast<std::size_t>(columns_ + 2), up = static_cast<std::size_t>(rows_ + 2);
    least_.resize(across * up);
    parallel_for(across, 16, [&](std::size_t c) {
      for (std::size_t r = 0; r < up; ++r) least_[c * up + r] = least(scan, static_cast<int>(c) - 1, static_cast<int>(r) - 1);
    });
  }

  /// In a direction of unit length: 0 outside of the field of view.
  [[nodiscard]] float along(const Vec<Dim>& world) const {
    const Vec<Dim> d = sensor_from_world_ * world;
    const double azimuth = angle_of(d[1], d[0]), elevation = angle_of((Dim - 2) * d[Dim - 1], d.template head<2>().norm());
    const double column = wraps_ ? (azimuth + kPi) / (2.0 * kPi) * columns_ : azimuth / step_ + 0.5 * (columns_ - 1);
    const double row = elevation / step_ + 0.5 * (rows_ - 1);
    constexpr double kHalf = 0.5 + 1e-9;  // A ray stands for half a step on each side.
    if (!wraps_ && (column < -kHalf || column > columns_ - 1 + kHalf)) return 0.0F;
    if (row < -kHalf || row > rows_ - 1 + kHalf) return 0.0F;
    return at(static_cast<int>(std::floor(column)), static_cast<int>(std::floor(row)));
  }

  /// Lowers the pixels of a row as along() says, which is asked only where a guess is not sure.
  void lower(DepthImage<Dim>& image, std::size_t first) const {
    const PixelRun<Dim> run = image.run(first);
    Guess guess = guess_for(run);
    for (int at = 0; at < image.resolution(); at += kLanes) {
      guess.first = static_cast<float>(run.offset(at));
      Places places;
      best_guess(guess, places);
      const int count = std::min(kLanes, image.resolution() - at);
      for (int k = 0; k < count; ++k) {
        const auto lane = static_cast<std::size_t>(k);
        const float range = places.unsure[lane] != 0 ? along(run.direction(at + k)) : at_half(places.column[lane] - 2, places.row[lane] - 2);
        float& least = image[first + static_cast<std::size_t>(at + k)];
        least = std::min(least, range);
      }
    }
  }

 private:
  static float least(const Scan<Dim>& scan, int column, int row) {
    const ScanPattern& pattern = scan.pattern;
    const int columns = pattern.columns(), rows = pattern.rows<Dim>();
    float least = std::numeric_limits<float>::infinity();
    for (const int c : {column, column + 1})
      for (const int r : {row, row + 1}) {
        const int cc = pattern.full_circle() ? (c + columns) % columns : std::clamp(c, 0, columns - 1);
        least = std::min(least, free_range(scan.range(cc, std::clamp(r, 0, rows - 1)), pattern.max_range));
      }
    return least;
  }

  /// Between columns and rows `column`, `row` and the next.
  [[nodiscard]] float at(int column, int row) const {
    return least_[static_cast<std::size_t>(column + 1) * static_cast<std::size_t>(rows_ + 2) + static_cast<std::size_t>(row + 1)];
  }
  [[nodiscard]] float at_half(int column, int row) const {
    const bool outside = (!wraps_ && (column < -1 || column >= 2 * columns_ - 1)) || row < -1 || row >= 2 * rows_ - 1;
    return outside ? 0.0F : at(column >> 1, row >> 1);
  }

  [[nodiscard]] Guess guess_for(const PixelRun<Dim>& run) const {
    const double columns = wraps_ ? columns_ / (2.0 * kPi) : 1.0 / step_, rows = 1.0 / step_;
    Guess g{};
    const Vec<Dim> base = sensor_from_world_ * run.base, along = sensor_from_world_ * run.along;
    for (int a = 0; a < Dim; ++a) {
      g.base[a] = static_cast<float>(base[a]);
      g.along[a] = static_cast<float>(along[a]);
    }
    g.step = static_cast<float>(2.0 / run.resolution);
    g.columns = static_cast<float>(columns);
    g.rows = static_cast<float>(rows);
    // One more than it is: above zero wherever it matters, so that truncation rounds down.
    g.column = static_cast<float>((wraps_ ? 0.5 * columns_ : 0.5 * (columns_ - 1)) + 1.0);
    g.row = static_cast<float>(0.5 * (rows_ - 1) + 1.0);
    g.column_error = static_cast<float>(2.0 * kAngleError * columns);
    g.row_error = static_cast<float>(2.0 * kAngleError * rows);
    return g;
  }

  Eigen::Matrix<double, Dim, Dim> sensor_from_world_;
  double step_;
  bool wraps_;
  int columns_, rows_;
  std::vector<float> least_;  ///< (columns + 2, rows + 2), from one before the first on.
};

}  // namespace

template <int Dim>
void draw_ranges(DepthImage<Dim>& image, const Scan<Dim>& scan) {
  const FreeRanges<Dim> free(scan);
  const auto row = static_cast<std::size_t>(image.resolution());
  parallel_for(image.size() / row, 4, [&](std::size_t r) { free.lower(image, r * row); });
}

template void draw_ranges<2>(DepthImage<2>&, const Scan<2>&);
template void draw_ranges<3>(DepthImage<3>&, const Scan<3>&);

}  // namespace vantage

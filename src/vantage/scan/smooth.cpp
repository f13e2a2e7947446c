// SPDX-License-Identifier: Apache-2.0
#include "vantage/scan/smooth.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "vantage/base/parallel.h"
#include "vantage/base/random.h"
#include "vantage/scan/range_image.h"

namespace vantage {
namespace {

constexpr double kOff = 3.0;                             // Farthest from the plane that counts as on it, in standard deviations.
constexpr double kShare = 0.8;                           // Of the hits around that must be on it.
constexpr double kMost = 0.65;                           // The same, to contradict the hit in the middle.
constexpr double kScatter = 2.0;                         // How far their mean square may be above its expectation, in its standard deviations.
const double kWindow = radians(60.0);                    // Widest.
constexpr int kGuesses = 8;                              // Planes through Dim hits, to begin with.
constexpr int kSteps = 4;                                // Of Gauss and Newton.
constexpr int kReaches[2][3] = {{12, 6, 3}, {6, 3, 2}};  // Rays to each side, by dimension.
constexpr std::size_t kFewest[] = {0, 0, 6, 9};          // Hits for a plane, by dimension.

/// The hits around a ray that a plane is fitted to.
template <int Dim>
struct Hits {
  std::vector<Vec<Dim>> directions;
  std::vector<double> ranges;
  [[nodiscard]] std::size_t size() const { return ranges.size(); }
};

/// How well a plane fits.
struct Fit {
  std::size_t on = 0;    ///< Hits on it.
  double squares = 0.0;  ///< Of their distances along the rays [m^2].
};

template <int Dim>
class PlaneAround {
 public:
  PlaneAround(const RangeImage<Dim>& image, double step, double noise) : image_(image), step_(step), off_(kOff * noise), variance_(noise * noise) {}

  /// N of the plane of the ray at a column and row; zero for none.
  Vec<Dim> operator()(int column, int row) {
    const int centre = image_.index(column, row);
    if (!std::isfinite(image_.range(centre))) return Vec<Dim>::Zero();
    random_ = Random(static_cast<std::uint64_t>(centre));
    const int least = kReaches[Dim - 2][2];
    if (2 * least * step_ > kWindow) return Vec<Dim>::Zero();
    for (const int reach : kReaches[Dim - 2]) {
      if (2 * reach * step_ > kWindow) continue;
      for (const int shift : {0, reach / 2, reach})
        for (int side = 0; side < (shift == 0 ? 1 : 1 << (Dim - 1)); ++side) {
          const int dc = (side & 1) != 0 ? shift : -shift, dr = tall_ * ((side & 2) != 0 ? shift : -shift);
          const Vec<Dim> plane = fit(column + dc, row + dr, reach, kShare);
          if (on(plane, image_.direction(centre), image_.range(centre))) return plane;
        }
    }
    return fit(column, row, least, kMost);
  }

 private:
  void gather(int column, int row, int reach) {
    hits_.directions.clear();
    hits_.ranges.clear();
    const int up = tall_ * reach;
    for (int dc = -reach; dc <= reach; ++dc)
      for (int dr = -up; dr <= up; ++dr) {
        const int i = image_.index(column + dc, row + dr);
        if (!std::isfinite(image_.range(i))) continue;
        hits_.directions.push_back(image_.direction(i));
        hits_.ranges.push_back(image_.range(i));
      }
  }

  [[nodiscard]] bool on(const Vec<Dim>& plane, const Vec<Dim>& direction, double range) const {
    const double inverse = plane.dot(direction);
    return inverse > 0.0 && std::abs(range - 1.0 / inverse) <= off_;
  }

  [[nodiscard]] Fit judge(const Vec<Dim>& plane) const {
    Fit fit;
    for (std::size_t k = 0; k < hits_.size(); ++k) {
      const double inverse = plane.dot(hits_.directions[k]), off = hits_.ranges[k] - 1.0 / inverse;
      if (!(inverse > 0.0) || std::abs(off) > off_) continue;
      ++fit.on;
      fit.squares += off * off;
    }
    return fit;
  }

  [[nodiscard]] bool holds(const Vec<Dim>& plane, double share) const {
    const Fit fit = judge(plane);
    if (fit.on < kFewest[Dim] || static_cast<double>(fit.on) <= share * static_cast<double>(hits_.size())) return false;
    const double freedom = static_cast<double>(fit.on) - Dim;
    return fit.squares <= variance_ * (freedom + kScatter * std::sqrt(2.0 * freedom));
  }

  /// The plane through Dim of the hits, picked at random, that most hits are on.
  Vec<Dim> guess() {
    Vec<Dim> best = Vec<Dim>::Zero();
    std::size_t most = 0;
    for (int k = 0; k < kGuesses && static_cast<double>(most) < kShare * static_cast<double>(hits_.size()); ++k) {
      Eigen::Matrix<double, Dim, Dim> rays;
      Vec<Dim> inverse;
      for (int a = 0; a < Dim; ++a) {
        const std::size_t hit = random_.below(hits_.size());
        rays.row(a) = hits_.directions[hit].transpose();
        inverse[a] = 1.0 / hits_.ranges[hit];
      }
      const Vec<Dim> plane = rays.fullPivLu().solve(inverse);
      if (!plane.allFinite()) continue;
      if (const std::size_t count = judge(plane).on; count > most) {
        most = count;
        best = plane;
      }
    }
    return best;
  }

  /// The plane that the hits around lie on, or zero: least squares of the ranges of those that do.
  Vec<Dim> fit(int column, int row, int reach, double share) {
    gather(column, row, reach);
    if (hits_.size() < kFewest[Dim]) return Vec<Dim>::Zero();
    Vec<Dim> plane = guess();
    for (int step = 0; step < kSteps; ++step) {
      Eigen::Matrix<double, Dim, Dim> normal = Eigen::Matrix<double, Dim, Dim>::Zero();
      Vec<Dim> right = Vec<Dim>::Zero();
      for (std::size_t k = 0; k < hits_.size(); ++k) {
        if (!on(plane, hits_.directions[k], hits_.ranges[k])) continue;
        const double range = 1.0 / plane.dot(hits_.directions[k]);
        const Vec<Dim> slope = -range * range * hits_.directions[k];
        normal += slope * slope.transpose();
        right += (hits_.ranges[k] - range) * slope;
      }
      const Vec<Dim> change = normal.ldlt().solve(right);
      if (!change.allFinite()) return Vec<Dim>::Zero();
      plane += change;
    }
    return holds(plane, share) ? plane : Vec<Dim>::Zero();
  }

  const RangeImage<Dim>& image_;
  int tall_ = image_.rows() > 1 ? 1 : 0;  // Whether there are rays above and below.
  double step_, off_, variance_;
  Random random_{0};
  Hits<Dim> hits_;
};

}  // namespace

template <int Dim>
std::vector<Vec<Dim>> local_planes(const Scan<Dim>& scan, double noise) {
  const RangeImage<Dim> image(scan);
  const auto rows = static_cast<std::size_t>(image.rows());
  std::vector<Vec<Dim>> planes(scan.ranges.size(), Vec<Dim>::Zero());
  parallel_for(static_cast<std::size_t>(image.columns()), 1, [&](std::size_t c) {
    PlaneAround<Dim> around(image, scan.pattern.step, noise);
    for (std::size_t r = 0; r < rows; ++r) planes[c * rows + r] = around(static_cast<int>(c), static_cast<int>(r));
  });
  return planes;
}

template <int Dim>
Smoothed put_on_planes(Scan<Dim>& scan, double noise) {
  Smoothed smoothed;
  if (!(noise > 0.0)) return smoothed;
  const std::vector<Vec<Dim>> planes = local_planes(scan, noise), rays = directions<Dim>(scan.pattern);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const double inverse = planes[i].dot(rays[i]);
    if (!(inverse > 0.0)) continue;
    const bool on = std::abs(static_cast<double>(scan.ranges[i]) - 1.0 / inverse) <= kOff * noise;
    scan.ranges[i] = on ? static_cast<float>(1.0 / inverse) : kNoData;
    ++(on ? smoothed.moved : smoothed.dropped);
  }
  return smoothed;
}

template std::vector<Vec<2>> local_planes<2>(const Scan<2>&, double);
template std::vector<Vec<3>> local_planes<3>(const Scan<3>&, double);
template Smoothed put_on_planes<2>(Scan<2>&, double);
template Smoothed put_on_planes<3>(Scan<3>&, double);

}  // namespace vantage

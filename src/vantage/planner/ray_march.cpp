// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/ray_march.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "vantage/base/parallel.h"
#include "vantage/geometry/angle.h"
#include "vantage/planner/march_grid.h"

namespace vantage {
namespace {

/// e^-x for x >= 0 with + - * / only, good to 1e-9: halved six times, a series, squared six times.
double exp_minus(double x) {
  if (x > 30.0) return 0.0;
  const double y = x / 64.0;
  double e = 1.0 - y * (1.0 - y / 2.0 * (1.0 - y / 3.0 * (1.0 - y / 4.0 * (1.0 - y / 5.0 * (1.0 - y / 6.0)))));
  for (int k = 0; k < 6; ++k) e *= e;
  return e;
}

template <int Dim>
double cell_power(double r) {  // r^(Dim-1)
  double value = 1.0;
  for (int a = 1; a < Dim; ++a) value *= r;
  return value;
}

constexpr double kNudge = 1e-6;  // Past the side of a cell, into the next [cells].

/// A straight line through cells [i, i + 1) along every axis; lengths in cells.
template <int Dim>
struct Ray {
  Ray(const Grid<Dim>& grid, const Vec<Dim>& origin, const Vec<Dim>& d)
      : start(origin / grid.spacing - grid.first.template cast<double>() + Vec<Dim>::Constant(0.5)), direction(d) {
    for (int a = 0; a < Dim; ++a) {
      inverse[a] = std::abs(d[a]) > 1e-9 ? 1.0 / d[a] : 1e18;
      ahead[a] = inverse[a] > 0.0 ? 1 : 0;
      inside = inside && start[a] >= 0.0 && start[a] < grid.extent[a];
      end = std::min(end, ((inverse[a] > 0.0 ? grid.extent[a] : 0) - start[a]) * inverse[a]);
    }
  }
  [[nodiscard]] Index<Dim> cell(double t) const {
    Index<Dim> i;
    for (int a = 0; a < Dim; ++a) i[a] = static_cast<std::int32_t>(start[a] + t * direction[a]);
    return i;
  }
  /// Where it leaves the cube of all cells less than `distance` away along every axis.
  [[nodiscard]] double exit(const Index<Dim>& from, int distance) const {
    double least = kInfinity;
    for (int a = 0; a < Dim; ++a) {
      const std::int32_t side = from[a] + 1 - distance + ahead[a] * (2 * distance - 1);
      least = std::min(least, (static_cast<double>(side) - start[a]) * inverse[a]);
    }
    return least;
  }

  Vec<Dim> start, direction, inverse;
  Index<Dim> ahead;
  bool inside = true;      // The start lies in the window.
  double end = kInfinity;  // Where it leaves the window.
};

/// Codes as MarchGrid's, cell by cell.
template <int Dim>
struct PlainCodes {
  const Field<Dim, NodeState>& state;
  [[nodiscard]] std::uint8_t code(const Index<Dim>& cell) const {
    const Index<Dim> node = cell.cwiseMin((state.window.extent.array() - 1).matrix());
    return static_cast<std::uint8_t>(static_cast<int>(state.at(node)) << 6 | 1);
  }
};

struct Stop {
  double range = 0.0;   // [cells]
  bool inside = false;  // At a cell that is not seen; false: left the window or the limit is reached.
};

/// One stride from `t`; false at a cell that is not seen.
template <int Dim, class Codes>
bool stride(const Ray<Dim>& ray, const Codes& codes, double& t) {
  // The observer stands in free space even where the lattice calls its own node an obstacle.
  const double own = std::sqrt(static_cast<double>(Dim));
  const Index<Dim> cell = ray.cell(t);
  const std::uint8_t code = codes.code(cell);
  const bool seen = MarchGrid<Dim>::state(code) == NodeState::seen;
  if (!seen && t > own) return false;
  t = std::max(t, ray.exit(cell, seen ? MarchGrid<Dim>::distance(code) : 1)) + kNudge;
  return true;
}

template <int Dim, class Codes>
Stop march(const Ray<Dim>& ray, const Codes& codes, double limit) {
  const double end = std::min(limit, ray.end);
  double t = 0.0;
  while (t < end && ray.inside)
    if (!stride(ray, codes, t)) return {t, true};
  return {ray.inside ? end : 0.0, false};
}

/// Runs `begin(i, state)` and then `step(i, state)` until that is false for all i < count, a step of each in turn, so that none waits for the memory
/// that another asked for.
template <class State, class Begin, class Step>
void in_turn(std::size_t count, Begin&& begin, Step&& step) {
  constexpr std::size_t kTogether = 16;
  std::array<std::size_t, kTogether> number;
  std::array<State, kTogether> state;
  std::size_t active = 0, next = 0;
  while (true) {
    for (; active < kTogether && next < count; ++next)
      if (begin(next, state[active])) number[active++] = next;
    if (active == 0) return;
    for (std::size_t k = 0; k < active;) {
      if (step(number[k], state[k])) {
        ++k;
      } else {
        number[k] = number[--active];
        state[k] = state[active];
      }
    }
  }
}

/// The rays' part of RaySums beyond where they stop.
template <int Dim, class Codes>
class Beyond {
 public:
  using Medium = typename RayMarch<Dim>::Medium;
  using Fading = std::vector<std::array<double, Dim + 1>>;
  /// On the way through what is not seen; a sample in the middle of every cell's length.
  struct Depth {
    double t = 0.0, transmitted = 0.0, volume = 0.0;
  };
  Beyond(const Codes& codes, const Field<Dim>& openness, const Medium& medium, const Fading& fading)
      : codes_(codes), openness_(openness), medium_(medium), fading_(fading), h_(openness.window.spacing) {}

  /// From the observer on, whatever opens.
  [[nodiscard]] Depth whole_way() {
    own_ = std::sqrt(static_cast<double>(Dim));
    return {0.5, unit_, 0.0};
  }

  /// False if nothing opens where the ray stops; else adds to the other sums, per solid angle.
  bool begin(const Ray<Dim>& ray, double range, Depth& depth, RaySums& sums) const {
    const double open = openness_at(ray, range);
    if (open == 0.0) return false;
    const double here = weight(ray.cell(range)) * open;
    sums.solid_angle += here;
    sums.area += here * cell_power<Dim>(range * h_) * inverse_power(std::max(range * h_, 1e-9), medium_.tau_power);
    depth = {range + 0.5, open * unit_, 0.0};
    return true;
  }
  /// On to where something else begins; false at a known surface and at the end.
  bool step(const Ray<Dim>& ray, Depth& depth) const {
    const double limit = std::min(medium_.max_range / h_, ray.end - kNudge);
    if (depth.t >= limit || depth.transmitted <= 1e-6 * unit_) return false;
    const Index<Dim> cell = ray.cell(depth.t);
    const std::uint8_t code = codes_.code(cell);
    const NodeState state = MarchGrid<Dim>::state(code);
    if (state == NodeState::obstacle && depth.t > own_) return false;
    const int reach = medium_.weight == nullptr ? MarchGrid<Dim>::distance(code) : 1;
    const double samples = std::clamp(std::ceil(std::min(ray.exit(cell, reach), limit) - depth.t), 1.0, most_);
    if (state == NodeState::unseen) {
      const auto n = static_cast<std::size_t>(samples);
      depth.volume += weight(cell) * depth.transmitted * power_sum(depth.t, n);
      depth.transmitted *= fading_[n][Dim];
    }
    depth.t += samples;
    return true;
  }

 private:
  /// The first unseen node may be met over a corner and have no face to a seen one: the next along the ray then carries the probability.
  [[nodiscard]] double openness_at(const Ray<Dim>& ray, double range) const {
    const double give_up = std::min(range + std::sqrt(static_cast<double>(Dim)), ray.end);
    for (double t = range; t < give_up; t += 0.5) {
      const Index<Dim> cell = ray.cell(t);
      if (MarchGrid<Dim>::state(codes_.code(cell)) != NodeState::unseen) return 0.0;
      const float open = openness_.at(cell);
      if (open > 0.0F) return static_cast<double>(open);
    }
    return 0.0;
  }
  [[nodiscard]] double weight(const Index<Dim>& cell) const {
    return medium_.weight == nullptr ? 1.0 : static_cast<double>(medium_.weight->at(cell));
  }
  /// Sum of f^k (t + k)^(Dim-1) for k < samples, by the binomial theorem.
  [[nodiscard]] double power_sum(double t, std::size_t samples) const {
    double sum = 0.0, binomial = 1.0;
    for (std::size_t j = 0; j < Dim; ++j) {  // Horner from the highest power of t.
      sum = sum * t + binomial * fading_[samples][j];
      binomial = binomial * static_cast<double>(Dim - 1 - j) / static_cast<double>(j + 1);
    }
    return sum;
  }

  const Codes& codes_;
  const Field<Dim>& openness_;
  const Medium& medium_;
  const Fading& fading_;
  double own_ = 0.0;  // Obstacles as near as this do not count [cells].
  double h_, most_ = static_cast<double>(fading_.size() - 1);
  double unit_ = h_ * cell_power<Dim>(h_) * exp_minus(0.5 * medium_.lambda * h_);  // Of the first sample at range 1 [cell].
};

/// Sums per solid angle over all `rays`.
template <int Dim, class Codes>
RaySums look_along(const Codes& codes, const Beyond<Dim, Codes>& beyond, std::span<const Ray<Dim>> rays, double limit) {
  std::vector<Stop> stops(rays.size());
  in_turn<double>(
      rays.size(), [&](std::size_t i, double& t) { return t = 0.0, rays[i].inside; },
      [&](std::size_t i, double& t) {
        if (t >= std::min(limit, rays[i].end)) return false;
        if (stride(rays[i], codes, t)) return true;
        stops[i] = {t, true};
        return false;
      });
  RaySums sums;
  std::vector<double> volumes(rays.size());  // Added in the order of the rays.
  using Depth = typename Beyond<Dim, Codes>::Depth;
  in_turn<Depth>(
      rays.size(), [&](std::size_t i, Depth& depth) { return stops[i].inside && beyond.begin(rays[i], stops[i].range, depth, sums); },
      [&](std::size_t i, Depth& depth) {
        if (beyond.step(rays[i], depth)) return true;
        volumes[i] = depth.volume;
        return false;
      });
  for (const double volume : volumes) sums.volume += volume;
  return sums;
}

}  // namespace

double inverse_power(double x, double power) {
  double value = 1.0;
  for (; power >= 1.0; power -= 1.0) value /= x;
  if (power >= 0.5) {
    value /= std::sqrt(x);
    power -= 0.5;
  }
  if (power >= 0.25) value /= std::sqrt(std::sqrt(x));
  return value;
}

template <int Dim>
  requires SpatialDim<Dim>
RayMarch<Dim>::RayMarch(const BeliefView<Dim>& view, const Field<Dim>& openness, const Medium& medium)
    : view_(view), openness_(openness), medium_(medium) {
  constexpr std::size_t kMost = 2 * MarchGrid<Dim>::kFar;
  const double fade = exp_minus(medium.lambda * view.window().spacing);
  fading_.resize(kMost + 1);
  std::array<double, Dim> sums{};
  double left = 1.0;
  for (std::size_t n = 0; n <= kMost; ++n) {
    double power = left;
    for (std::size_t j = 0; j < Dim; ++j) {
      fading_[n][j] = sums[j];
      sums[j] += power;
      power *= static_cast<double>(n);
    }
    fading_[n][Dim] = left;
    left *= fade;
  }
}

template <int Dim>
  requires SpatialDim<Dim>
RaySums RayMarch<Dim>::look(const Vec<Dim>& origin, std::span<const Vec<Dim>> directions) const {
  const Grid<Dim>& grid = view_.window();
  std::vector<Ray<Dim>> rays;
  rays.reserve(directions.size());
  for (const Vec<Dim>& direction : directions) rays.emplace_back(grid, origin, direction);
  const auto along = [&](const auto& codes) {
    RaySums sums = look_along<Dim>(codes, Beyond<Dim, std::decay_t<decltype(codes)>>(codes, openness_, medium_, fading_),
                                   std::span<const Ray<Dim>>(rays), medium_.max_range / grid.spacing);
    const double solid_angle = 2.0 * kPi * (Dim - 1) / static_cast<double>(rays.size());
    for (double* sum : {&sums.volume, &sums.solid_angle, &sums.area}) *sum *= solid_angle;
    return sums;
  };
  return medium_.grid != nullptr ? along(*medium_.grid) : along(PlainCodes<Dim>{view_.state});
}

template <int Dim>
  requires SpatialDim<Dim>
double RayMarch<Dim>::unseen_volume(const Vec<Dim>& origin, std::span<const Vec<Dim>> directions) const {
  const Grid<Dim>& grid = view_.window();
  Medium clear = medium_;
  clear.lambda = 0.0;
  const RayMarch<Dim> through(view_, openness_, clear);
  std::vector<Ray<Dim>> rays;
  rays.reserve(directions.size());
  for (const Vec<Dim>& direction : directions) rays.emplace_back(grid, origin, direction);
  const auto along = [&](const auto& codes) {
    using Way = Beyond<Dim, std::decay_t<decltype(codes)>>;
    using Depth = typename Way::Depth;
    Way way(codes, openness_, through.medium_, through.fading_);
    const Depth start = way.whole_way();
    std::vector<double> volumes(rays.size());
    in_turn<Depth>(
        rays.size(), [&](std::size_t i, Depth& depth) { return depth = start, rays[i].inside; },
        [&](std::size_t i, Depth& depth) {
          if (way.step(rays[i], depth)) return true;
          volumes[i] = depth.volume;
          return false;
        });
    double sum = 0.0;
    for (const double volume : volumes) sum += volume;
    return sum * (2.0 * kPi * (Dim - 1) / static_cast<double>(rays.size()));
  };
  return medium_.grid != nullptr ? along(*medium_.grid) : along(PlainCodes<Dim>{view_.state});
}

template <int Dim>
  requires SpatialDim<Dim>
bool RayMarch<Dim>::line_of_sight(const Vec<Dim>& from, const Vec<Dim>& to, double slack) const {
  const Grid<Dim>& grid = view_.window();
  const Vec<Dim> offset = (to - from) / grid.spacing;
  const double distance = offset.norm(), limit = distance - slack / grid.spacing;
  if (limit <= 0.0) return true;
  const Ray<Dim> ray(grid, from, offset / distance);
  return (medium_.grid != nullptr ? march(ray, *medium_.grid, limit) : march(ray, PlainCodes<Dim>{view_.state}, limit)).range >= limit;
}

template <int Dim>
  requires SpatialDim<Dim>
std::vector<double> RayMarch<Dim>::highest_hits(const Vec<Dim>& origin, std::span<const Vec<Dim>> directions, std::size_t sectors) const {
  const Grid<Dim>& grid = view_.window();
  const double limit = medium_.max_range / grid.spacing;
  const auto along = [&](const auto& codes) {
    std::vector<double> all(sectors, -1.0);
    for (const Vec<Dim>& direction : directions) {
      double& highest = all[sector_of<Dim>(direction, sectors)];
      if (direction[Dim - 1] <= highest) continue;
      const Ray<Dim> ray(grid, origin, direction);
      const Stop stop = march(ray, codes, limit);
      if (stop.inside && MarchGrid<Dim>::state(codes.code(ray.cell(stop.range))) == NodeState::obstacle) highest = direction[Dim - 1];
    }
    return all;
  };
  return medium_.grid != nullptr ? along(*medium_.grid) : along(PlainCodes<Dim>{view_.state});
}

template <int Dim>
  requires SpatialDim<Dim>
double RayMarch<Dim>::weight_at(const Vec<Dim>& place) const {
  if (medium_.weight == nullptr) return 1.0;
  const Index<Dim> node = view_.window().nearest(place);
  return view_.window().inside(node) ? static_cast<double>(medium_.weight->at(node)) : 1.0;
}

template <int Dim>
std::size_t sector_of(const Vec<Dim>& direction, std::size_t sectors) {
  const double turn = std::array{direction[0] < 0.0 ? 0.0 : 0.5, 0.5 + angle_of(direction[1], direction[0]) / (2.0 * kPi)}[Dim - 2];
  return std::min(static_cast<std::size_t>(turn * static_cast<double>(sectors)), sectors - 1);
}

template <int Dim>
double measured_opacity(const BeliefView<Dim>& view) {
  struct Count {
    double walls = 0.0, seen = 0.0;
  };
  const Grid<Dim>& grid = view.window();
  const Count total = parallel_reduce(
      grid.size(), std::size_t{1} << 15, Count{},
      [&](std::size_t begin, std::size_t end) {
        Count count;
        for (std::size_t i = begin; i < end; ++i) {
          if (!view.seen(i)) continue;
          count.seen += 1.0;
          if (static_cast<double>(view.psi[i]) > 0.6 * grid.spacing) continue;
          const Index<Dim> node = grid.local(i);
          for (int a = 0; a < Dim; ++a) {
            const std::size_t stride = grid.stride(a);
            if (node[a] > 0 && view.state[i - stride] == NodeState::obstacle) count.walls += 1.0;
            if (node[a] + 1 < grid.extent[a] && view.state[i + stride] == NodeState::obstacle) count.walls += 1.0;
          }
        }
        return count;
      },
      [](Count& sum, const Count& part) {
        sum.walls += part.walls;
        sum.seen += part.seen;
      });
  // Lattice faces overcount a surface of random direction by 4/pi in 2D and 3/2 in 3D; chords are pi V / A and 4 V / A long.
  constexpr std::array<double, 2> kTrueArea{kPi / 4.0, 2.0 / 3.0}, kChord{kPi, 4.0};
  if (total.seen == 0.0) return 0.0;
  return total.walls * kTrueArea[Dim - 2] / (kChord[Dim - 2] * total.seen * grid.spacing);
}

template class RayMarch<2>;
template class RayMarch<3>;
template double measured_opacity<2>(const BeliefView<2>&);
template double measured_opacity<3>(const BeliefView<3>&);

template std::size_t sector_of<2>(const Vec<2>&, std::size_t);
template std::size_t sector_of<3>(const Vec<3>&, std::size_t);

}  // namespace vantage

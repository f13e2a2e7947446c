// SPDX-License-Identifier: Apache-2.0
#include "vantage/visibility/sieve.h"

namespace vantage {
namespace {

constexpr double kWider = 1.0 + 1e-6;

/// A polygon's plane is met at t D, t = height / n.D, if that is in front, nearer than the range so far, and within the widened polygon's ball.
VANTAGE_LANES unsigned polygon(const SieveForms& f, int first, const Lanes<float>& ranges) {
  unsigned mask = 0;
  for (int k = 0; k < kLanes; ++k) {
    const double w = f.first + (first + k) * f.step, square = f.square + w * w;
    const double slope = f.value[0] + w * f.change[0], center = f.value[1] + w * f.change[1], z = static_cast<double>(ranges[k]);
    const double height = f.height, slope2 = slope * slope, reach2 = height * height * square;
    const bool unsure = slope2 <= 1e-12 * square;
    const bool nearer = reach2 <= z * z * slope2 * kWider;
    const bool within = reach2 - 2.0 * height * slope * center + f.excess * slope2 <= 0.0;
    mask |= static_cast<unsigned>(unsure | ((slope * height >= 0.0) & nearer & within)) << k;
  }
  return mask;
}

/// A segment's line passes the ray nearer than the margin, and one of its ends is nearer than the range so far.
VANTAGE_LANES unsigned capsule(const SieveForms& f, int first, const Lanes<float>& ranges) {
  unsigned mask = 0;
  for (int k = 0; k < kLanes; ++k) {
    const double w = f.first + (first + k) * f.step, square = f.square + w * w;
    const double along = f.value[0] + w * f.change[0], off = f.value[1] + w * f.change[1], z = static_cast<double>(ranges[k]);
    const double a = f.value[2] + w * f.change[2], b = f.value[3] + w * f.change[3], nearest = a < b ? a : b;
    const bool within = f.excess * (square - along * along) <= off * off + f.slack * square;
    const bool nearer = (nearest <= 0.0) | (nearest * nearest <= z * z * square * kWider);
    mask |= static_cast<unsigned>(within & nearer) << k;
  }
  return mask;
}

VANTAGE_LANES unsigned pass(const SieveForms& f, int first, const Lanes<float>& ranges) {
  return f.polygon ? polygon(f, first, ranges) : capsule(f, first, ranges);
}

unsigned pass_anywhere(const SieveForms& f, int first, const Lanes<float>& ranges) { return pass(f, first, ranges); }
#if VANTAGE_WIDE
VANTAGE_AVX2 unsigned pass_wide(const SieveForms& f, int first, const Lanes<float>& ranges) { return pass(f, first, ranges); }
const auto best_pass = has_avx2() ? &pass_wide : &pass_anywhere;
#else
const auto best_pass = &pass_anywhere;
#endif

}  // namespace

template <int Dim>
Sieve<Dim>::Sieve(const Occluder<Dim>& occluder, double margin) {
  const double wide = margin * kWider + 1e-9;
  forms_.polygon = occluder.patch.count >= 3;
  if (forms_.polygon) {
    const double reach = occluder.radius + wide, distance = occluder.center.squaredNorm();
    vector_ = {occluder.n, occluder.center, Vec<Dim>::Zero(), Vec<Dim>::Zero()};
    forms_.height = occluder.height;
    forms_.excess = distance - reach * reach - 1e-11 * distance;
    return;
  }
  const auto& v = occluder.patch.vertices;
  const Vec<Dim> a = v[0], b = v[static_cast<std::size_t>(occluder.patch.count - 1)];
  const double length = (b - a).norm();
  const Vec<Dim> along = length > 0.0 ? Vec<Dim>((b - a) / length) : Vec<Dim>(Vec<Dim>::Zero());
  const Vec<Dim> off = a - along * along.dot(a);  // From the viewpoint to the segment's line.
  vector_ = {along, off, a, b};
  forms_.excess = off.squaredNorm() - wide * wide - 1e-11 * a.squaredNorm();
  forms_.slack = 1e-11 * a.squaredNorm();
}

template <int Dim>
void Sieve<Dim>::start(const PixelRun<Dim>& run) {
  for (std::size_t i = 0; i < vector_.size(); ++i) {
    forms_.value[i] = vector_[i].dot(run.base);
    forms_.change[i] = vector_[i].dot(run.along);
  }
  forms_.square = run.base.squaredNorm();
  forms_.first = run.offset(0);
  forms_.step = 2.0 / run.resolution;
}

template <int Dim>
unsigned Sieve<Dim>::pixels(int first, const float* ranges, int count) const {
  Lanes<float> z{};
  if (count == kLanes)
    std::copy_n(ranges, kLanes, z.begin());
  else
    std::copy_n(ranges, count, z.begin());
  return best_pass(forms_, first, z) & ((1U << count) - 1U);
}

template class Sieve<2>;
template class Sieve<3>;

}  // namespace vantage

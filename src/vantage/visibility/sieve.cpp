// SPDX-License-Identifier: Apache-2.0
#include "vantage/visibility/sieve.h"

namespace vantage {
namespace {

constexpr double kWider = 1.0 + 1e-6;

/// Linear forms of the direction along a run: value at its first pixel, and change per pixel.
struct Forms {
  double value[4], change[4];
  double square, along_square;  ///< |D|^2 = square + w^2 along_square.
  double first, step;           ///< Of w.
  double constant[3];           ///< Of the sieve.
};

/// A polygon's plane is met at t D, t = height / n.D, if that is in front, nearer than the range so far, and within the widened polygon's ball.
VANTAGE_LANES unsigned polygon(const Forms& f, const Lanes<float>& ranges) {
  unsigned mask = 0;
  for (int k = 0; k < kLanes; ++k) {
    const double w = f.first + k * f.step, square = f.square + w * w * f.along_square;
    const double slope = f.value[0] + k * f.change[0], center = f.value[1] + k * f.change[1], z = static_cast<double>(ranges[k]);
    const double height = f.constant[1], slope2 = slope * slope, reach2 = height * height * square;
    const bool unsure = slope2 <= 1e-12 * square;
    const bool nearer = reach2 <= z * z * slope2 * kWider;
    const bool within = reach2 - 2.0 * height * slope * center + f.constant[0] * slope2 <= 0.0;
    mask |= static_cast<unsigned>(unsure | ((slope * height >= 0.0) & nearer & within)) << k;
  }
  return mask;
}

/// A segment's line passes the ray nearer than the margin, and one of its ends is nearer than the range so far.
VANTAGE_LANES unsigned capsule(const Forms& f, const Lanes<float>& ranges) {
  unsigned mask = 0;
  for (int k = 0; k < kLanes; ++k) {
    const double w = f.first + k * f.step, square = f.square + w * w * f.along_square;
    const double along = f.value[0] + k * f.change[0], off = f.value[1] + k * f.change[1], z = static_cast<double>(ranges[k]);
    const double a = f.value[2] + k * f.change[2], b = f.value[3] + k * f.change[3], nearest = a < b ? a : b;
    const bool within = f.constant[0] * (square - along * along) <= off * off + f.constant[2] * square;
    const bool nearer = (nearest <= 0.0) | (nearest * nearest <= z * z * square * kWider);
    mask |= static_cast<unsigned>(within & nearer) << k;
  }
  return mask;
}

VANTAGE_LANES unsigned pass(bool flat, const Forms& forms, const Lanes<float>& ranges) {
  return flat ? polygon(forms, ranges) : capsule(forms, ranges);
}

unsigned pass_anywhere(bool flat, const Forms& forms, const Lanes<float>& ranges) { return pass(flat, forms, ranges); }
#if VANTAGE_WIDE
VANTAGE_AVX2 unsigned pass_wide(bool flat, const Forms& forms, const Lanes<float>& ranges) { return pass(flat, forms, ranges); }
const auto best_pass = has_avx2() ? &pass_wide : &pass_anywhere;
#else
const auto best_pass = &pass_anywhere;
#endif

}  // namespace

template <int Dim>
Sieve<Dim>::Sieve(const Occluder<Dim>& occluder, double margin) : flat_(occluder.patch.count >= 3), height_(0.0), slack_(0.0) {
  const double wide = margin * kWider + 1e-9;
  if (flat_) {
    const double reach = occluder.radius + wide, distance = occluder.center.squaredNorm();
    vector_ = {occluder.n, occluder.center, Vec<Dim>::Zero(), Vec<Dim>::Zero()};
    height_ = occluder.height;
    square_ = distance - reach * reach - 1e-11 * distance;
    return;
  }
  const auto& v = occluder.patch.vertices;
  const Vec<Dim> a = v[0], b = v[static_cast<std::size_t>(occluder.patch.count - 1)];
  const double length = (b - a).norm();
  const Vec<Dim> along = length > 0.0 ? Vec<Dim>((b - a) / length) : Vec<Dim>(Vec<Dim>::Zero());
  const Vec<Dim> off = a - along * along.dot(a);  // From the viewpoint to the segment's line.
  vector_ = {along, off, a, b};
  square_ = off.squaredNorm() - wide * wide - 1e-11 * a.squaredNorm();
  slack_ = 1e-11 * a.squaredNorm();
}

template <int Dim>
unsigned Sieve<Dim>::pixels(const PixelRun<Dim>& run, const float* ranges, int count) const {
  Forms forms;
  for (std::size_t i = 0; i < vector_.size(); ++i) {
    const double change = vector_[i].dot(run.along);
    forms.value[i] = vector_[i].dot(run.base) + run.first * change;
    forms.change[i] = run.step * change;
  }
  forms.square = run.base.squaredNorm();
  forms.along_square = run.along.squaredNorm();
  forms.first = run.first;
  forms.step = run.step;
  forms.constant[0] = square_;
  forms.constant[1] = height_;
  forms.constant[2] = slack_;
  Lanes<float> z{};
  for (int k = 0; k < count; ++k) z[static_cast<std::size_t>(k)] = ranges[k];
  return best_pass(flat_, forms, z) & ((1U << count) - 1U);
}

template class Sieve<2>;
template class Sieve<3>;

}  // namespace vantage

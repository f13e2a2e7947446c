// SPDX-License-Identifier: Apache-2.0
#include "vantage/report/marks.h"

#include <array>

#include "vantage/report/curves.h"
#include "vantage/report/text.h"

namespace vantage {

namespace {

constexpr Rgb kWhite{255, 255, 255}, kDiamond{53, 208, 192}, kDiamondRim{11, 31, 40}, kCross{255, 61, 120};

}  // namespace

void draw_diamond(Canvas& canvas, const Vec<2>& place, double radius) {
  const auto ring = [&](double r) {
    return std::array<Vec<2>, 4>{place + Vec<2>(0.0, -r), place + Vec<2>(r, 0.0), place + Vec<2>(0.0, r), place + Vec<2>(-r, 0.0)};
  };
  canvas.area(ring(radius + 1.6), kDiamondRim);
  canvas.area(ring(radius), kDiamond);
}

void draw_cross(Canvas& canvas, const Vec<2>& place, double radius) {
  const std::array<Vec<2>, 2> down{place - Vec<2>::Constant(radius), place + Vec<2>::Constant(radius)};
  const std::array<Vec<2>, 2> up{place + Vec<2>(-radius, radius), place + Vec<2>(radius, -radius)};
  for (const auto& [width, colour] : {std::pair{0.75 * radius, kWhite}, std::pair{0.42 * radius, kCross}}) {
    canvas.stroke(down, width, colour);
    canvas.stroke(up, width, colour);
  }
}

void draw_way(Canvas& canvas, std::span<const Vec<2>> way, double width) {
  // Piece by piece: a stroke asks every pixel of its box.
  for (const auto& [w, colour, opacity] : {std::tuple{2.2 * width, kWhite, 0.65}, std::tuple{width, kMark, 1.0}})
    for (std::size_t i = 1; i < way.size(); ++i) canvas.stroke(way.subspan(i - 1, 2), w, colour, opacity);
}

void draw_pin(Canvas& canvas, const Vec<2>& place, int number, double radius) {
  const std::array<Vec<2>, 1> centre{place};
  canvas.stroke(centre, 2.0 * radius + 3.0, kWhite);
  canvas.stroke(centre, 2.0 * radius, number == 0 ? kInk : kMark);
  const double size = 1.35 * radius;
  canvas.text(place + Vec<2>(0.0, 0.36 * size), std::to_string(number), {size, kWhite, Lettering::Align::middle, true});
}

void draw_scale(Canvas& canvas, const Vec<2>& place, double pixels_per_metre, double longest) {
  double length = 1e-3;
  for (int k = 0; k < 24; ++k) {
    const double next = length * (k % 3 == 1 ? 2.5 : 2.0);  // 1, 2, 5 and so on.
    if (next * pixels_per_metre > longest) break;
    length = next;
  }
  const double end = place.x() + length * pixels_per_metre;
  const std::array<Vec<2>, 4> bar{place - Vec<2>(0.0, 7.0), place, Vec<2>(end, place.y()), Vec<2>(end, place.y() - 7.0)};
  canvas.stroke(bar, 5.0, kWhite, 0.7);
  canvas.stroke(bar, 2.0, kInk);
  const Vec<2> middle(0.5 * (place.x() + end), place.y() - 8.0);
  canvas.text(middle, rounded(length) + "\u00a0m", {17.0, kInk, Lettering::Align::middle});
}

std::vector<Vec<2>> on_canvas(std::span<const Vec<3>> places, const Camera& camera) {
  std::vector<Vec<2>> pixels;
  for (const Vec<3>& place : places) {
    if (!place.allFinite() || !camera.in_front(place)) continue;
    const Projected q = camera.project(place);
    pixels.emplace_back(q.x, q.y);
  }
  return pixels;
}

}  // namespace vantage

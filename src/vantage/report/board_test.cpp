// SPDX-License-Identifier: Apache-2.0
#include "vantage/report/board.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "vantage/geometry/angle.h"
#include "vantage/report/facets.h"
#include "vantage/report/plot.h"
#include "vantage/report/png.h"

namespace vantage {
namespace {

constexpr Rgb kWhite{255, 255, 255}, kBlack{0, 0, 0};

/// How much of the picture is covered by black on white [pixels].
double ink(const Image& image) {
  double sum = 0.0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) sum += (255.0 - image.pixel(x, y)[0]) / 255.0;
  return sum;
}

TEST(Canvas, StrokeCoversLengthTimesWidth) {
  Canvas canvas(200, 200, kWhite);
  canvas.stroke(std::array<Vec<2>, 2>{Vec<2>(30.3, 40.1), Vec<2>(150.7, 120.9)}, 6.0, kBlack);
  const double length = (Vec<2>(150.7, 120.9) - Vec<2>(30.3, 40.1)).norm();
  EXPECT_NEAR(ink(canvas.image()), 6.0 * length + kPi * 9.0, 0.01 * 6.0 * length);  // With its round ends.
}

TEST(Canvas, AreaCoversItsArea) {
  Canvas canvas(200, 200, kWhite);
  canvas.area(std::array<Vec<2>, 3>{Vec<2>(20.0, 20.0), Vec<2>(180.0, 33.0), Vec<2>(60.0, 170.0)}, kBlack);
  const double area = 0.5 * (160.0 * 150.0 - 13.0 * 40.0);
  EXPECT_NEAR(ink(canvas.image()), area, 0.005 * area);
}

TEST(Canvas, DashesCoverTwoThirds) {
  const std::array<Vec<2>, 2> line{Vec<2>(10.0, 50.0), Vec<2>(310.0, 50.0)};
  Canvas whole(320, 100, kWhite), dashed(320, 100, kWhite);
  whole.stroke(line, 1.0, kBlack);
  dashed.dashes(line, 1.0, 20.0, kBlack);
  EXPECT_NEAR(ink(dashed.image()) / ink(whole.image()), 2.0 / 3.0, 0.06);  // The round ends of the dashes.
}

TEST(Canvas, OpacityMixes) {
  Canvas canvas(20, 20, kWhite);
  canvas.rectangle({5.0, 5.0}, {15.0, 15.0}, kBlack, 0.5);
  EXPECT_NEAR(canvas.image().pixel(10, 10)[0], 128, 1);
  EXPECT_EQ(canvas.image().pixel(2, 2)[0], 255);
}

TEST(Canvas, LaysPicturesCutAtTheRim) {
  Image picture(10, 10);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 10; ++x) picture.set(x, y, kBlack);
  Canvas canvas(20, 20, kWhite);
  canvas.lay(picture, 15, -4);
  EXPECT_DOUBLE_EQ(ink(canvas.image()), 5.0 * 6.0);
}

TEST(Letters, EveryPrintableCharacterHasOneOfItsOwn) {
  const Glyph& unknown = glyph(U'\ufffd');
  for (const char c : std::string("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789.,:;!?()[]+-=/|%<>'\"*_"))
    EXPECT_NE(&glyph(static_cast<char32_t>(c)), &unknown) << c;
  EXPECT_EQ(&glyph(U'\u4e00'), &unknown);
}

TEST(Letters, StrokesStayWithinTheirWidthAndLine) {
  for (char32_t c = U'!'; c <= U'~'; ++c)
    for (const auto& stroke : glyph(c).strokes)
      for (const Vec<2>& p : stroke) {
        EXPECT_GE(p.x(), -1.0) << static_cast<int>(c);
        EXPECT_LE(p.x(), glyph(c).width + 0.3) << static_cast<int>(c);
        EXPECT_GE(p.y(), -5.0) << static_cast<int>(c);
        EXPECT_LE(p.y(), 16.5) << static_cast<int>(c);
      }
}

TEST(Letters, WidthAddsUpAndScales) {
  const double gap = text_width("no") - text_width("n") - text_width("o");
  EXPECT_GT(gap, 0.0);
  EXPECT_NEAR(text_width("nono"), 2.0 * text_width("no") + gap, 1e-9);
  EXPECT_NEAR(text_width("scans", {40.0}), 2.0 * text_width("scans", {20.0}), 1e-9);
  EXPECT_GT(text_width("\xff\xfe"), 0.0);  // Broken UTF-8 gives boxes.
}

TEST(Letters, TurnedTextHasTheSameInk) {
  Canvas flat(120, 120, kWhite), turned(120, 120, kWhite);
  flat.text({10.0, 60.0}, "Eta 0.4 m", {20.0, kBlack});
  turned.text({60.0, 110.0}, "Eta 0.4 m", {20.0, kBlack, Lettering::Align::left, false, true});
  EXPECT_GT(ink(flat.image()), 200.0);
  EXPECT_NEAR(ink(turned.image()), ink(flat.image()), 0.02 * ink(flat.image()));
}

TEST(PlotImage, LinePassesWhereItsValuesAre) {
  Plot plot{"", "x", "y"};
  plot.lines.push_back({{200, 0, 0}, PlotLine::Style::dots, {0.0, 10.0}, {0.0, 10.0}});
  const Image image = plot_image(plot, 400, 300);
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p = image.pixel(x, y);
      if (p[0] < 190 || p[1] > 40) continue;
      left = std::min<double>(left, x), right = std::max<double>(right, x), top = std::min<double>(top, y), bottom = std::max<double>(bottom, y);
    }
  EXPECT_NEAR(left, 86.0, 6.0);  // The dots' centres lie on the frame's corners.
  EXPECT_NEAR(right, 378.0, 6.0);
  EXPECT_NEAR(top, 44.0, 6.0);
  EXPECT_NEAR(bottom, 234.0, 6.0);
}

TEST(PlotImage, NothingToShowIsAnEmptyFrame) {
  Plot plot{"", "x", "y", true};
  plot.lines.push_back({kBlack, PlotLine::Style::line, {1.0, 2.0}, {0.0, std::nan("")}});
  EXPECT_EQ(plot_image(plot, 300, 200).width, 300);
}

TEST(BoardImage, HoldsItsTilesAndLegend) {
  Image tile(100, 80);
  for (int y = 0; y < 80; ++y)
    for (int x = 0; x < 100; ++x) tile.set(x, y, {10, 200, 10});
  const Image image = board_image({"title", "note", {{"row", {{tile, "one"}, {tile, "two"}}}}, {{Key::Sign::area, {200, 10, 10}, "a key", {}}}});
  int green = 0, red = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p = image.pixel(x, y);
      green += p[1] == 200 && p[0] == 10 ? 1 : 0;
      red += p[0] == 200 && p[1] == 10 ? 1 : 0;
    }
  EXPECT_EQ(green, 2 * 100 * 80);
  EXPECT_GT(red, 100);
  EXPECT_FALSE(png(image).empty());
}

/// psi of a world seen but for a ball; the ball's lower half is a known obstacle.
struct Ball {
  static constexpr double kRadius = 1.3, kSpacing = 0.1;
  Field<3> psi{window_over<3>({Vec<3>::Constant(-2.0), Vec<3>::Constant(2.0)}, kSpacing)};
  Field<3, NodeState> state{psi.window};
  Ball() {
    for (std::size_t i = 0; i < psi.values.size(); ++i) {
      const Vec<3> p = psi.window.position(i);
      psi[i] = static_cast<float>(p.norm() - kRadius);
      state[i] = psi[i] > 0.0F ? NodeState::seen : p.z() < 0.0 ? NodeState::obstacle : NodeState::unseen;
    }
  }
};

TEST(LevelSurface, OfABallIsTheSphere) {
  const Ball ball;
  const LevelSurface surface = level_surface(ball.psi, ball.state, 0);
  double area = 0.0;
  for (const Vec<3>& v : surface.vertices) EXPECT_NEAR(v.norm(), Ball::kRadius, 0.3 * Ball::kSpacing);
  for (const auto& quad : surface.quads) {
    const Vec<3>&a = surface.vertices[quad.corners[0]], &b = surface.vertices[quad.corners[1]], &c = surface.vertices[quad.corners[2]],
          &d = surface.vertices[quad.corners[3]];
    const Vec<3> u = c - a, v = d - b;
    area += 0.5 * Vec<3>(u.y() * v.z() - u.z() * v.y(), u.z() * v.x() - u.x() * v.z(), u.x() * v.y() - u.y() * v.x()).norm();
    const double height = 0.25 * (a + b + c + d).z();
    if (std::abs(height) > 2.0 * Ball::kSpacing) {
      EXPECT_EQ(quad.known, height < 0.0);
    }
  }
  EXPECT_NEAR(area, 4.0 * kPi * Ball::kRadius * Ball::kRadius, 0.03 * area);
}

TEST(LevelSurface, IsClosed) {
  const Ball ball;
  const LevelSurface surface = level_surface(ball.psi, ball.state);
  EXPECT_EQ(surface.vertices.size(), surface.quads.size() + 2);  // Euler: V - E + F = 2 with E = 2 F.
}

TEST(LevelSurface, RelaxedStaysWithinTheCell) {
  const Ball ball;
  const LevelSurface before = level_surface(ball.psi, ball.state, 0), after = level_surface(ball.psi, ball.state, 5);
  ASSERT_EQ(before.vertices.size(), after.vertices.size());
  for (std::size_t i = 0; i < before.vertices.size(); ++i)
    EXPECT_LE((after.vertices[i] - before.vertices[i]).cwiseAbs().maxCoeff(), 0.45 * Ball::kSpacing + 1e-12);
}

}  // namespace
}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <png.h>

#include "vantage/base/random.h"
#include "vantage/geometry/angle.h"
#include "vantage/report/png.h"
#include "vantage/report/raster.h"

namespace vantage {
namespace {

const Box<3> kCube{Vec<3>(0.0, 0.0, 0.0), Vec<3>(10.0, 10.0, 10.0)};
constexpr Rgb kRed{200, 20, 10}, kBlue{10, 20, 200};

/// Pixels of a PNG file by libpng's own reader.
Image decoded(const std::string& file) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  EXPECT_TRUE(png_image_begin_read_from_memory(&header, file.data(), file.size()));
  header.format = PNG_FORMAT_RGBA;
  Image image(static_cast<int>(header.width), static_cast<int>(header.height));
  EXPECT_TRUE(png_image_finish_read(&header, nullptr, image.rgba.data(), 0, nullptr));
  return image;
}

TEST(Png, FewColoursComeBackExactly) {
  Image image(37, 21);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if ((x + y) % 3 != 0) image.set(x, y, {static_cast<std::uint8_t>(7 * (x % 16)), static_cast<std::uint8_t>(9 * (y % 8)), 77}, x % 2 == 0 ? 255 : 128);
    }
  }
  EXPECT_EQ(decoded(png(image)).rgba, image.rgba);
}

TEST(Png, ManyColoursComeBackNearly) {
  Image image(256, 256);
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x) image.set(x, y, {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), static_cast<std::uint8_t>((x + y) / 2)});
  }
  EXPECT_LE(quantised(image).palette.size(), 256U);
  const Image back = decoded(png(image));
  double sum = 0.0;
  int worst = 0;
  for (std::size_t i = 0; i < image.rgba.size(); ++i) {
    const int error = std::abs(image.rgba[i] - back.rgba[i]);
    sum += error;
    worst = std::max(worst, error);
  }
  // 256 cells of a 256 x 256 plane are 16 wide: at most 16 or so from a cell's mean, 4 on average over the three channels that vary.
  EXPECT_LT(worst, 24);
  EXPECT_LT(sum / static_cast<double>(image.rgba.size()), 4.0);
}

TEST(Png, RareColoursSurviveQuantising) {
  Image image(200, 200);
  Random random(5);
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 200; ++x) {
      const auto grey = [&] { return static_cast<std::uint8_t>(90 + random.below(90)); };
      image.set(x, y, {grey(), grey(), grey()});
    }
  }
  for (int x = 80; x < 120; ++x) image.set(x, 100, {250, 10, 10});
  const Image back = decoded(png(image));
  EXPECT_GT(back.pixel(100, 100)[0], 235);
  EXPECT_LT(back.pixel(100, 100)[1], 25);
}

TEST(Base64, KnownVectors) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST(Colour, MapsStartAndEndAsPublished) {
  EXPECT_EQ(colour_of(ColourMap::viridis, 0.0), (Rgb{68, 1, 84}));
  EXPECT_EQ(colour_of(ColourMap::viridis, 7.0), (Rgb{253, 231, 37}));
  EXPECT_EQ(colour_of(ColourMap::inferno, std::nan("")), (Rgb{0, 0, 4}));
  for (int i = 0; i < 100; ++i) {
    const auto light = [](Rgb c) { return 0.21 * c.r + 0.72 * c.g + 0.07 * c.b; };
    EXPECT_LT(light(colour_of(ColourMap::inferno, i / 100.0)), light(colour_of(ColourMap::inferno, (i + 1) / 100.0))) << i;
  }
}

TEST(Image, LayingOverBlends) {
  Image base(2, 1), top(2, 1);
  base.set(0, 0, {100, 100, 100});
  top.set(0, 0, {200, 0, 100}, 128);
  lay_over(base, top);
  EXPECT_NEAR(base.pixel(0, 0)[0], 150, 1);
  EXPECT_NEAR(base.pixel(0, 0)[1], 50, 1);
  EXPECT_EQ(base.pixel(0, 0)[3], 255);
  EXPECT_EQ(base.pixel(1, 0)[3], 0);
}

TEST(Camera, MapIsToScale) {
  const Camera camera = Camera::map({Vec<3>(10.0, 20.0, 0.0), Vec<3>(30.0, 30.0, 5.0)}, {1000, 1000, 50.0});
  EXPECT_EQ(camera.width(), 1000);
  EXPECT_EQ(camera.height(), 550);
  const Projected low = camera.project({10.0, 20.0, 0.0}), high = camera.project({30.0, 30.0, 3.0});
  EXPECT_NEAR(low.x, 50.0, 1e-6);
  EXPECT_NEAR(low.y, 500.0, 1e-6);
  EXPECT_NEAR(high.x, 950.0, 1e-6);
  EXPECT_NEAR(high.y, 50.0, 1e-6);
  EXPECT_NEAR(camera.pixel_size(7.0), 20.0 / 900.0, 1e-12);
  EXPECT_NEAR((camera.ground(low.x, low.y) - Vec<2>(10.0, 20.0)).norm(), 0.0, 1e-9);
  EXPECT_LT(camera.distance(high.depth), camera.distance(low.depth));
}

TEST(Camera, BirdFillsTheFrameAndKeepsItsMargin) {
  for (const double azimuth : {0.0, 25.0, 62.0, 130.0, 300.0}) {
    const Camera camera = Camera::bird(kCube, radians(azimuth), radians(35.0), {800, 600, 20.0});
    Box<2> seen;
    for (int k = 0; k < 8; ++k) {
      const Projected q = camera.project({k & 1 ? 10.0 : 0.0, k & 2 ? 10.0 : 0.0, k & 4 ? 10.0 : 0.0});
      seen.extend(Vec<2>(q.x, q.y));
    }
    EXPECT_LE(camera.width(), 800);
    EXPECT_LE(camera.height(), 600);
    EXPECT_NEAR(seen.low.x(), 20.0, 1.0);
    EXPECT_NEAR(seen.low.y(), 20.0, 1.0);
    EXPECT_NEAR(seen.high.x(), camera.width() - 20.0, 1.0);
    EXPECT_NEAR(seen.high.y(), camera.height() - 20.0, 1.0);
  }
}

TEST(Camera, BirdLooksDownAlongItsAzimuth) {
  const Camera camera = Camera::bird(kCube, radians(90.0), radians(30.0), {800, 800, 20.0});
  EXPECT_NEAR((camera.forward() - Vec<3>(0.0, std::sqrt(0.75), -0.5)).norm(), 0.0, 1e-12);
  const Projected centre = camera.project(kCube.center()), higher = camera.project({5.0, 5.0, 6.0}), farther = camera.project({5.0, 8.0, 5.0});
  const Projected right = camera.project({6.0, 5.0, 5.0});
  EXPECT_LT(higher.y, centre.y);
  EXPECT_LT(farther.y, centre.y);
  EXPECT_GT(camera.distance(farther.depth), camera.distance(centre.depth));
  EXPECT_GT(right.x, centre.x);
  EXPECT_NEAR(right.y, centre.y, 1e-9);
  EXPECT_FALSE(camera.in_front(kCube.center() - 100.0 * camera.forward()));
}

std::array<Vec<3>, 3> triangle(double z, double side) { return {Vec<3>(1.0, 1.0, z), Vec<3>(1.0 + side, 1.0, z), Vec<3>(1.0, 1.0 + side, z)}; }

TEST(Raster, NearHidesFarInAnyOrder) {
  const Camera camera = Camera::map(kCube, {200, 200, 0.0});
  for (const bool near_first : {true, false}) {
    Raster raster(camera);
    if (near_first) raster.polygon(triangle(8.0, 4.0), kRed);
    raster.polygon(triangle(2.0, 8.0), kBlue);
    if (!near_first) raster.polygon(triangle(8.0, 4.0), kRed);
    const Image image = resolved(raster, {0.0});
    const Projected both = camera.project({2.0, 2.0, 0.0}), far_only = camera.project({2.0, 7.5, 0.0}), none = camera.project({9.0, 9.0, 0.0});
    const auto at = [&](const Projected& q) { return image.pixel(static_cast<int>(q.x), static_cast<int>(q.y)); };
    EXPECT_EQ((Rgb{at(both)[0], at(both)[1], at(both)[2]}), kRed);
    EXPECT_EQ((Rgb{at(far_only)[0], at(far_only)[1], at(far_only)[2]}), kBlue);
    EXPECT_EQ(at(none)[3], 0);
  }
}

TEST(Raster, PerspectiveDepthIsExactInsideATriangle) {
  const Camera camera = Camera::bird(kCube, radians(40.0), radians(30.0), {300, 300, 10.0});
  Raster raster(camera);
  const std::array<Vec<3>, 3> floor{Vec<3>(0.0, 0.0, 0.0), Vec<3>(10.0, 0.0, 0.0), Vec<3>(0.0, 10.0, 0.0)};
  raster.polygon(floor, kRed);
  const Vec<3> p(3.0, 3.0, 0.0);
  const Projected q = camera.project(p);
  const float distance = raster.distance(static_cast<int>(q.x * Raster::kSamples), static_cast<int>(q.y * Raster::kSamples));
  EXPECT_NEAR(distance, camera.distance(q.depth), 2.0 * camera.pixel_size(distance));
}

TEST(Raster, AreaOfAPolygonAndADisc) {
  const Camera camera = Camera::map(kCube, {400, 400, 0.0});
  const auto covered = [&](auto&& draw) {
    Raster raster(camera);
    draw(raster);
    double sum = 0.0;
    const Image image = resolved(raster, {0.0});
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) sum += image.rgba[i] / 255.0;
    return sum;
  };
  const std::array<Vec<3>, 4> square{Vec<3>(2.1, 3.3, 1.0), Vec<3>(7.1, 3.3, 1.0), Vec<3>(7.1, 6.3, 1.0), Vec<3>(2.1, 6.3, 1.0)};
  EXPECT_NEAR(covered([&](Raster& raster) { raster.polygon(square, kRed); }), 15.0 * 1600.0, 150.0);
  EXPECT_NEAR(covered([&](Raster& raster) { raster.point({5.0, 5.0, 5.0}, 30.0, kRed); }), kPi * 900.0, 30.0);
  EXPECT_NEAR(covered([&](Raster& raster) { raster.segment({2.0, 2.0, 1.0}, {6.0, 5.0, 1.0}, 8.0, kRed); }), 200.0 * 8.0 + kPi * 16.0, 30.0);
}

TEST(Raster, TooSmallToMeetASampleStillShows) {
  Raster raster(Camera::map(kCube, {50, 50, 0.0}));
  const std::array<Vec<3>, 3> speck{Vec<3>(5.0, 5.0, 1.0), Vec<3>(5.001, 5.0, 1.0), Vec<3>(5.0, 5.001, 1.0)};
  raster.polygon(speck, kRed);
  int count = 0;
  for (int y = 0; y < raster.height(); ++y) {
    for (int x = 0; x < raster.width(); ++x) count += raster.empty(x, y) ? 0 : 1;
  }
  EXPECT_EQ(count, 1);
}

TEST(Raster, NothingOutsideThePictureOrBehindTheEye) {
  const Camera camera = Camera::bird(kCube, 0.3, 0.5, {60, 60, 5.0});
  Raster raster(camera);
  raster.point(kCube.center() - 1000.0 * camera.forward(), 5.0, kRed);
  raster.point(kCube.center() + 1000.0 * camera.right(), 5.0, kRed);
  raster.segment(kCube.center() + 500.0 * camera.up(), kCube.center() + 501.0 * camera.up(), 3.0, kRed);
  const std::array<Vec<3>, 3> around{kCube.center(), kCube.center() - 1000.0 * camera.forward(), kCube.center() + camera.up()};
  raster.polygon(around, kRed);
  raster.polygon(std::span(around).first(2), kRed);
  for (int y = 0; y < raster.height(); ++y) {
    for (int x = 0; x < raster.width(); ++x) EXPECT_TRUE(raster.empty(x, y));
  }
}

TEST(Shade, APlaneKeepsItsColourAndAFootOfAWallIsDarker) {
  const Camera camera = Camera::bird(kCube, radians(90.0), radians(35.0), {300, 300, 10.0});
  Raster raster(camera);
  const std::array<Vec<3>, 4> floor{Vec<3>(0, 0, 0), Vec<3>(10, 0, 0), Vec<3>(10, 8, 0), Vec<3>(0, 8, 0)};
  const std::array<Vec<3>, 4> wall{Vec<3>(0, 8, 0), Vec<3>(10, 8, 0), Vec<3>(10, 8, 6), Vec<3>(0, 8, 6)};
  const Rgb grey{200, 200, 200};
  raster.polygon(floor, grey);
  raster.polygon(wall, grey);
  const Image image = resolved(raster);
  const auto light = [&](const Vec<3>& p) {
    const Projected q = camera.project(p);
    return static_cast<int>(image.pixel(static_cast<int>(q.x), static_cast<int>(q.y))[0]);
  };
  EXPECT_GE(light({5.0, 3.0, 0.0}), 195);
  EXPECT_GE(light({5.0, 8.0, 4.0}), 195);
  EXPECT_LT(light({5.0, 7.9, 0.0}), 180);
}

}  // namespace
}  // namespace vantage

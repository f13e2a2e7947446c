// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/occupancy_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <numbers>
#include <set>

#include "vantage/base/error.h"
#include "vantage/base/random.h"
#include "vantage/io/image.h"
#include "vantage/io/test_data.h"

namespace vantage {
namespace {

using testing::HasSubstr;

std::string error_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& e) {
    const std::string message = e.what();
    EXPECT_EQ(message.find_first_of("\r\n"), std::string::npos) << message;
    return std::to_string(static_cast<int>(e.code())) + " " + message;
  }
  return {};
}

void put(const std::filesystem::path& path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }

/// Bytes of a PNG of the given libpng format.
std::string png(int width, int height, unsigned format, const std::vector<std::uint8_t>& samples, const std::vector<std::uint8_t>& colors = {}) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<unsigned>(width);
  image.height = static_cast<unsigned>(height);
  image.format = format;
  image.colormap_entries = static_cast<unsigned>(colors.size() / 3);
  png_alloc_size_t size = 0;
  EXPECT_TRUE(png_image_write_to_memory(&image, nullptr, &size, 0, samples.data(), 0, colors.empty() ? nullptr : colors.data()));
  std::string bytes(size, '\0');
  EXPECT_TRUE(png_image_write_to_memory(&image, bytes.data(), &size, 0, samples.data(), 0, colors.empty() ? nullptr : colors.data()));
  return bytes;
}

std::vector<std::uint8_t> shades_of(const std::string& bytes, std::uint8_t background = 205) {
  const ScratchFolder folder;
  put(folder / "a", bytes);
  return read_gray_image(folder / "a", background).pixels;
}

TEST(Image, ShadesOfEveryKind) {
  using Shades = std::vector<std::uint8_t>;
  const Shades truth{0, 205, 254, 255};
  EXPECT_EQ(shades_of("P2 # made by hand\n2 2\n# shades\n255\n0 205\n254 255\n"), truth);
  EXPECT_EQ(shades_of(std::string("P5\n2 2\n255\n\x00\xcd\xfe\xff", 15)), truth);
  EXPECT_EQ(shades_of(std::string("P5 2 1 65535\n\x00\x00\xff\xff", 17)), (Shades{0, 255}));
  EXPECT_EQ(shades_of("P2 3 1 100 0 50 100"), (Shades{0, 128, 255}));
  EXPECT_EQ(shades_of(png(2, 2, PNG_FORMAT_GRAY, truth)), truth);
  EXPECT_EQ(shades_of(png(2, 2, PNG_FORMAT_RGB, {0, 0, 0, 205, 205, 205, 254, 254, 254, 255, 255, 255})), truth);
  EXPECT_EQ(shades_of(png(2, 2, PNG_FORMAT_RGB_COLORMAP, {2, 0, 1, 0}, {205, 205, 205, 254, 254, 254, 0, 0, 0})), (Shades{0, 205, 254, 205}));
  EXPECT_EQ(shades_of(png(2, 2, PNG_FORMAT_GA, {0, 255, 205, 255, 254, 255, 7, 0}), 99), (Shades{0, 205, 254, 99}));
}

/// The PNG with another size in its header, checksum and all.
std::string resized(std::string bytes, std::uint32_t width, std::uint32_t height) {
  const auto put_u32 = [&](std::size_t at, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(value >> (24 - 8 * i));
  };
  put_u32(16, width);
  put_u32(20, height);
  std::uint32_t crc = 0xffffffff;
  for (std::size_t i = 12; i < 29; ++i) {
    crc ^= static_cast<unsigned char>(bytes[i]);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320U : 0U);
  }
  put_u32(29, ~crc);
  return bytes;
}

TEST(Image, Hostile) {
  EXPECT_THAT(error_of([] { (void)shades_of(""); }), HasSubstr("is empty"));
  EXPECT_THAT(error_of([] { (void)shades_of("GIF89a"); }), HasSubstr("not an image"));
  EXPECT_THAT(error_of([] { (void)shades_of("P5"); }), HasSubstr("PGM header"));
  EXPECT_THAT(error_of([] { (void)shades_of("P5 -3 4 255 "); }), HasSubstr("PGM header"));
  EXPECT_THAT(error_of([] { (void)shades_of("P5 60000 60000 255\n"); }), HasSubstr("60000 x 60000 pixels: must be 1 .. 64 million"));
  EXPECT_THAT(error_of([] { (void)shades_of("P5 6000 6000 255\nabc"); }), HasSubstr("6000 x 6000 pixels exceed the file"));
  EXPECT_THAT(error_of([] { (void)shades_of("P5 2 2 99999\nabcd"); }), HasSubstr("greatest shade 99999"));
  EXPECT_THAT(error_of([] { (void)shades_of("P2 2 2 9\n1 2 3\n"), (void)shades_of("P2 2 2 9\n1 2 3 x\n"); }), HasSubstr("PGM"));
  EXPECT_THAT(error_of([] { (void)shades_of("P2 2 2 9\n1 2 3 10\n"); }), HasSubstr("pixel 3: must be 0 .. 9"));
  const std::string whole = png(2, 2, PNG_FORMAT_GRAY, {0, 1, 2, 3});
  EXPECT_THAT(error_of([&] { (void)shades_of(resized(whole, 60000, 60000)); }), HasSubstr("60000 x 60000 pixels: must be 1 .. 64 million"));
  EXPECT_THAT(error_of([&] { (void)shades_of(resized(whole, 8000, 8000)); }), HasSubstr("8000 x 8000 pixels exceeds the file"));
  for (std::size_t n = 1; n + 12 < whole.size(); ++n)
    EXPECT_THAT(error_of([&] { (void)shades_of(whole.substr(0, n)); }), testing::StartsWith("2 ")) << n;
}

/// Map of text, `.` free, `#` occupied, else unknown; the first row is the top.
OccupancyMap drawn(const std::vector<std::string>& rows) {
  OccupancyMap map;
  map.width = static_cast<int>(rows[0].size());
  map.height = static_cast<int>(rows.size());
  map.resolution = 1.0;
  for (auto row = rows.rbegin(); row != rows.rend(); ++row)
    for (const char c : *row) map.cells.push_back(c == '.' ? CellState::free : c == '#' ? CellState::occupied : CellState::unknown);
  return map;
}

double length_of(const Mesh<2>& mesh) {
  double sum = 0.0;
  for (const auto& f : mesh.facets) sum += (mesh.vertices[f[1]] - mesh.vertices[f[0]]).norm();
  return sum;
}

TEST(OccupancyMap, WallsAreTheFreeCellsBorder) {
  const Mesh<2> mesh = walls(drawn({"####", "#..#", "#.##", "####"}));
  EXPECT_EQ(mesh.facets.size(), 6U + 4U);  // An L, and the frame.
  EXPECT_DOUBLE_EQ(length_of(mesh), 8.0 + 24.0);
  EXPECT_EQ(mesh.bounds().low, Vec<2>(-1, -1));
  EXPECT_EQ(mesh.bounds().high, Vec<2>(5, 5));
  // Open rims, unknown cells and a diagonal touch are walls as well.
  EXPECT_DOUBLE_EQ(length_of(walls(drawn({"."}))), 4.0 + 12.0);
  EXPECT_DOUBLE_EQ(length_of(walls(drawn({".?", "?."}))), 8.0 + 16.0);
  EXPECT_EQ(walls(drawn({".?", "?."})).facets.size(), 4U + 2U + 4U);
  EXPECT_EQ(walls(drawn({"....", "...."})).facets.size(), 8U);
}

TEST(OccupancyMap, WallsCloseAndMatchTheCells) {
  Random random(3);
  for (int round = 0; round < 30; ++round) {
    std::vector<std::string> rows(9, std::string(12, '.'));
    for (std::string& row : rows)
      for (char& c : row) c = ".#?."[random.below(4)];
    const OccupancyMap map = drawn(rows);
    const Mesh<2> mesh = walls(map);
    double border = 0.0;
    for (int y = -1; y <= map.height; ++y)
      for (int x = -1; x <= map.width; ++x) {
        border += (map.at(x, y) == CellState::free) != (map.at(x + 1, y) == CellState::free) ? 1.0 : 0.0;
        border += (map.at(x, y) == CellState::free) != (map.at(x, y + 1) == CellState::free) ? 1.0 : 0.0;
      }
    EXPECT_DOUBLE_EQ(length_of(mesh), border + 2.0 * (map.width + 2 + map.height + 2));
    std::vector<int> uses(mesh.vertices.size(), 0);  // Every corner is the end of an even number of segments: the outline is closed.
    for (const auto& f : mesh.facets) ++uses[f[0]], ++uses[f[1]];
    for (const int count : uses) EXPECT_EQ(count % 2, 0);
  }
}

TEST(OccupancyMap, OriginAndYawPlaceTheCells) {
  OccupancyMap map = drawn({".#"});
  map.resolution = 0.5;
  map.origin = {10.0, 20.0};
  map.yaw = 0.5 * std::numbers::pi;
  EXPECT_LT((map.position(2.0, 1.0) - Vec<2>(9.5, 21.0)).norm(), 1e-12);
}

std::string map_error(const std::string& yaml) {
  const ScratchFolder folder;
  put(folder / "map.pgm", "P2 2 1 255 0 254\n");
  put(folder / "map.yaml", yaml);
  return error_of([&] { (void)read_occupancy_map(folder / "map.yaml"); });
}

TEST(OccupancyMap, YamlSaysItAll) {
  const ScratchFolder folder;
  put(folder / "m.pgm", "P2 2 2 255\n0 205\n254 100\n");
  put(folder / "m.yaml", "image: m.pgm\nresolution: 0.25\norigin: [1, 2, 3]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
  const OccupancyMap map = read_occupancy_map(folder / "m.yaml");
  EXPECT_EQ(map.resolution, 0.25);
  EXPECT_EQ(map.origin, Vec<2>(1, 2));
  EXPECT_EQ(map.yaw, 3.0);
  EXPECT_EQ(map.at(0, 1), CellState::occupied);  // Top left.
  EXPECT_EQ(map.at(1, 1), CellState::unknown);
  EXPECT_EQ(map.at(0, 0), CellState::free);
  EXPECT_EQ(map.at(1, 0), CellState::unknown);
  EXPECT_EQ(map.at(2, 0), CellState::unknown);
  put(folder / "n.yaml", "image: m.pgm\nnegate: 1\n");
  EXPECT_EQ(read_occupancy_map(folder / "n.yaml").at(0, 1), CellState::free);
  EXPECT_EQ(read_occupancy_map(folder / "n.yaml").resolution, 0.05);
  EXPECT_EQ(read_occupancy_map(folder / "m.pgm").resolution, 0.05);
  EXPECT_EQ(read_occupancy_map(folder / "m.pgm", 0.2).resolution, 0.2);
}

TEST(OccupancyMap, HostileYaml) {
  EXPECT_EQ(map_error("image: map.pgm\n"), "");
  const std::pair<const char*, const char*> cases[] = {
      {"", "not a map's description"},
      {"[1, 2]", "not a map's description"},
      {"resolution: 0.05\n", "lacks 'image: FILE'"},
      {"image: [a]\n", "lacks 'image: FILE'"},
      {"image: map.pgm\nresolution: 0\n", "resolution = 0: must be"},
      {"image: map.pgm\nresolution: nan\n", "resolution"},
      {"image: map.pgm\nresolution: .nan\n", "resolution = nan: must be"},
      {"image: map.pgm\nresolution: [1]\n", "resolution: must be a number"},
      {"image: map.pgm\norigin: [1]\n", "origin: must be [x, y, yaw]"},
      {"image: map.pgm\norigin: [0, 0, .inf]\n", "origin = inf"},
      {"image: map.pgm\nnegate: maybe\n", "negate: must be 0 | 1"},
      {"image: map.pgm\nfree_thresh: 0.9\n", "free_thresh = 0.9: must be <= occupied_thresh = 0.65"},
      {"image: map.pgm\nmode: raw\n", "mode = raw: must be trinary | scale"},
      {"image: \"map\\n.pgm\"\n", "lacks 'image: FILE'"},
      {"{a: &a [*a, *a]", "map.yaml:"},
      {"\t\tx: : -\n-", "map.yaml"},
  };
  for (const auto& [yaml, message] : cases) EXPECT_THAT(map_error(yaml), testing::AllOf(testing::StartsWith("2 "), HasSubstr(message))) << yaml;
  EXPECT_THAT(map_error(std::string(100000, '[')), testing::StartsWith("2 "));
  EXPECT_THAT(map_error("image: none.png\n"), testing::AllOf(testing::StartsWith("3 "), HasSubstr("none.png: cannot open")));
  EXPECT_THAT(map_error(std::string(2 << 20, ' ')), HasSubstr("larger than 1 MiB"));
}

TEST(OccupancyMap, RealPlans) {
  VANTAGE_NEEDS_DATA("maps2d");
  const OccupancyMap stata = read_occupancy_map(data_set("maps2d") / "stata_basement.yaml");
  EXPECT_EQ(stata.width, 1730);
  EXPECT_EQ(stata.height, 1300);
  EXPECT_EQ(stata.resolution, 0.0504);
  const auto share = [](const OccupancyMap& map, CellState state) {
    return static_cast<double>(std::count(map.cells.begin(), map.cells.end(), state)) / static_cast<double>(map.cells.size());
  };
  EXPECT_NEAR(share(stata, CellState::free), 0.158, 0.05);
  EXPECT_GT(share(stata, CellState::unknown), 0.7);
  const OccupancyMap levine = read_occupancy_map(data_set("maps2d") / "levinelobby.yaml");
  EXPECT_EQ(levine.width, 692);
  EXPECT_EQ(levine.height, 836);
  EXPECT_GT(share(levine, CellState::free), 0.02);
  EXPECT_GT(share(levine, CellState::occupied), 0.001);
}

}  // namespace
}  // namespace vantage

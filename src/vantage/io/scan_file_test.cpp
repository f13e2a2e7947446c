// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/scan_file.h"

#include <gtest/gtest.h>

#include "vantage/base/error.h"
#include "vantage/io/octomap.h"
#include "vantage/io/sample_scans.h"
#include "vantage/io/test_data.h"

namespace vantage {
namespace {

using samples::few_points;
using samples::Points;

double largest_difference(const Points& a, const Points& b) {
  if (a.size() != b.size()) return kInfinity;
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).cwiseAbs().maxCoeff());
  return largest;
}

MeasuredScan only(const std::string& bytes, std::string_view name) {
  std::vector<MeasuredScan> scans = parse_scan_file(bytes, name);
  EXPECT_EQ(scans.size(), 1U);
  return scans.at(0);
}

std::string error_of(const std::string& bytes, std::string_view name) {
  try {
    (void)parse_scan_file(bytes, name);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
    return error.what();
  }
  return "";
}

template <class Number>
std::string with(std::string bytes, std::size_t offset, Number value) {
  std::string raw;
  put(raw, value);
  return bytes.replace(offset, raw.size(), raw);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(ScanFile, PlyAndPcdOfEveryEncodingHoldTheSamePoints) {
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    const MeasuredScan scan = only(samples::ply(format, few_points()), "a.ply");
    EXPECT_EQ(largest_difference(scan.points, few_points()), 0.0) << format;
    EXPECT_EQ(scan.format, std::string("PLY, ") + format);
    EXPECT_FALSE(scan.position.has_value());
  }
  for (const char* data : {"ascii", "binary", "binary_compressed"}) {
    const MeasuredScan scan = only(samples::pcd(data, few_points()), "a.pcd");
    EXPECT_EQ(largest_difference(scan.points, few_points()), 0.0) << data;
    EXPECT_FALSE(scan.position.has_value()) << "a default VIEWPOINT says nothing";
  }
}

TEST(ScanFile, AViewpointIsThePlaceOfTheSensorAmongThePoints) {
  const MeasuredScan scan = only(samples::pcd("binary", few_points(), "1 2 3 0 0 0 -2"), "a.pcd");
  EXPECT_EQ(largest_difference(scan.points, few_points()), 0.0);
  EXPECT_EQ(scan.position.value(), Vec<3>(1, 2, 3));
  EXPECT_NEAR((scan.orientation * Vec<3>(1, 0, 0) - Vec<3>(-1, 0, 0)).norm(), 0.0, 1e-15);
  EXPECT_NE(error_of(samples::pcd("ascii", few_points(), "1 2 3 0 0 0 0"), "a.pcd").find("quaternion"), std::string::npos);
  EXPECT_NE(error_of(samples::pcd("ascii", few_points(), "1 2 3"), "a.pcd").find("a.pcd:9: VIEWPOINT"), std::string::npos);
}

TEST(ScanFile, PointsThatAreNotFiniteAreCountedAndLeftOut) {
  const MeasuredScan scan = only("1 2 3\nnan 1 1\n4 5 6\n1 inf 1\n", "a.xyz");
  EXPECT_EQ(scan.points, (Points{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(scan.not_finite, 2);
  EXPECT_EQ(scan.dim, 3);
}

TEST(ScanFile, TheContentTellsTheFormatBeforeTheName) {
  for (const auto& [name, bytes] : samples::all()) {
    if (name.ends_with(".bin") || name.ends_with(".xyz") || name.ends_with(".csv")) continue;
    EXPECT_EQ(parse_scan_file(bytes, "scan.xyz").at(0).format, parse_scan_file(bytes, name).at(0).format) << name;
  }
  const std::string headless = replaced(samples::pcd("ascii", few_points()), "# .PCD v0.7 - Point Cloud Data file format\n", "");
  EXPECT_EQ(only(headless, "a.txt").format, "PCD, ascii");
  EXPECT_EQ(scan_format("v 1 2 3\n", "a.obj"), std::nullopt);
  EXPECT_EQ(scan_format("1 2 3\n", "A.XYZ"), "text");
}

TEST(ScanFile, EveryPointFormatAndVersionOfLas) {
  for (int minor = 0; minor <= 4; ++minor)
    for (int format = 0; format <= (minor < 4 ? 5 : 10); ++format) {
      const MeasuredScan scan = only(samples::las(minor, format, few_points()), "a.las");
      EXPECT_EQ(largest_difference(scan.points, few_points()), 0.0) << minor << ' ' << format;
      EXPECT_EQ(scan.format, fmt::format("LAS 1.{}, point format {}", minor, format));
    }
}

TEST(ScanFile, LargeCoordinatesKeepTheirDigits) {
  const Vec<3> far(512094.0 + 1.0 / 1024, 5403180.0 - 3.0 / 1024, 227.0);
  Points points = few_points();
  for (Vec<3>& p : points) p += far;
  EXPECT_EQ(largest_difference(only(samples::las(2, 0, points, Vec<3>(512000, 5403000, 0)), "a.las").points, points), 0.0);
  EXPECT_EQ(largest_difference(only(points_as_xyz<3>(points), "a.xyz").points, points), 0.0);
}

TEST(ScanFile, WrongLasFilesAreRefusedWithTheirPlace) {
  const std::string good = samples::las(2, 3, few_points());
  EXPECT_NE(error_of(with<std::uint8_t>(good, 104, 0x83), "a.laz").find("vantage-convert IN.laz OUT.las"), std::string::npos);
  EXPECT_NE(error_of(with<std::uint32_t>(good, 107, 6), "a.las").find("a.las:232: 6 points of 34 bytes exceed"), std::string::npos);
  EXPECT_NE(error_of(with<std::uint32_t>(good, 96, 100), "a.las").find("points begin at byte 100"), std::string::npos);
  EXPECT_NE(error_of(with<std::uint16_t>(good, 105, 33), "a.las").find("records of 33 bytes"), std::string::npos);
  EXPECT_NE(error_of(with<std::uint16_t>(good, 105, 0), "a.las").find("records of 0 bytes"), std::string::npos);
  EXPECT_NE(error_of(with<std::uint8_t>(good, 104, 11), "a.las").find("point format 11"), std::string::npos);
  EXPECT_NE(error_of(with(good, 131, 0.0), "a.las").find("scale 0"), std::string::npos);
  EXPECT_NE(error_of(with(good, 155, kInfinity), "a.las").find("offset inf"), std::string::npos);
  EXPECT_NE(error_of(with<std::uint8_t>(good, 25, 5), "a.las").find("LAS 1.5"), std::string::npos);
  EXPECT_NE(error_of(with<std::uint16_t>(good, 94, 226), "a.las").find("header of 226"), std::string::npos);
  EXPECT_NE(error_of(with(samples::las(4, 6, few_points()), 247, ~std::uint64_t{0}), "a.las").find("exceed"), std::string::npos);
  EXPECT_NE(error_of(good.substr(0, 100), "a.las").find("exceed the file"), std::string::npos);
  EXPECT_NE(error_of("dear", "a.las").find("LASF"), std::string::npos);
}

TEST(ScanFile, KittiOfThreeOrFourFloats) {
  Points points;  // 12: both sizes divide.
  for (int i = 0; i < 12; ++i) points.emplace_back(i, -2 * i - 1, 0.5 * i);
  for (const int floats : {3, 4}) {
    const MeasuredScan scan = only(samples::kitti(floats, points), "a.bin");
    EXPECT_EQ(largest_difference(scan.points, points), 0.0) << floats;
    EXPECT_EQ(scan.format, floats == 4 ? "KITTI, x y z reflectance" : "KITTI, x y z");
    EXPECT_FALSE(scan.position.has_value());
  }
  EXPECT_NE(error_of(samples::kitti(3, points) + "x", "a.bin").find("3 or 4 floats"), std::string::npos);
  EXPECT_NE(error_of(std::string(48, '\x7f'), "a.bin").find("3 or 4 floats"), std::string::npos);
}

TEST(ScanFile, PtxHasScansWithPosesAndRays) {
  const std::vector<MeasuredScan> scans = parse_scan_file(samples::ptx(), "a.ptx");
  ASSERT_EQ(scans.size(), 2U);
  for (const MeasuredScan& scan : scans) {
    EXPECT_EQ(scan.position.value(), Vec<3>(10, 20, 30));
    EXPECT_LT(largest_difference(scan.points, {{10, 21, 30}, {10, 20, 32}, {10, 23, 30}, {6, 20, 30}}), 1e-12);
    EXPECT_LT((scan.orientation * Vec<3>(1, 0, 0) - Vec<3>(0, 1, 0)).norm(), 1e-12);
    EXPECT_EQ(scan.rays->columns, 2);
    EXPECT_EQ(scan.rays->rows, 3);
    EXPECT_EQ(scan.rays->point, (std::vector<std::int32_t>{0, RayTable::kNoReturn, 1, 2, 3, RayTable::kNoData}));
    EXPECT_EQ(scan.not_finite, 1);
  }
  EXPECT_EQ(scans[1].name, "a.ptx, scan 2 of 2");
}

TEST(ScanFile, WrongPtxFilesAreRefusedWithTheirLine) {
  const std::string good = samples::ptx_scan();
  EXPECT_NE(error_of(replaced(good, "2\n3\n", "2\n4\n"), "a.ptx").find("ends within a scan"), std::string::npos);
  EXPECT_NE(error_of(replaced(good, "2\n3\n", "2147483647\n2147483647\n"), "a.ptx").find("a.ptx:2: 2147483647 x 2147483647 points exceed"),
            std::string::npos);
  EXPECT_NE(error_of(replaced(good, "2\n3\n", "-2\n3\n"), "a.ptx").find("a.ptx:1: -2"), std::string::npos);
  EXPECT_NE(error_of(replaced(good, "0 1 0 0\n", "0 2 0 0\n"), "a.ptx").find("no rigid motion"), std::string::npos);
  EXPECT_NE(error_of(replaced(good, "0 1 0 0\n", "0 -1 0 0\n"), "a.ptx").find("no rigid motion"), std::string::npos);
  EXPECT_NE(error_of(replaced(good, "3 0 0 0.5", "3 x 0 0.5"), "a.ptx").find("a.ptx:14: x: not a number"), std::string::npos);
  EXPECT_NE(error_of(good + "7\n", "a.ptx").find("ends within a scan"), std::string::npos);
}

TEST(ScanFile, OctoMapGivesItsLeaves) {
  const std::string bytes = samples::octomap();
  const OccupancyTree tree = parse_occupancy_tree(FileBytes(bytes, "a.bt"));
  ASSERT_EQ(tree.leaves.size(), 4U);
  const double half = 0.5 * 32768;  // Of the root: 16 levels of 0.5 m.
  EXPECT_FALSE(tree.leaves[0].occupied);
  EXPECT_EQ(tree.leaves[0].side, half);
  EXPECT_EQ(tree.leaves[0].centre, Vec<3>(-half / 2, -half / 2, -half / 2));
  EXPECT_EQ(tree.leaves[1].centre, Vec<3>(half / 2, -half / 2, -half / 2));
  EXPECT_EQ(tree.leaves[3].centre, Vec<3>::Constant(0.75 * half));
  EXPECT_EQ(tree.leaves[3].side, half / 2);
  EXPECT_EQ(only(bytes, "a.bt").points.size(), 3U);
}

TEST(ScanFile, WrongOctoMapFilesAreRefused) {
  const std::string good = samples::octomap(), head = good.substr(0, good.size() - 4);
  EXPECT_NE(error_of(replaced(good, "size 6", "size 7"), "a.bt").find("6 nodes, the header announces 7"), std::string::npos);
  EXPECT_NE(error_of(good.substr(0, good.size() - 1), "a.bt").find("exceed the file"), std::string::npos);
  EXPECT_NE(error_of(replaced(good, "res 0.5", "res 0"), "a.bt").find("res 0"), std::string::npos);
  EXPECT_NE(error_of(replaced(good, "id OcTree", "id Tree"), "a.bt").find("id Tree"), std::string::npos);
  EXPECT_NE(error_of(head + std::string(64, '\x03'), "a.bt").find("deeper than 16"), std::string::npos);
  EXPECT_NE(error_of(replaced(good, "binary file", "file"), "a.ot").find("not an OctoMap binary file"), std::string::npos);
}

TEST(ScanFile, AnOrganisedPcdKeepsItsRays) {
  const std::string file = samples::organised_pcd();  // Two lines: (1 0 1) (1 1 1) nan, and (1 0 0) zeros (0 1 0).
  const MeasuredScan scan = parse_scan_file(file, "a.pcd").at(0);
  EXPECT_EQ(scan.format, "PCD, ascii, 3 x 2 rays");
  EXPECT_EQ(scan.points, (std::vector<Vec<3>>{{1, 0, 1}, {1, 1, 1}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(scan.not_finite, 1);
  ASSERT_TRUE(scan.rays.has_value());
  EXPECT_TRUE(scan.rays->assumed);
  EXPECT_EQ(scan.rays->columns, 3);
  EXPECT_EQ(scan.rays->rows, 2);
  EXPECT_EQ(scan.rays->point, (std::vector<std::int32_t>{0, 2, 1, -1, -1, 3}));
  // A header that does not fit its points means nothing, and one line is a list.
  for (const auto& [width, height] : {std::pair("6", "1"), {"1", "6"}, {"3", "3"}, {"x", "2"}, {"18446744073709551615", "2"}, {"0", "0"}}) {
    const std::string other = replaced(replaced(file, "WIDTH 3", "WIDTH " + std::string(width)), "HEIGHT 2", "HEIGHT " + std::string(height));
    const MeasuredScan list = parse_scan_file(other, "a.pcd").at(0);
    EXPECT_FALSE(list.rays.has_value()) << width;
    EXPECT_EQ(list.points.size(), 5U);
    EXPECT_EQ(list.format, "PCD, ascii");
  }
}

}  // namespace
}  // namespace vantage

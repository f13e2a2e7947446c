// SPDX-License-Identifier: Apache-2.0
// Counts and boxes of files that nobody in this project wrote, as their README.md states them.
#include <gtest/gtest.h>

#include "vantage/base/error.h"
#include "vantage/geometry/box.h"
#include "vantage/io/octomap.h"
#include "vantage/io/scan_file.h"
#include "vantage/io/test_data.h"

namespace vantage {
namespace {

MeasuredScan only(const std::string& name) {
  const std::vector<MeasuredScan> scans = read_scan_file(data_set(name));
  EXPECT_EQ(scans.size(), 1U);
  return scans.at(0);
}

Box<3> box_of(const MeasuredScan& scan) {
  Box<3> box;
  for (const Vec<3>& p : scan.points) box.extend(p);
  return box;
}

void expect_box(const Box<3>& box, const Vec<3>& low, const Vec<3>& high, double tolerance) {
  EXPECT_LT((box.low - low).cwiseAbs().maxCoeff(), tolerance) << box.low.transpose();
  EXPECT_LT((box.high - high).cwiseAbs().maxCoeff(), tolerance) << box.high.transpose();
}

TEST(ScanData, CorridorTls) {
  VANTAGE_NEEDS_DATA("corridor_tls");
  const std::size_t counts[] = {65786, 82363, 87883, 86322, 85978, 85489};
  for (int k = 0; k < 6; ++k) {
    const MeasuredScan scan = only("corridor_tls/scan00" + std::to_string(k) + ".pcd");
    EXPECT_EQ(scan.points.size(), counts[k]);
    EXPECT_FALSE(scan.position.has_value());
  }
}

TEST(ScanData, Kitti00Street) {
  VANTAGE_NEEDS_DATA("kitti00_street");
  const MeasuredScan first = only("kitti00_street/000000.bin");
  EXPECT_EQ(first.points.size(), 124668U);
  EXPECT_EQ(first.format, "KITTI, x y z reflectance");
  EXPECT_EQ(only("kitti00_street/000005.bin").points.size(), 123924U);
  EXPECT_EQ(only("kitti00_street/000010.pcd").points.size(), 121018U);
  // The scanner is 1.73 m above the road: no street sweep lies off that.
  EXPECT_LT(box_of(first).low[2], -1.73);
  EXPECT_LT(box_of(first).size().maxCoeff(), 200.0);
}

TEST(ScanData, Hdl32Pair) {
  VANTAGE_NEEDS_DATA("hdl32_pair");
  EXPECT_EQ(only("hdl32_pair/source.ply").points.size() + only("hdl32_pair/target.ply").points.size(), 69792U + 69088U);
}

TEST(ScanData, PumpE57) {
  VANTAGE_NEEDS_DATA("pump_e57");
  const MeasuredScan scan = only("pump_e57/pumpAVisualReferenceImage.e57");
  EXPECT_EQ(scan.points.size(), 155201U);
  expect_box(box_of(scan), {-2.904, -5.301, -1.900}, {1.722, -0.793, 1.843}, 1e-3);
  EXPECT_EQ(scan.position.value(), Vec<3>(0, 0, 0));
  ASSERT_TRUE(scan.rays.has_value());
  EXPECT_EQ(scan.rays->columns, 345);
  EXPECT_EQ(scan.rays->rows, 1074);
  double nearest = kInfinity, farthest = 0.0;
  for (const Vec<3>& p : scan.points) {
    nearest = std::min(nearest, p.norm());
    farthest = std::max(farthest, p.norm());
  }
  EXPECT_NEAR(nearest, 1.98, 0.005);
  EXPECT_NEAR(farthest, 5.43, 0.005);
}

TEST(ScanData, LasAndPtx) {
  VANTAGE_NEEDS_DATA("las_sample");
  EXPECT_EQ(only("las_sample/autzen-thin.las").points.size(), 10653U);
  const MeasuredScan warsaw = only("las_sample/warsaw_small.las");
  EXPECT_EQ(warsaw.points.size(), 3000U);
  EXPECT_LT((box_of(warsaw).size() - Vec<3>(33, 33, 20)).cwiseAbs().maxCoeff(), 1.0) << box_of(warsaw).size().transpose();
  const MeasuredScan las = only("las_sample/1.2-with-color.las"), ptx = only("las_sample/1.2-with-color.ptx");
  EXPECT_EQ(las.points.size(), 1065U);
  ASSERT_EQ(ptx.points.size(), 1065U);
  for (std::size_t i = 0; i < las.points.size(); ++i) ASSERT_LT((las.points[i] - ptx.points[i]).norm(), 1e-5) << i;
  EXPECT_EQ(ptx.rays->columns * ptx.rays->rows, 15 * 71);
  EXPECT_THROW((void)only("las_sample/autzen_trim.laz"), Error);
}

TEST(ScanData, OctoMapOfAFloor) {
  VANTAGE_NEEDS_DATA("octomap_scan");
  const OccupancyTree tree = read_occupancy_tree(data_set("octomap_scan/geb079.bt"));  // Checks the 532,566 nodes its header announces.
  EXPECT_EQ(tree.resolution, 0.08);
  const MeasuredScan scan = only("octomap_scan/geb079.bt");
  const auto occupied = std::count_if(tree.leaves.begin(), tree.leaves.end(), [](const auto& leaf) { return leaf.occupied; });
  EXPECT_EQ(static_cast<std::int64_t>(scan.points.size()), occupied);
  EXPECT_GT(tree.leaves.size(), scan.points.size());
  const Vec<3> size = box_of(scan).size();
  EXPECT_TRUE(size.maxCoeff() > 10.0 && size.maxCoeff() < 100.0 && size[2] < 10.0) << size.transpose();
}

TEST(ScanData, PclPcd) {
  VANTAGE_NEEDS_DATA("pcl_pcd");
  const MeasuredScan lamp = only("pcl_pcd/lamppost.pcd");
  EXPECT_EQ(lamp.points.size(), 1771U);
  EXPECT_NEAR(box_of(lamp).size().maxCoeff(), 5.9, 0.1);
  EXPECT_EQ(only("pcl_pcd/min_cut_segmentation_tutorial.pcd").points.size(), 9311U);
  const MeasuredScan town = only("pcl_pcd/samp31-utm.pcd");
  EXPECT_EQ(town.points.size(), 28862U);
  expect_box(box_of(town), {512094, 5403180, 227}, {512268, 5403341, 344}, 1.0);
}

}  // namespace
}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/point_cloud_file.h"

#include <gtest/gtest.h>

#include "vantage/base/error.h"
#include "vantage/base/random.h"
#include "vantage/io/bytes.h"
#include "vantage/io/test_data.h"

namespace vantage {
namespace {

template <class Dimension>
class PointFiles : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(PointFiles, Dimensions);

template <int Dim>
std::vector<Vec<Dim>> random_points(std::size_t count, double reach) {
  Random random(7);
  std::vector<Vec<Dim>> points(count);
  for (Vec<Dim>& p : points)
    for (int a = 0; a < Dim; ++a) p[a] = random.uniform(-reach, reach);
  return points;
}

template <int Dim>
double largest_difference(const PointCloud& cloud, const std::vector<Vec<Dim>>& points) {
  EXPECT_EQ(cloud.dim, Dim);
  if (cloud.points.size() != points.size()) return kInfinity;
  double largest = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) largest = std::max(largest, (cloud.points[i].head<Dim>() - points[i]).cwiseAbs().maxCoeff());
  return largest;
}

TYPED_TEST(PointFiles, PlyReadsBackWithinHalfAMillimetreNearAndExactlyFar) {
  constexpr int Dim = TypeParam::value;
  const auto near = random_points<Dim>(100, 4000.0), far = random_points<Dim>(100, 6e6);
  EXPECT_LT(largest_difference<Dim>(parse_points(points_as_ply<Dim>(near), "a.ply"), near), 5e-4);
  EXPECT_EQ(largest_difference<Dim>(parse_points(points_as_ply<Dim>(far), "a.ply"), far), 0.0);
}

TYPED_TEST(PointFiles, XyzReadsBackExactly) {
  constexpr int Dim = TypeParam::value;
  const auto points = random_points<Dim>(100, 1e7);
  EXPECT_EQ(largest_difference<Dim>(parse_points(points_as_xyz<Dim>(points), "a.xyz"), points), 0.0);
}

/// A PLY or PCD with one point (1, -2, 0.5) preceded by an unwanted column, in every encoding.
std::string ply(const std::string& format, const std::string& data) {
  return "ply\nformat " + format +
         " 1.0\ncomment made by hand\nelement vertex 1\nproperty uchar red\nproperty float x\nproperty double y\nproperty short z\nend_header\n" +
         data;
}

TEST(PointFile, PlyInEveryByteOrder) {
  std::string little, big;
  for (std::string* out : {&little, &big}) {
    const bool swap = out == &big;
    put<std::uint8_t>(*out, 200);
    put(*out, swap ? byte_swapped(1.0F) : 1.0F);
    put(*out, swap ? byte_swapped(-2.0) : -2.0);
    put(*out, swap ? byte_swapped<std::int16_t>(-3) : std::int16_t{-3});
  }
  for (const std::string& bytes : {ply("ascii", "200 1 -2 -3\n"), ply("binary_little_endian", little), ply("binary_big_endian", big)}) {
    const PointCloud cloud = parse_points(bytes, "a.ply");
    ASSERT_EQ(cloud.points.size(), 1U);
    EXPECT_EQ(cloud.points[0], Vec<3>(1, -2, -3));
  }
}

TEST(PointFile, PcdAsciiBinaryAndCompressed) {
  const std::string head =
      "# .PCD v0.7\nVERSION 0.7\nFIELDS intensity x y z\nSIZE 2 4 8 4\nTYPE U F F I\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ";
  std::string records, columns;
  const double y[] = {-2.0, 0.25};
  for (int i = 0; i < 2; ++i) {
    put<std::uint16_t>(records, 9);
    put<float>(records, 1.0F);
    put<double>(records, y[i]);
    put<std::int32_t>(records, -3);
  }
  for (int i = 0; i < 2; ++i) put<std::uint16_t>(columns, 9);
  for (int i = 0; i < 2; ++i) put<float>(columns, 1.0F);
  for (int i = 0; i < 2; ++i) put<double>(columns, y[i]);
  for (int i = 0; i < 2; ++i) put<std::int32_t>(columns, -3);
  // LZF by hand: 32 literals, then four more; the last four bytes (0xfdffffff) are those 4 bytes back: length 4, distance 4.
  std::string packed = std::string(1, 31) + columns.substr(0, 32) + std::string({char(2 << 5), char(3)});
  std::string compressed;
  put<std::uint32_t>(compressed, static_cast<std::uint32_t>(packed.size()));
  put<std::uint32_t>(compressed, static_cast<std::uint32_t>(columns.size()));
  compressed += packed;
  for (const std::string& bytes :
       {head + "ascii\n9 1 -2 -3\n9 1 0.25 -3\n", head + "binary\n" + records, head + "binary_compressed\n" + compressed}) {
    const PointCloud cloud = parse_points(bytes, "a.pcd");
    ASSERT_EQ(cloud.points.size(), 2U) << cloud.format;
    EXPECT_EQ(cloud.points[0], Vec<3>(1, -2, -3)) << cloud.format;
    EXPECT_EQ(cloud.points[1], Vec<3>(1, 0.25, -3)) << cloud.format;
  }
}

TEST(PointFile, TextWithHeaderSeparatorsAndComments) {
  const PointCloud cloud = parse_points("# scan\r\n\"time\",\"Z\",\"X\",\"Y\"\r\n0,3,1,2\r\n\r\n// end\n1;nan;+5;6e0\n", "a.csv");
  ASSERT_EQ(cloud.points.size(), 2U);
  EXPECT_EQ(cloud.points[0], Vec<3>(1, 2, 3));
  EXPECT_EQ(cloud.points[1].head<2>(), Vec<2>(5, 6));
  EXPECT_EQ(cloud.not_finite, 1);
  EXPECT_EQ(parse_points("1 2\n3 4\n", "a.xyz").dim, 2);
}

struct Bad {
  std::string bytes, name, message;
};

TEST(PointFile, HostileFilesGiveOnePlacedMessage) {
  const std::string pcd = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
  std::string bomb;
  put<std::uint32_t>(bomb, 4);
  put<std::uint32_t>(bomb, 4000000000U);
  const Bad table[] = {
      {"", "a.ply", "the file is empty"},
      {"ply\n", "a.ply", "within the header"},
      {"ply\nformat binary 1.0\n", "a.ply", "a.ply:2: format binary"},
      {"ply\nformat ascii 1.0\nelement vertex 99999999999999999999\n", "a.ply", "a.ply:3"},
      {"ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\nend_header\n1 2\n", "a.ply", "exceed the file"},
      {"ply\nformat binary_little_endian 1.0\nelement vertex 18446744073709551615\nproperty float x\nproperty float y\nend_header\n", "a.ply",
       "exceed the file"},
      {"ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nend_header\n1 2 3\n", "a.ply", "ends within the data"},
      {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n1 two\n", "a.ply", "a.ply:7: two: not a number"},
      {"ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int i\nelement vertex 0\nproperty float x\nproperty float y\nend_header\n1e300 "
       "2\n",
       "a.ply", "list length 1e+300"},
      {"ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int i\nelement vertex 0\nproperty float x\nproperty float y\nend_header\n-1 2\n",
       "a.ply", "list length -1"},
      {"ply\nformat ascii 1.0\nelement face 0\nproperty int i\nend_header\n", "a.ply", "no vertex element"},
      {"ply\nformat ascii 1.0\nelement vertex 1\nproperty list int float x\nproperty float y\nend_header\n0 1\n", "a.ply",
       "vertices without x and y"},
      {pcd + "POINTS 5\n", "a.pcd", "within the header"},
      {pcd + "POINTS 5\nDATA ascii\n1 2 3\n", "a.pcd", "after 1 of 5 points"},
      {pcd + "POINTS 1\nDATA ascii\n1 2\n", "a.pcd", "a.pcd:8: 2 numbers"},
      {pcd + "POINTS 4000000000\nDATA binary\nxx", "a.pcd", "exceed the file"},
      {pcd + "POINTS 333333333\nDATA binary_compressed\n" + bomb + "abcd", "a.pcd", "do not hold"},
      {pcd + "POINTS 1\nDATA jpeg\n", "a.pcd", "DATA jpeg"},
      {"FIELDS x y\nSIZE 3 4\nTYPE F F\nCOUNT 1 1\nPOINTS 0\nDATA ascii\n", "a.pcd", "field x"},
      {"FIELDS x\nSIZE 4\nTYPE F\nCOUNT 1\nPOINTS 0\nDATA ascii\n", "a.pcd", "no field y"},
      {"1 2 3\n4 5\n", "a.xyz", "a.xyz:2: 2 numbers"},
      {"1 2 3\n4 5 six\n", "a.xyz", "a.xyz:2: six: not a number"},
      {"hello world\n", "a.txt", "a.txt:1: hello"},
      {std::string("\x7f"
                   "ELF\0\0\0",
                   7),
       "a.xyz", "not a point cloud"},
  };
  for (const Bad& bad : table) {
    try {
      static_cast<void>(parse_points(bad.bytes, bad.name));
      ADD_FAILURE() << "accepted: " << bad.bytes;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_input);
      EXPECT_NE(std::string(error.what()).find(bad.message), std::string::npos) << error.what() << "\nexpected: " << bad.message;
    }
  }
}

/// Every prefix and many one-byte changes of good files are read or refused, nothing else.
TEST(PointFile, DamagedFilesNeverCrash) {
  const auto points = random_points<3>(5, 10.0);
  const std::string pcd = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nPOINTS 2\nDATA binary\n" + std::string(24, 'a');
  Random random(3);
  int refused = 0;
  const auto attempt = [&](const std::string& bytes, const char* name) {
    try {
      static_cast<void>(parse_points(bytes, name));
    } catch (const Error&) {
      ++refused;
    }
  };
  for (const auto& [good, name] : {std::pair{points_as_ply<3>(points), "a.ply"}, {pcd, "a.pcd"}, {points_as_xyz<3>(points), "a.xyz"}}) {
    for (std::size_t length = 0; length < good.size(); ++length) attempt(good.substr(0, length), name);
    for (int i = 0; i < 2000; ++i) {
      std::string bytes = good;
      bytes[random.below(bytes.size())] = static_cast<char>(random.below(256));
      attempt(bytes, name);
    }
  }
  EXPECT_GT(refused, 500);
}

TEST(PointFile, MissingFilesAndFoldersAreIoErrors) {
  for (const char* path : {"no/such/file.ply", "/"}) {
    try {
      static_cast<void>(read_points(path));
      ADD_FAILURE() << path;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::io);
    }
  }
}

TEST(PointFile, UpstreamFilesLoadOrAreRefused) {
  VANTAGE_NEEDS_DATA("corrupt");
  struct Expectation {
    const char* file;
    int points;  ///< -1: refused.
  };
  const Expectation table[] = {
      {"corrupt/assimp/crash-30d6d0f7c529b3b66b4131700b7a4580cd7082df.ply", -1},
      {"corrupt/assimp/empty.ply", -1},
      {"corrupt/pdal/missingheader.pcd", -1},
      {"corrupt/pdal/no_vertex.ply", -1},
      {"corrupt/pdal/badheader.txt", -1},
      {"corrupt/pdal/mesh.ply", 4},
      {"corrupt/pdal/issue_2421.ply", 1},
      {"corrupt/assimp/cube_binary_starts_with_nl.ply", 8},
      {"corrupt/trimesh/points_emptyface.ply", 1024},
      {"hdl32_pair/source.ply", 69792},
      {"pcl_pcd/lamppost.pcd", 1771},
      {"pcl_pcd/min_cut_segmentation_tutorial.pcd", 9311},
      {"pcl_pcd/samp31-utm.pcd", 28862},
  };
  for (const Expectation& expected : table) {
    int points = -1;
    std::string message;
    try {
      points = static_cast<int>(read_points(data_set(expected.file)).points.size());
    } catch (const Error& error) {
      message = error.what();
    }
    EXPECT_EQ(points, expected.points) << expected.file << " " << message;
  }
}

}  // namespace
}  // namespace vantage

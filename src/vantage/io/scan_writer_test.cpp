// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/scan_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <rapidcheck.h>

#include "vantage/base/error.h"
#include "vantage/base/random.h"
#include "vantage/io/sample_scans.h"

namespace vantage {
namespace {

using samples::Points;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kFormats[] = {"PLY", "PCD", "LAS", "XYZ", "CSV"};

std::string file_name(std::string_view format) {
  return format == "PLY" ? "a.ply" : format == "PCD" ? "a.pcd" : format == "LAS" ? "a.las" : format == "XYZ" ? "a.xyz" : "a.csv";
}

MeasuredScan scan_of(Points points) {
  MeasuredScan scan;
  scan.points = std::move(points);
  return scan;
}

/// The points of all scans, as our own reader finds them again.
Points read_again(std::string_view format, const std::vector<MeasuredScan>& scans, const ScanWriteOptions& options = {}) {
  return parse_points(scans_as(format, scans, options).bytes, file_name(format)).points;
}

double largest_difference(const Points& a, const Points& b) {
  if (a.size() != b.size()) return kInfinity;
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).cwiseAbs().maxCoeff());
  return largest;
}

/// Points around `middle` on a lattice of `step`.
Points random_points(std::size_t count, const Vec<3>& middle, double step, std::uint64_t seed) {
  Random random(seed);
  Points points;
  for (std::size_t i = 0; i < count; ++i) {
    Vec<3> p;
    for (double& c : p) c = step * static_cast<double>(static_cast<std::int64_t>(random.below(200001)) - 100000);
    points.push_back(middle + p);
  }
  return points;
}

TEST(ScanWriter, EveryFormatGivesThePointsBack) {
  for (const char* format : kFormats)
    rc::check(format, [&] {
      const auto count = *rc::gen::inRange<std::size_t>(1, 60);
      const auto seed = *rc::gen::arbitrary<std::uint64_t>();
      const Vec<3> middle = *rc::gen::element<Vec<3>>(Vec<3>(0, 0, 0), Vec<3>(1e7, -1e7, 300), Vec<3>(-3, 512345.678, 0.25));
      const Points points = random_points(count, middle, 0.001, seed);
      // LAS rounds to a tenth of a millimetre, and its sums and products to the last place of a double; the others keep every bit.
      const double allowed = std::string_view(format) == "LAS" ? 0.5e-4 + 4e-9 : 0.0;
      RC_ASSERT(largest_difference(read_again(format, {scan_of(points)}), points) <= allowed);
    });
}

TEST(ScanWriter, LasKeepsMillimetresTenThousandKilometresAway) {
  // Multiples of the resolution come back as the same multiples.
  const Points points = random_points(500, Vec<3>(1e7, 1e7, 0), 0.001, 1);
  const Points read = read_again("LAS", {scan_of(points)}, {.resolution = 0.001});
  ASSERT_EQ(read.size(), points.size());
  for (std::size_t i = 0; i < read.size(); ++i)
    for (int a = 0; a < 3; ++a) ASSERT_EQ(std::llround(read[i][a] * 1000), std::llround(points[i][a] * 1000));
}

TEST(ScanWriter, SmallFilesAreFilesToo) {
  for (const char* format : kFormats) {
    const std::string bytes = scans_as(format, std::vector<MeasuredScan>{scan_of({})}).bytes;
    if (!bytes.empty()) {  // As without a header.
      EXPECT_THAT(parse_points(bytes, file_name(format)).points, IsEmpty()) << format;
    }
    EXPECT_THAT(read_again(format, {scan_of({{1e7 + 0.125, -2, 0.5}})}), ElementsAre(Vec<3>(1e7 + 0.125, -2, 0.5))) << format;
  }
  EXPECT_EQ(scans_as("XYZ", std::vector<MeasuredScan>{scan_of({})}).bytes, "");
}

TEST(ScanWriter, FloatsOnlyWhereTheyKeepEveryDigit) {
  const std::vector<MeasuredScan> short_digits{scan_of({{0.5, -2, 1024.25}})}, long_digits{scan_of({{0.1, -2, 1024.25}})};
  for (const char* format : {"PLY", "PCD"})
    for (const bool ascii : {false, true}) {
      EXPECT_EQ(scans_as(format, short_digits, {.ascii = ascii}).precision, "floats");
      EXPECT_EQ(scans_as(format, long_digits, {.ascii = ascii}).precision, "doubles");
      EXPECT_EQ(read_again(format, long_digits, {.ascii = ascii}), long_digits[0].points);
      const ScanWriteOptions narrow{.ascii = ascii, .number = ScanWriteOptions::Number::float32};
      EXPECT_EQ(read_again(format, long_digits, narrow)[0][0], ascii ? 0.1 : static_cast<double>(0.1F));  // As text, the fewest digits of the float.
      EXPECT_THAT(scans_as(format, long_digits, narrow).left_out, ElementsAre(HasSubstr("digits beyond a float (up to 1.5e-09)")));
      EXPECT_EQ(scans_as(format, short_digits, {.ascii = ascii, .number = ScanWriteOptions::Number::float64}).precision, "doubles");
    }
  EXPECT_THROW((void)scans_as("PLY", std::vector{scan_of({{1e300, 0, 0}})}, {.number = ScanWriteOptions::Number::float32}), Error);
}

TEST(ScanWriter, APlaneStaysOne) {
  MeasuredScan plane = scan_of({{1.5, 2.5, 0}, {3, -4, 0}});
  plane.dim = 2;
  for (const char* format : kFormats) {
    const WrittenScans written = scans_as(format, std::vector{plane});
    const bool las = std::string_view(format) == "LAS";
    const PointCloud read = parse_points(written.bytes, file_name(format));
    EXPECT_EQ(read.dim, las ? 3 : 2) << format;
    EXPECT_EQ(read.points, plane.points) << format;
    EXPECT_EQ(written.left_out.size(), las ? 1U : 0U) << format;
  }
}

TEST(ScanWriter, PcdKeepsThePoseOfOneScan) {
  MeasuredScan scan = scan_of(samples::few_points());
  scan.position = Vec<3>(512345.125, -2, 1.75);
  scan.orientation = Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5);
  const WrittenScans written = scans_as("PCD", std::vector{scan});
  const MeasuredScan read = parse_scan_file(written.bytes, "a.pcd").at(0);
  EXPECT_EQ(read.position.value(), *scan.position);
  EXPECT_TRUE(read.orientation.coeffs() == scan.orientation.coeffs());
  EXPECT_THAT(written.left_out, IsEmpty());

  const WrittenScans two = scans_as("PCD", std::vector{scan, scan});
  EXPECT_FALSE(parse_scan_file(two.bytes, "a.pcd").at(0).position.has_value());
  EXPECT_THAT(two.left_out, ElementsAre("2 poses", "which of the 2 scans a point is of"));

  scan.position = Vec<3>::Zero();
  scan.orientation.setIdentity();
  EXPECT_THAT(scans_as("PCD", std::vector{scan}).left_out, ElementsAre(HasSubstr("reads as none")));
}

TEST(ScanWriter, LossesAreNamed) {
  const std::vector<MeasuredScan> scans = parse_scan_file(samples::ptx(), "a.ptx");
  EXPECT_THAT(scans_as("PLY", scans).left_out, ElementsAre("2 poses", "2 rays without return", "which of the 2 scans a point is of",
                                                           "2 points that are not finite", HasSubstr("intensity")));
  EXPECT_THAT(scans_as("CSV", scans).left_out.size(), 4U);
}

TEST(ScanWriter, TheNumberOfTheScanStaysWithEachPoint) {
  const std::vector<MeasuredScan> scans{scan_of({{1, 2, 3}}), scan_of({}), scan_of({{4, 5, 6}, {7, 8, 9}})};
  EXPECT_EQ(scans_as("CSV", scans).bytes, "x,y,z,scan\n1,2,3,0\n4,5,6,2\n7,8,9,2\n");
  for (const int minor : {2, 4}) {
    const std::string las = scans_as("LAS", scans, {.las_minor = minor}).bytes;
    const std::size_t begin = minor == 2 ? 227 : 375, record = minor == 2 ? 20 : 30, at = minor == 2 ? 18 : 20;
    ASSERT_EQ(las.size(), begin + 3 * record);
    for (const auto& [point, source] : {std::pair{0, 1}, {1, 3}, {2, 3}})
      EXPECT_EQ(get<std::uint16_t>(las, begin + static_cast<std::size_t>(point) * record + at), source);
  }
}

TEST(ScanWriter, LasStepsFitTheExtent) {
  const auto precision = [](double reach, double resolution) {
    return scans_as("LAS", std::vector{scan_of({{-reach, 0, 0}, {reach, 0, 0}})}, {.resolution = resolution}).precision;
  };
  EXPECT_EQ(precision(10.0, 0.0), "multiples of 0.0001");
  EXPECT_EQ(precision(2e5, 0.0), "multiples of 0.0001");
  EXPECT_EQ(precision(3e5, 0.0), "multiples of 0.001");
  EXPECT_EQ(precision(1e12, 0.0), "multiples of 1000");
  EXPECT_EQ(precision(1e7, 0.01), "multiples of 0.01");
  EXPECT_EQ(precision(2147483.0, 0.001), "multiples of 0.001");
  EXPECT_THROW((void)precision(2147484.0, 0.001), Error);
  EXPECT_THROW((void)precision(kInfinity, 0.0), Error);
  EXPECT_THROW((void)scans_as("LAS", std::vector<MeasuredScan>{}, {.las_minor = 3}), Error);
}

TEST(ScanWriter, LasBoundsAreThoseOfItsOwnPoints) {
  const std::string las = scans_as("LAS", std::vector{scan_of({{0.123, 5, -7}, {1.4, 4, 2}})}, {.resolution = 0.25}).bytes;
  const double expected[] = {1.5, 0.0, 5, 4, 2, -7};  // Largest and smallest x, y, z.
  for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(get<double>(las, 179 + 8 * k), expected[k]) << k;
}

TEST(ScanWriter, TheCoordinateSystemComesBack) {
  for (const int minor : {2, 4}) {
    const std::string las = scans_as("LAS", std::vector{scan_of({{1, 2, 3}})}, {.las_minor = minor, .epsg = 25832}).bytes;
    const MeasuredScan read = parse_scan_file(las, "a.las").at(0);
    EXPECT_EQ(read.epsg, 25832) << minor;
    EXPECT_EQ(read.points, (Points{{1, 2, 3}})) << minor;
  }
  EXPECT_FALSE(parse_scan_file(scans_as("LAS", std::vector{scan_of({{1, 2, 3}})}).bytes, "a.las").at(0).epsg.has_value());
}

TEST(LasCrs, WktNamesTheProjectedSystemAlone) {
  const std::string projected =
      "PROJCS[\"a [b\",GEOGCS[\"c\",AUTHORITY[\"EPSG\",\"4258\"]],UNIT[\"metre\",1,AUTHORITY[\"EPSG\",\"9001\"]],AUTHORITY[\"EPSG\",\"25832\"]]";
  const std::pair<std::string, std::optional<int>> table[] = {
      {projected, 25832},
      {"COMPD_CS[\"both\"," + projected + ",VERT_CS[\"h\",AUTHORITY[\"EPSG\",\"7837\"]],AUTHORITY[\"EPSG\",\"5555\"]]", 25832},
      {"PROJCRS[\"n\",BASEGEOGCRS[\"m\",ID[\"EPSG\",4258]],ID[\"EPSG\",25833]]", 25833},
      {"PROJCS[\"n\",GEOGCS[\"c\",AUTHORITY[\"EPSG\",\"4258\"]],UNIT[\"metre\",1]]", std::nullopt},
      {"GEOGCS[\"c\",AUTHORITY[\"EPSG\",\"4258\"]]", std::nullopt},
      {"PROJCS[\"n\",AUTHORITY[\"ESRI\",\"102100\"]]", std::nullopt},
      {"PROJCS[\"never closed", std::nullopt},
      {"PROJCS[", std::nullopt},
      {"", std::nullopt}};
  for (const auto& [wkt, epsg] : table) {
    std::string las = scans_as("LAS", std::vector{scan_of({{1, 2, 3}})}, {.las_minor = 2, .epsg = 1}).bytes;
    const std::string points = las.substr(las.size() - 20);
    las = las.substr(0, 227);
    std::string record(2, '\0');
    record += "LASF_Projection\0";
    record.resize(18, '\0');
    put<std::uint16_t>(record, 2112);
    put(record, static_cast<std::uint16_t>(wkt.size()));
    record.resize(54, '\0');
    las += record + wkt + points;
    std::string begin;
    put(begin, static_cast<std::uint32_t>(las.size() - 20));
    las.replace(96, 4, begin);
    EXPECT_EQ(parse_scan_file(las, "a.las").at(0).epsg, epsg) << wkt;
  }
}

TEST(ScanWriter, EndingsNameFormats) {
  EXPECT_EQ(written_scan_format("a.b/SCAN.LAS"), "LAS");
  EXPECT_EQ(written_scan_format("a.txt"), "XYZ");
  EXPECT_EQ(written_scan_format("a.e57"), std::nullopt);
  EXPECT_THROW((void)scans_as("E57", std::vector<MeasuredScan>{}), Error);
}

}  // namespace
}  // namespace vantage

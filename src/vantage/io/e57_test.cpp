// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/e57.h"

#include <gtest/gtest.h>

#include "vantage/base/error.h"
#include "vantage/base/random.h"
#include "vantage/io/sample_scans.h"
#include "vantage/io/scan_file.h"
#include "vantage/io/test_data.h"

namespace vantage {
namespace {

using samples::E57Scan;

std::string error_of(const std::string& bytes) {
  try {
    (void)parse_scan_file(bytes, "a.e57");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
    return error.what();
  }
  return "";
}

TEST(E57, ChecksumOfTheStandardsExample) {
  EXPECT_EQ(checksum_castagnoli("123456789"), 0xe3069283U);
  EXPECT_EQ(checksum_castagnoli(std::string(32, '\0')), 0x8a9136aaU);  // RFC 3720, B.4.
}

TEST(E57, PosesTableOfRaysAndInvalidStates) {
  const std::vector<MeasuredScan> scans = parse_scan_file(samples::e57({samples::e57_grid_scan(), samples::e57_spherical_scan()}), "a.e57");
  ASSERT_EQ(scans.size(), 2U);
  // Turned half around z, then shifted.
  const double unit = 1.0 / 512;
  const std::vector<Vec<3>> expected = {{100.5, -1, -2}, {100.5 - unit, -2, -3}, {100.5 - 4095 * unit, -4, -5}, {100.5 - 1, -5, -6}};
  ASSERT_EQ(scans[0].points.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_LT((scans[0].points[i] - expected[i]).norm(), 1e-12) << i;
  EXPECT_EQ(scans[0].position.value(), Vec<3>(100.5, 0, -1));
  ASSERT_TRUE(scans[0].rays.has_value());
  EXPECT_EQ(scans[0].rays->columns, 3);
  EXPECT_EQ(scans[0].rays->rows, 2);
  EXPECT_EQ(scans[0].rays->point, (std::vector<std::int32_t>{0, 1, RayTable::kNoReturn, 2, 3, RayTable::kNoData}));
  // Without a pose: the identity.
  EXPECT_EQ(scans[1].position.value(), Vec<3>(0, 0, 0));
  EXPECT_LT((scans[1].points.at(0) - Vec<3>(0, 2, 0)).norm(), 1e-12);
  EXPECT_LT((scans[1].points.at(1) - Vec<3>(3 * std::sqrt(0.75), 0, 1.5)).norm(), 1e-12);
  EXPECT_FALSE(scans[1].rays.has_value());
}

TEST(E57, IntegersOfEveryWidthInManyPackets) {
  Random random(3);
  for (unsigned bits = 1; bits <= 64; ++bits) {
    E57Scan scan;
    scan.records = 200;
    const std::uint64_t mask = bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
    const std::int64_t low = bits == 64 ? std::numeric_limits<std::int64_t>::min() : -static_cast<std::int64_t>(mask / 2) - 1;
    scan.prototype = fmt::format(
        "<cartesianX type=\"Integer\" minimum=\"{}\" maximum=\"{}\"/><cartesianY type=\"Integer\" minimum=\"3\" maximum=\"3\"/><cartesianZ "
        "type=\"ScaledInteger\" minimum=\"0\" maximum=\"1\" scale=\"2\" offset=\"-5\"/>",
        low, static_cast<std::int64_t>(static_cast<std::uint64_t>(low) + mask));
    std::vector<std::uint64_t> raw, flags;
    for (std::uint64_t i = 0; i < scan.records; ++i) {
      raw.push_back(((std::uint64_t{random.below(1U << 31)} << 33) ^ (std::uint64_t{random.below(1U << 31)} << 11) ^ random.below(1U << 11)) & mask);
      flags.push_back(i % 3 == 0);
    }
    scan.streams = {samples::packed(raw, bits), "", samples::packed(flags, 1)};
    const std::vector<MeasuredScan> scans = parse_scan_file(samples::e57({scan}, 61), "a.e57");
    ASSERT_EQ(scans.at(0).points.size(), scan.records);
    for (std::size_t i = 0; i < raw.size(); ++i) {
      const auto x = static_cast<double>(static_cast<std::int64_t>(static_cast<std::uint64_t>(low) + raw[i]));
      ASSERT_EQ(scans[0].points[i], Vec<3>(x, 3, flags[i] ? -3 : -5)) << bits << ' ' << i;
    }
  }
}

TEST(E57, EveryPageIsVerified) {
  const std::string good = samples::e57({samples::e57_grid_scan(), samples::e57_spherical_scan()});
  ASSERT_GT(good.size(), 1024U);
  for (const std::size_t at : {std::size_t{60}, std::size_t{1023}, std::size_t{1500}}) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 16);
    EXPECT_NE(error_of(bad).find(fmt::format("a.e57:{}: the page's checksum", at / 1024 * 1024)), std::string::npos);
  }
  EXPECT_NE(error_of(good.substr(0, good.size() - 1)).find("exceed the file"), std::string::npos);
  EXPECT_NE(error_of("ASTM-E57").find("the header"), std::string::npos);
}

TEST(E57, HostileSizesAreRefused) {
  const E57Scan grid = samples::e57_grid_scan();
  const auto with = [&](auto&& change) {
    E57Scan scan = grid;
    change(scan);
    return error_of(samples::e57({scan}));
  };
  EXPECT_NE(with([](E57Scan& s) { s.records = 6; }).find("6 records announced"), std::string::npos);
  EXPECT_NE(with([](E57Scan& s) { s.records = ~std::uint64_t{0}; }).find("records announced"), std::string::npos);
  EXPECT_NE(with([](E57Scan& s) { s.streams.pop_back(); }).find("6 streams in a packet, the prototype has 7"), std::string::npos);
  EXPECT_NE(with([](E57Scan& s) { s.prototype = replaced(s.prototype, "cartesianZ", "depth"); }).find("neither cartesianX"), std::string::npos);
  EXPECT_NE(with([](E57Scan& s) { s.prototype = replaced(s.prototype, "\"4095\"", "\"-5000\""); }).find("above maximum"), std::string::npos);
  EXPECT_NE(with([](E57Scan& s) { s.pose = replaced(s.pose, "<z type=\"Float\">1<", "<z type=\"Float\">7<"); }).find("quaternion"),
            std::string::npos);
  E57Scan constant;
  constant.records = std::uint64_t{1} << 60;
  for (const char axis : {'X', 'Y', 'Z'}) constant.prototype += fmt::format("<cartesian{} type=\"Integer\" minimum=\"1\" maximum=\"1\"/>", axis);
  constant.streams.resize(3);
  EXPECT_NE(error_of(samples::e57({constant})).find("without any data"), std::string::npos);
}

TEST(E57, ScansMayNotShareTheirBytes) {
  E57Scan scan;
  scan.records = 500;
  for (const char axis : {'X', 'Y', 'Z'}) {
    scan.prototype += fmt::format("<cartesian{} type=\"Float\"/>", axis);
    scan.streams.emplace_back(8 * scan.records, '\1');
  }
  EXPECT_EQ(error_of(samples::e57({scan, scan, scan}, 60000)), "");
  EXPECT_NE(error_of(samples::e57({scan, scan, scan}, 60000, true)).find("share their bytes"), std::string::npos);
}

TEST(E57, SparseTablesOfRaysAreNotKept) {
  E57Scan scan = samples::e57_grid_scan();
  scan.prototype = replaced(scan.prototype, "minimum=\"4\" maximum=\"6\"", "minimum=\"0\" maximum=\"4294967295\"");
  scan.streams[5] = samples::packed({0, 0, 1, 1, 4000000000U}, 32);
  const std::vector<MeasuredScan> scans = parse_scan_file(samples::e57({scan}), "a.e57");
  EXPECT_FALSE(scans.at(0).rays.has_value());
  EXPECT_EQ(scans[0].points.size(), 4U);
}

TEST(E57, NoScansAndScansWithoutPoints) {
  EXPECT_TRUE(parse_scan_file(samples::e57({}), "a.e57").empty());
  E57Scan none = samples::e57_grid_scan();
  none.records = 0;
  EXPECT_TRUE(parse_scan_file(samples::e57({none}), "a.e57").at(0).points.empty());
}

TEST(E57, CoordinateMetadataNamesTheSystem) {
  const auto epsg = [](const std::string& text) {
    const std::string file = samples::e57({samples::e57_grid_scan(), samples::e57_spherical_scan()}, 7, false,
                                          "<coordinateMetadata type=\"String\">" + text + "</coordinateMetadata>");
    const std::vector<MeasuredScan> scans = parse_scan_file(file, "a.e57");
    EXPECT_EQ(scans[0].epsg, scans[1].epsg);
    return scans[0].epsg;
  };
  const std::string wkt = "PROJCS[\"a\",GEOGCS[\"b\",AUTHORITY[\"EPSG\",\"4258\"]],UNIT[\"metre\",1],AUTHORITY[\"EPSG\",\"25832\"]]";
  EXPECT_EQ(epsg("<![CDATA[" + wkt + "]]>"), 25832);
  EXPECT_EQ(epsg("EPSG:31467"), 31467);
  EXPECT_EQ(epsg(" urn:ogc:def:crs:EPSG::25833\n"), 25833);
  for (const char* none :
       {"", "EPSG:4326", "EPSG:", "EPSG:x", "urn:ogc:def:crs:EPSG", "GEOGCS[\"b\",AUTHORITY[\"EPSG\",\"4258\"]]", "PROJCS[", "local"})
    EXPECT_EQ(epsg(none), std::nullopt) << none;
}

}  // namespace
}  // namespace vantage

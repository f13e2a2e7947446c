// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/table1.h"

#include <gtest/gtest.h>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"

namespace vantage {
namespace {

LidarOptions coarse_sensor() {
  LidarOptions sensor;
  sensor.pattern.step = radians(4.0);
  return sensor;
}

TEST(Table1, PrintedRowsStandBesideOurs) {
  const Table1 table = make_table1(coarse_sensor());
  ASSERT_EQ(table.rows.size(), 6U);
  ASSERT_EQ(table.surfaces.size(), 2U);
  for (std::size_t i = 0; i < 6; i += 3) {
    const Table1Row &printed = table.rows[i], &papers = table.rows[i + 1], &ours = table.rows[i + 2];
    SCOPED_TRACE(printed.domain);
    EXPECT_EQ(printed.rules, "paper");
    EXPECT_EQ(papers.rules, "surface.paper = true");
    EXPECT_EQ(ours.rules, "surface.paper = false");
    for (const Table1Row& row : {printed, papers, ours}) {
      EXPECT_EQ(row.domain, printed.domain);
      EXPECT_EQ(row.eta, printed.eta);
      EXPECT_EQ(row.scans, printed.scans);
      EXPECT_EQ(row.leaves, 7 * (row.nodes - row.leaves) + 1);  // A split makes all eight.
      EXPECT_GT(row.fits, 0);
    }
    EXPECT_EQ(papers.points, ours.points);
    EXPECT_EQ(papers.side, ours.side);
    // The paper's rules lose points, ours do not.
    EXPECT_GT(papers.hausdorff, papers.eta);
    EXPECT_LE(ours.hausdorff, ours.eta);
    EXPECT_EQ(papers.segments + papers.loose_points, 0);
    EXPECT_GT(ours.loose_points, 0);
    for (const Table1Row& row : {papers, ours}) EXPECT_LE(row.hausdorff, row.certified + 1e-12);
    EXPECT_EQ(static_cast<std::int64_t>(table.surfaces[i / 3].patches.size()), ours.fits + ours.segments + ours.loose_points);
  }
  EXPECT_EQ(table.rows[0].fits, 1370);
  EXPECT_EQ(table.rows[3].nodes, 83769);
  EXPECT_NEAR(table.rows[1].side, 20.0, 1e-9);
}

TEST(Table1, MarkdownHasBothUnits) {
  Table1Row row{.domain = "patio", .rules = "surface.paper = true", .scans = 16, .points = 1954249, .side = 20.0, .eta = 0.02};
  row.nodes = 2377;
  row.hausdorff = 0.0199;
  const std::string text = table1_as_markdown({row});
  for (const char* part : {"| patio | `surface.paper = true` | 16 | 1,954,249 | 20 m | 0.02 | 0.4 m |", "| 2,377 |", "| 0.0199 | 0.398 m |"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
  row.rules = "paper";
  row.side = 0.0;
  EXPECT_NE(table1_as_markdown({row}).find("| 0.0199 | ? |"), std::string::npos);
  const auto columns = [](std::string_view line) { return std::count(line.begin(), line.end(), '|'); };
  const std::string head = text.substr(0, text.find('\n')), last = text.substr(text.rfind('\n', text.size() - 2) + 1);
  EXPECT_EQ(columns(head), columns(last));
}

TEST(Table1, StopsWhenAsked) {
  class Stop final : public Observer {
    bool stop_requested() override { return true; }
  } observer;
  EXPECT_THROW(static_cast<void>(make_table1(coarse_sensor(), &observer)), Error);
}

}  // namespace
}  // namespace vantage

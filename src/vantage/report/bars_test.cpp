// SPDX-License-Identifier: Apache-2.0
#include "vantage/report/bars.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "vantage/report/curves.h"

namespace vantage {
namespace {

/// What the first group of `pattern` holds at each match.
std::vector<double> numbers_in(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::vector<double> numbers;
  for (std::sregex_iterator match(text.begin(), text.end(), regex), end; match != end; ++match) numbers.push_back(std::stod((*match)[1]));
  return numbers;
}

TEST(Bars, PartsLieEndToEndInProportion) {
  const Bars bars{.title = "Scans",
                  .caption = "",
                  .mark = "oracle",
                  .parts = {{"useful", "blue"}, {"idle", "red"}},
                  .rows = {{"a<b", {3.0, 1.0}, 2.0}, {"none", {0.0, 0.0}, 0.0}}};
  const std::string html = bars_html(bars);
  const std::vector<double> x = numbers_in(html, R"rx(<rect[^>]* x="([0-9.]+)")rx"), widths = numbers_in(html, R"rx(<rect[^>]* width="([0-9.]+)")rx");
  ASSERT_EQ(widths.size(), 4U);
  EXPECT_NEAR(widths[0], 3.0 * widths[1], 0.3);
  EXPECT_NEAR(x[1], x[0] + widths[0], 0.11);
  EXPECT_EQ(widths[2], 0.0);
  const std::vector<double> marks = numbers_in(html, R"rx(<path d="M([0-9.]+) )rx");
  ASSERT_EQ(marks.size(), 1U);  // None for a row without.
  EXPECT_NEAR(marks[0] - x[0], 2.0 / 3.0 * widths[0], 0.2);
  EXPECT_NE(html.find("a&lt;b"), std::string::npos);
  EXPECT_EQ(html.find("a<b"), std::string::npos);
  EXPECT_EQ(bars_html({}), "");
}

TEST(Bars, AllZeroIsNoDivisionByZero) {
  const std::string html = bars_html({.title = "t", .caption = "", .mark = "", .parts = {{"p", "red"}}, .rows = {{"r", {0.0}, 0.0}}});
  EXPECT_EQ(html.find("nan"), std::string::npos);
  EXPECT_EQ(html.find("inf"), std::string::npos);
}

/// Curves that end at the same low value: their names stay above the axis, a line apart.
TEST(Curves, NamesStayInTheChart) {
  Chart chart;
  for (int k = 0; k < 9; ++k)
    chart.curves.push_back({"curve", "red", k == 0 ? Curve::Style::dashed : Curve::Style::line, {1.0, 2.0}, {100.0, k == 1 ? 70.0 : 0.0}});
  const std::string html = chart_html(chart);
  std::vector<double> y = numbers_in(html, R"rx(class="name"[^>]* y="([0-9.]+)")rx");
  const std::vector<double> axis = numbers_in(html, R"rx(class="axis" d="M[0-9.]+ ([0-9.]+)H)rx");
  ASSERT_EQ(y.size(), 9U);
  ASSERT_EQ(axis.size(), 1U);
  std::ranges::sort(y);
  EXPECT_LE(y.back(), axis[0] + 0.11);
  EXPECT_GE(y.front(), 0.0);
  for (std::size_t k = 1; k < y.size(); ++k) EXPECT_GE(y[k] - y[k - 1], 16.8);
  EXPECT_EQ(numbers_in(html, R"rx(curve dashed" style="--c:red"><path d="M([0-9.]+))rx").size(), 1U);
}

}  // namespace
}  // namespace vantage

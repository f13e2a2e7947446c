// SPDX-License-Identifier: Apache-2.0
#include "vantage/report/report.h"

#include <gtest/gtest.h>

#include <pugixml.hpp>
#include <set>

#include "vantage/base/parallel.h"
#include "vantage/report/curves.h"
#include "vantage/report/maps.h"
#include "vantage/report/pictures.h"
#include "vantage/report/sample_run.h"
#include "vantage/report/sections.h"
#include "vantage/report/text.h"

namespace vantage {
namespace {

template <class T>
class Report : public testing::Test {
 protected:
  static const ReportInput<T::value>& input() {
    static const ReportInput<T::value> made = sample::run<T::value>();
    return made;
  }
  static const std::string& html() {
    static const std::string made = render_report(input());
    return made;
  }
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Report, Dimensions);

/// The page as a tree; fails the test if a tag is left open, an attribute lacks its quotes, or an entity is unknown.
pugi::xml_document parsed(const std::string& html) {
  pugi::xml_document document;
  const pugi::xml_parse_result result =
      document.load_buffer(html.data(), html.size(), pugi::parse_default | pugi::parse_doctype, pugi::encoding_utf8);
  EXPECT_TRUE(result) << result.description() << " at " << html.substr(static_cast<std::size_t>(result.offset), 80);
  return document;
}

TYPED_TEST(Report, IsWellFormedAndHasItsParts) {
  const pugi::xml_document document = parsed(this->html());
  EXPECT_EQ(document.document_element().name(), std::string("html"));
  std::set<std::string> ids;
  for (const pugi::xpath_node& node : document.select_nodes("//*[@id]")) EXPECT_TRUE(ids.insert(node.node().attribute("id").value()).second);
  for (const char* id : {"surface", "path", "metric", "curves", "left", "run"}) EXPECT_TRUE(ids.contains(id)) << id;
  EXPECT_EQ(document.select_nodes("//figure[@class='chart']").size(), 4U);
  EXPECT_EQ(document.select_nodes("//figure[@id='metric']//img").size(), 6U);
  EXPECT_EQ(document.select_node("//h1").node().child_value(), std::string("sample"));
}

TYPED_TEST(Report, NeedsNothingFromOutside) {
  const std::string& html = this->html();
  for (const char* word : {"http:", "https:", "url(", "@import", "<script", "<link", "<iframe"})
    EXPECT_EQ(html.find(word), std::string::npos) << word;
  const pugi::xml_document document = parsed(html);
  for (const pugi::xpath_node& node : document.select_nodes("//*[@src]")) {
    EXPECT_TRUE(std::string_view(node.node().attribute("src").value()).starts_with("data:image/png;base64,iVBOR"));
  }
}

TYPED_TEST(Report, EveryPictureHasWords) {
  const pugi::xml_document document = parsed(this->html());
  for (const pugi::xpath_node& node : document.select_nodes("//img")) EXPECT_FALSE(std::string(node.node().attribute("alt").value()).empty());
  for (const pugi::xpath_node& node : document.select_nodes("//figure"))
    EXPECT_FALSE(std::string(node.node().child("figcaption").text().get()).empty());
}

TYPED_TEST(Report, SameBytesForAnyNumberOfThreads) {
  const auto with = [&](int threads) {
    const ThreadLimit limit(threads);
    return render_report(this->input());
  };
  EXPECT_EQ(this->html(), with(1));
  EXPECT_EQ(this->html(), with(2));
  EXPECT_EQ(this->html(), with(7));
}

TYPED_TEST(Report, TimesDoNotShow) {
  constexpr int Dim = TypeParam::value;
  ReportInput<Dim> other = this->input();
  for (StepRecord<Dim>& step : other.steps) step.seconds["surface"] = 12.5;
  EXPECT_EQ(this->html(), render_report(other));
}

TYPED_TEST(Report, EmptyRunsMakeAPage) {
  constexpr int Dim = TypeParam::value;
  const std::string nothing = render_report(ReportInput<Dim>());
  EXPECT_NE(nothing.find("No scan was taken"), std::string::npos);
  (void)parsed(nothing);
  // Any part may be missing.
  for (int part = 0; part < 6; ++part) {
    ReportInput<Dim> input = this->input();
    if (part == 0) input.scan_points.clear();
    if (part == 1) input.patches.clear();
    if (part == 2) input.state = {};
    if (part == 3) input.steps.clear();
    if (part == 4) input.snapshots = {Snapshot<Dim>()};
    if (part == 5) input.verdict = {};
    (void)parsed(render_report(input));
  }
}

TYPED_TEST(Report, DegenerateRunsMakeAPage) {
  constexpr int Dim = TypeParam::value;
  ReportInput<Dim> input;
  input.picture_width = 300;
  input.domain = {Vec<Dim>::Constant(3.0), Vec<Dim>::Constant(3.0)};
  input.scan_points = {{Vec<Dim>::Constant(3.0), Vec<Dim>::Constant(std::nan("")), Vec<Dim>::Constant(kInfinity)}};
  input.patches = {point_patch<Dim>(Vec<Dim>::Constant(3.0))};
  StepRecord<Dim> step;
  step.vantage = Vec<Dim>::Constant(3.0);
  step.next_score = std::nan("");
  step.expected_volume = kInfinity;
  input.steps = {step};
  input.path = {step.vantage, Vec<Dim>::Constant(std::nan(""))};
  const std::string html = render_report(input);
  (void)parsed(html);
  EXPECT_EQ(html.find("nan"), std::string::npos);
}

TYPED_TEST(Report, NamesAreEscaped) {
  constexpr int Dim = TypeParam::value;
  ReportInput<Dim> input = this->input();
  const std::string bad = "<b onclick=\"x\">&'\x01</b>";
  input.scene = input.command = input.verdict.reason = bad;
  input.settings = {{bad, bad}};
  input.verdict.unseen[0].reason = bad;
  const std::string html = render_report(input);
  EXPECT_EQ(html.find("<b onclick"), std::string::npos);
  EXPECT_EQ(std::string(parsed(html).select_node("//h1").node().child_value()), "<b onclick=\"x\">&' </b>");
}

TYPED_TEST(Report, TheVerdictIsSaidAsItIs) {
  constexpr int Dim = TypeParam::value;
  ReportInput<Dim> input = this->input();
  input.verdict = {};
  input.verdict.complete = true;
  input.verdict.reason = "nothing that remains can open";
  input.verdict.seen_fraction = 0.99968;
  input.verdict.seen_low = 0.9991;
  input.verdict.seen_high = 0.99999;
  EXPECT_EQ(verdict_text(input),
            "6\u00a0scans saw 99.96\u00a0% of what can be seen here (between 99.91\u00a0% and 100.00\u00a0%). Nothing that remains can open.");
  EXPECT_NE(header_html(input).find("<b>Complete.</b>"), std::string::npos);
  input.verdict.complete = false;
  EXPECT_NE(header_html(input).find("<b>Not complete.</b>"), std::string::npos);
  input.surface.data_to_surface = 0.2;
  EXPECT_NE(header_html(input).find("above the tolerance"), std::string::npos);
  // Of a person's scans nobody knows how much there is to see.
  input.next.push_back({});
  EXPECT_EQ(verdict_text(input).find("of what can be seen"), std::string::npos);
  EXPECT_EQ(verdict_text(input).find("6\u00a0scans saw "), 0U) << verdict_text(input);
}

TEST(StateMap, NodesStandWhereTheyAre) {
  Field<2, NodeState> state(Grid<2>{1.0, {2, 3}, {20, 10}}, NodeState::seen);
  state.at({4, 1}) = NodeState::obstacle;
  state.at({15, 8}) = NodeState::unseen;
  const Camera camera = Camera::map(map_box(state.window), {400, 400, 0.0});
  EXPECT_EQ(camera.height(), 200);
  const Image image = state_map(state, camera, kLightStates);
  const auto colour_at = [&](double x, double y) {
    const Projected q = camera.project({x, y, 0.0});
    const std::uint8_t* p = image.pixel(static_cast<int>(q.x), static_cast<int>(q.y));
    return Rgb{p[0], p[1], p[2]};
  };
  EXPECT_EQ(colour_at(6.0, 4.0), kLightStates.obstacle);
  EXPECT_EQ(colour_at(6.4, 4.4), kLightStates.obstacle);
  EXPECT_EQ(colour_at(6.6, 4.0), kLightStates.seen);
  const Rgb unseen = colour_at(17.0, 11.0);
  EXPECT_TRUE(unseen == kLightStates.unseen || unseen == kLightStates.hatch);
}

TEST(MetricMap, IsBrightestAtTheBestPlaceAndOnlyWhereSeen) {
  Field<2, NodeState> state(Grid<2>{1.0, {0, 0}, {40, 40}}, NodeState::seen);
  for (int y = 0; y < 40; ++y) state.at({10, y}) = NodeState::unseen;
  Field<2, float> metric(Grid<2>{2.0, {0, 0}, {20, 20}}, std::nanf(""));
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 15; ++x) metric.at({x, y}) = static_cast<float>(x);
  }
  const Camera camera = Camera::map(map_box(state.window), {400, 400, 0.0});
  const Image image = metric_map(metric, state, camera);
  const auto at = [&](double x, double y) {
    const Projected q = camera.project({x, y, 0.0});
    return image.pixel(static_cast<int>(q.x), static_cast<int>(q.y));
  };
  EXPECT_EQ(at(10.0, 20.0)[3], 0);
  EXPECT_EQ(at(34.0, 20.0)[3], 0);
  EXPECT_LT(at(4.0, 20.0)[1], at(16.0, 20.0)[1]);
  EXPECT_LT(at(16.0, 20.0)[1], at(28.0, 20.0)[1]);
  EXPECT_EQ((Rgb{at(28.0, 20.0)[0], at(28.0, 20.0)[1], at(28.0, 20.0)[2]}), colour_of(ColourMap::inferno, 1.0));
}

TEST(Points, AllAreDrawnOnceUpToTwoMillion) {
  ReportInput<2> input;
  input.domain = {Vec<2>(0.0, 0.0), Vec<2>(1.0, 1.0)};
  input.scan_points.assign(7, std::vector<Vec<2>>(714'287, Vec<2>(0.5, 0.5)));
  EXPECT_EQ(point_stride(input), 3U);
  std::atomic<std::size_t> count = 0;
  for_drawn_points(input, [&](std::size_t, const Vec<2>&) { ++count; });
  EXPECT_EQ(count, (7U * 714'287U + 2U) / 3U);
}

TEST(Text, NumbersReadWell) {
  EXPECT_EQ(number(1234567.0), "1\u202f234\u202f567");
  EXPECT_EQ(number(std::int64_t{-12345}), "-12\u202f345");
  EXPECT_EQ(number(std::int64_t{1234}), "1234");
  EXPECT_EQ(number(0.09812), "0.0981");
  EXPECT_EQ(number(12.345), "12.3");
  EXPECT_EQ(number(0.09999), "0.100");
  EXPECT_EQ(number(99.97), "100");
  EXPECT_EQ(number(0.0), "0");
  EXPECT_EQ(number(std::nan("")), "–");
  EXPECT_EQ(rounded(0.5), "0.5");
  EXPECT_EQ(rounded(1.0 / 3.0, 3), "0.333");
  EXPECT_EQ(rounded(20000.0), "20\u202f000");
}

TEST(Text, SharesAreNeverRoundedUpToAll) {
  EXPECT_EQ(percent(1.0), "100\u00a0%");
  EXPECT_EQ(percent(0.999999), "99.99\u00a0%");
  EXPECT_EQ(percent(0.997), "99.70\u00a0%");
  EXPECT_EQ(percent(0.9159), "91.5\u00a0%");
  EXPECT_EQ(percent(0.9151, true), "91.6\u00a0%");
  EXPECT_EQ(percent(-1.0), "0.0\u00a0%");
  EXPECT_EQ(percent(std::nan("")), "–");
}

TEST(Curves, TicksAreRoundAndCover) {
  EXPECT_EQ(round_ticks(0.0, 100.0, 4), (std::vector<double>{0.0, 50.0, 100.0}));
  EXPECT_EQ(round_ticks(0.0, 1.0, 4), (std::vector<double>{0.0, 0.5, 1.0}));
  EXPECT_EQ(round_ticks(0.0, 0.3, 3), (std::vector<double>{0.0, 0.1, 0.2, 0.3}));
  EXPECT_EQ(round_ticks(3.0, 17.0, 6), (std::vector<double>{0.0, 5.0, 10.0, 15.0, 20.0}));
  for (const double high : {1e-6, 0.013, 0.7, 42.0, 1e7}) {
    const std::vector<double> ticks = round_ticks(0.0, high, 5);
    EXPECT_GE(ticks.back(), high * (1.0 - 1e-9));
    EXPECT_LE(ticks.size(), 7U);
    EXPECT_GE(ticks.size(), 2U);
  }
}

TEST(Curves, LogarithmIsRight) {
  for (const double value : {1e-9, 0.02, 0.5, 1.0, 2.0, 10.0, 123.456, 1e12})
    EXPECT_NEAR(log10_of(value), std::log10(value), 1e-13 * (1.0 + std::abs(std::log10(value))));
}

TEST(Curves, WhatCannotBeShownIsLeftOut) {
  Chart chart;
  chart.logarithmic = true;
  chart.curves.push_back({"a", "red", Curve::Style::line, {0.0, 1.0, 2.0}, {0.0, std::nan(""), -3.0}});
  EXPECT_EQ(chart_html(chart), "");
  chart.curves[0].y[2] = 30.0;
  const std::string html = chart_html(chart);
  EXPECT_EQ(html.find("nan"), std::string::npos);
  EXPECT_NE(html.find("<circle"), std::string::npos);
  EXPECT_EQ(html.find("<circle"), html.rfind("<circle"));
}

}  // namespace
}  // namespace vantage

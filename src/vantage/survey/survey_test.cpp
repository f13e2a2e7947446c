// SPDX-License-Identifier: Apache-2.0
#include "vantage/survey/survey.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/survey/tour.h"
#include "vantage/world/blocks.h"

namespace vantage {
namespace {

template <class T>
class SurveyTest : public testing::Test {};
using Dims = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(SurveyTest, Dims);

/// The box over a rectangle; in 3D it is 3 m high.
template <int Dim>
Box<Dim> over(double x0, double y0, double x1, double y1) {
  Box<Dim> box{Vec<Dim>::Zero(), Vec<Dim>::Constant(3.0)};
  box.low.template head<2>() = Vec<2>(x0, y0);
  box.high.template head<2>() = Vec<2>(x1, y1);
  return box;
}

/// Hollows in a solid of 20 x 20 m.
template <int Dim>
Scene<Dim> scene_of(const std::vector<Box<Dim>>& hollows) {
  Scene<Dim> scene;
  scene.name = "hollows";
  Blocks<Dim> rock;
  rock.fill(over<Dim>(-1.0, -1.0, 21.0, 21.0).grown(1.0));
  for (const Box<Dim>& hollow : hollows) rock.carve(hollow);
  rock.append_to(scene.mesh);
  scene.domain = over<Dim>(-0.5, -0.5, 20.5, 20.5).grown(0.25);
  scene.start = Vec<Dim>::Constant(1.5);
  return scene;
}

template <int Dim>
Scene<Dim> room() {
  return scene_of<Dim>({over<Dim>(0.0, 0.0, 10.0, 8.0)});
}

/// Three corridors of 3 m round a block.
template <int Dim>
Scene<Dim> horseshoe() {
  return scene_of<Dim>({over<Dim>(0.0, 0.0, 3.0, 20.0), over<Dim>(0.0, 0.0, 20.0, 3.0), over<Dim>(17.0, 0.0, 20.0, 20.0)});
}

SurveyOptions options_for(double incidence_deg) {
  SurveyOptions options;
  options.incidence = radians(incidence_deg);
  options.min_range = 0.0;
  options.samples = 1000;
  options.candidates = 300;
  options.effort = 5;
  return options;
}

TYPED_TEST(SurveyTest, OneStationMeasuresAnEmptyRoom) {
  const auto survey = make_survey(room<TypeParam::value>(), options_for(85.0));
  EXPECT_EQ(survey.stations.size(), 1u);
  EXPECT_EQ(survey.at_least, 1);
  EXPECT_EQ(survey.share, 1.0);
  EXPECT_EQ(survey.legs.size(), 1u);
}

TYPED_TEST(SurveyTest, TheWallIsThatOfTheRoom) {
  const auto survey = make_survey(room<TypeParam::value>(), options_for(85.0));
  const double expected = std::array{36.0, 36.0 * 3.0 + 160.0}[TypeParam::value - 2];
  EXPECT_NEAR(survey.wall, expected, 0.06 * expected);
  EXPECT_NEAR(survey.stations[0].sees, survey.wall, 1e-9 * expected);
  EXPECT_EQ(survey.stations[0].adds, survey.stations[0].sees);
}

TYPED_TEST(SurveyTest, TwoStationsMeasureAHorseshoe) {
  const auto survey = make_survey(horseshoe<TypeParam::value>(), options_for(89.9));
  EXPECT_EQ(survey.stations.size(), 2u);
  EXPECT_EQ(survey.at_least, 2);
  EXPECT_EQ(survey.share, 1.0);
}

TYPED_TEST(SurveyTest, TighterLimitsNeedMore) {
  const auto scene = horseshoe<TypeParam::value>();
  const auto loose = make_survey(scene, options_for(89.9));
  SurveyOptions options = options_for(60.0);
  const auto steep = make_survey(scene, options);
  EXPECT_GT(steep.stations.size(), loose.stations.size());
  options.range = 2.5;
  const auto near = make_survey(scene, options);
  EXPECT_GT(near.stations.size(), steep.stations.size());
  options.range = 80.0;
  options.density = std::array{30.0, 900.0}[TypeParam::value - 2];
  EXPECT_GT(make_survey(scene, options).stations.size(), loose.stations.size());
  for (const auto& survey : {loose, steep, near}) {
    EXPECT_EQ(survey.share, 1.0);
    EXPECT_LE(survey.at_least, static_cast<std::int64_t>(survey.stations.size()));
  }
}

TYPED_TEST(SurveyTest, StationsKeepTheClearanceAndWaysStayWithin) {
  const auto scene = horseshoe<TypeParam::value>();
  SurveyOptions options = options_for(60.0);
  options.come_back = true;
  const auto survey = make_survey(scene, options);
  const RayCaster<TypeParam::value> truth(scene.mesh);
  for (const auto& station : survey.stations) EXPECT_GE(truth.distance(station.place), options.clearance);
  ASSERT_EQ(survey.legs.size(), survey.stations.size() + 1);
  EXPECT_EQ(survey.legs.front().front(), scene.start);
  EXPECT_EQ(survey.legs.back().back(), scene.start);
  for (const auto& leg : survey.legs) {
    ASSERT_FALSE(leg.empty());
    for (std::size_t i = 1; i < leg.size(); ++i) EXPECT_TRUE(in_sight(truth, leg[i - 1], leg[i]));
  }
}

TYPED_TEST(SurveyTest, EveryPlaceTwice) {
  SurveyOptions options = options_for(85.0);
  options.cover = 2;
  const auto survey = make_survey(room<TypeParam::value>(), options);
  EXPECT_EQ(survey.stations.size(), 2u);
  EXPECT_EQ(survey.at_least, 2);
  EXPECT_TRUE(std::all_of(survey.times.begin(), survey.times.end(), [](auto times) { return times == 2; }));
}

TYPED_TEST(SurveyTest, OverlapLinksEveryStationToAnEarlierOne) {
  SurveyOptions options = options_for(70.0);
  options.range = 9.0;
  const auto apart = make_survey(horseshoe<TypeParam::value>(), options);
  options.overlap = 0.4;
  const auto survey = make_survey(horseshoe<TypeParam::value>(), options);
  EXPECT_TRUE(survey.linked);
  EXPECT_EQ(survey.share, 1.0);
  EXPECT_GE(survey.stations.size(), apart.stations.size());
  for (std::size_t k = 1; k < survey.stations.size(); ++k) {
    EXPECT_GE(survey.stations[k].overlap, options.overlap);
    EXPECT_LT(survey.stations[k].partner, static_cast<int>(k));
  }
}

TYPED_TEST(SurveyTest, AShareOfAllNeedsFewer) {
  SurveyOptions options = options_for(60.0);
  const auto all = make_survey(horseshoe<TypeParam::value>(), options);
  options.share = 0.8;
  const auto most = make_survey(horseshoe<TypeParam::value>(), options);
  EXPECT_LT(most.stations.size(), all.stations.size());
  EXPECT_GE(most.share, 0.8);
  EXPECT_LE(most.at_least, static_cast<std::int64_t>(most.stations.size()));
}

TYPED_TEST(SurveyTest, TheFreeSpaceToo) {
  SurveyOptions options = options_for(89.9);
  options.voxel = 0.25;
  options.range = 7.0;
  const auto walls = make_survey(room<TypeParam::value>(), options);
  options.volume = true;
  const auto survey = make_survey(room<TypeParam::value>(), options);
  EXPECT_GT(survey.demands, walls.demands);
  EXPECT_EQ(survey.wall, walls.wall);
  EXPECT_EQ(survey.share, 1.0);
}

TYPED_TEST(SurveyTest, SameForAnyNumberOfThreads) {
  const auto text = [](int threads) {
    const ThreadLimit limit(threads);
    const auto survey = make_survey(horseshoe<TypeParam::value>(), options_for(60.0));
    return stations_as_csv(survey) + path_as_csv(survey) + survey_page(survey, "horseshoe");
  };
  EXPECT_EQ(text(1), text(3));
}

TYPED_TEST(SurveyTest, MeasuresWithinTheLimitsOnly) {
  constexpr int Dim = TypeParam::value;
  const RayCaster<Dim> truth(room<Dim>().mesh);
  SurveyOptions options;
  options.min_range = 1.0;
  options.range = 6.0;
  options.incidence = radians(60.0);
  Demand<Dim> demand{Vec<Dim>::Constant(2.0), Vec<Dim>::UnitX()};
  demand.place[0] = 0.0;
  const auto from = [&](double range, double angle) {
    const auto [s, c] = sin_cos(radians(angle));
    Vec<Dim> place = demand.place;
    place[0] += range * c;
    place[1] += range * s;
    return measures(truth, place, demand, options);
  };
  EXPECT_TRUE(from(5.9, 0.0) && from(1.1, 0.0) && from(3.0, 59.0));
  EXPECT_FALSE(from(6.1, 0.0) || from(0.9, 0.0) || from(3.0, 61.0));
  options.step = radians(1.0);
  const double metres = 4.0, spacing = metres * options.step;
  options.density = std::array{1.0 / spacing, 1.0 / (spacing * spacing)}[Dim - 2];  // Frontally up to 4 m away.
  EXPECT_TRUE(from(0.99 * metres, 0.0));
  EXPECT_FALSE(from(1.01 * metres, 0.0) || from(0.99 * metres, 30.0));
  demand.normal = -demand.normal;
  EXPECT_FALSE(from(2.0, 0.0));
}

TYPED_TEST(SurveyTest, DemandsLieEvenlyOnBothSides) {
  constexpr int Dim = TypeParam::value;
  Scene<Dim> scene = room<Dim>();
  scene.domain = over<Dim>(-3.0, -3.0, 23.0, 23.0).grown(5.0);
  const auto demands = surface_demands(scene, 4000, 3);
  EXPECT_EQ(demands.size(), 8000u);
  const RayCaster<Dim> truth(scene.mesh);
  std::size_t inner = 0;
  for (const auto& demand : demands) {
    EXPECT_LT(truth.distance(demand.place), 1e-9);
    inner += over<Dim>(0.0, 0.0, 10.0, 8.0).grown(1e-6).contains(demand.place) ? 1 : 0;
  }
  const double room_wall = std::array{36.0, 268.0}[Dim - 2], hull = std::array{96.0, 4.0 * 24.0 * 5.0 + 2.0 * 24.0 * 24.0}[Dim - 2];
  EXPECT_NEAR(static_cast<double>(inner) / 8000.0, room_wall / (room_wall + hull), 0.01);
}

TEST(Survey, TheScannerStandsAtItsHeight) {
  SurveyOptions options = options_for(80.0);
  options.height = 1.5;
  options.voxel = 0.25;
  const auto survey = make_survey(horseshoe<3>(), options);
  for (const auto& station : survey.stations) EXPECT_NEAR(station.place[2], 1.5, 0.125 + 1e-9);
  options.height = 2.9;
  EXPECT_THROW(static_cast<void>(make_survey(horseshoe<3>(), options)), Error);
}

TEST(Survey, WrongOptionsAreNamed) {
  SurveyOptions options;
  options.overlap = 2.0;
  EXPECT_THROW(static_cast<void>(make_survey(room<2>(), options)), Error);
}

TravelTable straight(const std::vector<Vec<2>>& places) {
  TravelTable table{places.size(), {}};
  for (const auto& a : places)
    for (const auto& b : places) table.metres.push_back((a - b).norm());
  return table;
}

TEST(Tour, GoesAlongALineAndRoundACircle) {
  EXPECT_EQ(tour(straight({{0.0, 0.0}, {3.0, 0.0}, {1.0, 0.0}, {2.0, 0.0}}), false), (std::vector<std::size_t>{0, 2, 3, 1}));
  std::vector<Vec<2>> ring;
  for (const int k : {0, 5, 2, 7, 1, 6, 3, 4}) {
    const auto [s, c] = sin_cos(k * 0.25 * kPi);
    ring.emplace_back(c, s);
  }
  const TravelTable table = straight(ring);
  const auto order = tour(table, true);
  double length = 0.0;
  for (std::size_t k = 0; k < order.size(); ++k) length += table(order[k], order[(k + 1) % order.size()]);
  EXPECT_NEAR(length, 8.0 * (ring[0] - ring[4]).norm(), 1e-9);
}

TEST(Tour, KeepsTheRule) {
  const OrderRule rule = [](const std::vector<std::size_t>& order) { return order.size() < 2 || order[1] == 1; };
  EXPECT_EQ(tour(straight({{0.0, 0.0}, {3.0, 0.0}, {1.0, 0.0}, {2.0, 0.0}}), false, rule), (std::vector<std::size_t>{0, 1, 3, 2}));
  EXPECT_TRUE(tour(TravelTable{}, false).empty());
}

TEST(Tour, WaysGoRoundWhatIsInBetween) {
  Field<2, std::uint8_t> passable(Grid<2>{0.5, {0, 0}, {41, 41}}, 1);
  for (int y = 0; y < 36; ++y) passable.at({20, y}) = 0;
  const std::vector<Vec<2>> places{{5.0, 5.0}, {15.0, 5.0}};
  const double expected = 2.0 * Vec<2>(5.0, 13.0).norm();  // By the gap's edge at (10, 18).
  EXPECT_NEAR(travel_table<2>(passable, places)(0, 1), expected, 0.08 * expected);
  const auto way = way_between<2>(passable, places[0], places[1]);
  EXPECT_NEAR(length_of<2>(way), expected, 0.06 * expected);
  EXPECT_EQ(way.front(), places[0]);
  EXPECT_EQ(way.back(), places[1]);
  for (int y = 36; y < 41; ++y) passable.at({20, y}) = 0;
  EXPECT_TRUE(way_between<2>(passable, places[0], places[1]).empty());
}

}  // namespace
}  // namespace vantage

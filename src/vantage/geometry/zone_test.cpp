// SPDX-License-Identifier: Apache-2.0
#include "vantage/geometry/zone.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vantage/base/error.h"
#include "vantage/base/random.h"

namespace vantage {
namespace {

using testing::HasSubstr;

std::string error_of(std::vector<std::vector<Vec<2>>> rings, double low = -kInfinity, double high = kInfinity) {
  try {
    Zone zone{std::move(rings), low, high};
    tidy_zone(zone, "here");
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

/// An L of 4 x 4 m, 1 m wide, and a frame of 10 x 10 m with a hole of 4 x 4 m.
Zone corner() { return {{{{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}}}, 0.0, 2.0}; }
Zone frame() { return {{{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{3, 3}, {7, 3}, {7, 7}, {3, 7}}}}; }

TEST(Zones, HoldWhatTheirShapeHolds) {
  Random random(4);
  const Zone l = corner(), o = frame();
  for (int k = 0; k < 2000; ++k) {
    const Vec<2> p(random.uniform(-1, 11), random.uniform(-1, 11));
    const bool in_l = p.minCoeff() > 0 && p.maxCoeff() < 4 && p.minCoeff() < 1;
    const bool in_hole = p.minCoeff() > 3 && p.maxCoeff() < 7, in_square = p.minCoeff() > 0 && p.maxCoeff() < 10;
    EXPECT_EQ(l.contains<2>(p), in_l) << p.transpose();
    EXPECT_EQ(o.contains<2>(p), in_square && !in_hole) << p.transpose();
    EXPECT_EQ(l.contains<3>({p.x(), p.y(), 1.9}), in_l);
    EXPECT_FALSE(l.contains<3>({p.x(), p.y(), 2.1}) || l.contains<3>({p.x(), p.y(), -0.1}));
  }
  for (const Vec<2>& p : {Vec<2>(0, 0), Vec<2>(4, 1), Vec<2>(2, 1), Vec<2>(0, 3.5)}) EXPECT_TRUE(l.contains<2>(p)) << p.transpose();
  EXPECT_TRUE(l.contains<3>({2, 0.5, 2.0}) && l.contains<3>({2, 0.5, 0.0}));
}

TEST(Zones, AreWhatTheBoxIs) {
  Random random(5);
  const Box<3> box{{1, 2, 3}, {4, 5, 6}};
  const Zone zone = box_zone<3>(box);
  for (int k = 0; k < 2000; ++k) {
    const Vec<3> p(random.uniform(0, 7), random.uniform(0, 7), random.uniform(0, 7)), q = p + Vec<3>(random.uniform(0, 2), random.uniform(0, 2), 1.0);
    EXPECT_EQ(zone.contains<3>(p), box.contains(p)) << p.transpose();
    EXPECT_EQ(zone.meets<3>({p, q}), !box.intersection({p, q}).empty()) << p.transpose();
  }
  EXPECT_TRUE(zone.contains<3>(box.low) && zone.contains<3>(box.high));
  EXPECT_TRUE(box_zone<2>({{0, 0}, {1, 1}}).contains<2>({1, 1}));
}

TEST(Zones, MeetBoxesThatHoldNoneOfTheirCorners) {
  EXPECT_TRUE(corner().meets<2>({{2, 0.2}, {3, 0.4}}));   // All inside.
  EXPECT_FALSE(corner().meets<2>({{1.5, 1.5}, {3, 3}}));  // In the angle of the L.
  EXPECT_FALSE(frame().meets<2>({{4, 4}, {6, 6}}));       // In the hole.
  EXPECT_TRUE(frame().meets<2>({{4, 4}, {6, 8}}));
  EXPECT_TRUE((Zone{{{{0, 0.5}, {9, 0.5}, {9, 0.51}}}}.meets<2>({{4, 0}, {5, 1}})));  // A sliver across.
  EXPECT_FALSE(corner().meets<3>({{0, 0, 2.5}, {1, 1, 3}}));
}

TEST(Zones, AreTidied) {
  Zone zone{{{{0, 0}, {0, 0}, {4, 0}, {4, 3}, {0, 0}}}};
  tidy_zone(zone, "here");
  EXPECT_EQ(zone.rings[0].size(), 3U);
  EXPECT_EQ(error_of(corner().rings), "");
  EXPECT_EQ(error_of(frame().rings), "");
  EXPECT_EQ(error_of({{{0, 0}, {2, 0}, {4, 0}, {4, 4}}}), "");  // A corner in a straight side.
}

TEST(Zones, RefuseWhatIsNoPolygon) {
  const double nan = std::nan("");
  EXPECT_THAT(error_of({}), HasSubstr("no corners"));
  EXPECT_THAT(error_of({{{0, 0}, {1, 0}}}), HasSubstr("2 corners: a polygon has at least 3"));
  EXPECT_THAT(error_of({{{0, 0}, {1, 0}, {0, 0}, {0, 0}}}), HasSubstr("at least 3"));
  EXPECT_THAT(error_of({{{0, 0}, {1, 0}, {1, nan}}}), HasSubstr("finite"));
  EXPECT_THAT(error_of({{{0, 0}, {4, 4}, {4, 0}, {0, 4}}}), HasSubstr("crosses or touches itself"));                     // A bow tie.
  EXPECT_THAT(error_of({{{0, 0}, {4, 0}, {2, 0}, {2, 3}}}), HasSubstr("crosses or touches itself"));                     // Back on itself.
  EXPECT_THAT(error_of({{{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}}}), HasSubstr("near 2,0"));                              // Pinched.
  EXPECT_THAT(error_of({{{0, 0}, {9, 0}, {9, 9}}, {{5, 1}, {12, 2}, {6, 2}}}), HasSubstr("crosses or touches itself"));  // A hole sticks out.
  EXPECT_THAT(error_of(corner().rings, 2.0, 1.0), HasSubstr("the lower comes first"));
}

}  // namespace
}  // namespace vantage

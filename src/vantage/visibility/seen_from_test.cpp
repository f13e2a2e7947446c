// SPDX-License-Identifier: Apache-2.0
#include "vantage/visibility/seen_from.h"

#include <gtest/gtest.h>

#include "vantage/base/parallel.h"
#include "vantage/base/random.h"
#include "vantage/visibility/depth_pyramid.h"
#include "vantage/visibility/visibility.h"

namespace vantage {
namespace {

template <class T>
class SeenFrom : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(SeenFrom, Dimensions);

template <int Dim>
Vec<Dim> random_place(Random& random, double half_side) {
  Vec<Dim> p;
  for (int a = 0; a < Dim; ++a) p[a] = random.uniform(-half_side, half_side);
  return p;
}

/// Points, segments and balls of points around the origin.
template <int Dim>
std::vector<Patch<Dim>> random_patches(Random& random, int count) {
  std::vector<Patch<Dim>> patches;
  for (int i = 0; i < count; ++i) {
    const Vec<Dim> p = random_place<Dim>(random, 10.0);
    patches.push_back(i % 3 == 0 ? point_patch<Dim>(p) : segment_patch<Dim>(p, p + random_place<Dim>(random, 4.0)));
  }
  return patches;
}

/// A window of odd extents somewhere around the origin; now and then it does not hold it, or is one node thin.
template <int Dim>
Grid<Dim> random_window(Random& random) {
  Grid<Dim> window{random.uniform(0.2, 0.7), {}, {}};
  for (int a = 0; a < Dim; ++a) {
    window.first[a] = static_cast<std::int32_t>(random.uniform(-50.0, 12.0));
    window.extent[a] = static_cast<std::int32_t>(random.uniform(1.0, Dim == 2 ? 120.0 : 60.0));
  }
  return window;
}

/// Ranges with jumps, slopes, blind pixels and far pixels.
template <int Dim>
DepthImage<Dim> random_image(Random& random, float far) {
  DepthImage<Dim> image(static_cast<int>(random.uniform(5.0, 150.0)), far);
  draw_patches<Dim>(image, random_patches<Dim>(random, 30), random_place<Dim>(random, 3.0), random.uniform(0.0, 0.5), random.uniform(0.0, 0.1));
  const double holes = random.uniform(0.0, 0.01);
  for (std::size_t p = 0; p < image.size(); ++p)
    if (random.uniform(0.0, 1.0) < holes) image[p] = 0.0F;
  return image;
}

template <int Dim>
void expect_every_node(const SeenSet<Dim>& set, const DepthImage<Dim>& image, const Viewpoint<Dim>& view) {
  std::size_t seen = 0;
  for (std::size_t i = 0; i < set.window().size(); ++i) {
    const bool asked = sees<Dim>(image, view.max_range, set.window().position(i) - view.origin);
    seen += asked ? 1 : 0;
    ASSERT_EQ(set.at(set.window().local(i)), asked) << set.window().position(i).transpose();
  }
  EXPECT_EQ(set.count(), seen);
}

/// The law of the blocks: no node differs from asking it.
TYPED_TEST(SeenFrom, EqualsAskingEveryNode) {
  constexpr int Dim = TypeParam::value;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    const Viewpoint<Dim> view{random_place<Dim>(random, 2.0), random.uniform(2.0, 40.0)};
    const DepthImage<Dim> image = random_image<Dim>(random, static_cast<float>(random.uniform(5.0, 40.0)));
    expect_every_node(seen_from(image, view, random_window<Dim>(random)), image, view);
  }
}

/// Origins on lattice nodes and between them: directions on the edges of pixels and faces, ranges that tie.
TYPED_TEST(SeenFrom, EqualsAskingEveryNodeInTies) {
  constexpr int Dim = TypeParam::value;
  for (const double shift : {0.0, 0.25, 0.5})
    for (const int resolution : {1, 4, 64, 65}) {
      const Viewpoint<Dim> view{Vec<Dim>::Constant(shift), 5.0};
      DepthImage<Dim> image(resolution, 5.0F);
      for (std::size_t p = 0; p < image.size(); p += 3) image[p] = static_cast<float>(p % 5);
      const Grid<Dim> window{0.5, Index<Dim>::Constant(-11), Index<Dim>::Constant(23)};
      expect_every_node(seen_from(image, view, window), image, view);
    }
}

TYPED_TEST(SeenFrom, WindowsAgreeWhereTheyOverlap) {
  constexpr int Dim = TypeParam::value;
  Random random(7);
  const Viewpoint<Dim> view{random_place<Dim>(random, 1.0), 12.0};
  const DepthImage<Dim> image = random_image<Dim>(random, 12.0F);
  const Grid<Dim> large{0.5, Index<Dim>::Constant(-24), Index<Dim>::Constant(48)}, small{0.5, Index<Dim>::Constant(-13), Index<Dim>::Constant(21)};
  const SeenSet<Dim> all = seen_from(image, view, large), part = seen_from(image, view, small);
  for (std::size_t i = 0; i < small.size(); ++i) {
    const Index<Dim> node = small.local(i) + small.first;
    ASSERT_EQ(part.at(node - small.first), all.at(node - large.first));
  }
}

/// The laws of the coarse answer: it never errs, refining narrows it, and what it leaves open at the end are the mixed blocks and few others.
TYPED_TEST(SeenFrom, CoarseAnswersBoundTheFineOne) {
  constexpr int Dim = TypeParam::value;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    const Viewpoint<Dim> view{random_place<Dim>(random, 2.0), random.uniform(2.0, 40.0)};
    const DepthImage<Dim> image = random_image<Dim>(random, static_cast<float>(random.uniform(5.0, 40.0)));
    const Grid<Dim> window = random_window<Dim>(random);
    const SeenSet<Dim> fine = seen_from(image, view, window);
    const DepthPyramid<Dim> pyramid(image);
    GradualView<Dim> coarse(pyramid, view, window);
    std::size_t least = 0, most = window.size();
    do {
      ASSERT_LE(least, coarse.seen_at_least());
      ASSERT_GE(most, coarse.seen_at_most());
      least = coarse.seen_at_least(), most = coarse.seen_at_most();
      ASSERT_LE(least, fine.count());
      ASSERT_GE(most, fine.count());
      Field<Dim, std::uint8_t> said(window);  // 0: hidden.
      const auto mark = [&](const std::vector<Grid<Dim>>& cubes, std::uint8_t value) {
        for (const Grid<Dim>& cube : cubes)
          for (std::size_t i = 0; i < cube.size(); ++i) {
            std::uint8_t& node = said.at(cube.first + cube.local(i) - window.first);
            ASSERT_EQ(node, 0);  // No node twice.
            node = value;
          }
      };
      mark(coarse.seen(), 1);
      mark(coarse.undecided(), 2);
      for (std::size_t i = 0; i < window.size(); ++i)
        if (said[i] != 2) {
          ASSERT_EQ(fine.at(window.local(i)), said[i] == 1);
        }
    } while (coarse.refine());
    EXPECT_EQ(coarse.side(), SeenSet<Dim>::kSide);
    EXPECT_FALSE(coarse.refine());
    EXPECT_GE(coarse.undecided().size(), fine.mixed() > 0 ? 1U : 0U);
  }
}

TYPED_TEST(SeenFrom, UniformBlocksTakeNoBits) {
  constexpr int Dim = TypeParam::value;
  const DepthImage<Dim> open(32, 100.0F);
  const Grid<Dim> window{0.5, Index<Dim>::Constant(-16), Index<Dim>::Constant(32)};
  const SeenSet<Dim> all = seen_from(open, Viewpoint<Dim>{Vec<Dim>::Zero(), 100.0}, window);
  EXPECT_EQ(all.mixed(), 0U);
  EXPECT_EQ(all.count(), window.size());
  const SeenSet<Dim> none = seen_from(DepthImage<Dim>(32, 0.0F), Viewpoint<Dim>{Vec<Dim>::Constant(0.1), 100.0}, window);
  EXPECT_EQ(none.mixed(), 0U);
  EXPECT_EQ(none.count(), 0U);
}

TYPED_TEST(SeenFrom, EmptyWindowSeesNothing) {
  constexpr int Dim = TypeParam::value;
  const Grid<Dim> window{0.5, Index<Dim>::Constant(3), Index<Dim>::Zero()};
  EXPECT_EQ(seen_from(DepthImage<Dim>(8, 1.0F), Viewpoint<Dim>{}, window).count(), 0U);
}

TYPED_TEST(SeenFrom, SameBitsForAnyNumberOfThreads) {
  constexpr int Dim = TypeParam::value;
  Random random(3);
  const Viewpoint<Dim> view{random_place<Dim>(random, 1.0), 30.0};
  const DepthImage<Dim> image = random_image<Dim>(random, 30.0F);
  const Grid<Dim> window{0.25, Index<Dim>::Constant(-70), Index<Dim>::Constant(141)};
  const SeenSet<Dim> once = seen_from(image, view, window);
  EXPECT_GT(once.mixed(), 0U);
  for (const int threads : {1, 2, 7}) {
    const ThreadLimit limit(threads);
    EXPECT_EQ(seen_from(image, view, window), once);
  }
}

TYPED_TEST(SeenFrom, IsTheSignOfVisibility) {
  constexpr int Dim = TypeParam::value;
  Random random(11);
  Scan<Dim> scan;
  scan.pattern.step = radians(2.0);
  scan.pattern.max_range = 9.0;
  for (std::size_t i = 0; i < directions<Dim>(scan.pattern).size(); ++i)
    scan.ranges.push_back(random.uniform(0.0, 1.0) < 0.1 ? kNoReturn : static_cast<float>(random.uniform(2.0, 9.0)));
  const auto patches = random_patches<Dim>(random, 20);
  const Grid<Dim> window{0.3, Index<Dim>::Constant(-31), Index<Dim>::Constant(57)};
  const SeenSet<Dim> set = seen_by<Dim>(patches, scan, window, 0.1);
  const Field<Dim> phi = visibility<Dim>(patches, scan, window, 0.1);
  EXPECT_GT(set.count(), 0U);
  for (std::size_t i = 0; i < window.size(); ++i) ASSERT_EQ(phi[i] > 0.0F, set.at(window.local(i)));
}

/// Bounds hold for every direction to the box.
TYPED_TEST(SeenFrom, PyramidBoundsHold) {
  constexpr int Dim = TypeParam::value;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    const DepthImage<Dim> image = random_image<Dim>(random, 20.0F);
    const DepthPyramid<Dim> pyramid(image);
    for (int i = 0; i < 20; ++i) {
      Box<Dim> box;
      box.extend(random_place<Dim>(random, 10.0));
      box.extend(Vec<Dim>(box.low + random_place<Dim>(random, 2.0)));
      const auto bounds = pyramid.over(box);
      for (int k = 0; k < 50; ++k) {
        Vec<Dim> p;
        for (int a = 0; a < Dim; ++a) p[a] = random.uniform(box.low[a], box.high[a]);
        const float range = image[image.pixel(p)];
        ASSERT_GE(range, bounds.low);
        ASSERT_LE(range, bounds.high);
      }
    }
  }
}

}  // namespace
}  // namespace vantage

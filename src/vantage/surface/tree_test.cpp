// SPDX-License-Identifier: Apache-2.0
#include "vantage/surface/tree.h"

#include <gtest/gtest.h>

#include <map>

#include <algorithm>
#include <functional>

#include "vantage/base/random.h"

namespace vantage {
namespace {

constexpr double kEta = 0.1;

template <int Dim>
Box<Dim> domain() {
  return {Vec<Dim>::Constant(-20.0), Vec<Dim>::Constant(20.0)};
}

template <int Dim>
FitRules<Dim> rules(double eta = kEta) {
  const Snap<Dim> snap(domain<Dim>());
  return {snap, eta * (1.0 - 1e-6) - snap.slack(), Dim + 2, false};
}

template <int Dim>
Vec<Dim> anywhere(Random& random, double half) {
  Vec<Dim> p;
  for (int a = 0; a < Dim; ++a) p[a] = random.uniform(-half, half);
  return p;
}

template <int Dim>
std::vector<Site<Dim>> sites_of(const std::vector<Vec<Dim>>& points) {
  const Snap<Dim> snap(domain<Dim>());
  std::vector<Site<Dim>> sites;
  for (const auto& p : points)
    if (const auto site = snap.site(p)) sites.push_back(*site);
  sort_sites<Dim>(sites);
  return sites;
}

/// What a spinning scanner at `at` hits of a floor with a wall, a block and a pole: thinner with range.
template <int Dim>
std::vector<Site<Dim>> scan_of(const Vec<Dim>& at, int rays, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec<Dim>> points;
  for (int i = 0; i < rays; ++i) {
    Vec<Dim> u = anywhere<Dim>(random, 1.0);
    if (u.norm() > 1.0 || u.norm() < 0.01) continue;
    u.normalize();
    double range = 18.0;
    const auto hit = [&](int axis, double value) {
      if (const double t = (value - at[axis]) / u[axis]; t > 0.0) range = std::min(range, t);
    };
    hit(Dim - 1, -2.0);
    hit(0, 15.0);
    hit(1, Dim == 2 ? -3.0 : 12.0);
    if (range < 18.0) points.push_back(at + range * u + anywhere<Dim>(random, 0.004));
  }
  return sites_of<Dim>(points);
}

template <int Dim>
void each_leaf(const Node<Dim>& node, const std::function<void(const LeafNode<Dim>&)>& visit) {
  if (node.leaf) visit(*node.leaf);
  if (node.inner)
    for (const auto& child : node.inner->children) each_leaf<Dim>(child, visit);
}

template <class T>
class TreeOf : public ::testing::Test {};
using Dims = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(TreeOf, Dims);

TYPED_TEST(TreeOf, BoundsOfALeafAreWithinTenPerCentOfTheTruth) {
  constexpr int Dim = TypeParam::value;
  Tree<Dim> tree(rules<Dim>(), kEta, 14);
  tree.insert(scan_of<Dim>(Vec<Dim>::Zero(), 6000, 1));
  tree.sharpen();
  const Snap<Dim>& snap = tree.rules().snap;
  Random random(2);
  int checked = 0;
  each_leaf<Dim>(tree.root(), [&](const LeafNode<Dim>& leaf) {
    if (leaf.fit.patches.empty()) return;
    std::vector<Vec<Dim>> data;
    for (const auto& site : leaf.sites) data.push_back(snap.world(snap.local(site)));
    double to_surface = 0.0, bound = 0.0;
    for (const auto& p : data) {
      double least = kInfinity;
      for (const auto& patch : leaf.fit.patches) least = std::min(least, distance(patch, p));
      for (const std::uint32_t i : leaf.fit.loose) least = std::min(least, (p - data[i]).norm());
      to_surface = std::max(to_surface, least);
    }
    for (std::size_t k = 0; k < leaf.fit.patches.size(); ++k) {
      auto patch = leaf.fit.patches[k];
      EXPECT_LE(leaf.sharp[k].surface_to_data, patch.surface_to_data);
      EXPECT_LE(leaf.sharp[k].data_to_surface, patch.data_to_surface);
      patch.data_to_surface = leaf.sharp[k].data_to_surface;
      patch.surface_to_data = leaf.sharp[k].surface_to_data;
      bound = std::max(bound, static_cast<double>(patch.data_to_surface));
      double to_data = 0.0, apart = 0.0;
      const int samples = patch.count > 2 ? 400 : 60;
      for (int s = 0; s < samples; ++s) {
        Vec<Dim> p = Vec<Dim>::Zero();
        double sum = 0.0;
        for (const auto& corner : patch.corners()) {
          const double weight = s < patch.count ? (&corner == &patch.corners()[s] ? 1.0 : 0.0) : random.uniform();
          p += weight * corner;
          sum += weight;
        }
        double least = kInfinity;
        for (const auto& q : data) least = std::min(least, (q - p / sum).norm());
        to_data = std::max(to_data, least);
        apart = std::max(apart, (p / sum - patch.vertices[0]).norm());
      }
      EXPECT_GE(patch.surface_to_data, to_data);
      EXPECT_LE(patch.surface_to_data, 1.1 * (to_data + 2.0 * apart / std::sqrt(samples)) + 1e-6);
    }
    EXPECT_GE(bound, to_surface);
    EXPECT_LE(bound, leaf.fit.patches.size() == 1 && leaf.fit.loose.empty() ? 1.1 * to_surface + 1e-6 : kEta);
    ++checked;
  });
  EXPECT_GT(checked, 10);
}

/// Panels of random places and tilts, `each` points on every one.
template <int Dim>
std::vector<std::vector<Vec<Dim>>> panels(int count, int each) {
  Random random(30);
  std::vector<std::vector<Vec<Dim>>> out(count);
  for (auto& panel : out) {
    const Vec<Dim> center = anywhere<Dim>(random, 18.0), normal = anywhere<Dim>(random, 1.0).normalized();
    for (int i = 0; i < each; ++i) {
      const Vec<Dim> p = anywhere<Dim>(random, 1.2);
      panel.push_back(center + p - normal * normal.dot(p));
    }
  }
  return out;
}

TYPED_TEST(TreeOf, CostOfAScanFollowsTheScan) {
  constexpr int Dim = TypeParam::value;
  std::int64_t read_before = 0;
  for (const int count : {40, 80, 160}) {  // The map grows, the scan does not.
    const auto all = panels<Dim>(count, 1000);
    std::vector<Vec<Dim>> map, scan;
    for (const auto& panel : all) map.insert(map.end(), panel.begin(), panel.end() - 100);
    scan.insert(scan.end(), all[0].end() - 100, all[0].end());
    Tree<Dim> tree(rules<Dim>(), kEta, 14);
    tree.insert(sites_of<Dim>(map));
    const std::int64_t points = tree.totals().points;
    const auto change = tree.insert(sites_of<Dim>(scan));
    EXPECT_GT(change.nodes_touched, 1);
    EXPECT_LT(change.points_read, 12 * 1000);  // A few times the panel that the scan touches.
    EXPECT_LT(change.points_read, points / 3);
    EXPECT_LT(change.points_read, count > 40 ? 2 * read_before + 2000 : points);
    read_before = change.points_read;
    // Nothing new: nothing read.
    EXPECT_EQ(tree.insert({}).points_read, 0);
  }
}

TYPED_TEST(TreeOf, APatchWithRoomToSpareTakesMorePointsUnread) {
  constexpr int Dim = TypeParam::value;
  Random random(31);
  const auto wall = [&](int count, double off) {
    std::vector<Vec<Dim>> points;
    for (int i = 0; i < count; ++i) {
      Vec<Dim> p = anywhere<Dim>(random, 19.0);
      p[0] = 1.0 + 0.1 * p[1] + off * random.uniform(-1.0, 1.0);
      points.push_back(p);
    }
    return sites_of<Dim>(points);
  };
  Tree<Dim> tree(rules<Dim>(2.0), 2.0, 14);
  tree.insert(wall(20000, 0.1));
  ASSERT_EQ(tree.totals().nodes, 1);
  EXPECT_LE(tree.insert(wall(100, 0.2)).points_read, 100);
  EXPECT_EQ(tree.totals().nodes, 1);
  EXPECT_GT(tree.insert(wall(100, 6.0)).points_read, 20000);  // These are beside it.
  EXPECT_GT(tree.totals().nodes, 1);
}

TYPED_TEST(TreeOf, TakingOutAndPuttingBackIsNoChange) {
  constexpr int Dim = TypeParam::value;
  const auto sites = scan_of<Dim>(Vec<Dim>::Zero(), 5000, 4), extra = scan_of<Dim>(Vec<Dim>::Ones(), 2000, 5);
  Tree<Dim> tree(rules<Dim>(), kEta, 14);
  tree.insert(sites);
  const auto count = [&] {
    std::int64_t leaves = 0;
    each_leaf<Dim>(tree.root(), [&](const auto&) { ++leaves; });
    return leaves;
  };
  const Totals totals = tree.totals();
  const std::int64_t leaves = count();
  tree.insert(extra);
  tree.remove(extra);
  tree.remove(extra);  // No longer there.
  EXPECT_EQ(tree.totals().points, totals.points);
  EXPECT_EQ(tree.totals().nodes, totals.nodes);
  EXPECT_EQ(tree.totals().fits, totals.fits);
  EXPECT_EQ(tree.totals().loose, totals.loose);
  EXPECT_EQ(count(), leaves);
}

TYPED_TEST(TreeOf, FinerScansPrune) {
  constexpr int Dim = TypeParam::value;
  Random random(6);
  const auto wall = [&](int count) {
    std::vector<Vec<Dim>> points;
    for (int i = 0; i < count; ++i) {
      Vec<Dim> p = anywhere<Dim>(random, 3.0);
      p[0] = 1.0;
      points.push_back(p);
    }
    return sites_of<Dim>(points);
  };
  const double eta = Dim == 2 ? 0.05 : 0.2;
  Tree<Dim> tree(rules<Dim>(eta), eta, 14);
  tree.insert(wall(Dim == 2 ? 200 : 300));  // Too thin to be a wall.
  const Totals coarse = tree.totals();
  EXPECT_GT(coarse.nodes, 1);
  tree.insert(wall(Dim == 2 ? 4000 : 20000));
  EXPECT_LT(tree.totals().nodes, coarse.nodes);
  EXPECT_LE(tree.totals().fits, 4);
  EXPECT_EQ(tree.totals().loose, 0);
}

TYPED_TEST(TreeOf, ProofsHoldAgainstTheNodeRule) {
  constexpr int Dim = TypeParam::value;
  Random random(7);
  int proofs = 0;
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<Vec<Dim>> points;
    const int kind = trial % 3;
    for (int i = 0; i < 800; ++i) {
      Vec<Dim> p = anywhere<Dim>(random, 19.0);
      if (kind == 1) p[0] = random.below(2) == 0 ? -5.0 : 5.0;
      if (kind == 2) p[0] = 0.1 * p[1];
      points.push_back(p);
    }
    const auto sites = sites_of<Dim>(points);
    auto given = rules<Dim>(kind == 0 ? 1.0 : kind == 1 ? 2.0 : 0.4);
    const Cell<Dim> cell;
    given.paper = trial % 2 == 0;
    const auto proof =
        Proof<Dim>::find(SiteView<Dim>(sites), cell, {given.limit / given.snap.step(), given.limit / given.snap.step(), given.paper ? 2 : 1});
    if (!proof) continue;
    ++proofs;
    GatheredSites<Dim> all{SiteView<Dim>(sites)};
    const Moments<Dim> sums = moments<Dim>(sites, cell.low, cell.bits);
    EXPECT_FALSE(fit_cell<Dim>(all, &sums, cell, given));
    EXPECT_TRUE(proof->survives_adding({}, cell));
    EXPECT_TRUE(proof->survives_removing({}));
    EXPECT_FALSE(proof->survives_removing(sites));
  }
  EXPECT_GT(proofs, 10);
}

TYPED_TEST(TreeOf, ViewsOfATreeAndOfASpanAgree) {
  constexpr int Dim = TypeParam::value;
  const auto sites = scan_of<Dim>(Vec<Dim>::Zero(), 6000, 8);
  Tree<Dim> tree(rules<Dim>(), kEta, 14);
  tree.insert(sites);
  const SiteView<Dim> spread(tree.root()), flat(sites);
  ASSERT_FALSE(spread.in_one_span());
  EXPECT_EQ(spread.collect(), sites);
  for (std::size_t i = 0; i < sites.size(); i += 97) EXPECT_EQ(spread[i], sites[i]);
  EXPECT_EQ(spread_sample<Dim>(spread, {}), spread_sample<Dim>(flat, {}));
  Random random(9);
  int empty = 0;
  for (int i = 0; i < 300; ++i) {
    Vec<Dim> center;
    for (int a = 0; a < Dim; ++a) center[a] = random.uniform(0.0, 0x1p32);
    const double radius = random.uniform(0.0, 0x1p30);
    const bool expected = std::none_of(sites.begin(), sites.end(), [&](const auto& s) { return (lattice_place<Dim>(s) - center).norm() <= radius; });
    EXPECT_EQ(is_empty_ball<Dim>(flat, {}, center, radius), expected);
    EXPECT_EQ(is_empty_ball<Dim>(spread, {}, center, radius), expected);
    empty += expected ? 1 : 0;
  }
  EXPECT_GT(empty, 20);
  EXPECT_LT(empty, 280);
}

TYPED_TEST(TreeOf, RadixSortIsTheMortonOrder) {
  constexpr int Dim = TypeParam::value;
  Random random(10);
  for (const std::uint64_t span : {std::uint64_t{4}, std::uint64_t{1} << 14, std::uint64_t{1} << 32}) {
    std::vector<Site<Dim>> sites(3000);
    for (auto& site : sites) {
      for (auto& x : site) x = static_cast<std::uint32_t>(random.below(span));
      site[Dim] = (static_cast<std::uint32_t>(random.below(2)) << kCountBits) + 1;
    }
    std::map<Site<Dim>, int, decltype(&morton_less<Dim>)> counts(&morton_less<Dim>);  // Those of one place and scan are one.
    for (const auto& site : sites) ++counts[site];
    std::vector<Site<Dim>> expected;
    for (const auto& [key, count] : counts) {
      Site<Dim> site = key;
      site[Dim] += static_cast<std::uint32_t>(count) - 1;
      expected.push_back(site);
    }
    sort_sites<Dim>(sites);
    EXPECT_EQ(sites, expected);
    // Every cell is an interval: splitting finds the same sites as looking at each.
    const Cell<Dim> cell;
    const auto parts = cell.split(sites);
    for (int c = 0; c < Cell<Dim>::kChildren; ++c)
      for (const auto& site : parts[c])
        for (int a = 0; a < Dim; ++a) EXPECT_EQ(site[a] >> 31, static_cast<unsigned>((c >> a) & 1));
  }
}

TYPED_TEST(TreeOf, WidthOfASimplexAgreesWithAllDirections) {
  constexpr int Dim = TypeParam::value;
  Random random(11);
  for (int trial = 0; trial < 20; ++trial) {
    std::array<Vec<Dim>, Dim + 1> simplex;
    for (auto& corner : simplex) corner = anywhere<Dim>(random, 1.0);
    double least = kInfinity;
    for (int i = 0; i < 40000; ++i) {
      const Vec<Dim> n = anywhere<Dim>(random, 1.0).normalized();
      double low = kInfinity, high = -kInfinity;
      for (const auto& corner : simplex) {
        low = std::min(low, n.dot(corner));
        high = std::max(high, n.dot(corner));
      }
      least = std::min(least, high - low);
    }
    EXPECT_LE(width<Dim>(simplex), least + 1e-12);
    EXPECT_GE(width<Dim>(simplex), least - 0.1);
  }
}

}  // namespace
}  // namespace vantage

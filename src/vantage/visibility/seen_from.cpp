// SPDX-License-Identifier: Apache-2.0
#include "vantage/visibility/seen_from.h"

#include <algorithm>

#include "vantage/base/parallel.h"
#include "vantage/visibility/depth_pyramid.h"

namespace vantage {
namespace {

constexpr int kLevels = 3;  ///< A task starts with 2^kLevels blocks a side.
constexpr int kLanes = 8;   ///< Nodes looked up at once: a row of a block.
static_assert(kLanes == SeenSet<3>::kSide);

/// Length of an offset, as Eigen's norm() adds it up. Rounding is monotone: no component smaller, no length smaller.
template <int Dim>
double length(const Vec<Dim>& d) {
  double sum = d[Dim - 1] * d[Dim - 1];
  for (int a = Dim - 2; a >= 0; --a) sum = d[a] * d[a] + sum;
  return std::sqrt(sum);
}

template <int Dim>
class Classifier {
 public:
  using Set = SeenSet<Dim>;
  struct Mixed {
    std::size_t block;
    typename Set::Bits bits;
  };
  enum class Verdict : std::uint8_t { hidden, seen, mixed };

  Classifier(const DepthPyramid<Dim>& pyramid, const Viewpoint<Dim>& viewpoint, Set& set)
      : pyramid_(pyramid), view_(viewpoint), set_(set), window_(set.window()), h_(window_.spacing) {}

  /// Classifies the blocks `first` .. `first + 2^level - 1` (counted from the set's first): uniform ones into the set, the others onto `mixed`.
  void classify(const Index<Dim>& first, int level, std::vector<Mixed>& mixed) const {
    if ((first.array() >= set_.blocks().extent.array()).any()) return;
    const Verdict verdict = judge(nodes(first, level));
    if (verdict == Verdict::hidden) return;  // As blocks are from the start.
    if (verdict == Verdict::mixed && level > 0) {
      for (int child = 0; child < (1 << Dim); ++child) {
        Index<Dim> at = first;
        for (int a = 0; a < Dim; ++a) at[a] += (child >> a & 1) << (level - 1);
        classify(at, level - 1, mixed);
      }
      return;
    }
    Grid<Dim> blocks{1.0, first, Index<Dim>::Constant(1 << level)};
    blocks.extent = blocks.extent.cwiseMin(set_.blocks().extent - first);
    for (std::size_t b = 0; b < blocks.size(); ++b) settle(first + blocks.local(b), verdict, mixed);
  }

 private:
  /// The nodes of 2^level blocks a side that lie in the window.
  [[nodiscard]] Grid<Dim> nodes(const Index<Dim>& block, int level) const {
    const Grid<Dim> all{h_, (set_.blocks().first + block) * Set::kSide, Index<Dim>::Constant(Set::kSide << level)};
    return intersection(all, window_);
  }

  [[nodiscard]] double offset(int axis, std::int32_t node) const { return static_cast<double>(node) * h_ - view_.origin[axis]; }

  [[nodiscard]] Verdict judge(const Grid<Dim>& part) const {
    Box<Dim> box;
    Vec<Dim> near, far;
    for (int a = 0; a < Dim; ++a) {
      box.low[a] = offset(a, part.first[a]);
      box.high[a] = offset(a, part.first[a] + part.extent[a] - 1);
      near[a] = std::max({box.low[a], -box.high[a], 0.0});
      far[a] = std::max(-box.low[a], box.high[a]);
    }
    const double nearest = length<Dim>(near), farthest = length<Dim>(far);
    if (nearest > view_.max_range) return Verdict::hidden;
    const auto depth = pyramid_.over(box);
    if (farthest <= static_cast<double>(depth.low) && farthest <= view_.max_range) return Verdict::seen;
    return nearest > static_cast<double>(depth.high) ? Verdict::hidden : Verdict::mixed;
  }

  /// One block whose nodes in the window are all seen, or must be asked.
  void settle(const Index<Dim>& block, Verdict verdict, std::vector<Mixed>& mixed) const {
    const Grid<Dim> part = nodes(block, 0);
    Mixed out{set_.blocks().linear(block), {}};
    if (verdict == Verdict::seen && part.size() == Set::kNodes) return set_.set_uniform(out.block, true);
    const Index<Dim> first = (set_.blocks().first + block) * Set::kSide;
    const auto inside = static_cast<std::uint8_t>(((1 << part.extent[0]) - 1) << (part.first[0] - first[0]));
    Grid<Dim> rows{h_, part.first, part.extent};
    rows.first[0] = first[0];
    rows.extent[0] = 1;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Index<Dim> node = rows.first + rows.local(i), within = node - first;
      out.bits[Set::row_of(within)] = verdict == Verdict::seen ? inside : static_cast<std::uint8_t>(inside & row(node));
    }
    mixed.push_back(out);
  }

  /// sees() for the eight nodes from `first` along axis 0, lowest bit first.
  [[nodiscard]] unsigned row(const Index<Dim>& first) const {
    const DepthImage<Dim>& image = pyramid_.image();
    const auto resolution = static_cast<double>(image.resolution());
    const std::int32_t columns = image.resolution();
    std::array<std::int32_t, kLanes> pixel;
    std::array<double, kLanes> range;
    std::array<double, Dim> d;
    for (int a = 1; a < Dim; ++a) d[a] = offset(a, first[a]);
    for (int k = 0; k < kLanes; ++k) {
      d[0] = static_cast<double>(first[0] + k) * h_ - view_.origin[0];
      double major = d[0], square = d[Dim - 1] * d[Dim - 1];
      std::array<double, Dim> across = d;
      std::int32_t face = 0;
      for (int a = Dim - 2; a >= 0; --a) square = d[a] * d[a] + square;
      for (int a = 1; a < Dim; ++a) {
        const bool more = std::abs(d[a]) > std::abs(major);
        major = more ? d[a] : major;
        face = more ? 2 * a : face;
        for (int j = 1; j < Dim; ++j) across[j] = more ? d[(a + j) % Dim] : across[j];
      }
      face += major < 0.0 ? 1 : 0;
      const double size = std::max(std::abs(major), 1e-300);
      std::int32_t index = face;
      for (int j = 1; j < Dim; ++j)
        index = index * columns + static_cast<std::int32_t>(std::min((across[j] / size + 1.0) * 0.5 * resolution, resolution - 1.0));
      pixel[k] = index;
      range[k] = std::sqrt(square);
    }
    unsigned seen = 0;
    for (int k = 0; k < kLanes; ++k) {
      const double depth = static_cast<double>(image[static_cast<std::size_t>(pixel[k])]);
      seen |= static_cast<unsigned>(range[k] <= view_.max_range && (range[k] <= depth || range[k] == 0.0)) << k;
    }
    return seen;
  }

  const DepthPyramid<Dim>& pyramid_;
  const Viewpoint<Dim>& view_;
  Set& set_;
  const Grid<Dim>& window_;
  double h_;
};

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
SeenSet<Dim> seen_from(const DepthImage<Dim>& image, const Viewpoint<Dim>& viewpoint, const Grid<Dim>& window) {
  const DepthPyramid<Dim> pyramid(image);
  SeenSet<Dim> set(window);
  const Classifier<Dim> classifier(pyramid, viewpoint, set);
  Grid<Dim> tasks = set.blocks();
  for (int a = 0; a < Dim; ++a) tasks.extent[a] = (tasks.extent[a] + (1 << kLevels) - 1) >> kLevels;
  std::vector<std::vector<typename Classifier<Dim>::Mixed>> mixed(tasks.size());
  parallel_for(tasks.size(), 1, [&](std::size_t t) { classifier.classify(Index<Dim>(tasks.local(t) * (1 << kLevels)), kLevels, mixed[t]); });
  for (const auto& part : mixed)
    for (const auto& [block, bits] : part) set.set(block, bits);
  return set;
}

template SeenSet<2> seen_from<2>(const DepthImage<2>&, const Viewpoint<2>&, const Grid<2>&);
template SeenSet<3> seen_from<3>(const DepthImage<3>&, const Viewpoint<3>&, const Grid<3>&);

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#include "vantage/visibility/seen_from.h"

#include <algorithm>

#include "vantage/base/parallel.h"
#include "vantage/visibility/depth_pyramid.h"
#include "vantage/visibility/look_up.h"

namespace vantage {
namespace {

constexpr int kLevels = 3;  ///< A task starts with 2^kLevels blocks a side.

/// Square of an offset's length, added up as sees() does. Rounding is monotone: no component smaller, no length smaller.
template <int Dim>
double square(const Vec<Dim>& d) {
  double sum = d[Dim - 1] * d[Dim - 1];
  for (int a = Dim - 2; a >= 0; --a) sum = d[a] * d[a] + sum;
  return sum;
}

/// The multiple of `side` at or below a node.
std::int32_t start_of(std::int32_t node, std::int32_t side) { return node - (node % side + side) % side; }

enum class Verdict : std::uint8_t { hidden, seen, mixed };

/// What the pyramid says of all nodes of `part` at once.
template <int Dim>
Verdict judge(const DepthPyramid<Dim>& pyramid, const Viewpoint<Dim>& viewpoint, const Grid<Dim>& part) {
  const auto offset = [&](int a, std::int32_t node) { return static_cast<double>(node) * part.spacing - viewpoint.origin[a]; };
  Box<Dim> box;
  Vec<Dim> near, far;
  for (int a = 0; a < Dim; ++a) {
    box.low[a] = offset(a, part.first[a]);
    box.high[a] = offset(a, part.first[a] + part.extent[a] - 1);
    near[a] = std::max({box.low[a], -box.high[a], 0.0});
    far[a] = std::max(-box.low[a], box.high[a]);
  }
  const double nearest = square<Dim>(near), farthest = square<Dim>(far), reach = viewpoint.max_range * viewpoint.max_range;
  if (nearest > reach) return Verdict::hidden;
  const auto depth = pyramid.over(box);
  const double low = static_cast<double>(depth.low), high = static_cast<double>(depth.high);
  if (farthest <= low * low && farthest <= reach) return Verdict::seen;
  return nearest > high * high ? Verdict::hidden : Verdict::mixed;
}

template <int Dim>
class Classifier {
 public:
  using Set = SeenSet<Dim>;
  struct Mixed {
    std::size_t block;
    typename Set::Bits bits;
  };

  Classifier(const DepthPyramid<Dim>& pyramid, const Viewpoint<Dim>& viewpoint, Set& set)
      : pyramid_(pyramid), viewpoint_(viewpoint), set_(set), window_(set.window()) {
    const DepthImage<Dim>& image = pyramid.image();
    look_ = {image.ranges().data(), image.resolution(), window_.spacing, viewpoint.max_range * viewpoint.max_range, viewpoint.origin};
  }

  /// Classifies the blocks `first` .. `first + 2^level - 1` (counted from the set's first): uniform ones into the set, the others onto `mixed`.
  void classify(const Index<Dim>& first, int level, std::vector<Mixed>& mixed) const {
    if ((first.array() >= set_.blocks().extent.array()).any()) return;
    const Verdict verdict = judge(pyramid_, viewpoint_, nodes(first, level));
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
    const Grid<Dim> all{window_.spacing, (set_.blocks().first + block) * Set::kSide, Index<Dim>::Constant(Set::kSide << level)};
    return intersection(all, window_);
  }

  /// One block whose nodes in the window are all seen, or must be asked.
  void settle(const Index<Dim>& block, Verdict verdict, std::vector<Mixed>& mixed) const {
    const Grid<Dim> part = nodes(block, 0);
    const std::size_t index = set_.blocks().linear(block);
    const Index<Dim> first = (set_.blocks().first + block) * Set::kSide;
    typename Set::Bits bits;
    if (verdict == Verdict::seen)
      bits.fill(0xff);
    else
      bits = look_up<Dim>(look_, first);
    if (part.size() < Set::kNodes) clip(bits, part, first);
    if (verdict == Verdict::seen && part.size() == Set::kNodes)
      set_.set_uniform(index, true);
    else
      mixed.push_back({index, bits});
  }

  /// Clears the nodes outside of `part`.
  static void clip(typename Set::Bits& bits, const Grid<Dim>& part, const Index<Dim>& first) {
    const auto inside = static_cast<std::uint8_t>(((1 << part.extent[0]) - 1) << (part.first[0] - first[0]));
    typename Set::Bits mask{};
    Grid<Dim> rows = part;
    rows.extent[0] = 1;
    for (std::size_t i = 0; i < rows.size(); ++i) mask[Set::row_of(part.first + rows.local(i) - first)] = inside;
    for (std::size_t r = 0; r < bits.size(); ++r) bits[r] &= mask[r];
  }

  const DepthPyramid<Dim>& pyramid_;
  const Viewpoint<Dim>& viewpoint_;
  Set& set_;
  const Grid<Dim>& window_;
  LookUp<Dim> look_;
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

template <int Dim>
  requires SpatialDim<Dim>
GradualView<Dim>::GradualView(const DepthPyramid<Dim>& pyramid, const Viewpoint<Dim>& viewpoint, const Grid<Dim>& window)
    : pyramid_(pyramid), viewpoint_(viewpoint), window_(window) {
  // Cubes stand at multiples of their side, so that a cut one tells where it began.
  const Index<Dim> last = window.first + window.extent - Index<Dim>::Ones();
  Grid<Dim> places{window.spacing, {}, {}};
  for (int a = 0; a < Dim; ++a) {
    places.first[a] = start_of(window.first[a], side()) / side();
    places.extent[a] = std::max(0, start_of(last[a], side()) / side() - places.first[a] + 1);
  }
  std::vector<Grid<Dim>> cubes;
  for (std::size_t i = 0; i < places.size(); ++i)
    cubes.push_back({window.spacing, (places.first + places.local(i)) * side(), Index<Dim>::Constant(side())});
  judge(std::move(cubes));
}

template <int Dim>
  requires SpatialDim<Dim>
void GradualView<Dim>::judge(std::vector<Grid<Dim>> cubes) {
  std::vector<Verdict> verdicts(cubes.size());
  parallel_for(cubes.size(), 64, [&](std::size_t i) {
    cubes[i] = intersection(cubes[i], window_);
    verdicts[i] = cubes[i].size() == 0 ? Verdict::hidden : vantage::judge(pyramid_, viewpoint_, cubes[i]);
  });
  undecided_.clear();
  open_ = 0;
  for (std::size_t i = 0; i < cubes.size(); ++i) {
    if (verdicts[i] == Verdict::hidden) continue;
    const bool all = verdicts[i] == Verdict::seen;
    (all ? seen_ : undecided_).push_back(cubes[i]);
    (all ? least_ : open_) += cubes[i].size();
  }
}

template <int Dim>
  requires SpatialDim<Dim>
bool GradualView<Dim>::refine() {
  if (level_ == 0) return false;
  const std::int32_t whole = side(), half = whole / 2;
  --level_;
  std::vector<Grid<Dim>> cubes;
  for (const Grid<Dim>& cube : undecided_)
    for (int child = 0; child < (1 << Dim); ++child) {
      Grid<Dim> part{cube.spacing, {}, Index<Dim>::Constant(half)};
      for (int a = 0; a < Dim; ++a) part.first[a] = start_of(cube.first[a], whole) + ((child >> a & 1) != 0 ? half : 0);
      cubes.push_back(part);
    }
  judge(std::move(cubes));
  return true;
}

template class GradualView<2>;
template class GradualView<3>;
template SeenSet<2> seen_from<2>(const DepthImage<2>&, const Viewpoint<2>&, const Grid<2>&);
template SeenSet<3> seen_from<3>(const DepthImage<3>&, const Viewpoint<3>&, const Grid<3>&);

}  // namespace vantage

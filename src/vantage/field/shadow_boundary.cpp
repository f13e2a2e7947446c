// SPDX-License-Identifier: Apache-2.0
#include "vantage/field/shadow_boundary.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "vantage/base/parallel.h"

namespace vantage {
namespace {

constexpr int kPlaceBits = 12;                     // Of an element: direction and node.
constexpr double kUnit = 179.0;                    // Components that are not the longest are at most 1 / sqrt(2).
constexpr std::int32_t kBaseline = 3, kAside = 2;  // Slopes are taken over 2 kBaseline steps, at a node and kAside steps off it along every axis.

constexpr int power(int base, int exponent) { return exponent == 0 ? 1 : base * power(base, exponent - 1); }

/// Slope of psi around nodes: the mean of wide differences. On a binary set's distances as good as smoothing four times (see the tests), and cheaper
/// where only the boundary is asked for.
template <int Dim>
class Slope {
 public:
  explicit Slope(const Field<Dim>& psi) : psi_(psi) {
    for (int a = 0; a < Dim; ++a) stride_[static_cast<std::size_t>(a)] = static_cast<std::ptrdiff_t>(psi.window.stride(a));
    places_[0] = Index<Dim>::Zero();
    for (int a = 0; a < Dim; ++a) {
      places_[static_cast<std::size_t>(2 * a + 1)] = -kAside * Index<Dim>::Unit(a);
      places_[static_cast<std::size_t>(2 * a + 2)] = kAside * Index<Dim>::Unit(a);
    }
  }

  /// At a node counted from the window's first [1, up to a factor].
  [[nodiscard]] Vec<Dim> operator()(const Index<Dim>& node) const {
    constexpr std::int32_t kReach = kBaseline + kAside;
    const bool inner = (node.array() >= kReach).all() && (node.array() + kReach < psi_.window.extent.array()).all();
    return inner ? inside(node) : at_border(node);
  }

 private:
  [[nodiscard]] Vec<Dim> inside(const Index<Dim>& node) const {
    const float* here = psi_.values.data() + psi_.window.linear(node);
    Vec<Dim> slope = Vec<Dim>::Zero();
    for (const Index<Dim>& place : places_) {
      const float* at = here;
      for (int a = 0; a < Dim; ++a) at += place[a] * stride_[static_cast<std::size_t>(a)];
      for (int a = 0; a < Dim; ++a) {
        const std::ptrdiff_t way = kBaseline * stride_[static_cast<std::size_t>(a)];
        slope[a] += static_cast<double>(at[way] - at[-way]);
      }
    }
    return slope / (2.0 * kBaseline);
  }

  /// Places outside of the window are its nearest inside.
  [[nodiscard]] Vec<Dim> at_border(const Index<Dim>& node) const {
    const Index<Dim> last = psi_.window.extent.array() - 1;
    Vec<Dim> slope = Vec<Dim>::Zero();
    for (const Index<Dim>& place : places_)
      for (int a = 0; a < Dim; ++a) {
        const Index<Dim> at = node + place;
        const Index<Dim> low = (at - kBaseline * Index<Dim>::Unit(a)).cwiseMax(0).cwiseMin(last),
                         high = (at + kBaseline * Index<Dim>::Unit(a)).cwiseMax(0).cwiseMin(last);
        if (low[a] < high[a]) slope[a] += static_cast<double>(psi_.at(high) - psi_.at(low)) / (high[a] - low[a]);
      }
    return slope;
  }

  const Field<Dim>& psi_;
  std::array<std::ptrdiff_t, Dim> stride_;
  std::array<Index<Dim>, 2 * Dim + 1> places_;
};

/// Which nodes of a block and around it are seen and which unseen: a row along axis 0 each, its bit 0 the node before the block.
template <int Dim>
struct Rows {
  static constexpr int kRows = ShadowBoundary<Dim>::kSide + 2;
  std::array<std::uint16_t, power(kRows, Dim - 1)> seen{}, unseen{};
  std::array<std::size_t, Dim> stride;  ///< From row to row; of axis 0 unused.

  Rows(const Field<Dim, NodeState>& state, const Index<Dim>& first) {
    const Grid<Dim>& window = state.window;
    Grid<Dim> rows;
    rows.extent.setConstant(kRows);
    rows.extent[0] = 1;
    for (int a = 0; a < Dim; ++a) stride[static_cast<std::size_t>(a)] = rows.stride(a);
    const std::int32_t begin = std::max(first[0] - 1, 0), end = std::min(first[0] - 1 + kRows, window.extent[0]);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      Index<Dim> node = first + rows.local(r) - Index<Dim>::Ones();
      node[0] = begin;
      if (!window.inside(node)) continue;
      const NodeState* at = state.values.data() + window.linear(node);
      unsigned s = 0, u = 0;
      for (std::int32_t x = begin; x < end; ++x, ++at) {
        s |= static_cast<unsigned>(*at == NodeState::seen) << (x - first[0] + 1);
        u |= static_cast<unsigned>(*at == NodeState::unseen) << (x - first[0] + 1);
      }
      seen[r] = static_cast<std::uint16_t>(s);
      unseen[r] = static_cast<std::uint16_t>(u);
    }
  }
  /// Both seen and unseen nodes are there.
  [[nodiscard]] bool mixed() const {
    const auto any = [](const auto& rows) { return std::any_of(rows.begin(), rows.end(), [](std::uint16_t row) { return row != 0; }); };
    return any(seen) && any(unseen);
  }
  /// Seen nodes of row `r` whose neighbour in `direction` is unseen.
  [[nodiscard]] unsigned faces(std::size_t r, int direction) const {
    const std::size_t step = stride[static_cast<std::size_t>(direction / 2)];
    if (direction == 0) return seen[r] & unseen[r] >> 1;
    if (direction == 1) return seen[r] & static_cast<unsigned>(unseen[r]) << 1;
    return seen[r] & unseen[direction % 2 == 0 ? r + step : r - step];
  }
};

/// A unit vector in 19 bits.
template <int Dim>
std::uint32_t pack(const Vec<Dim>& normal) {
  int longest = 0;
  normal.cwiseAbs().maxCoeff(&longest);
  std::uint32_t bits = static_cast<std::uint32_t>(longest) | (normal[longest] < 0.0 ? 4U : 0U);
  for (int a = 0, shift = 3; a < Dim; ++a)
    if (a != longest) {
      bits |= static_cast<std::uint32_t>(static_cast<std::uint8_t>(static_cast<std::int8_t>(std::lround(kUnit * normal[a])))) << shift;
      shift += 8;
    }
  return bits;
}

template <int Dim>
Vec<Dim> unpack(std::uint32_t bits) {
  const int longest = static_cast<int>(bits & 3U);
  Vec<Dim> normal;
  double rest = 1.0;
  for (int a = 0, shift = 3; a < Dim; ++a)
    if (a != longest) {
      normal[a] = static_cast<double>(static_cast<std::int8_t>(bits >> shift & 0xffU)) / kUnit;
      rest -= normal[a] * normal[a];
      shift += 8;
    }
  normal[longest] = ((bits & 4U) != 0 ? -1.0 : 1.0) * std::sqrt(std::max(rest, 0.0));
  return normal;
}

template <int Dim>
Index<Dim> neighbour(Index<Dim> node, int direction) {
  node[direction / 2] += direction % 2 == 0 ? 1 : -1;
  return node;
}

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
ShadowBoundary<Dim>::ShadowBoundary(const Grid<Dim>& window) : window_(window), blocks_(window), lists_(1) {
  blocks_.first.setZero();
  blocks_.extent = (window.extent.array() + (kSide - 1)) / kSide;
  slot_.assign(blocks_.size(), 0);
  touched_.assign(blocks_.size(), 0);
}

template <int Dim>
  requires SpatialDim<Dim>
void ShadowBoundary<Dim>::touch(const Index<Dim>& local) {
  std::uint8_t& flag = touched_[blocks_.linear(local / kSide)];
  std::atomic_ref(flag).store(1, std::memory_order_relaxed);
}

template <int Dim>
  requires SpatialDim<Dim>
ShadowFace<Dim> ShadowBoundary<Dim>::unpack(std::size_t block, Element element) const {
  ShadowFace<Dim> face;
  const std::uint32_t place = element & ((1U << kPlaceBits) - 1U);
  face.key = (block << kPlaceBits) + place;
  face.direction = static_cast<int>(place & 7U);
  Index<Dim> here = blocks_.local(block) * kSide;
  for (int a = 0, rest = static_cast<int>(place >> 3); a < Dim; ++a, rest /= kSide) here[a] += rest % kSide;
  const auto stride = static_cast<std::ptrdiff_t>(window_.stride(face.direction / 2));
  face.seen = window_.linear(here);
  face.unseen = face.seen + static_cast<std::size_t>(face.direction % 2 == 0 ? stride : -stride);
  face.center = window_.position(here) - 0.5 * window_.spacing * face.step();
  face.normal = vantage::unpack<Dim>(element >> kPlaceBits);
  return face;
}

template <int Dim>
  requires SpatialDim<Dim>
auto ShadowBoundary<Dim>::list(const Field<Dim, NodeState>& state, const Field<Dim>& psi, const Index<Dim>& block) const -> List {
  const Index<Dim> first = block * kSide;
  const Rows<Dim> rows(state, first);
  if (!rows.mixed()) return {};
  const Slope<Dim> slope(psi);
  Grid<Dim> inner;
  inner.extent.setConstant(kSide);
  inner.extent[0] = 1;
  List list;
  for (std::size_t r = 0; r < inner.size(); ++r) {
    const Index<Dim> row = inner.local(r);
    std::size_t at = 0;
    for (int a = 1; a < Dim; ++a) at += static_cast<std::size_t>(row[a] + 1) * rows.stride[static_cast<std::size_t>(a)];
    std::array<unsigned, 2 * Dim> faces;
    unsigned any = 0;
    for (int direction = 0; direction < 2 * Dim; ++direction) {
      faces[static_cast<std::size_t>(direction)] = rows.faces(at, direction) >> 1 & 0xffU;
      any |= faces[static_cast<std::size_t>(direction)];
    }
    for (std::int32_t x = 0; x < kSide; ++x)
      if ((any >> x & 1U) != 0)
        for (int direction = 0; direction < 2 * Dim; ++direction)
          if ((faces[static_cast<std::size_t>(direction)] >> x & 1U) != 0) {
            Index<Dim> here = first + row;
            here[0] += x;
            const Vec<Dim> sum = slope(here) + slope(neighbour<Dim>(here, direction));
            const double length = sum.norm();
            const Vec<Dim> normal =
                length > 1e-9 ? Vec<Dim>(sum / length) : Vec<Dim>((here - neighbour<Dim>(here, direction)).template cast<double>());
            list.push_back(static_cast<Element>((r * kSide + static_cast<std::size_t>(x)) << 3 | static_cast<std::size_t>(direction)) |
                           pack<Dim>(normal) << kPlaceBits);
          }
  }
  list.shrink_to_fit();
  return list;
}

template <int Dim>
  requires SpatialDim<Dim>
void ShadowBoundary<Dim>::put(std::size_t block, List list) {
  std::uint32_t& slot = slot_[block];
  size_ += list.size() - lists_[slot].size();
  if (slot == 0 && list.empty()) return;
  if (list.empty()) {
    lists_[slot] = {};
    free_.push_back(slot);
    slot = 0;
    return;
  }
  if (slot == 0 && free_.empty()) {
    free_.push_back(static_cast<std::uint32_t>(lists_.size()));
    lists_.emplace_back();
  }
  if (slot == 0) {
    slot = free_.back();
    free_.pop_back();
  }
  lists_[slot] = std::move(list);
}

template <int Dim>
  requires SpatialDim<Dim>
void ShadowBoundary<Dim>::renew(const Field<Dim, NodeState>& state, const Field<Dim>& psi, const Grid<Dim>& part) {
  if (part.size() == 0) return;
  const Index<Dim> begin = part.first - window_.first, end = begin + part.extent;
  const Grid<Dim> whole{1.0, Index<Dim>::Zero(), blocks_.extent};
  const Grid<Dim> touched{1.0, begin / kSide, (end.array() - 1).matrix() / kSide - begin / kSide + Index<Dim>::Ones()};
  const Grid<Dim> around = intersection(padded(touched, 1), whole);
  std::vector<std::uint8_t> wanted(around.size());
  // What was touched changes the normals of faces up to six nodes off.
  for (std::size_t i = 0; i < touched.size(); ++i) {
    const Index<Dim> at = touched.first + touched.local(i);
    std::uint8_t& flag = touched_[blocks_.linear(at)];
    if (flag == 0) continue;
    flag = 0;
    const Grid<Dim> near = intersection(padded(Grid<Dim>{1.0, at, Index<Dim>::Ones()}, 1), whole);
    for (std::size_t k = 0; k < near.size(); ++k) wanted[around.linear(near.first + near.local(k) - around.first)] = 1;
  }
  std::vector<std::size_t> blocks;
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (wanted[i] != 0) blocks.push_back(blocks_.linear(around.first + around.local(i)));
  std::vector<List> lists(blocks.size());
  parallel_for(blocks.size(), 16, [&](std::size_t i) { lists[i] = list(state, psi, blocks_.local(blocks[i])); });
  for (std::size_t i = 0; i < blocks.size(); ++i) put(blocks[i], std::move(lists[i]));
}

template <int Dim>
  requires SpatialDim<Dim>
std::size_t ShadowBoundary<Dim>::bytes() const {
  std::size_t sum = touched_.capacity() + (slot_.capacity() + free_.capacity()) * sizeof(std::uint32_t) + lists_.capacity() * sizeof(List);
  for (const List& list : lists_) sum += list.capacity() * sizeof(Element);
  return sum;
}

template class ShadowBoundary<2>;
template class ShadowBoundary<3>;

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "vantage/base/error.h"
#include "vantage/io/octomap.h"

namespace vantage {
namespace {

constexpr int kDepth = 16;
constexpr std::int64_t kReach = std::int64_t{1} << (kDepth - 1);  // Cubes on either side of zero.

/// Two bits of a child, as octomap.cpp reads them.
enum Code : unsigned { kUnknown = 0, kFree = 1, kOccupied = 2, kInner = 3 };

using Key = Eigen::Matrix<std::int64_t, 3, 1>;

/// Writes the tree depth first: two bytes a node, then the subtrees of its children. Cubes are numbered so that node i of the lattice fills 2i - 1
/// and 2i along each axis.
template <int Dim>
class TreeWriter {
 public:
  explicit TreeWriter(const Field<Dim, NodeState>& states) : states_(states) {
    for (int a = 0; a < 3; ++a) {
      low_[a] = a < Dim ? 2 * static_cast<std::int64_t>(states.window.first[a]) - 1 : -1;
      high_[a] = low_[a] + (a < Dim ? 2 * static_cast<std::int64_t>(states.window.extent[a]) : 2);
    }
    require((low_.array() >= -kReach).all() && (high_.array() <= kReach).all(),
            fmt::format("OctoMap reaches {} cubes from the origin, the lattice from {} to {}", kReach, low_.minCoeff(), high_.maxCoeff()));
  }

  /// Bytes of the tree; none: all is unknown.
  [[nodiscard]] std::string write() {
    if (cube(Key::Constant(-kReach), 2 * kReach) == kInner) return std::move(out_);
    nodes_ = 0;
    return {};
  }
  [[nodiscard]] std::uint64_t nodes() const { return nodes_; }

 private:
  Code state_of(const Key& key) const {
    Index<Dim> local;
    for (int a = 0; a < Dim; ++a) local[a] = static_cast<std::int32_t>((key[a] - low_[a]) / 2);
    const NodeState state = states_.at(local);
    return state == NodeState::seen ? kFree : state == NodeState::obstacle ? kOccupied : kUnknown;
  }

  /// Appends the cube's subtree if it is not all the same.
  Code cube(const Key& corner, std::int64_t side) {
    if (((corner.array() + side) <= low_.array()).any() || (corner.array() >= high_.array()).any()) return kUnknown;
    if (side == 1) return state_of(corner);
    const std::size_t begin = out_.size();
    const std::uint64_t nodes_before = nodes_;
    out_.append(2, '\0');
    unsigned word = 0;
    bool same = true;
    for (int i = 0; i < 8; ++i) {
      const Code code = cube(corner + side / 2 * Key(i & 1, i >> 1 & 1, i >> 2), side / 2);
      word |= static_cast<unsigned>(code) << (2 * i);
      same = same && code != kInner && code == (word & 3U);
      nodes_ += code != kUnknown;
    }
    if (same) {
      out_.resize(begin);
      nodes_ = nodes_before;
      return static_cast<Code>(word & 3U);
    }
    out_[begin] = static_cast<char>(word & 0xff);
    out_[begin + 1] = static_cast<char>(word >> 8);
    return kInner;
  }

  const Field<Dim, NodeState>& states_;
  Key low_, high_;
  std::string out_;
  std::uint64_t nodes_ = 1;  ///< With the root.
};

}  // namespace

template <int Dim>
std::string states_as_octomap(const Field<Dim, NodeState>& states) {
  TreeWriter<Dim> writer(states);
  const std::string tree = writer.write();
  return fmt::format(
             "# Octomap OcTree binary file\n# (feel free to add / change comments, but leave the first line as it is!)\n#\nid OcTree\nsize {}\nres "
             "{}\ndata\n",
             writer.nodes(), 0.5 * states.window.spacing) +
         tree;
}

template std::string states_as_octomap<2>(const Field<2, NodeState>&);
template std::string states_as_octomap<3>(const Field<3, NodeState>&);

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#include "vantage/exchange/leaf_code.h"

#include <fmt/format.h>

#include <algorithm>

#include "vantage/base/error.h"
#include "vantage/exchange/bit_coder.h"
#include "vantage/exchange/plane_code.h"
#include "vantage/exchange/predictor.h"
#include "vantage/exchange/surroundings.h"
#include "vantage/surface/snap.h"

namespace vantage {
namespace {

/// A leaf takes a bit at least, and no prediction is surer than 1 - 2^-8: so many leaves fit into a byte at most.
constexpr std::size_t kMostPerByte = 8 * 178;

template <int Dim>
using Cells = std::vector<LevelCell<Dim>>;

template <int Dim>
CellNumber<Dim> parent_of(const CellNumber<Dim>& cell) {
  CellNumber<Dim> at = cell;
  for (std::uint32_t& a : at) a >>= 1U;
  return at;
}

template <int Dim>
int child_number(const CellNumber<Dim>& cell) {
  int k = 0;
  for (int a = 0; a < Dim; ++a) k |= static_cast<int>(cell[a] & 1U) << a;
  return k;
}

/// The cells of every level that are to be written, with all that the reader will find out.
template <int Dim>
class Pyramid {
 public:
  explicit Pyramid(Leaves<Dim> leaves) : leaves_(std::move(leaves)), levels_(ExchangeLattice<Dim>::kDepth + 1) {
    sort_leaves(leaves_);
    for (const SiteLeaf<Dim>& leaf : leaves_.sites) {
      require(leaf.sites >= 1 && leaf.sites <= 3, "a cell without sites");
      levels_[0].push_back({.at = leaf.cell, .mask = leaf.sites});
    }
    for (std::size_t i = 0; i < leaves_.planes.size(); ++i) {
      const PlaneLeaf<Dim>& plane = leaves_.planes[i];
      require(plane.level >= PlaneLeaf<Dim>::kLowest && plane.level <= PlaneLeaf<Dim>::kHighest, "a plane on no level for planes");
      levels_[static_cast<std::size_t>(plane.level)].push_back({.at = plane.cell, .plane = static_cast<std::int32_t>(i)});
    }
    for (std::size_t l = 0; l + 1 < levels_.size(); ++l) raise(levels_[l], levels_[l + 1]);
    if (!levels_.back().empty()) require(levels_.back().size() == 1 && levels_.back()[0].at == CellNumber<Dim>{}, "a leaf outside the lattice");
  }
  [[nodiscard]] const Cells<Dim>& level(int l) const { return levels_[static_cast<std::size_t>(l)]; }
  [[nodiscard]] const std::vector<PlaneLeaf<Dim>>& planes() const { return leaves_.planes; }

 private:
  Leaves<Dim> leaves_;
  std::vector<Cells<Dim>> levels_;

  static void raise(const Cells<Dim>& from, Cells<Dim>& to) {
    Cells<Dim> parents;
    for (const LevelCell<Dim>& cell : from) {
      const CellNumber<Dim> at = parent_of<Dim>(cell.at);
      if (parents.empty() || parents.back().at != at) parents.push_back({.at = at});
      parents.back().mask |= static_cast<std::uint8_t>(1U << static_cast<unsigned>(child_number<Dim>(cell.at)));
    }
    Cells<Dim> all;
    std::merge(parents.begin(), parents.end(), to.begin(), to.end(), std::back_inserter(all),
               [](const auto& a, const auto& b) { return curve_less<Dim>(a.at, b.at); });
    to.clear();
    for (const LevelCell<Dim>& cell : all) {
      if (to.empty() || to.back().at != cell.at) {
        to.push_back(cell);
        continue;
      }
      require(to.back().plane < 0 || cell.plane < 0, "two planes in one cell");
      to.back().plane = std::max(to.back().plane, cell.plane);
      to.back().mask |= cell.mask;
    }
  }
};

/// Writes leaves, or reads them, with one code: `truth` is null when reading.
template <int Dim, class Coder>
class TreeCode {
 public:
  TreeCode(Coder& coder, const Pyramid<Dim>* truth, const LeafCounts& counts, std::string_view where)
      : coder_(coder), truth_(truth), counts_(counts), where_(where) {}

  Leaves<Dim> run() {
    Cells<Dim> cells(1);
    for (int l = ExchangeLattice<Dim>::kDepth; l > 0; --l) {
      check(cells);
      Level<Dim> level(std::move(cells));
      code_planes(level, l);
      cells = code_children(level, l);
    }
    check(cells);
    Level<Dim> level(std::move(cells));
    code_sites(level);
    if constexpr (Coder::kReads)
      require(out_.planes.size() == counts_.planes && out_.sites.size() == counts_.cells, "holds fewer leaves than its header says", where_);
    return std::move(out_);
  }

 private:
  static constexpr int kChildren = 1 << Dim;
  Coder& coder_;
  const Pyramid<Dim>* truth_;
  LeafCounts counts_;
  std::string_view where_;
  Leaves<Dim> out_;
  Predictor children_{Surroundings<Dim>::kInputs, 18, Surroundings<Dim>::kSets};
  Predictor sites_{5, 16, 8};
  PlaneCode<Dim> planes_;

  /// Each cell to be coded ends in a leaf at least.
  void check(const Cells<Dim>& cells) const {
    if constexpr (Coder::kReads) {
      const auto coded = std::count_if(cells.begin(), cells.end(), [](const auto& c) { return !c.below_plane; });
      require(static_cast<std::size_t>(coded) <= counts_.planes + counts_.cells - out_.planes.size(), "holds more leaves than its header says",
              where_);
    }
  }
  void check_end() const {
    if constexpr (Coder::kReads) require(!coder_.overrun(), "the code ends early", where_);
  }
  /// The next cell to write of `level`; nullptr when reading.
  const LevelCell<Dim>* next(int level, std::size_t& at) const { return truth_ == nullptr ? nullptr : &truth_->level(level)[at++]; }

  void code_planes(Level<Dim>& level, int l) {
    if (l < PlaneLeaf<Dim>::kLowest || l > PlaneLeaf<Dim>::kHighest || counts_.planes == 0) return;
    std::size_t at = 0;
    for (LevelCell<Dim>& cell : level.cells) {
      if (cell.below_plane) continue;
      const LevelCell<Dim>* known = next(l, at);
      if (planes_.code_flag(coder_, level, cell, l, known != nullptr && known->plane >= 0)) {
        PlaneLeaf<Dim> plane{.cell = cell.at, .level = l};
        if (known != nullptr) plane = truth_->planes()[static_cast<std::size_t>(known->plane)];
        require(out_.planes.size() < counts_.planes, "holds more planes than its header says", where_);
        cell.plane = static_cast<std::int32_t>(out_.planes.size());
        planes_.code_plane(coder_, plane);
        cell.bare = planes_.code_bare(coder_, l, known != nullptr && known->mask == 0);
        out_.planes.push_back(plane);
      }
      check_end();
    }
  }

  Cells<Dim> code_children(Level<Dim>& level, int l) {
    const auto met = [&](const LevelCell<Dim>& cell) {
      return cell.plane < 0 ? std::uint8_t{0} : met_children<Dim>(out_.planes[static_cast<std::size_t>(cell.plane)], cell.at, l);
    };
    for (LevelCell<Dim>& cell : level.cells)
      if (cell.bare || cell.below_plane) {
        cell.mask = met(cell);
        cell.known = true;
      }
    Cells<Dim> below;
    std::size_t at = 0;
    for (LevelCell<Dim>& cell : level.cells) {
      const LevelCell<Dim>* known = cell.below_plane ? nullptr : next(l, at);
      std::uint8_t coded = 0;
      if (!cell.known) {
        code_mask(level, cell, l, known == nullptr ? 0 : known->mask);
        coded = cell.mask;
        cell.mask |= met(cell);
      }
      for (int k = 0; k < kChildren; ++k) {
        const bool real = (coded >> k & 1) != 0;
        if ((cell.mask >> k & 1) != 0) below.push_back({.at = child_of<Dim>(cell.at, k), .below_plane = !real, .plane = real ? -1 : cell.plane});
      }
      if ((below.size() & 0xffffU) < kChildren) require_memory(static_cast<double>(below.size()), 4.0 * sizeof(LevelCell<Dim>), "cells of a map");
    }
    return below;
  }

  void code_mask(const Level<Dim>& level, LevelCell<Dim>& cell, int l, std::uint8_t truth) {
    Surroundings<Dim> around(level, cell, l - 1);
    std::uint8_t mask = 0;
    for (int k = 0; k < kChildren; ++k) {
      const bool certain = k == kChildren - 1 && mask == 0;
      const bool holds = certain || code_bit(coder_, children_, (truth >> k & 1) != 0, around.contexts(k), around.set(k));
      around.learn(k, holds);
      mask |= static_cast<std::uint8_t>(static_cast<unsigned>(holds) << static_cast<unsigned>(k));
    }
    cell.mask = mask;
    cell.known = true;
    check_end();
  }

  void code_sites(Level<Dim>& level) {
    std::size_t at = 0;
    for (LevelCell<Dim>& cell : level.cells) {
      if (cell.below_plane) continue;
      const LevelCell<Dim>* known = next(0, at);
      const std::uint8_t truth = known == nullptr ? 0 : known->mask;
      const SiteContexts<Dim> contexts(level, cell);
      const bool corner = code_bit(coder_, sites_, (truth & 1U) != 0, contexts.corner(), 0);
      const bool center = !corner || code_bit(coder_, sites_, (truth & 2U) != 0, contexts.center(), 1);
      cell.mask = static_cast<std::uint8_t>((corner ? 1U : 0U) | (center ? 2U : 0U));
      cell.known = true;
      out_.sites.push_back({cell.at, cell.mask});
      check_end();
    }
  }
};

}  // namespace

template <int Dim>
void sort_leaves(Leaves<Dim>& leaves) {
  std::sort(leaves.planes.begin(), leaves.planes.end(),
            [](const auto& a, const auto& b) { return a.level != b.level ? a.level > b.level : curve_less<Dim>(a.cell, b.cell); });
  std::sort(leaves.sites.begin(), leaves.sites.end(), [](const auto& a, const auto& b) { return curve_less<Dim>(a.cell, b.cell); });
}

template <int Dim>
std::string encode_leaves(const Leaves<Dim>& leaves) {
  if (leaves.planes.empty() && leaves.sites.empty()) return {};
  const Pyramid<Dim> truth(leaves);
  BitEncoder coder;
  TreeCode<Dim, BitEncoder>(coder, &truth, {leaves.planes.size(), leaves.sites.size()}, {}).run();
  return coder.finish();
}

template <int Dim>
Leaves<Dim> decode_leaves(std::string_view bytes, const LeafCounts& counts, std::string_view where) {
  Leaves<Dim> leaves;
  if (counts.planes == 0 && counts.cells == 0) {
    require(bytes.empty(), "a code without leaves", where);
    return leaves;
  }
  require((counts.planes + counts.cells) / kMostPerByte <= bytes.size() + 8,
          fmt::format("{} leaves in {} bytes: no code is so short", counts.planes + counts.cells, bytes.size()), where);
  BitDecoder coder(bytes);
  leaves = TreeCode<Dim, BitDecoder>(coder, nullptr, counts, where).run();
  require(coder.unread() == 0, fmt::format("{} bytes behind the leaves", coder.unread()), where);
  return leaves;
}

template void sort_leaves(Leaves<2>&);
template void sort_leaves(Leaves<3>&);
template std::string encode_leaves(const Leaves<2>&);
template std::string encode_leaves(const Leaves<3>&);
template Leaves<2> decode_leaves(std::string_view, const LeafCounts&, std::string_view);
template Leaves<3> decode_leaves(std::string_view, const LeafCounts&, std::string_view);

}  // namespace vantage

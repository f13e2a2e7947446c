// SPDX-License-Identifier: Apache-2.0
#include "vantage/field/narrow_band.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/field/line_tiles.h"

namespace vantage {
namespace {

using Word = std::uint64_t;
constexpr int kMaxReach = 17;  ///< Steps to the other side's nodes.

/// A row near another one: `rows` on in the order of rows, and the square of the way there.
template <int Dim>
struct Neighbour {
  Index<Dim> step;
  std::ptrdiff_t rows;
  int square;
};

/// Rows of bits and what is within k nodes of a set one along the row.
template <int Dim>
class Band {
 public:
  Band(const Field<Dim, std::uint8_t>& inside, double reach) : window_(inside.window), half_(0.5 * inside.window.spacing) {
    width_ = static_cast<std::size_t>(window_.extent[0]);
    words_ = (width_ + 63) / 64;
    rows_ = window_.size() / width_;
    // Squares whose distance, less half a step, is below the reach.
    while (distance(last_ + 1) < static_cast<float>(reach)) ++last_;
    while ((far_ + 1) * (far_ + 1) <= last_) ++far_;
    find_neighbours();
    spread(inside);
    find_active();
  }

  [[nodiscard]] NarrowBand collect() const {
    constexpr std::size_t kRows = 64;
    std::vector<NarrowBand> parts((rows_ + kRows - 1) / kRows);
    parallel_chunks(rows_, kRows, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row)
        for (std::size_t w = 0; w < words_; ++w)
          if (active_[row * words_ + w] == (kIn | kOut)) add_word(row, w, parts[begin / kRows]);
    });
    NarrowBand out;
    for (const NarrowBand& part : parts) {
      out.nodes.insert(out.nodes.end(), part.nodes.begin(), part.nodes.end());
      out.distances.insert(out.distances.end(), part.distances.begin(), part.distances.end());
    }
    return out;
  }

 private:
  static constexpr std::uint8_t kIn = 1, kOut = 2;

  /// As signed_distance has it.
  [[nodiscard]] float distance(int square) const {
    const auto d = static_cast<float>(std::sqrt(static_cast<double>(square)) * window_.spacing);
    return static_cast<float>(static_cast<double>(d) - half_);
  }

  void find_neighbours() {
    Grid<Dim> cube;
    cube.extent.setConstant(2 * far_ + 1);
    cube.extent[0] = 1;
    for (std::size_t i = 0; i < cube.size(); ++i) {
      Neighbour<Dim> n{cube.local(i).array() - far_, 0, 0};
      n.step[0] = 0;
      n.square = n.step.squaredNorm();
      for (int a = 1; a < Dim; ++a) n.rows += n.step[a] * static_cast<std::ptrdiff_t>(window_.stride(a) / width_);
      if (n.square <= last_) neighbours_.push_back(n);
    }
  }

  /// within_[side][k] of every word: the bits of the side within k of it along the row.
  void spread(const Field<Dim, std::uint8_t>& inside) {
    const std::size_t reaches = static_cast<std::size_t>(far_) + 1;
    for (auto& side : within_) {
      side.reserve(rows_ * words_ * reaches);
      prefer_large_pages(side.data(), side.capacity() * sizeof(Word));
      side.resize(rows_ * words_ * reaches);
    }
    near_.resize(rows_ * words_);
    parallel_chunks(rows_, 64, [&](std::size_t begin, std::size_t end) {
      Bits in, out;
      for (std::size_t row = begin; row < end; ++row) {
        pack_row(inside.values.data() + row * width_, width_, in);
        out = in;
        for (Word& word : out) word = ~word;
        if (width_ % 64 != 0) out.back() &= (Word{1} << (width_ % 64)) - 1;
        for (std::size_t w = 0; w < words_; ++w) {
          const std::size_t place = row * words_ + w;
          const Word any_in = spread_word(in, w, within_[0].data() + place * reaches),
                     any_out = spread_word(out, w, within_[1].data() + place * reaches);
          near_[place] = static_cast<std::uint8_t>((any_in != 0 ? kIn : 0) | (any_out != 0 ? kOut : 0));
        }
      }
    });
  }

  Word spread_word(const Bits& bits, std::size_t w, Word* within) const {
    const Word word = bits[w], before = w > 0 ? bits[w - 1] : 0, after = w + 1 < words_ ? bits[w + 1] : 0;
    Word sum = within[0] = word;
    for (int k = 1; k <= far_; ++k) within[k] = sum |= (word << k | before >> (64 - k)) | (word >> k | after << (64 - k));
    return sum;
  }

  /// Which sides any row near enough has, word by word: axis after axis.
  void find_active() {
    active_ = near_;
    for (int a = 1; a < Dim; ++a) {
      const std::vector<std::uint8_t> old = active_;
      const std::size_t stride = window_.stride(a) / width_ * words_, length = static_cast<std::size_t>(window_.extent[a]);
      parallel_for(rows_, 64, [&](std::size_t row) {
        const auto along = static_cast<std::ptrdiff_t>(row * words_ / stride % length);
        for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(-along, -far_);
             k <= std::min<std::ptrdiff_t>(far_, static_cast<std::ptrdiff_t>(length) - 1 - along); ++k)
          for (std::size_t w = 0; w < words_; ++w)
            active_[row * words_ + w] |=
                old[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(row * words_ + w) + k * static_cast<std::ptrdiff_t>(stride))];
      });
    }
  }

  void add_word(std::size_t row, std::size_t w, NarrowBand& band) const {
    constexpr std::size_t kSquares = static_cast<std::size_t>(kMaxReach) * kMaxReach + 1;
    std::array<std::array<Word, kSquares>, 2> met;  // By side and square.
    for (auto& side : met) std::fill_n(side.begin(), last_ + 1, Word{0});
    const std::size_t reaches = static_cast<std::size_t>(far_) + 1;
    const Index<Dim> here = window_.local(row * width_);
    for (const Neighbour<Dim>& n : neighbours_) {
      if (!window_.inside(here + n.step)) continue;
      const auto place = (static_cast<std::size_t>(static_cast<std::ptrdiff_t>(row) + n.rows) * words_ + w) * reaches;
      for (int k = 0; n.square + k * k <= last_; ++k)
        for (std::size_t side = 0; side < 2; ++side)
          met[side][static_cast<std::size_t>(n.square + k * k)] |= within_[side][place + static_cast<std::size_t>(k)];
    }
    const std::size_t own = (row * words_ + w) * reaches;
    for (std::size_t side = 0; side < 2; ++side) {
      Word left = within_[side][own];
      for (int square = 1; square <= last_ && left != 0; ++square) {
        Word found = left & met[1 - side][static_cast<std::size_t>(square)];
        left &= ~found;
        for (const float d = side == 0 ? distance(square) : -distance(square); found != 0; found &= found - 1) {
          band.nodes.push_back(static_cast<std::uint32_t>(row * width_ + w * 64 + static_cast<std::size_t>(std::countr_zero(found))));
          band.distances.push_back(d);
        }
      }
    }
  }

  const Grid<Dim>& window_;
  double half_;
  std::size_t width_ = 0, words_ = 0, rows_ = 0;
  int last_ = 0, far_ = 0;  ///< Largest square within reach, and its root.
  std::vector<Neighbour<Dim>> neighbours_;
  std::array<std::vector<Word>, 2> within_;
  std::vector<std::uint8_t> near_, active_;
};

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
NarrowBand narrow_band(const Field<Dim, std::uint8_t>& inside, double reach) {
  const double h = inside.window.spacing;
  require(reach > 0.0 && reach <= (kMaxReach - 1) * h,
          fmt::format("narrow_band: reach = {} m: must be > 0 and <= {} steps of {} m", reach, kMaxReach - 1, h));
  return inside.values.empty() ? NarrowBand{} : Band<Dim>(inside, reach).collect();
}

template NarrowBand narrow_band<2>(const Field<2, std::uint8_t>&, double);
template NarrowBand narrow_band<3>(const Field<3, std::uint8_t>&, double);

}  // namespace vantage

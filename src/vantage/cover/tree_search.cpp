// SPDX-License-Identifier: Apache-2.0
#include "vantage/cover/tree_search.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "vantage/base/error.h"

namespace vantage {
namespace {

using Bits = std::vector<std::uint64_t>;
constexpr int kClasses = 31;  // Of weights above 0.

/// Bits that two rows of words share.
std::int64_t shared(const std::uint64_t* a, const std::uint64_t* b, std::size_t words) {
  std::int64_t total = 0;
  for (std::size_t begin = 0; begin < words; begin += 31) {
    std::uint64_t bytes = 0;  // At most 8 x 31 each.
    const std::size_t end = std::min(words, begin + 31);
    for (std::size_t k = begin; k < end; ++k) {
      std::uint64_t x = a[k] & b[k];
      x -= x >> 1 & 0x5555555555555555U;
      x = (x & 0x3333333333333333U) + (x >> 2 & 0x3333333333333333U);
      bytes += (x + (x >> 4)) & 0x0f0f0f0f0f0f0f0fU;
    }
    bytes = (bytes & 0x00ff00ff00ff00ffU) + (bytes >> 8 & 0x00ff00ff00ff00ffU);
    total += static_cast<std::int64_t>(bytes * 0x0001000100010001U >> 48);
  }
  return total;
}

/// Demands of one weight: a stretch of whole words.
struct Stretch {
  std::int64_t weight;
  std::size_t first, words;
};

struct Gain {
  std::int64_t count = 0, weight = 0;
  std::uint32_t candidate = 0;
};

class Tree {
 public:
  Tree(const CoverProblem& problem, std::span<const double> prices, std::int64_t& work)
      : spare_(static_cast<std::int64_t>(problem.spare)), work_(work) {
    const std::vector<std::size_t> place = sort_demands(problem, prices);
    rows_.assign(problem.sets.size(), Bits(words_));
    for (std::size_t c = 0; c < rows_.size(); ++c)
      for (const std::uint32_t i : problem.sets[c])
        if (problem.need[i] > 0) set(rows_[c], place[i]);
    left_.resize(words_);
    for (std::size_t i = 0; i < place.size(); ++i)
      if (problem.need[i] > 0) set(left_, place[i]);
  }

  TreeResult run(std::size_t size) {
    std::vector<std::uint32_t> all(rows_.size());
    std::iota(all.begin(), all.end(), 0U);
    TreeResult result;
    if (search(left_, all, size)) result.choice = chosen_;
    result.complete = !spent_;
    return result;
  }

 private:
  static void set(Bits& bits, std::size_t place) { bits[place / 64] |= std::uint64_t{1} << (place % 64); }

  /// Where each demand stands: the dearest first, each class from a new word on.
  std::vector<std::size_t> sort_demands(const CoverProblem& problem, std::span<const double> prices) {
    const double dearest = prices.empty() ? 0.0 : *std::max_element(prices.begin(), prices.end());
    std::vector<std::vector<std::size_t>> classes(kClasses + 1);
    for (std::size_t i = 0; i < problem.need.size(); ++i) {
      require(problem.need[i] <= 1, "tree_search: a demand needs more than one candidate");
      classes[dearest > 0.0 ? static_cast<std::size_t>(std::lround(kClasses * prices[i] / dearest)) : 0].push_back(i);
    }
    std::vector<std::size_t> place(problem.need.size());
    for (std::size_t k = classes.size(); k-- > 0;) {
      if (classes[k].empty()) continue;
      for (std::size_t n = 0; n < classes[k].size(); ++n) place[classes[k][n]] = 64 * words_ + n;
      stretches_.push_back({static_cast<std::int64_t>(k), words_, (classes[k].size() + 63) / 64});
      words_ += stretches_.back().words;
    }
    return place;
  }

  /// What is left, or the part of it that a candidate covers.
  Gain measure(const Bits& left, const Bits& row) const {
    Gain gain;
    for (const Stretch& s : stretches_) {
      const std::int64_t n = shared(left.data() + s.first, row.data() + s.first, s.words);
      gain.count += n;
      gain.weight += s.weight * n;
    }
    return gain;
  }

  /// Of what is left, as much as must be covered.
  Gain needed(const Bits& left) const {
    Gain need = measure(left, left);
    std::int64_t short_of = spare_;
    need.count -= short_of;
    for (const Stretch& s : stretches_) {
      const std::int64_t n = std::min(short_of, shared(left.data() + s.first, left.data() + s.first, s.words));
      need.weight -= s.weight * n;
      short_of -= n;
    }
    return need;
  }

  bool search(const Bits& left, std::span<const std::uint32_t> candidates, std::size_t size) {
    const Gain need = needed(left);
    if (need.count <= 0) return true;
    work_ -= static_cast<std::int64_t>((candidates.size() + 2) * words_);
    spent_ = spent_ || work_ < 0;
    if (size == 0 || spent_) return false;
    std::vector<Gain> gains;
    for (const std::uint32_t c : candidates) {
      gains.push_back(measure(left, rows_[c]));
      gains.back().candidate = c;
      if (gains.back().count == 0) gains.pop_back();
    }
    return choose(left, gains, size, need);
  }

  /// Tries the candidates in the order of the measure that cuts more; each without those before it.
  bool choose(const Bits& left, std::vector<Gain>& gains, std::size_t size, const Gain& need) {
    const double by_count = reach(gains, size, &Gain::count, need.count), by_weight = reach(gains, size, &Gain::weight, need.weight);
    if (by_count < 1.0 || by_weight < 1.0) return false;
    const auto measure = by_weight < by_count ? &Gain::weight : &Gain::count;
    std::sort(gains.begin(), gains.end(), [&](const Gain& a, const Gain& b) {
      if (a.*measure != b.*measure) return a.*measure > b.*measure;
      return a.count != b.count ? a.count > b.count : a.candidate < b.candidate;
    });
    std::vector<std::uint32_t> rest;
    for (const Gain& gain : gains) rest.push_back(gain.candidate);
    Bits next(words_);
    for (std::size_t r = 0; r < gains.size(); ++r) {
      std::int64_t most = 0;
      for (std::size_t k = r; k < std::min(gains.size(), r + size); ++k) most += gains[k].*measure;
      if (most < need.*measure) return false;
      for (std::size_t w = 0; w < words_; ++w) next[w] = left[w] & ~rows_[gains[r].candidate][w];
      chosen_.push_back(gains[r].candidate);
      if (search(next, std::span(rest).subspan(r + 1), size - 1)) return true;
      chosen_.pop_back();
      if (spent_) return false;
    }
    return false;
  }

  /// The most that `size` candidates could cover, over what is needed.
  static double reach(std::vector<Gain>& gains, std::size_t size, std::int64_t Gain::* measure, std::int64_t need) {
    if (need <= 0) return 2.0 * static_cast<double>(gains.size()) + 2.0;
    const auto end = gains.begin() + static_cast<std::ptrdiff_t>(std::min(size, gains.size()));
    std::partial_sort(gains.begin(), end, gains.end(), [&](const Gain& a, const Gain& b) { return a.*measure > b.*measure; });
    std::int64_t most = 0;
    for (auto gain = gains.begin(); gain != end; ++gain) most += (*gain).*measure;
    return static_cast<double>(most) / static_cast<double>(need);
  }

  std::int64_t spare_;
  std::int64_t& work_;
  bool spent_ = false;
  std::size_t words_ = 0;
  std::vector<Stretch> stretches_;  ///< The dearest first.
  std::vector<Bits> rows_;          ///< Of each candidate.
  Bits left_;
  Choice chosen_;
};

}  // namespace

TreeResult tree_search(const CoverProblem& problem, std::size_t size, std::span<const double> prices, std::int64_t& work) {
  return Tree(problem, prices, work).run(size);
}

}  // namespace vantage

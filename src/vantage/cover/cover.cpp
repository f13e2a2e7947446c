// SPDX-License-Identifier: Apache-2.0
#include "vantage/cover/cover.h"

#include <algorithm>
#include <numeric>
#include <optional>

namespace vantage {
namespace {

struct Entry {
  double gain;
  std::size_t candidate;
  /// Worse than `other`: less gain, or the larger index.
  bool operator<(const Entry& other) const { return gain != other.gain ? gain < other.gain : candidate > other.candidate; }
};

bool has(const std::vector<std::uint64_t>& bits, std::uint32_t demand) { return (bits[demand / 64] >> (demand % 64) & 1U) != 0; }

/// A choice that gets smaller while what it covers stays covered.
class Reducer {
 public:
  Reducer(const CoverProblem& problem, Choice choice, const Acceptable& acceptable)
      : problem_(problem), acceptable_(acceptable), choice_(std::move(choice)), count_(problem.need.size()), owners_(problem.need.size()) {
    for (std::size_t c = 0; c < problem_.sets.size(); ++c) {
      bits_.push_back(as_bits(problem_.sets[c], problem_.need.size()));
      for (const std::uint32_t i : problem_.sets[c]) owners_[i].push_back(c);
    }
    for (const std::size_t c : choice_) change(c, +1);
    for (std::size_t i = 0; i < count_.size(); ++i) required_.push_back(count_[i] >= problem_.need[i]);
  }

  Choice reduce() {
    drop_needless();
    while (replace_two()) drop_needless();
    return std::move(choice_);
  }

 private:
  void change(std::size_t candidate, int by) {
    for (const std::uint32_t i : problem_.sets[candidate]) count_[i] += static_cast<std::uint32_t>(by);
  }

  bool accepts(const Choice& choice) const { return !acceptable_ || acceptable_(choice); }

  bool needless(std::size_t candidate) const {
    const auto& set = problem_.sets[candidate];
    return std::none_of(set.begin(), set.end(), [&](std::uint32_t i) { return required_[i] && count_[i] <= problem_.need[i]; });
  }

  /// Last chosen first: of a greedy choice these see least.
  void drop_needless() {
    for (std::size_t k = choice_.size(); k-- > 0;) {
      if (!needless(choice_[k])) continue;
      Choice rest = choice_;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(k));
      if (!accepts(rest)) continue;
      change(choice_[k], -1);
      choice_ = std::move(rest);
    }
  }

  /// Demands that the choice without a and b leaves one short; nullopt if it leaves one two short.
  std::optional<std::vector<std::uint32_t>> short_without(std::size_t a, std::size_t b) const {
    std::vector<std::uint32_t> all;
    for (const auto& [mine, other] : {std::pair{a, b}, std::pair{b, a}})
      for (const std::uint32_t i : problem_.sets[mine]) {
        const bool both = has(bits_[other], i);
        const std::uint32_t left = count_[i] - (both ? 2U : 1U);
        if (!required_[i] || left >= problem_.need[i] || (both && mine == b)) continue;
        if (left + 1 < problem_.need[i]) return std::nullopt;
        all.push_back(i);
      }
    return all;
  }

  /// A candidate, not chosen yet, that covers all of them.
  std::optional<std::size_t> substitute(const std::vector<std::uint32_t>& demands, const Choice& rest) const {
    const auto rarest = std::min_element(demands.begin(), demands.end(), [&](auto x, auto y) { return owners_[x].size() < owners_[y].size(); });
    if (rarest == demands.end()) return std::nullopt;
    for (const std::size_t c : owners_[*rarest]) {
      if (std::find(choice_.begin(), choice_.end(), c) != choice_.end()) continue;
      if (!std::all_of(demands.begin(), demands.end(), [&](std::uint32_t i) { return has(bits_[c], i); })) continue;
      Choice with = rest;
      with.push_back(c);
      if (accepts(with)) return c;
    }
    return std::nullopt;
  }

  bool replace_two() {
    for (std::size_t x = 0; x < choice_.size(); ++x)
      for (std::size_t y = x + 1; y < choice_.size(); ++y) {
        const std::size_t a = choice_[x], b = choice_[y];
        const auto demands = short_without(a, b);
        if (!demands) continue;
        Choice rest = choice_;
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(y));
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(x));
        const auto c = substitute(*demands, rest);
        if (!c) continue;
        change(a, -1);
        change(b, -1);
        change(*c, +1);
        rest.push_back(*c);
        choice_ = std::move(rest);
        return true;
      }
    return false;
  }

  const CoverProblem& problem_;
  const Acceptable& acceptable_;
  Choice choice_;
  std::vector<std::uint32_t> count_;              ///< Chosen candidates that cover a demand.
  std::vector<std::vector<std::size_t>> owners_;  ///< All candidates that cover it.
  std::vector<std::vector<std::uint64_t>> bits_;
  std::vector<bool> required_;
};

}  // namespace

std::vector<std::uint64_t> as_bits(std::span<const std::uint32_t> set, std::size_t demands) {
  std::vector<std::uint64_t> bits((demands + 63) / 64);
  for (const std::uint32_t i : set) bits[i / 64] |= std::uint64_t{1} << (i % 64);
  return bits;
}

bool covers(const CoverProblem& problem, std::span<const std::size_t> choice) {
  std::vector<std::uint32_t> count(problem.need.size());
  for (const std::size_t c : choice)
    for (const std::uint32_t i : problem.sets[c]) ++count[i];
  std::size_t missing = 0;
  for (std::size_t i = 0; i < count.size(); ++i) missing += count[i] < problem.need[i] ? 1 : 0;
  return missing <= problem.spare;
}

Choice greedy_cover(const CoverProblem& problem, std::span<const double> prices) {
  std::vector<std::uint32_t> left = problem.need;
  auto missing = static_cast<std::size_t>(std::count_if(left.begin(), left.end(), [](auto n) { return n > 0; }));
  const auto gain = [&](std::size_t c) {
    double sum = 0.0;
    for (const std::uint32_t i : problem.sets[c])
      if (left[i] > 0) sum += prices.empty() ? 1.0 : prices[i];
    return sum;
  };
  std::vector<Entry> heap;
  for (std::size_t c = 0; c < problem.sets.size(); ++c) heap.push_back({gain(c), c});
  std::make_heap(heap.begin(), heap.end());
  Choice choice;
  while (missing > problem.spare && !heap.empty()) {
    std::pop_heap(heap.begin(), heap.end());
    const Entry fresh{gain(heap.back().candidate), heap.back().candidate};
    heap.pop_back();
    if (!heap.empty() && fresh < heap.front()) {
      heap.push_back(fresh);
      std::push_heap(heap.begin(), heap.end());
      continue;
    }
    choice.push_back(fresh.candidate);
    for (const std::uint32_t i : problem.sets[fresh.candidate])
      if (left[i] > 0 && --left[i] == 0) --missing;
  }
  return choice;
}

Choice improved(const CoverProblem& problem, Choice choice, const Acceptable& acceptable) {
  return Reducer(problem, std::move(choice), acceptable).reduce();
}

}  // namespace vantage

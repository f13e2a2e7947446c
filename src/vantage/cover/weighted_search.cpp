// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <tuple>

#include "vantage/base/random.h"
#include "vantage/cover/cover.h"

namespace vantage {
namespace {

/// A choice that changes by one candidate at a time, with for each candidate what adding it would gain or taking it out would lose.
class Search {
 public:
  Search(const CoverProblem& problem, const Choice& choice, std::uint64_t seed)
      : problem_(problem),
        need_(problem.need),
        count_(need_.size()),
        weight_(need_.size(), 1),
        owners_(need_.size()),
        random_(seed, 3),
        position_(need_.size(), kNone) {
    const std::size_t candidates = problem.sets.size();
    value_.assign(candidates, 0);
    changed_.assign(candidates, 0);
    is_chosen_.assign(candidates, 0);
    may_enter_.assign(candidates, 1);
    for (std::size_t c = 0; c < candidates; ++c)
      for (const std::uint32_t i : problem.sets[c]) owners_[i].push_back(c);
    for (std::size_t i = 0; i < need_.size(); ++i)
      if (need_[i] > 0) set_short(static_cast<std::uint32_t>(i));
    for (std::size_t c = 0; c < candidates; ++c)
      for (const std::uint32_t i : problem.sets[c]) value_[c] += need_[i] > 0 ? 1 : 0;
    for (const std::size_t c : choice) add(c);
  }

  Choice run(std::int64_t work) {
    Choice best = chosen_;
    for (spent_ = 0; spent_ < work; ++step_) {
      if (short_.size() <= problem_.spare) {
        best = chosen_;
        if (best.empty()) break;
        take_out(cheapest(kNone));
        continue;
      }
      if (best.size() < 2) break;  // None at all does not do.
      take_out(cheapest(last_added_));
      last_added_ = best_for(short_[random_.below(short_.size())]);
      add(last_added_);
      raise_weights();
    }
    return best;
  }

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};

  void set_short(std::uint32_t i) {
    position_[i] = short_.size();
    short_.push_back(i);
  }
  void set_met(std::uint32_t i) {
    position_[short_.back()] = position_[i];
    short_[position_[i]] = short_.back();
    short_.pop_back();
    position_[i] = kNone;
  }

  /// Adds to what the chosen, or the other, owners of a demand are worth.
  void change_value(std::uint32_t i, bool of_chosen, std::int64_t by) {
    spent_ += static_cast<std::int64_t>(owners_[i].size());
    for (const std::size_t c : owners_[i]) {
      if ((is_chosen_[c] != 0) != of_chosen) continue;
      value_[c] += by;
      may_enter_[c] = 1;
    }
  }

  /// What a candidate covers that is short without it.
  std::int64_t worth(std::size_t c) const {
    std::int64_t sum = 0;
    for (const std::uint32_t i : problem_.sets[c]) {
      const std::uint32_t others = count_[i] - (is_chosen_[c] != 0 ? 1 : 0);
      sum += others < need_[i] ? weight_[i] : 0;
    }
    return sum;
  }

  void add(std::size_t c) {
    for (const std::uint32_t i : problem_.sets[c]) {
      const std::uint32_t n = count_[i]++;
      if (need_[i] == 0) continue;
      if (n + 1 == need_[i]) set_met(i), change_value(i, false, -weight_[i]);
      if (n == need_[i]) change_value(i, true, -weight_[i]);
    }
    is_chosen_[c] = 1;
    changed_[c] = step_;
    chosen_.push_back(c);
    value_[c] = worth(c);
  }

  void take_out(std::size_t c) {
    chosen_.erase(std::find(chosen_.begin(), chosen_.end(), c));
    for (const std::uint32_t i : problem_.sets[c]) {
      const std::uint32_t n = --count_[i];
      if (need_[i] == 0) continue;
      if (n + 1 == need_[i]) set_short(i), change_value(i, false, weight_[i]);
      if (n == need_[i]) change_value(i, true, weight_[i]);
    }
    is_chosen_[c] = 0;
    changed_[c] = step_;
    value_[c] = worth(c);
    may_enter_[c] = 0;  // Not before something round it has changed.
  }

  /// Chosen candidate whose loss weighs least, the one unchanged for longest of equals.
  std::size_t cheapest(std::size_t barred) const {
    std::size_t best = kNone;
    for (const std::size_t c : chosen_) {
      if (c == barred && chosen_.size() > 1) continue;
      if (best == kNone || std::pair(value_[c], changed_[c]) < std::pair(value_[best], changed_[best])) best = c;
    }
    return best;
  }

  /// Candidate that covers the demand and gains most, rather one that may enter.
  std::size_t best_for(std::uint32_t demand) const {
    const auto rank = [&](std::size_t c) { return std::tuple(may_enter_[c] == 0, -value_[c], changed_[c]); };
    std::size_t best = kNone;
    for (const std::size_t c : owners_[demand])
      if (is_chosen_[c] == 0 && (best == kNone || rank(c) < rank(best))) best = c;
    return best;
  }

  void raise_weights() {
    for (const std::uint32_t i : short_) {
      ++weight_[i];
      spent_ += static_cast<std::int64_t>(owners_[i].size());
      for (const std::size_t c : owners_[i]) ++value_[c];  // Chosen or not, the demand is short without it.
    }
  }

  const CoverProblem& problem_;
  std::vector<std::uint32_t> need_, count_;
  std::vector<std::int64_t> weight_;              ///< Of a demand: the steps it was short for.
  std::vector<std::vector<std::size_t>> owners_;  ///< Candidates that cover it.
  Random random_;
  Choice chosen_;
  std::vector<std::uint32_t> short_;  ///< Demands that are short, and where each stands among them.
  std::vector<std::size_t> position_;
  std::vector<std::int64_t> value_;    ///< `worth` of each candidate.
  std::vector<std::int64_t> changed_;  ///< Step at which it came or went.
  std::vector<char> is_chosen_, may_enter_;
  std::int64_t step_ = 1, spent_ = 0;
  std::size_t last_added_ = kNone;
};

}  // namespace

Choice weighted_search(const CoverProblem& problem, const Choice& choice, std::uint64_t seed, std::int64_t work) {
  return Search(problem, choice, seed).run(work);
}

}  // namespace vantage

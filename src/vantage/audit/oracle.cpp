// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/oracle.h"

#include <algorithm>
#include <bit>

namespace vantage {
namespace {

/// Columns of one kind, and which of them are left to see.
class Left {
 public:
  /// Not more than `needed` columns are worth anything.
  Left(std::size_t count, std::int64_t needed)
      : count_(static_cast<std::int64_t>(count)), needed_(needed), bits_((count + 63) / 64, ~std::uint64_t{0}) {
    if (count % 64 != 0) bits_.back() = (std::uint64_t{1} << (count % 64)) - 1;
  }

  [[nodiscard]] std::int64_t fresh(const std::vector<std::uint64_t>& row) const {
    std::int64_t total = 0;
    for (std::size_t w = 0; w < bits_.size(); ++w) total += std::popcount(row[w] & bits_[w]);
    return total;
  }
  [[nodiscard]] std::int64_t gain(const std::vector<std::uint64_t>& row) const {
    return covered_ >= needed_ ? 0 : std::min(fresh(row), needed_ - covered_);
  }
  void take(const std::vector<std::uint64_t>& row) {
    covered_ += fresh(row);
    for (std::size_t w = 0; w < bits_.size(); ++w) bits_[w] &= ~row[w];
  }
  [[nodiscard]] std::int64_t count() const { return count_; }
  [[nodiscard]] double share() const { return static_cast<double>(covered_) / static_cast<double>(count_); }

 private:
  std::int64_t count_, needed_, covered_ = 0;
  std::vector<std::uint64_t> bits_;
};

/// Fewest columns of `count` that are the share `goal`.
std::int64_t needed(std::size_t count, double goal) {
  const auto all = static_cast<double>(count);
  auto least = static_cast<std::int64_t>(goal * all);
  while (static_cast<double>(least) / all < goal) ++least;
  return least;
}

/// What is left to see, and which places may be chosen.
template <int Dim>
class Cover {
 public:
  Cover(const SightTable<Dim>& table, const GreedyOptions& options)
      : table_(table),
        with_walls_(options.walls && table.walls > 0),
        targets_(table.targets, with_walls_ ? needed(table.targets, options.goal) : static_cast<std::int64_t>(table.targets)),
        walls_(table.walls, needed(table.walls, options.goal)),
        seen_(table.candidates.size()) {}

  /// Newly seen targets; with walls the sum of both shares, in units of 1/(targets walls).
  [[nodiscard]] std::int64_t gain(std::size_t candidate) const {
    const std::int64_t targets = targets_.gain(table_.rows[candidate]);
    return with_walls_ ? targets * walls_.count() + walls_.gain(table_.wall_rows[candidate]) * targets_.count() : targets;
  }
  [[nodiscard]] bool place_seen(std::size_t candidate) const { return seen_[candidate]; }

  void take(std::size_t candidate, OracleRun& run) {
    targets_.take(table_.rows[candidate]);
    for (std::size_t other = 0; other < seen_.size(); ++other)
      if (table_.sees_place(candidate, other)) seen_[other] = true;
    run.places.push_back(candidate);
    run.coverage.push_back(targets_.share());
    if (table_.walls == 0) return;
    walls_.take(table_.wall_rows[candidate]);
    run.walls.push_back(walls_.share());
  }

 private:
  const SightTable<Dim>& table_;
  bool with_walls_;
  Left targets_, walls_;
  std::vector<bool> seen_;
};

struct Entry {
  std::int64_t gain;
  std::size_t candidate;
  /// Worse than `other`: less gain, or the larger index.
  bool operator<(const Entry& other) const { return gain != other.gain ? gain < other.gain : candidate > other.candidate; }
};

/// Evaluates all at every turn.
template <int Dim>
Entry best_of_all(const Cover<Dim>& cover, std::size_t count, bool from_seen) {
  Entry best{0, count};
  for (std::size_t c = 0; c < count; ++c)
    if (!from_seen || cover.place_seen(c)) best = std::max(best, Entry{cover.gain(c), c});
  return best;
}

/// Keeps old gains, which are upper bounds, in a heap (Minoux 1978).
template <int Dim>
class LazyChoice {
 public:
  explicit LazyChoice(const Cover<Dim>& cover, std::size_t count) {
    for (std::size_t c = 0; c < count; ++c) heap_.push_back({cover.gain(c), c});
    std::make_heap(heap_.begin(), heap_.end());
  }

  Entry best(const Cover<Dim>& cover, bool from_seen) {
    std::vector<Entry> barred;
    Entry best{0, 0};
    while (!heap_.empty()) {
      std::pop_heap(heap_.begin(), heap_.end());
      const Entry top = heap_.back();
      heap_.pop_back();
      if (from_seen && !cover.place_seen(top.candidate)) {
        barred.push_back(top);
        continue;
      }
      const Entry fresh{cover.gain(top.candidate), top.candidate};
      if (fresh.gain == top.gain) {
        best = fresh;
        break;
      }
      push(fresh);
    }
    for (const Entry& entry : barred) push(entry);
    return best;
  }

 private:
  void push(const Entry& entry) {
    heap_.push_back(entry);
    std::push_heap(heap_.begin(), heap_.end());
  }

  std::vector<Entry> heap_;
};

}  // namespace

std::optional<std::int64_t> scans_to(std::span<const double> coverage, double share) {
  const auto first = std::find_if(coverage.begin(), coverage.end(), [share](double c) { return c >= share; });
  if (first == coverage.end()) return std::nullopt;
  return first - coverage.begin() + 1;
}

std::optional<std::int64_t> OracleRun::scans_to_both(double share) const {
  if (walls.empty()) return scans_to(share);
  const auto both = std::pair(vantage::scans_to(coverage, share), vantage::scans_to(walls, share));
  if (!both.first || !both.second) return std::nullopt;
  return std::max(*both.first, *both.second);
}

template <int Dim>
OracleRun greedy_oracle(const SightTable<Dim>& table, const GreedyOptions& options) {
  OracleRun run;
  Cover<Dim> cover(table, options);
  cover.take(0, run);
  const std::size_t count = table.candidates.size();
  LazyChoice<Dim> lazy(cover, count);
  const auto choose = [&] { return options.lazy ? lazy.best(cover, options.from_seen) : best_of_all(cover, count, options.from_seen); };
  for (Entry next = choose(); next.gain > 0; next = choose()) cover.take(next.candidate, run);
  return run;
}

template OracleRun greedy_oracle<2>(const SightTable<2>&, const GreedyOptions&);
template OracleRun greedy_oracle<3>(const SightTable<3>&, const GreedyOptions&);

}  // namespace vantage

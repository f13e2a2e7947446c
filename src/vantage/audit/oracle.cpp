// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/oracle.h"

#include <algorithm>
#include <bit>

#include "vantage/base/parallel.h"
#include "vantage/base/random.h"

namespace vantage {
namespace {

/// `count` of `all`, in their order, one drawn from each of as many equal stretches; all of them if there are no more.
std::vector<std::size_t> draw(const std::vector<std::size_t>& all, std::size_t count, Random& random) {
  if (all.size() <= count) return all;
  std::vector<std::size_t> drawn;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t begin = k * all.size() / count, end = (k + 1) * all.size() / count;
    drawn.push_back(all[begin + random.below(end - begin)]);
  }
  return drawn;
}

template <int Dim, class Predicate>
std::vector<std::size_t> nodes_where(const Reference<Dim>& reference, Predicate&& predicate) {
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < reference.nodes.values.size(); ++i)
    if (predicate(reference.nodes[i])) all.push_back(i);
  return all;
}

/// Draws the places, then fills the table.
template <int Dim>
class TableBuilder {
 public:
  TableBuilder(const Reference<Dim>& reference, const RayCaster<Dim>& truth, const OracleOptions& options)
      : reference_(reference), truth_(truth), options_(options), random_(static_cast<std::uint64_t>(options.seed)) {}

  SightTable<Dim> build(const Vec<Dim>& start) {
    const Grid<Dim>& grid = reference_.nodes.window;
    for (const std::size_t i :
         draw(nodes_where(reference_, [](const Truth& t) { return t.counts(); }), static_cast<std::size_t>(options_.targets), random_))
      targets_.push_back(grid.position(i));
    table_.targets = targets_.size();
    table_.candidates.push_back(start);
    const auto reachable = nodes_where(reference_, [](const Truth& t) { return t.reachable; });
    for (const std::size_t i : draw(reachable, static_cast<std::size_t>(options_.candidates), random_)) table_.candidates.push_back(grid.position(i));
    look_at_targets(0);
    add_missing_views();
    look_at_places();
    return std::move(table_);
  }

 private:
  bool sees(const Vec<Dim>& from, const Vec<Dim>& to) const { return (to - from).norm() <= reference_.options.range && in_sight(truth_, from, to); }

  void look_at_targets(std::size_t first) {
    table_.rows.resize(table_.candidates.size(), std::vector<std::uint64_t>((targets_.size() + 63) / 64));
    parallel_for(table_.candidates.size() - first, 1, [&](std::size_t k) {
      for (std::size_t t = 0; t < targets_.size(); ++t)
        if (sees(table_.candidates[first + k], targets_[t])) table_.rows[first + k][t / 64] |= std::uint64_t{1} << (t % 64);
    });
  }

  std::vector<std::size_t> unseen_targets() const {
    std::vector<std::uint64_t> any((targets_.size() + 63) / 64);
    for (const auto& row : table_.rows)
      for (std::size_t w = 0; w < any.size(); ++w) any[w] |= row[w];
    std::vector<std::size_t> unseen;
    for (std::size_t t = 0; t < targets_.size(); ++t)
      if ((any[t / 64] >> (t % 64) & 1U) == 0) unseen.push_back(t);
    return unseen;
  }

  /// Places that see targets none of the candidates sees, 32 at a time since one of them sees many.
  void add_missing_views() {
    const auto directions = fixed_directions<Dim>(reference_.options.rays);
    const std::size_t limit = 2 * table_.candidates.size();
    for (auto unseen = unseen_targets(); !unseen.empty() && table_.candidates.size() < limit; unseen = unseen_targets()) {
      const std::vector<std::size_t> tried = draw(unseen, std::min<std::size_t>(32, limit - table_.candidates.size()), random_);
      std::vector<std::optional<std::size_t>> views(tried.size());
      parallel_for(tried.size(), 1, [&](std::size_t k) { views[k] = find_view<Dim>(reference_, truth_, targets_[tried[k]], directions); });
      const std::size_t first = table_.candidates.size();
      for (const auto& view : views)
        if (view) table_.candidates.push_back(reference_.nodes.window.position(*view));
      if (table_.candidates.size() == first) break;
      look_at_targets(first);
    }
  }

  void look_at_places() {
    const std::size_t count = table_.candidates.size(), columns = table_.targets + count;
    for (auto& row : table_.rows) row.resize((columns + 63) / 64);
    parallel_for(count, 1, [&](std::size_t c) {
      for (std::size_t other = 0; other < count; ++other) {
        const std::size_t column = table_.targets + other;
        if (sees(table_.candidates[c], table_.candidates[other])) table_.rows[c][column / 64] |= std::uint64_t{1} << (column % 64);
      }
    });
  }

  const Reference<Dim>& reference_;
  const RayCaster<Dim>& truth_;
  OracleOptions options_;
  Random random_;
  std::vector<Vec<Dim>> targets_;
  SightTable<Dim> table_;
};

/// What is left to see, and which places may be chosen.
template <int Dim>
class Cover {
 public:
  explicit Cover(const SightTable<Dim>& table) : table_(table), left_((table.targets + 63) / 64, ~std::uint64_t{0}), seen_(table.candidates.size()) {
    if (table.targets % 64 != 0) left_.back() = (std::uint64_t{1} << (table.targets % 64)) - 1;
  }

  [[nodiscard]] std::int64_t gain(std::size_t candidate) const {
    std::int64_t total = 0;
    for (std::size_t w = 0; w < left_.size(); ++w) total += std::popcount(table_.rows[candidate][w] & left_[w]);
    return total;
  }
  [[nodiscard]] bool place_seen(std::size_t candidate) const { return seen_[candidate]; }

  void take(std::size_t candidate, OracleRun& run) {
    covered_ += gain(candidate);
    for (std::size_t w = 0; w < left_.size(); ++w) left_[w] &= ~table_.rows[candidate][w];
    for (std::size_t other = 0; other < seen_.size(); ++other)
      if (table_.sees_place(candidate, other)) seen_[other] = true;
    run.places.push_back(candidate);
    run.coverage.push_back(static_cast<double>(covered_) / static_cast<double>(table_.targets));
  }

 private:
  const SightTable<Dim>& table_;
  std::vector<std::uint64_t> left_;
  std::vector<bool> seen_;
  std::int64_t covered_ = 0;
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

void describe(OracleOptions& o, const OptionVisitor& visit) {
  visit("targets", o.targets, "", Range{1, 1e8}, "reference nodes the oracle looks at");
  visit("candidates", o.candidates, "", Range{1, 1e6}, "reachable places the oracle may scan from");
  visit("seed", o.seed, "", Range{0, 9e15}, "of the choice of both");
}

std::optional<std::int64_t> scans_to(std::span<const double> coverage, double share) {
  const auto first = std::find_if(coverage.begin(), coverage.end(), [share](double c) { return c >= share; });
  if (first == coverage.end()) return std::nullopt;
  return first - coverage.begin() + 1;
}

template <int Dim>
SightTable<Dim> make_sight_table(const Reference<Dim>& reference, const RayCaster<Dim>& truth, const Vec<Dim>& start, const OracleOptions& options) {
  check_options(options, "audit.oracle");
  return TableBuilder<Dim>(reference, truth, options).build(start);
}

template <int Dim>
OracleRun greedy_oracle(const SightTable<Dim>& table, const GreedyOptions& options) {
  OracleRun run;
  Cover<Dim> cover(table);
  cover.take(0, run);
  const std::size_t count = table.candidates.size();
  LazyChoice<Dim> lazy(cover, count);
  const auto choose = [&] { return options.lazy ? lazy.best(cover, options.from_seen) : best_of_all(cover, count, options.from_seen); };
  for (Entry next = choose(); next.gain > 0; next = choose()) cover.take(next.candidate, run);
  return run;
}

template struct SightTable<2>;
template struct SightTable<3>;
template SightTable<2> make_sight_table<2>(const Reference<2>&, const RayCaster<2>&, const Vec<2>&, const OracleOptions&);
template SightTable<3> make_sight_table<3>(const Reference<3>&, const RayCaster<3>&, const Vec<3>&, const OracleOptions&);
template OracleRun greedy_oracle<2>(const SightTable<2>&, const GreedyOptions&);
template OracleRun greedy_oracle<3>(const SightTable<3>&, const GreedyOptions&);

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/sight_table.h"

#include <algorithm>

#include "vantage/audit/draw.h"
#include "vantage/base/parallel.h"

namespace vantage {
namespace {

using Bits = std::vector<std::uint64_t>;

std::size_t words(std::size_t bits) { return (bits + 63) / 64; }
void set(Bits& row, std::size_t column) { row[column / 64] |= std::uint64_t{1} << (column % 64); }
void clear(Bits& row, std::size_t column) { row[column / 64] &= ~(std::uint64_t{1} << (column % 64)); }

template <int Dim, class Predicate>
std::vector<std::size_t> nodes_where(const Reference<Dim>& reference, Predicate&& predicate) {
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < reference.nodes.values.size(); ++i)
    if (predicate(reference.nodes[i])) all.push_back(i);
  return all;
}

/// Columns below `count` that no row but the first has.
std::vector<std::size_t> unseen(const std::vector<Bits>& rows, std::size_t count) {
  Bits any(words(count));
  for (std::size_t r = 1; r < rows.size(); ++r)
    for (std::size_t w = 0; w < any.size(); ++w) any[w] |= rows[r][w];
  std::vector<std::size_t> columns;
  for (std::size_t c = 0; c < count; ++c)
    if ((any[c / 64] >> (c % 64) & 1U) == 0) columns.push_back(c);
  return columns;
}

/// Fills a table, row by row.
template <int Dim>
class Looker {
 public:
  Looker(const SightInput<Dim>& input, SightTable<Dim>& table) : input_(input), table_(table) {}

  [[nodiscard]] bool sees(const Vec<Dim>& from, const Vec<Dim>& to) const {
    return (to - from).norm() <= input_.reference.options.range && in_sight(input_.truth, from, to);
  }

  /// Targets and walls from the candidates that have no rows yet.
  void look_at_targets() {
    const std::size_t first = table_.rows.size();
    table_.rows.resize(table_.candidates.size(), Bits(words(table_.targets)));
    table_.wall_rows.resize(table_.candidates.size(), Bits(words(table_.walls)));
    parallel_for(table_.candidates.size() - first, 1, [&](std::size_t k) { look_from(first + k); });
  }

  void look_from(std::size_t c) {
    for (std::size_t t = 0; t < table_.targets; ++t)
      if (sees(table_.candidates[c], table_.places[t])) set(table_.rows[c], t);
    for (std::size_t k = 0; k < table_.walls; ++k)
      if (input_.walls->sees(input_.truth, table_.candidates[c], k)) set(table_.wall_rows[c], k);
  }

  void look_at_places() {
    const std::size_t count = table_.candidates.size();
    for (Bits& row : table_.rows) row.resize(words(table_.targets + count));
    parallel_for(count, 1, [&](std::size_t c) {
      for (std::size_t other = 0; other < count; ++other)
        if (sees(table_.candidates[c], table_.candidates[other])) set(table_.rows[c], table_.targets + other);
    });
  }

 private:
  const SightInput<Dim>& input_;
  SightTable<Dim>& table_;
};

/// Draws the places, then fills the table.
template <int Dim>
class TableBuilder {
 public:
  TableBuilder(const SightInput<Dim>& input, const OracleOptions& options)
      : input_(input), options_(options), random_(static_cast<std::uint64_t>(options.seed)), looker_(input_, table_) {}

  SightTable<Dim> build(const Vec<Dim>& start) {
    const Reference<Dim>& reference = input_.reference;
    const Grid<Dim>& grid = reference.nodes.window;
    const auto counting = nodes_where(reference, [](const Truth& t) { return t.counts(); });
    for (const std::size_t i : draw(counting, static_cast<std::size_t>(options_.targets), random_)) table_.places.push_back(grid.position(i));
    table_.targets = table_.places.size();
    table_.walls = input_.walls != nullptr ? input_.walls->places.size() : 0;
    table_.candidates.push_back(start);
    const auto reachable = nodes_where(reference, [](const Truth& t) { return t.reachable; });
    for (const std::size_t i : draw(reachable, static_cast<std::size_t>(options_.candidates), random_)) table_.candidates.push_back(grid.position(i));
    looker_.look_at_targets();
    add_missing_views();
    looker_.look_at_places();
    return std::move(table_);
  }

 private:
  /// Places that see what none of the candidates sees, 32 at a time since one of them sees many.
  void add_missing_views() {
    const auto directions = fixed_directions<Dim>(input_.reference.options.rays);
    const std::size_t limit = 2 * table_.candidates.size();
    const auto room = [&] { return std::min<std::size_t>(32, limit - table_.candidates.size()); };
    for (auto missing = unseen(table_.rows, table_.targets); !missing.empty() && room() > 0; missing = unseen(table_.rows, table_.targets)) {
      const std::vector<std::size_t> tried = draw(missing, room(), random_);
      std::vector<std::optional<std::size_t>> views(tried.size());
      parallel_for(tried.size(), 1,
                   [&](std::size_t k) { views[k] = find_view<Dim>(input_.reference, input_.truth, table_.places[tried[k]], directions); });
      const std::size_t first = table_.candidates.size();
      for (const auto& view : views)
        if (view) table_.candidates.push_back(input_.reference.nodes.window.position(*view));
      if (table_.candidates.size() == first) break;
      looker_.look_at_targets();
    }
    for (auto missing = unseen(table_.wall_rows, table_.walls); !missing.empty() && room() > 0; missing = unseen(table_.wall_rows, table_.walls)) {
      for (const std::size_t k : draw(missing, room(), random_)) table_.candidates.push_back(input_.walls->views[k]);
      looker_.look_at_targets();
    }
  }

  SightInput<Dim> input_;
  OracleOptions options_;
  Random random_;
  SightTable<Dim> table_;
  Looker<Dim> looker_;
};

}  // namespace

void describe(OracleOptions& o, const OptionVisitor& visit) {
  visit("targets", o.targets, "", Range{1, 1e8}, "reference nodes the oracle looks at");
  visit("candidates", o.candidates, "", Range{1, 1e6}, "reachable places the oracle may scan from");
  visit("seed", o.seed, "", Range{0, 9e15}, "of the choice of both");
}

template <int Dim>
SightTable<Dim> make_sight_table(const SightInput<Dim>& input, const Vec<Dim>& start, const OracleOptions& options) {
  check_options(options, "audit.oracle");
  return TableBuilder<Dim>(input, options).build(start);
}

template <int Dim>
void move_start(SightTable<Dim>& table, const SightInput<Dim>& input, const Vec<Dim>& start) {
  Looker<Dim> looker(input, table);
  table.candidates[0] = start;
  std::ranges::fill(table.rows[0], 0);
  std::ranges::fill(table.wall_rows[0], 0);
  looker.look_from(0);
  for (std::size_t c = 0; c < table.candidates.size(); ++c) {
    clear(table.rows[c], table.targets);
    if (looker.sees(start, table.candidates[c])) set(table.rows[0], table.targets + c);
    if (looker.sees(table.candidates[c], start)) set(table.rows[c], table.targets);
  }
}

template struct SightTable<2>;
template struct SightTable<3>;
template SightTable<2> make_sight_table<2>(const SightInput<2>&, const Vec<2>&, const OracleOptions&);
template SightTable<3> make_sight_table<3>(const SightInput<3>&, const Vec<3>&, const OracleOptions&);
template void move_start<2>(SightTable<2>&, const SightInput<2>&, const Vec<2>&);
template void move_start<3>(SightTable<3>&, const SightInput<3>&, const Vec<3>&);

}  // namespace vantage

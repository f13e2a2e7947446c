// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/regions.h"

#include <algorithm>
#include <cstring>

#include "vantage/base/parallel.h"

namespace vantage {
namespace {

/// Union of sets of runs; the least member stands for a set.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    for (std::size_t i = 0; i < count; ++i) parent_[i] = static_cast<std::uint32_t>(i);
  }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// Appends the runs of ones in a row.
template <class Run>
void add_runs(std::span<const std::uint8_t> members, std::vector<Run>& runs) {
  const std::uint8_t *begin = members.data(), *end = begin + members.size(), *at = begin;
  while (at != end) {
    const auto* first = static_cast<const std::uint8_t*>(std::memchr(at, 1, static_cast<std::size_t>(end - at)));
    if (first == nullptr) return;
    const auto* last = static_cast<const std::uint8_t*>(std::memchr(first, 0, static_cast<std::size_t>(end - first)));
    at = last == nullptr ? end : last;
    runs.push_back({static_cast<std::uint32_t>(first - begin), static_cast<std::uint32_t>(at - begin), 0});
  }
}

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
Regions<Dim>::Regions(const Grid<Dim>& window, const std::function<void(std::size_t, std::span<std::uint8_t>)>& fill) : window_(window) {
  constexpr std::size_t kRows = 256;
  const std::size_t length = row_length(), rows = length > 0 ? window.size() / length : 0;
  std::vector<std::vector<Run>> parts((rows + kRows - 1) / kRows);
  first_run_.assign(rows + 1, 0);
  parallel_chunks(rows, kRows, [&](std::size_t begin, std::size_t end) {
    std::vector<Run>& part = parts[begin / kRows];
    std::vector<std::uint8_t> members(length);
    for (std::size_t r = begin; r < end; ++r) {
      fill(r * length, members);
      const std::size_t before = part.size();
      add_runs(members, part);
      first_run_[r + 1] = part.size() - before;
    }
  });
  for (std::size_t r = 0; r < rows; ++r) first_run_[r + 1] += first_run_[r];
  runs_.reserve(first_run_[rows]);
  for (const std::vector<Run>& part : parts) runs_.insert(runs_.end(), part.begin(), part.end());

  Sets sets(runs_.size());
  for (int a = 1; a < Dim; ++a) {
    const std::size_t step = window.stride(a) / length;
    for (std::size_t r = 0; r + step < rows; ++r) {
      if (window.local(r * length)[a] + 1 == window.extent[a]) continue;
      std::size_t i = first_run_[r], j = first_run_[r + step];
      while (i < first_run_[r + 1] && j < first_run_[r + step + 1]) {
        if (std::max(runs_[i].begin, runs_[j].begin) < std::min(runs_[i].end, runs_[j].end))
          sets.unite(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
        runs_[i].end < runs_[j].end ? ++i : ++j;
      }
    }
  }
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const std::uint32_t first = sets.find(static_cast<std::uint32_t>(i));
    runs_[i].region = first == i ? static_cast<std::int32_t>(count_++) : runs_[first].region;
  }
}

template <int Dim>
  requires SpatialDim<Dim>
std::int32_t Regions<Dim>::region_of(std::size_t node) const {
  const std::span<const Run> runs = row(node / row_length());
  const auto place = static_cast<std::uint32_t>(node % row_length());
  const auto behind = std::upper_bound(runs.begin(), runs.end(), place, [](std::uint32_t p, const Run& run) { return p < run.begin; });
  return behind != runs.begin() && place < (behind - 1)->end ? (behind - 1)->region : -1;
}

template class Regions<2>;
template class Regions<3>;

}  // namespace vantage

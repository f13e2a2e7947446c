// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/fewest_scans.h"

#include <algorithm>
#include <numeric>

#include "vantage/cover/fewest.h"

namespace vantage {
namespace {

/// What the start does not see is to be seen from the others. Candidate c of the table is set c - 1.
template <int Dim>
CoverProblem problem_of(const SightTable<Dim>& table, std::size_t spare) {
  std::vector<std::uint32_t> left;
  for (std::uint32_t t = 0; t < table.targets; ++t)
    if (!table.sees(0, t)) left.push_back(t);
  CoverProblem problem;
  std::vector<char> in_view(left.size());
  for (std::size_t c = 1; c < table.candidates.size(); ++c) {
    auto& set = problem.sets.emplace_back();
    for (std::uint32_t i = 0; i < left.size(); ++i)
      if (table.sees(c, left[i])) set.push_back(i), in_view[i] = 1;
  }
  problem.need.assign(in_view.begin(), in_view.end());
  const auto never = static_cast<std::size_t>(std::count(in_view.begin(), in_view.end(), 0));
  problem.spare = spare - std::min(spare, never);
  return problem;
}

/// The most gainful first.
Choice in_greedy_order(const CoverProblem& problem, Choice choice) {
  std::sort(choice.begin(), choice.end());
  CoverProblem chosen{{}, problem.need, 0};
  for (const std::size_t c : choice) chosen.sets.push_back(problem.sets[c]);
  for (std::size_t i = 0; i < chosen.need.size(); ++i) chosen.need[i] = 0;
  for (const auto& set : chosen.sets)
    for (const std::uint32_t i : set) chosen.need[i] = 1;
  Choice order;
  for (const std::size_t k : greedy_cover(chosen)) order.push_back(choice[k]);
  return order;
}

}  // namespace

template <int Dim>
std::optional<FewestScans> fewest_scans(const SightTable<Dim>& table, const OracleRun& greedy, double share, std::int64_t work) {
  const auto scans = greedy.scans_to(share);
  if (!scans) return std::nullopt;
  std::size_t seen = table.targets;
  while (seen > 0 && static_cast<double>(seen - 1) / static_cast<double>(table.targets) >= share) --seen;
  const CoverProblem problem = problem_of(table, table.targets - seen);
  Choice known;
  for (std::int64_t k = 1; k < *scans; ++k) known.push_back(greedy.places[static_cast<std::size_t>(k)] - 1);
  const FewestCover fewest = fewest_cover(problem, known, work);
  FewestScans result{1 + static_cast<std::int64_t>(fewest.at_least), 1.0 + fewest.relaxation, {0}};
  for (const std::size_t c : in_greedy_order(problem, fewest.choice)) result.places.push_back(c + 1);
  return result;
}

template std::optional<FewestScans> fewest_scans<2>(const SightTable<2>&, const OracleRun&, double, std::int64_t);
template std::optional<FewestScans> fewest_scans<3>(const SightTable<3>&, const OracleRun&, double, std::int64_t);

}  // namespace vantage

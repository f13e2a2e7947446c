// SPDX-License-Identifier: Apache-2.0
#include "vantage/cover/bound.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "vantage/base/parallel.h"

namespace vantage {
namespace {

constexpr double kSlack = 1e-6;  // Far above the rounding of the sums, far below one station.

/// Demands that are best left short at these prices: the dearest.
std::vector<char> left_short(const CoverProblem& problem, const std::vector<double>& prices) {
  std::vector<char> dropped(prices.size());
  if (problem.spare == 0) return dropped;
  std::vector<std::size_t> order(prices.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::size_t count = std::min(problem.spare, order.size());
  const auto dearer = [&](std::size_t a, std::size_t b) {
    const double x = problem.need[a] * prices[a], y = problem.need[b] * prices[b];
    return x != y ? x > y : a < b;
  };
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count) - 1, order.end(), dearer);
  for (std::size_t k = 0; k < count; ++k) dropped[order[k]] = 1;
  return dropped;
}

/// The bound that prices give, and its slope by each price.
struct Dual {
  double value = 0.0;
  std::vector<double> slope;
};

Dual evaluate(const CoverProblem& problem, const std::vector<double>& prices) {
  std::vector<double> load(problem.sets.size());
  parallel_for(load.size(), 16, [&](std::size_t c) {
    for (const std::uint32_t i : problem.sets[c]) load[c] += prices[i];
  });
  const std::vector<char> dropped = left_short(problem, prices);
  Dual dual{0.0, std::vector<double>(prices.size())};
  for (std::size_t i = 0; i < prices.size(); ++i) {
    if (dropped[i]) continue;
    dual.value += problem.need[i] * prices[i];
    dual.slope[i] = problem.need[i];
  }
  for (std::size_t c = 0; c < load.size(); ++c) {
    if (load[c] <= 1.0) continue;
    dual.value += 1.0 - load[c];
    for (const std::uint32_t i : problem.sets[c]) dual.slope[i] -= 1.0;
  }
  return dual;
}

/// Prices that no candidate's demands exceed in sum: a demand costs its share of the largest set it is in.
std::vector<double> first_prices(const CoverProblem& problem) {
  std::vector<double> prices(problem.need.size(), kSlack);
  std::vector<std::size_t> largest(problem.need.size());
  for (const auto& set : problem.sets)
    for (const std::uint32_t i : set) largest[i] = std::max(largest[i], set.size());
  for (std::size_t i = 0; i < prices.size(); ++i) prices[i] = largest[i] > 0 ? 1.0 / static_cast<double>(largest[i]) : 0.0;
  return prices;
}

}  // namespace

CoverBound cover_bound(const CoverProblem& problem, std::size_t best_known, int steps) {
  constexpr int kPatience = 100;
  CoverBound best{0.0, 0, first_prices(problem)};
  std::vector<double> prices = best.prices;
  double stride = 1.5;
  for (int step = 0, idle = 0; step < steps; ++step) {
    const Dual dual = evaluate(problem, prices);
    ++idle;
    if (dual.value > best.value + 1e-4) idle = 0;
    if (dual.value > best.value) best.value = dual.value, best.prices = prices;
    if (idle >= kPatience) idle = 0, stride *= 0.7, prices = best.prices;
    double squares = 0.0;
    for (std::size_t i = 0; i < prices.size(); ++i) squares += prices[i] > 0.0 || dual.slope[i] > 0.0 ? dual.slope[i] * dual.slope[i] : 0.0;
    if (!(squares > 0.0) || best.value > static_cast<double>(best_known) - kSlack) break;
    const double length = stride * std::max(static_cast<double>(best_known) - dual.value, 0.1) / squares;
    for (std::size_t i = 0; i < prices.size(); ++i) prices[i] = std::max(0.0, prices[i] + length * dual.slope[i]);
  }
  best.candidates = static_cast<std::size_t>(std::ceil(best.value - kSlack));
  return best;
}

}  // namespace vantage

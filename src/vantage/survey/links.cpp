// SPDX-License-Identifier: Apache-2.0
#include "vantage/survey/links.h"

#include <algorithm>
#include <bit>

#include "vantage/base/parallel.h"

namespace vantage {
namespace {

constexpr std::size_t kNone = ~std::size_t{0};

bool contains(const Choice& choice, std::size_t candidate) { return std::find(choice.begin(), choice.end(), candidate) != choice.end(); }

}  // namespace

Links::Links(const CoverProblem& problem, std::size_t count, double share) {
  for (const auto& set : problem.sets) {
    const auto end = std::lower_bound(set.begin(), set.end(), static_cast<std::uint32_t>(count));
    bits_.push_back(as_bits({set.begin(), end}, count));
    size_.push_back(static_cast<std::size_t>(end - set.begin()));
  }
  if (share <= 0.0) return;
  links_.assign(size_.size(), std::vector<std::uint64_t>((size_.size() + 63) / 64));
  parallel_for(links_.size(), 8, [&](std::size_t earlier) {
    for (std::size_t later = 0; later < size_.size(); ++later)
      if (overlap(earlier, later) >= share) links_[earlier][later / 64] |= std::uint64_t{1} << (later % 64);
  });
}

double Links::overlap(std::size_t earlier, std::size_t later) const {
  std::size_t both = 0;
  for (std::size_t w = 0; w < bits_[later].size(); ++w) both += static_cast<std::size_t>(std::popcount(bits_[earlier][w] & bits_[later][w]));
  return size_[later] == 0 ? 1.0 : static_cast<double>(both) / static_cast<double>(size_[later]);
}

bool Links::in_order(const Choice& order) const {
  for (std::size_t k = 1; k < order.size(); ++k)
    if (std::none_of(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(k), [&](std::size_t e) { return linked(e, order[k]); })) return false;
  return true;
}

Choice Links::reached(const Choice& choice, std::size_t root) const {
  Choice found{root};
  for (std::size_t k = 0; k < found.size(); ++k)
    for (const std::size_t c : choice)
      if (!contains(found, c) && linked(found[k], c)) found.push_back(c);
  return found;
}

Choice Links::unlinked(const Choice& choice) const {
  Choice most;
  for (const std::size_t root : choice) {
    if (contains(most, root)) continue;  // It reaches no more than what it is reached from.
    Choice found = reached(choice, root);
    if (found.size() > most.size()) most = std::move(found);
    if (most.size() == choice.size()) return {};
  }
  Choice rest;
  std::copy_if(choice.begin(), choice.end(), std::back_inserter(rest), [&](std::size_t c) { return !contains(most, c); });
  return rest;
}

Choice Links::roots(const Choice& choice) const {
  Choice all;
  for (const std::size_t root : choice)
    if (reached(choice, root).size() == choice.size()) all.push_back(root);
  return all;
}

Choice Links::joined(Choice choice) const {
  for (Choice apart = unlinked(choice); !apart.empty(); apart = unlinked(choice)) {
    std::vector<std::size_t> before(size_.size(), kNone);  // Breadth first over all candidates, from those that hang together.
    Choice front;
    for (const std::size_t c : choice)
      if (!contains(apart, c)) front.push_back(c), before[c] = c;
    std::size_t end = kNone;
    for (std::size_t k = 0; k < front.size() && end == kNone; ++k)
      for (std::size_t c = 0; c < size_.size() && end == kNone; ++c) {
        if (before[c] != kNone || !linked(front[k], c)) continue;
        before[c] = front[k];
        front.push_back(c);
        if (contains(apart, c)) end = c;
      }
    if (end == kNone) return choice;
    for (std::size_t c = before[end]; before[c] != c; c = before[c]) choice.push_back(c);
  }
  return choice;
}

}  // namespace vantage

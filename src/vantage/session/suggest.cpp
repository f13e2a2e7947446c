// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/suggest.h"

#include <algorithm>
#include <vector>

namespace vantage {
namespace {

/// Edit distance in which swapping two neighbours counts once (optimal string alignment).
std::size_t edits(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

}  // namespace

std::string nearest_name(std::string_view word, std::span<const std::string> names) {
  constexpr std::size_t kLongest = 80;  // Longer words are no slips of the finger.
  if (word.size() > kLongest) return {};
  std::string best;
  std::size_t fewest = word.size() / 3 + 2;
  for (const std::string& name : names)
    if (const std::size_t distance = edits(word, name); distance < fewest) {
      fewest = distance;
      best = name;
    }
  return best;
}

std::string did_you_mean(std::string_view word, std::span<const std::string> names) {
  const std::string name = nearest_name(word, names);
  return name.empty() ? "" : ": did you mean " + name + "?";
}

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <string_view>

namespace vantage {

/// Of the names, the one most like `word`: fewest letters changed, added, dropped or swapped with a neighbour; empty if none is near.
[[nodiscard]] std::string nearest_name(std::string_view word, std::span<const std::string> names);

/// ": did you mean NAME?" or nothing.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string> names);

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace vantage {

/// The JSON of a file that anyone may have written. Throws bad_input naming `WHERE:OFFSET`, counted from `begin`: no JSON, or one that nests deeper
/// than 100, since whatever copies or walks it calls itself; memory. `Json` is nlohmann::json, or ordered_json, which keeps the order of members.
template <class Json = nlohmann::json>
[[nodiscard]] Json parse_json(std::string_view bytes, std::string_view where, std::size_t begin = 0);

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>

#include "vantage/exchange/exchange_map.h"
#include "vantage/session/clouds.h"
#include "vantage/session/result.h"

namespace vantage {

/// Scans of one source as deltas, each with what it adds to the ones before, after those that `onto` holds of this source. Throws bad_input for a
/// tolerance [m] or a name that no delta may have, or scans of another dimension than `onto`.
[[nodiscard]] ExchangeMap published_scans(const AnyScans& scans, const std::string& source, double tolerance, const ExchangeMap& onto);

/// `{"kind": "exchanged map", …}`: counts, bytes, certified errors [m], sources, hash. Every delta is decoded. Throws bad_input, naming `where`.
[[nodiscard]] Json describe_map(const ExchangeMap& map, const std::string& where);

/// The patches of a map as a .ply file's bytes, or .glb's if `path` says so.
[[nodiscard]] std::string map_as_surface(const ExchangeMap& map, const std::string& path, const std::string& where);

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string_view>

namespace vantage {

/// From this code on, systems are the user's own.
inline constexpr int kUserDefinedEpsg = 32767;

/// The EPSG code of the projected coordinate system in well-known text, that which stands last in it: AUTHORITY["EPSG","25832"] or
/// ID["EPSG",25832]. None: the text holds none, or not by a code.
[[nodiscard]] std::optional<int> wkt_epsg(std::string_view wkt);

/// The same of a text that is well-known text or a name, EPSG:25832 or urn:ogc:def:crs:EPSG::25832.
[[nodiscard]] std::optional<int> crs_epsg(std::string_view text);

}  // namespace vantage

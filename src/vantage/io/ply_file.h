// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// What a PLY file holds: elements (vertex, face, edge …), each with named columns.
struct Ply {
  enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

  struct Property {
    std::string name;
    Type type = Type::float32;
    std::optional<Type> count_type;      ///< A list whose length has this type.
    std::vector<double> values;          ///< One a row, or the rows of a list one after the other; empty if not wanted.
    std::vector<std::size_t> row_start;  ///< Of a list: row i is values[row_start[i] .. row_start[i + 1]).
  };
  struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;
    [[nodiscard]] const Property* find(std::string_view property) const;
  };

  std::string format;                 ///< "ascii", "binary_little_endian" or "binary_big_endian".
  std::vector<std::string> comments;  ///< Without the word `comment`.
  std::vector<Element> elements;
  [[nodiscard]] const Element* find(std::string_view element) const;
};

/// The header alone; the data has begun at `data_offset`. Throws bad_input naming `where:line`.
[[nodiscard]] Ply parse_ply_header(std::string_view bytes, std::string_view where, std::size_t& data_offset);

/// Header and the columns for which `wanted(element, property)` holds. Every size is checked against the bytes there before memory is taken.
/// Throws bad_input naming `where:offset` (binary) or `where:line` (ascii).
[[nodiscard]] Ply parse_ply(std::string_view bytes, std::string_view where, const std::function<bool(std::string_view, std::string_view)>& wanted);

}  // namespace vantage

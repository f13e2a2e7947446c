// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/io/bytes.h"

namespace vantage {

/// CRC-32C (Castagnoli), the checksum of E57's pages.
[[nodiscard]] std::uint32_t checksum_castagnoli(std::string_view bytes);

/// The contents of an E57 file, its pages joined without their checksums.
class E57Pages {
 public:
  /// Verifies header and every page. Throws bad_input naming `where:offset`.
  explicit E57Pages(FileBytes file);
  /// Place among the contents of a place of the file.
  [[nodiscard]] std::uint64_t logical(std::uint64_t physical, std::string_view what) const;
  /// Reads of the contents; offsets in messages are those of the contents.
  [[nodiscard]] FileBytes contents() const { return {contents_, where_}; }
  [[nodiscard]] std::string_view xml() const;

 private:
  std::string contents_;
  std::string_view where_;
};

/// A field of an E57 record, as the prototype in the XML part describes it.
struct E57Field {
  enum class Type { integer, float32, float64, text };
  std::string name;
  Type type = Type::float64;
  std::int64_t low = 0, high = 0;    ///< Range of an integer.
  double scale = 1.0, offset = 0.0;  ///< value = integer * scale + offset.
  /// Bits a record takes.
  [[nodiscard]] unsigned bits() const;
};

/// The bytes of every field of a compressed vector, joined over its packets; those of fields that are not `wanted` stay empty. `begin`: of the
/// section, in the contents. `room`: bytes that no section has used yet; no two may share theirs. Throws bad_input.
[[nodiscard]] std::vector<std::string> e57_streams(const E57Pages& pages, std::uint64_t begin, const std::vector<bool>& wanted, std::uint64_t& room);

/// Record i of a field. The caller has checked that the stream holds it.
[[nodiscard]] double e57_value(const E57Field& field, std::string_view stream, std::uint64_t record);

}  // namespace vantage

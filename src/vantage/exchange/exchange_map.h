// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <vector>

#include "vantage/exchange/delta.h"

namespace vantage {

/// A set of deltas, and nothing more: merging is the union of sets, so it does not matter who exchanges what with whom, in which order, how often.
/// Vehicles that hold the same deltas have the same bytes, and the same hash.
class ExchangeMap {
 public:
  /// A delta with its name and its bytes.
  struct Entry {
    Digest id;          ///< SHA-256 of the bytes.
    std::string bytes;  ///< delta_bytes().
    Delta delta;
    std::size_t offset = 0;  ///< Of the bytes in the file they were read from; 0 if from none.
  };

  /// Adds a delta, unless it is there; false then. Throws bad_input for one of another dimension.
  bool add(const Delta& delta);
  /// Adds all deltas of another map.
  void merge(const ExchangeMap& other);
  /// The deltas that `other` does not hold: what to send to its owner.
  [[nodiscard]] ExchangeMap without(const ExchangeMap& other) const;

  /// Ordered by source, number, id.
  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }
  [[nodiscard]] bool empty() const { return entries_.empty(); }
  /// 0 for an empty map.
  [[nodiscard]] int dim() const { return entries_.empty() ? 0 : entries_.front().delta.dim; }
  /// The whole file; a pure function of the set.
  [[nodiscard]] std::string bytes() const;
  /// SHA-256 of bytes(), as `sha256sum` prints for the file.
  [[nodiscard]] Digest hash() const { return sha256(bytes()); }

 private:
  std::vector<Entry> entries_;
  friend ExchangeMap parse_map(std::string_view bytes, std::string_view where);
  bool insert(Entry entry, std::string_view where);
};

/// How a map file begins.
inline constexpr std::string_view kMapMagic = "VANTMAP2";

/// Throws bad_input, naming `where` and the offset, for anything that `ExchangeMap::bytes` does not write: every byte is under a checksum.
[[nodiscard]] ExchangeMap parse_map(std::string_view bytes, std::string_view where);
[[nodiscard]] ExchangeMap read_map(const std::filesystem::path& path);

/// Certificate of a map: of every source's scans against the patches of the map, if no scan before its last one is missing.
struct MapCertificate {
  double data_to_surface = 0.0, surface_to_data = 0.0;  ///< Largest of the deltas [m].
  std::uint64_t missing = 0;                            ///< Scans of the sources that others refer to and that are not here.
};
[[nodiscard]] MapCertificate certificate(const ExchangeMap& map);

/// All patches of the map, those of the same leaf once, with the errors of their deltas. `Dim` is the map's. Throws bad_input for a code that is
/// none.
template <int Dim>
[[nodiscard]] std::vector<Patch<Dim>> map_patches(const ExchangeMap& map, std::string_view where);

}  // namespace vantage

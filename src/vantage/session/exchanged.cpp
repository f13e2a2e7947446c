// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/exchanged.h"

#include "vantage/base/error.h"
#include "vantage/exchange/publisher.h"
#include "vantage/io/glb.h"
#include "vantage/io/patch_file.h"

namespace vantage {
namespace {

/// What a source has sent, as one row.
Json source_row(std::span<const ExchangeMap::Entry> entries) {
  std::uint64_t points = 0, bytes = 0;
  for (const ExchangeMap::Entry& entry : entries) {
    points += entry.delta.points;
    bytes += entry.bytes.size();
  }
  return {{"deltas", entries.size()},
          {"first", entries.front().delta.number},
          {"last", entries.back().delta.number},
          {"points", points},
          {"bytes", bytes}};
}

Json sources(std::span<const ExchangeMap::Entry> entries) {
  Json rows = Json::object();
  for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
    while (end < entries.size() && entries[end].delta.source == entries[begin].delta.source) ++end;
    rows[entries[begin].delta.source] = source_row(entries.subspan(begin, end - begin));
  }
  return rows;
}

template <int Dim>
void add_patches(const ExchangeMap& map, const std::string& where, Json& json) {
  std::int64_t by_rank[3] = {0, 0, 0};
  double area = 0.0;
  Box<3> box;
  for (const Patch<Dim>& patch : map_patches<Dim>(map, where)) {
    ++by_rank[patch.rank()];
    area += measure(patch);
  }
  for (const ExchangeMap::Entry& entry : map.entries())
    if (entry.delta.points > 0) box.extend(entry.delta.bounds);
  json["polygons"] = by_rank[2];
  json["segments"] = by_rank[1];
  json["points"] = by_rank[0];
  json["measure"] = area;
  if (!box.empty()) json["bounds"] = Json::array({to_json<Dim>(box.low.head<Dim>()), to_json<Dim>(box.high.head<Dim>())});
}

}  // namespace

ExchangeMap published_scans(const AnyScans& scans, const std::string& source, double tolerance, const ExchangeMap& onto) {
  ExchangeMap map = onto;
  std::visit(
      [&]<int Dim>(const std::vector<ScannedPoints<Dim>>& all) {
        Publisher<Dim> publisher(source, tolerance);
        publisher.resume(map);
        for (const ScannedPoints<Dim>& scan : all) map.add(publisher.publish(scan.points));
      },
      scans);
  return map;
}

Json describe_map(const ExchangeMap& map, const std::string& where) {
  const std::string bytes = map.bytes();
  const MapCertificate errors = certificate(map);
  Json json = {{"kind", "exchanged map"}, {"dim", map.dim()}, {"deltas", map.entries().size()}, {"bytes", bytes.size()}};
  if (map.dim() == 2) add_patches<2>(map, where, json);
  if (map.dim() == 3) add_patches<3>(map, where, json);
  json["data_to_surface_m"] = errors.data_to_surface;
  json["surface_to_data_m"] = errors.surface_to_data;
  json["missing_deltas"] = errors.missing;
  json["sources"] = sources(map.entries());
  json["sha256"] = as_hex(sha256(bytes));
  return json;
}

std::string map_as_surface(const ExchangeMap& map, const std::string& path, const std::string& where) {
  const auto bytes = [&]<int Dim>(const std::vector<Patch<Dim>>& patches) {
    return path.ends_with(".glb") ? surface_as_glb<Dim>(patches, {}) : patches_as_ply<Dim>(patches);
  };
  return map.dim() == 2 ? bytes(map_patches<2>(map, where)) : bytes(map_patches<3>(map, where));
}

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#include "vantage/exchange/exchange_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "vantage/base/error.h"
#include "vantage/exchange/published.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/bytes.h"

namespace vantage {
namespace {

/// Bytes of the file before the deltas: magic, number of deltas, checksum of both; of a delta's frame: length before, checksum behind.
constexpr std::size_t kHeader = 16, kLength = 4, kChecksum = 4;

auto order(const ExchangeMap::Entry& entry) { return std::tie(entry.delta.source, entry.delta.number, entry.id); }

float rounded_up(double value) {
  const auto near = static_cast<float>(value);
  return static_cast<double>(near) >= value ? near : std::nextafter(near, std::numeric_limits<float>::infinity());
}

/// Leaves of one lattice that were met before.
template <int Dim>
class Seen {
 public:
  /// What of `leaves` is new.
  [[nodiscard]] Leaves<Dim> unseen(const Leaves<Dim>& leaves) {
    Leaves<Dim> fresh;
    for (const PlaneLeaf<Dim>& plane : leaves.planes)
      if (planes_.insert({plane.level, plane.cell, plane.axis, plane.height}).second) fresh.planes.push_back(plane);
    for (const SiteLeaf<Dim>& leaf : leaves.sites) {
      SiteLeaf<Dim> rest{leaf.cell, 0};
      for (const unsigned center : {0U, 1U})
        if ((leaf.sites >> center & 1U) != 0 && sites_.insert(site_number<Dim>(leaf.cell, center != 0), 0))
          rest.sites |= static_cast<std::uint8_t>(1U << center);
      if (rest.sites != 0) fresh.sites.push_back(rest);
    }
    return fresh;
  }

 private:
  CellTable<Dim> sites_;
  std::set<std::tuple<int, CellNumber<Dim>, int, std::array<std::int32_t, Dim>>> planes_;
};

}  // namespace

bool ExchangeMap::insert(Entry entry, std::string_view where) {
  require(empty() || dim() == entry.delta.dim, fmt::format("a map of {} dimensions beside one of {}", entry.delta.dim, dim()), where);
  const auto at = std::lower_bound(entries_.begin(), entries_.end(), entry, [](const Entry& a, const Entry& b) { return order(a) < order(b); });
  if (at != entries_.end() && at->id == entry.id) return false;
  entries_.insert(at, std::move(entry));
  return true;
}

bool ExchangeMap::add(const Delta& delta) {
  std::string bytes = delta_bytes(delta);
  const Digest id = sha256(bytes);
  return insert({id, std::move(bytes), delta, 0}, {});
}

void ExchangeMap::merge(const ExchangeMap& other) {
  for (const Entry& entry : other.entries_) insert(entry, {});
}

ExchangeMap ExchangeMap::without(const ExchangeMap& other) const {
  ExchangeMap rest;
  std::set_difference(entries_.begin(), entries_.end(), other.entries_.begin(), other.entries_.end(), std::back_inserter(rest.entries_),
                      [](const Entry& a, const Entry& b) { return order(a) < order(b); });
  return rest;
}

std::string ExchangeMap::bytes() const {
  std::string out(kMapMagic);
  put<std::uint32_t>(out, static_cast<std::uint32_t>(entries_.size()));
  put<std::uint32_t>(out, checksum(out));
  for (const Entry& entry : entries_) {
    require(entry.bytes.size() <= 0xffffffffU, "a delta of more than 4 GiB");
    std::string frame;
    put<std::uint32_t>(frame, static_cast<std::uint32_t>(entry.bytes.size()));
    out += frame;
    out += entry.bytes;
    put<std::uint32_t>(out, checksum(entry.bytes, checksum(frame)));
  }
  return out;
}

ExchangeMap parse_map(std::string_view bytes, std::string_view where) {
  const auto here = [&](std::size_t offset) { return fmt::format("{}:{}", where, offset); };
  require(bytes.starts_with(kMapMagic.substr(0, kMapMagic.size() - 1)), "not a map of vantage", here(0));
  require(bytes.starts_with(kMapMagic), "a map of another version: 2 is known", here(kMapMagic.size() - 1));
  require(bytes.size() >= kHeader, "the file ends in its header", here(bytes.size()));
  require(checksum(bytes.substr(0, kHeader - kChecksum)) == get<std::uint32_t>(bytes, kHeader - kChecksum), "wrong checksum of the header",
          here(kHeader - kChecksum));
  const auto count = get<std::uint32_t>(bytes, kMapMagic.size());
  ExchangeMap map;
  std::size_t at = kHeader;
  for (std::uint32_t i = 0; i < count; ++i) {
    require(bytes.size() - at >= kLength + kChecksum, fmt::format("the file ends before delta {} of {}", i + 1, count), here(bytes.size()));
    const std::size_t size = get<std::uint32_t>(bytes, at);
    require(size <= bytes.size() - at - kLength - kChecksum, fmt::format("delta {} of {} bytes exceeds the file", i + 1, size), here(at));
    require(checksum(bytes.substr(at, kLength + size)) == get<std::uint32_t>(bytes, at + kLength + size),
            fmt::format("wrong checksum of delta {}", i + 1), here(at + kLength + size));
    const std::string_view body = bytes.substr(at + kLength, size);
    ExchangeMap::Entry entry{sha256(body), std::string(body), parse_delta(body, where, at + kLength), at + kLength};
    require(map.empty() || order(map.entries_.back()) < order(entry), fmt::format("delta {} is out of order", i + 1), here(at));
    map.insert(std::move(entry), here(at));
    at += kLength + size + kChecksum;
  }
  require(at == bytes.size(), fmt::format("{} bytes behind the last delta", bytes.size() - at), here(at));
  return map;
}

ExchangeMap read_map(const std::filesystem::path& path) { return parse_map(read_file(path), path.string()); }

MapCertificate certificate(const ExchangeMap& map) {
  MapCertificate all;
  std::map<std::pair<std::string, double>, std::set<std::uint32_t>> numbers;  // Of each source and tolerance: they build on one another.
  for (const ExchangeMap::Entry& entry : map.entries()) {
    const Delta& delta = entry.delta;
    all.data_to_surface = std::max(all.data_to_surface, delta.data_to_surface);
    all.surface_to_data = std::max(all.surface_to_data, delta.surface_to_data);
    numbers[{delta.source, delta.tolerance}].insert(delta.number);
  }
  for (const auto& [source, held] : numbers) all.missing += std::uint64_t{*held.rbegin()} + 1 - held.size();
  return all;
}

template <int Dim>
std::vector<Patch<Dim>> map_patches(const ExchangeMap& map, std::string_view where) {
  std::vector<Patch<Dim>> all;
  std::map<double, Seen<Dim>> seen;  // By the spacing.
  for (const ExchangeMap::Entry& entry : map.entries()) {
    const Delta& delta = entry.delta;
    const Leaves<Dim> fresh = seen[delta.spacing].unseen(decoded<Dim>(delta, fmt::format("{}:{}", where, entry.offset)));
    for (Patch<Dim>& patch : patches<Dim>({delta.spacing}, fresh)) {
      patch.data_to_surface = rounded_up(delta.data_to_surface);
      patch.surface_to_data = rounded_up(delta.surface_to_data);
      all.push_back(patch);
    }
  }
  return all;
}

template std::vector<Patch<2>> map_patches(const ExchangeMap&, std::string_view);
template std::vector<Patch<3>> map_patches(const ExchangeMap&, std::string_view);

}  // namespace vantage

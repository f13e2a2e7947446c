// SPDX-License-Identifier: Apache-2.0
#include "vantage/exchange/delta.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "vantage/base/error.h"
#include "vantage/io/bytes.h"

namespace vantage {
namespace {

constexpr std::size_t kLongestSource = 64;
constexpr double kFinest = 1e-6, kCoarsest = 1e3;  ///< Of the tolerance [m].
constexpr double kFarthest = 1e12;                 ///< Of the bounds [m].

bool is_printable(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

void check(const Delta& d, std::string_view where) {
  require(d.dim == 2 || d.dim == 3, fmt::format("dimension {}: must be 2 or 3", d.dim), where);
  require(!d.source.empty() && d.source.size() <= kLongestSource && is_printable(d.source), "the source's name must be 1 to 64 printable characters",
          where);
  require(d.tolerance >= kFinest && d.tolerance <= kCoarsest, fmt::format("tolerance = {}: must be {} .. {} [m]", d.tolerance, kFinest, kCoarsest),
          where);
  require(d.spacing >= kFinest && d.spacing <= 4.0 * kCoarsest,
          fmt::format("spacing = {}: must be {} .. {} [m]", d.spacing, kFinest, 4.0 * kCoarsest), where);
  for (const double error : {d.data_to_surface, d.surface_to_data})
    require(error >= 0.0 && error <= d.tolerance, fmt::format("certified error = {}: must be 0 .. {} [m], the tolerance", error, d.tolerance), where);
  require(d.new_points <= d.points, fmt::format("{} new points of {}", d.new_points, d.points), where);
  for (int a = 0; a < 3; ++a) {
    const double low = d.bounds.low[a], high = d.bounds.high[a];
    const bool none = d.points == 0 && low == kInfinity && high == -kInfinity;
    require(none || (low <= high && low >= -kFarthest && high <= kFarthest), fmt::format("bounds {} .. {}: no interval", low, high), where);
  }
}

/// Reads fields one after the other; each is there before it is read.
class Fields {
 public:
  Fields(std::string_view bytes, std::string_view where, std::size_t start) : bytes_(bytes), where_(where), start_(start) {}
  template <class Number>
  [[nodiscard]] Number number() {
    return get<Number>(text(sizeof(Number)), 0);
  }
  [[nodiscard]] std::string_view text(std::size_t size) {
    require(size <= bytes_.size() - at_, fmt::format("{} bytes are missing", size - (bytes_.size() - at_)), here());
    at_ += size;
    return bytes_.substr(at_ - size, size);
  }
  [[nodiscard]] std::string_view rest() { return text(bytes_.size() - at_); }
  [[nodiscard]] std::string here() const { return fmt::format("{}:{}", where_, start_ + at_); }

 private:
  std::string_view bytes_, where_;
  std::size_t start_, at_ = 0;
};

}  // namespace

std::string delta_bytes(const Delta& d) {
  check(d, {});
  std::string out;
  put<std::uint8_t>(out, static_cast<std::uint8_t>(d.dim));
  put<std::uint8_t>(out, static_cast<std::uint8_t>(d.source.size()));
  out += d.source;
  put<std::uint32_t>(out, d.number);
  for (const double value : {d.tolerance, d.spacing, d.data_to_surface, d.surface_to_data}) put<double>(out, value);
  for (const std::uint64_t value : {d.points, d.new_points}) put<std::uint64_t>(out, value);
  for (int a = 0; a < d.dim; ++a) put<double>(out, d.bounds.low[a]);
  for (int a = 0; a < d.dim; ++a) put<double>(out, d.bounds.high[a]);
  for (const std::size_t value : {d.counts.planes, d.counts.cells}) {
    require(value <= 0xffffffffU, "too many leaves");
    put<std::uint32_t>(out, static_cast<std::uint32_t>(value));
  }
  return out + d.code;
}

Delta parse_delta(std::string_view bytes, std::string_view where, std::size_t start) {
  Fields fields(bytes, where, start);
  Delta d;
  d.dim = fields.number<std::uint8_t>();
  require(d.dim == 2 || d.dim == 3, fmt::format("dimension {}: must be 2 or 3", d.dim), fields.here());
  d.source = fields.text(fields.number<std::uint8_t>());
  d.number = fields.number<std::uint32_t>();
  for (double* value : {&d.tolerance, &d.spacing, &d.data_to_surface, &d.surface_to_data}) *value = fields.number<double>();
  for (std::uint64_t* value : {&d.points, &d.new_points}) *value = fields.number<std::uint64_t>();
  if (d.dim == 2 && d.points > 0) d.bounds.low[2] = d.bounds.high[2] = 0.0;
  for (int a = 0; a < d.dim; ++a) d.bounds.low[a] = fields.number<double>();
  for (int a = 0; a < d.dim; ++a) d.bounds.high[a] = fields.number<double>();
  for (std::size_t* value : {&d.counts.planes, &d.counts.cells}) *value = fields.number<std::uint32_t>();
  check(d, fields.here());
  d.code = fields.rest();
  return d;
}

template <int Dim>
Leaves<Dim> decoded(const Delta& delta, std::string_view where) {
  require(delta.dim == Dim, fmt::format("a delta of {} dimensions, read as one of {}", delta.dim, Dim), where);
  return decode_leaves<Dim>(delta.code, delta.counts, where);
}

template Leaves<2> decoded(const Delta&, std::string_view);
template Leaves<3> decoded(const Delta&, std::string_view);

}  // namespace vantage

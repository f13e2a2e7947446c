// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "vantage/io/e57.h"

namespace vantage {
namespace {

constexpr std::uint64_t kSectionHeader = 32, kPacketHeader = 6;
enum Packet : std::uint8_t { kIndexPacket = 0, kDataPacket = 1, kEmptyPacket = 2 };

/// Where a section ends and its packets begin.
struct Section {
  std::uint64_t packets = 0, end = 0;
};

Section parse_section(const FileBytes& contents, const E57Pages& pages, std::uint64_t begin) {
  if (const auto id = contents.number<std::uint8_t>(begin, "a compressed vector"); id != 1)
    contents.fail(begin, fmt::format("section {}: a compressed vector, 1, must stand here", id));
  const auto length = contents.number<std::uint64_t>(begin + 8, "a compressed vector");
  (void)contents.part(begin, length, "a compressed vector");
  if (length < kSectionHeader) contents.fail(begin + 8, fmt::format("a compressed vector of {} bytes: must be {} or more", length, kSectionHeader));
  const std::uint64_t packets = pages.logical(contents.number<std::uint64_t>(begin + 16, "a compressed vector"), "a data packet");
  if (packets < begin + kSectionHeader || packets > begin + length) contents.fail(begin + 16, "the packets begin outside their section");
  return {packets, begin + length};
}

/// Appends the parts of a data packet to the streams.
void take_packet(const FileBytes& contents, std::uint64_t begin, std::uint64_t length, const std::vector<bool>& wanted,
                 std::vector<std::string>& streams) {
  const std::uint64_t count = contents.number<std::uint16_t>(begin + 4, "a data packet");
  if (count != wanted.size()) contents.fail(begin + 4, fmt::format("{} streams in a packet, the prototype has {}", count, wanted.size()));
  std::uint64_t at = kPacketHeader + 2 * count;
  if (at > length) contents.fail(begin, fmt::format("a packet of {} bytes cannot hold {} stream lengths", length, count));
  for (std::uint64_t k = 0; k < count; ++k) {
    const auto size = contents.number<std::uint16_t>(begin + kPacketHeader + 2 * k, "a data packet");
    if (size > length - at) contents.fail(begin, fmt::format("streams exceed their packet of {} bytes", length));
    if (wanted[k]) streams[k] += contents.part(begin + at, size, "a data packet");
    at += size;
  }
}

std::uint64_t raw_bits(std::string_view stream, std::uint64_t first_bit, unsigned bits) {
  const std::uint64_t byte = first_bit / 8;
  const unsigned shift = first_bit % 8;
  char window[9] = {};
  std::memcpy(window, stream.data() + byte, std::min<std::uint64_t>(sizeof(window), stream.size() - byte));
  const std::string_view view(window, sizeof(window));
  std::uint64_t value = get<std::uint64_t>(view, 0) >> shift;
  if (shift > 0) value |= static_cast<std::uint64_t>(static_cast<std::uint8_t>(window[8])) << (64 - shift);
  return bits == 64 ? value : value & ((std::uint64_t{1} << bits) - 1);
}

}  // namespace

unsigned E57Field::bits() const {
  if (type == Type::float32) return 32;
  if (type == Type::float64) return 64;
  return static_cast<unsigned>(std::bit_width(static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low)));
}

std::vector<std::string> e57_streams(const E57Pages& pages, std::uint64_t begin, const std::vector<bool>& wanted, std::uint64_t& room) {
  const FileBytes contents = pages.contents();
  const Section section = parse_section(contents, pages, begin);
  if (section.end - begin > room) contents.fail(begin, "two compressed vectors share their bytes");
  room -= section.end - begin;
  std::vector<std::string> streams(wanted.size());
  for (std::uint64_t at = section.packets; at < section.end;) {
    const auto type = contents.number<std::uint8_t>(at, "a packet");
    if (type > kEmptyPacket) contents.fail(at, fmt::format("packet of type {}: must be 0, 1 or 2", type));
    const std::uint64_t length = std::uint64_t{contents.number<std::uint16_t>(at + 2, "a packet")} + 1;
    if (length % 4 != 0 || length > section.end - at) contents.fail(at, fmt::format("a packet of {} bytes exceeds its section", length));
    if (type == kDataPacket) take_packet(contents, at, length, wanted, streams);
    at += length;
  }
  return streams;
}

double e57_value(const E57Field& field, std::string_view stream, std::uint64_t record) {
  if (field.type == E57Field::Type::float32) return static_cast<double>(get<float>(stream, 4 * record));
  if (field.type == E57Field::Type::float64) return get<double>(stream, 8 * record);
  const unsigned bits = field.bits();
  const std::uint64_t raw = bits == 0 ? 0 : raw_bits(stream, record * bits, bits);
  const auto integer = static_cast<std::int64_t>(static_cast<std::uint64_t>(field.low) + raw);
  return static_cast<double>(integer) * field.scale + field.offset;
}

}  // namespace vantage

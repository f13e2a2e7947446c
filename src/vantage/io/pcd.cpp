// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "vantage/base/error.h"
#include "vantage/io/bytes.h"
#include "vantage/io/point_cloud_formats.h"
#include "vantage/io/records.h"
#include "vantage/io/text.h"
#include "vantage/io/text_scanner.h"

namespace vantage {
namespace {

/// One field of a point: a column, or several side by side.
struct PcdField {
  std::string name;
  std::size_t size = 4, count = 1;
  char type = 'F';
  std::size_t column = 0;  ///< Of its first number, among the words of a line.
  std::size_t offset = 0;  ///< Of its first byte in a record.
};

struct PcdHeader {
  std::vector<PcdField> fields;
  std::uint64_t points = 0;
  std::string data;
  std::size_t data_offset = 0, lines = 0;
  std::uint64_t width = 0, height = 0;
  std::size_t columns = 0, record = 0;
  std::array<double, 7> viewpoint{0, 0, 0, 1, 0, 0, 0};  ///< Place, then the quaternion w x y z.

  [[nodiscard]] const PcdField* find(std::string_view name) const {
    const auto it = std::find_if(fields.begin(), fields.end(), [&](const PcdField& f) { return f.name == name; });
    return it == fields.end() ? nullptr : &*it;
  }
};

[[noreturn]] void fail(const std::string& message, std::string_view where, std::size_t place) {
  throw Error(ErrorCode::bad_input, message, fmt::format("{}:{}", where, place));
}

std::uint64_t whole_number(std::string_view word, std::string_view key, std::string_view where, std::size_t line) {
  const std::optional<std::uint64_t> value = to_number<std::uint64_t>(word);
  if (!value) fail(fmt::format("{} {}: must be a whole number", key, printable(word)), where, line);
  return *value;
}

/// Fills one attribute of every field from the rest of a header line.
template <class Set>
void each_field(PcdHeader& header, std::string_view rest, Set&& set) {
  for (PcdField& field : header.fields) set(field, take_word(rest));
}

void parse_viewpoint(std::string_view rest, PcdHeader& header, std::string_view where) {
  for (double& value : header.viewpoint) {
    const std::string_view word = take_word(rest);
    const std::optional<double> number = to_number<double>(word);
    if (!number || !std::isfinite(*number)) fail(fmt::format("VIEWPOINT {}: must be seven numbers", printable(word)), where, header.lines);
    value = *number;
  }
}

void parse_line(std::string_view key, std::string_view rest, PcdHeader& header, std::string_view where) {
  const std::size_t line = header.lines;
  if (key == "FIELDS") {
    for (std::string_view name = take_word(rest); !name.empty(); name = take_word(rest)) header.fields.push_back({.name = std::string(name)});
  } else if (key == "SIZE") {
    each_field(header, rest, [&](PcdField& f, std::string_view w) { f.size = whole_number(w, key, where, line); });
  } else if (key == "TYPE") {
    each_field(header, rest, [&](PcdField& f, std::string_view w) { f.type = w.empty() ? '?' : w.front(); });
  } else if (key == "COUNT") {
    each_field(header, rest, [&](PcdField& f, std::string_view w) { f.count = whole_number(w, key, where, line); });
  } else if (key == "POINTS") {
    header.points = whole_number(take_word(rest), key, where, line);
  } else if (key == "DATA") {
    header.data = take_word(rest);
  } else if (key == "VIEWPOINT") {
    parse_viewpoint(rest, header, where);
  } else if (key == "WIDTH" || key == "HEIGHT") {
    (key == "WIDTH" ? header.width : header.height) = to_number<std::uint64_t>(take_word(rest)).value_or(0);
  } else if (key != "VERSION") {
    fail(fmt::format("{}: not a header line of PCD", printable(key)), where, line);
  }
}

void finish_header(PcdHeader& header, std::string_view where) {
  for (PcdField& field : header.fields) {
    const bool known = (field.type == 'F' && (field.size == 4 || field.size == 8)) ||
                       ((field.type == 'I' || field.type == 'U') && (field.size == 1 || field.size == 2 || field.size == 4 || field.size == 8));
    if (!known || field.count > 65536)
      fail(fmt::format("field {}: type {}, size {}, count {} is not known", printable(field.name), printable(std::string(1, field.type)), field.size,
                       field.count),
           where, header.lines);
    field.column = header.columns;
    field.offset = header.record;
    header.columns += field.count;
    header.record += field.size * field.count;
  }
  for (const char* axis : {"x", "y"})
    if (header.find(axis) == nullptr || header.find(axis)->count == 0) fail(fmt::format("no field {}", axis), where, header.lines);
}

PcdHeader parse_header(std::string_view bytes, std::string_view where) {
  PcdHeader header;
  TextScanner scanner(bytes.substr(0, 1 << 16));
  const std::size_t length = scanner.remaining();
  while (const std::optional<std::string_view> line = scanner.next_line()) {
    header.lines = scanner.line();
    std::string_view rest = *line;
    const std::string_view key = take_word(rest);
    if (key.empty() || key.front() == '#') continue;
    parse_line(key, rest, header, where);
    if (key != "DATA") continue;
    header.data_offset = length - scanner.remaining();
    finish_header(header, where);
    return header;
  }
  fail("the file ends within the header", where, header.lines);
}

NumberType type_of(const PcdField& field) {
  if (field.type == 'F') return field.size == 4 ? NumberType::float32 : NumberType::float64;
  const bool plus = field.type == 'U';
  switch (field.size) {
    case 1: return plus ? NumberType::uint8 : NumberType::int8;
    case 2: return plus ? NumberType::uint16 : NumberType::int16;
    case 4: return plus ? NumberType::uint32 : NumberType::int32;
    default: return plus ? NumberType::uint64 : NumberType::int64;
  }
}

std::vector<Vec<3>> read_ascii(std::string_view bytes, const PcdHeader& header, std::string_view where) {
  TextScanner scanner(bytes.substr(header.data_offset), header.lines);
  if (header.points > scanner.remaining()) fail(fmt::format("{} points exceed the file", header.points), where, header.lines);
  std::vector<Vec<3>> points;
  points.reserve(header.points);
  std::vector<double> row;
  while (points.size() < header.points) {
    const std::optional<std::string_view> line = scanner.next_line();
    if (!line) fail(fmt::format("the file ends after {} of {} points", points.size(), header.points), where, scanner.line());
    std::string_view rest = *line;
    row.clear();
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
      const std::optional<double> value = to_number<double>(word);
      if (!value) fail(fmt::format("{}: not a number", printable(word)), where, scanner.line());
      row.push_back(*value);
    }
    if (row.empty()) continue;
    if (row.size() < header.columns) fail(fmt::format("{} numbers, the header announces {}", row.size(), header.columns), where, scanner.line());
    Vec<3> p = Vec<3>::Zero();
    for (int a = 0; a < 3; ++a)
      if (const PcdField* field = header.find(std::string_view("xyz").substr(static_cast<std::size_t>(a), 1))) p[a] = row[field->column];
    points.push_back(p);
  }
  return points;
}

/// Points from fixed records (binary) or from one column after the other (binary_compressed).
std::vector<Vec<3>> read_records(std::string_view data, const PcdHeader& header, bool by_column, std::string_view where) {
  PointColumns columns;
  for (std::size_t a = 0; a < 3; ++a) {
    const PcdField* field = header.find(std::string_view("xyz").substr(a, 1));
    if (field == nullptr || field->count == 0) continue;
    const std::size_t begin = by_column ? checked_product(field->offset, header.points, where) : field->offset;
    columns[a] = NumberColumn{begin, by_column ? field->size * field->count : header.record, type_of(*field)};
  }
  return widen_points(data, header.points, columns, where);
}

/// LZF, as PCL writes it: a control byte below 32 announces literals, else a copy from behind.
std::string decompress(std::string_view in, std::size_t size, std::string_view where, std::size_t offset) {
  std::string out;
  out.reserve(size);
  std::size_t i = 0;
  const auto next = [&] {
    if (i >= in.size()) fail("the compressed data ends too soon", where, offset + i);
    return static_cast<std::size_t>(static_cast<std::uint8_t>(in[i++]));
  };
  while (i < in.size()) {
    const std::size_t control = next();
    if (control < 32) {
      if (control + 1 > in.size() - i || control + 1 > size - out.size()) fail("the compressed data is damaged", where, offset + i);
      out.append(in.substr(i, control + 1));
      i += control + 1;
      continue;
    }
    std::size_t length = control >> 5;
    if (length == 7) length += next();
    const std::size_t back = ((control & 31) << 8) + next() + 1;
    if (back > out.size() || length + 2 > size - out.size()) fail("the compressed data is damaged", where, offset + i);
    for (std::size_t k = 0; k < length + 2; ++k) out.push_back(out[out.size() - back]);
  }
  if (out.size() != size) fail(fmt::format("the compressed data gives {} bytes instead of {}", out.size(), size), where, offset + i);
  return out;
}

std::vector<Vec<3>> read_compressed(std::string_view bytes, const PcdHeader& header, std::string_view where) {
  const std::string_view data = bytes.substr(header.data_offset);
  if (data.size() < 8) fail("the file ends within the sizes of the compressed data", where, bytes.size());
  const std::size_t packed = get<std::uint32_t>(data, 0), unpacked = get<std::uint32_t>(data, 4);
  if (packed > data.size() - 8) fail(fmt::format("{} compressed bytes exceed the file", packed), where, header.data_offset);
  // A compressed byte stands for fewer than 264 bytes, whatever the header says.
  if (unpacked / 264 > packed || header.points > unpacked / header.record || header.points * header.record != unpacked)
    fail(fmt::format("{} unpacked bytes do not hold {} points of {} bytes", unpacked, header.points, header.record), where, header.data_offset);
  return read_records(decompress(data.substr(8, packed), unpacked, where, header.data_offset + 8), header, true, where);
}

/// The place and turn of the sensor, in the frame of the points; what every writer puts there by default says nothing.
void take_viewpoint(const PcdHeader& header, PointCloud& cloud, std::string_view where) {
  const auto& v = header.viewpoint;
  if (v == PcdHeader{}.viewpoint) return;
  const Eigen::Quaterniond turn(v[3], v[4], v[5], v[6]);
  require(turn.norm() > 0.0 && std::isfinite(turn.norm()), "VIEWPOINT: the quaternion must not be 0", where);
  cloud.position = Vec<3>(v[0], v[1], v[2]);
  cloud.orientation = turn.normalized();
}

/// The points are a table of lines, if the header says so and they are as many.
void take_table(const PcdHeader& header, PointCloud& cloud) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::int32_t>::max();
  if (header.height < 2 || header.width < 2 || header.points > kMost) return;
  if (header.width > header.points || header.points % header.width != 0 || header.points / header.width != header.height) return;
  cloud.width = static_cast<std::int64_t>(header.width);
  cloud.height = static_cast<std::int64_t>(header.height);
}

}  // namespace

PointCloud parse_pcd(std::string_view bytes, std::string_view where) {
  const PcdHeader header = parse_header(bytes, where);
  PointCloud cloud;
  cloud.format = "PCD, " + header.data;
  cloud.dim = header.find("z") == nullptr ? 2 : 3;
  take_viewpoint(header, cloud, where);
  take_table(header, cloud);
  if (header.data == "ascii") {
    cloud.points = read_ascii(bytes, header, where);
  } else if (header.data == "binary") {
    const std::string_view data = bytes.substr(header.data_offset);
    if (header.points > data.size() / header.record)
      fail(fmt::format("{} points of {} bytes exceed the file", header.points, header.record), where, header.data_offset);
    cloud.points = read_records(data, header, false, where);
  } else if (header.data == "binary_compressed") {
    cloud.points = read_compressed(bytes, header, where);
  } else {
    fail(fmt::format("DATA {}: must be ascii, binary or binary_compressed", printable(header.data)), where, header.lines);
  }
  return cloud;
}

}  // namespace vantage

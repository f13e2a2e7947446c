// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "vantage/base/error.h"
#include "vantage/io/text.h"

namespace vantage {
namespace {

enum class Type { i8, u8, i16, u16, i32, u32, f32, f64 };
enum class Format { ascii, little, big };

constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
std::size_t size_of(Type type) { return kSizes[static_cast<std::size_t>(type)]; }

Type parse_type(std::string_view word, const std::string& name) {
  static constexpr std::array<std::array<std::string_view, 2>, 8> kNames{{{"char", "int8"},
                                                                          {"uchar", "uint8"},
                                                                          {"short", "int16"},
                                                                          {"ushort", "uint16"},
                                                                          {"int", "int32"},
                                                                          {"uint", "uint32"},
                                                                          {"float", "float32"},
                                                                          {"double", "float64"}}};
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (word == kNames[i][0] || word == kNames[i][1]) return static_cast<Type>(i);
  throw Error(ErrorCode::bad_input, fmt::format("PLY header: unknown type '{}'", printable(word)), name);
}

struct Property {
  Type type = Type::f32, count_type = Type::u8;
};

struct Header {
  Format format = Format::ascii;
  std::vector<PlyElement> elements;
  std::vector<std::vector<Property>> properties;  ///< Of each element.
};

Format parse_format(std::string_view word, const std::string& name) {
  if (word == "ascii") return Format::ascii;
  if (word == "binary_little_endian") return Format::little;
  require(word == "binary_big_endian", fmt::format("PLY header: unknown format '{}'", printable(word)), name);
  return Format::big;
}

void parse_header_line(std::string_view line, Header& header, const std::string& name) {
  const std::string_view key = next_word(line);
  if (key == "format") {
    header.format = parse_format(next_word(line), name);
  } else if (key == "element") {
    const std::string_view element = next_word(line);
    const auto count = leading_integer(next_word(line));
    require(count && *count >= 0, fmt::format("PLY header: element '{}' has no count", printable(element)), name);
    header.elements.push_back({std::string(element), static_cast<std::size_t>(*count), {}});
    header.properties.emplace_back();
  } else if (key == "property") {
    require(!header.elements.empty(), "PLY header: property before any element", name);
    Property property;
    std::string_view word = next_word(line);
    const bool list = word == "list";
    if (list) {
      property.count_type = parse_type(next_word(line), name);
      require(property.count_type < Type::f32, "PLY header: a list's length must be a whole number", name);
      word = next_word(line);
    }
    property.type = parse_type(word, name);
    header.properties.back().push_back(property);
    header.elements.back().columns.push_back({std::string(next_word(line)), {}, {}, list});
  }  // Comments and what else there may be say nothing about the bytes.
}

/// Cuts the header off `bytes`.
Header parse_header(std::string_view& bytes, const std::string& name) {
  std::string_view first = next_line(bytes);
  require(next_word(first) == "ply", "not a PLY file: its first line is not 'ply'", name);
  Header header;
  for (;;) {
    require(!bytes.empty(), "PLY header: cut short, no 'end_header'", name);
    std::string_view line = next_line(bytes);
    std::string_view rest = line;
    if (next_word(rest) == "end_header") return header;
    parse_header_line(line, header, name);
  }
}

/// Takes numbers off the front of the body.
class Body {
 public:
  Body(std::string_view bytes, Format format, const std::string& name) : bytes_(bytes), size_(bytes.size()), format_(format), name_(name) {}

  [[nodiscard]] double take(Type type) {
    if (format_ == Format::ascii) {
      const auto value = leading_number(next_word(bytes_));
      require(value.has_value(), fmt::format("not a number, or cut short, {} bytes after the PLY header", offset()), name_);
      return *value;
    }
    const std::size_t n = size_of(type);
    require(bytes_.size() >= n, fmt::format("cut short {} bytes after the PLY header", size_), name_);
    std::array<char, 8> raw{};
    std::copy_n(bytes_.data(), n, raw.data());
    if ((format_ == Format::big) != (std::endian::native == std::endian::big))
      std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(n));
    bytes_.remove_prefix(n);
    return decode(type, raw.data());
  }
  /// Throws unless `count` items of at least `properties` numbers may follow.
  void expect(const PlyElement& element, const std::vector<Property>& properties) const {
    std::size_t least = 0;
    for (std::size_t i = 0; i < properties.size(); ++i)
      least += format_ == Format::ascii ? 2 : size_of(element.columns[i].list ? properties[i].count_type : properties[i].type);
    require(
        element.count <= (bytes_.size() + 1) / std::max<std::size_t>(least, 1),
        fmt::format("PLY header: {} items of '{}' are more than the file's {} bytes can hold", element.count, printable(element.name), bytes_.size()),
        name_);
  }
  [[nodiscard]] std::size_t left() const { return bytes_.size(); }
  [[nodiscard]] std::size_t offset() const { return size_ - bytes_.size(); }

 private:
  template <class T>
  static double as(const char* raw) {
    T value;
    std::memcpy(&value, raw, sizeof value);
    return static_cast<double>(value);
  }
  static double decode(Type type, const char* raw) {
    switch (type) {
      case Type::i8: return as<std::int8_t>(raw);
      case Type::u8: return as<std::uint8_t>(raw);
      case Type::i16: return as<std::int16_t>(raw);
      case Type::u16: return as<std::uint16_t>(raw);
      case Type::i32: return as<std::int32_t>(raw);
      case Type::u32: return as<std::uint32_t>(raw);
      case Type::f32: return as<float>(raw);
      case Type::f64: break;
    }
    return as<double>(raw);
  }

  std::string_view bytes_;
  std::size_t size_;
  Format format_;
  const std::string& name_;
};

void take_list(Body& body, const Property& property, PlyColumn& column, const std::string& name) {
  const double length = body.take(property.count_type);
  require(length >= 0.0 && length <= static_cast<double>(body.left()) && length == std::floor(length),
          fmt::format("list length {} exceeds the file, {} bytes after the PLY header", length, body.offset()), name);
  for (double i = 0.0; i < length; ++i) column.values.push_back(body.take(property.type));
  column.ends.push_back(column.values.size());
}

void take_element(Body& body, const std::vector<Property>& properties, PlyElement& element, const std::string& name) {
  if (properties.empty()) return;
  body.expect(element, properties);
  for (PlyColumn& column : element.columns) (column.list ? column.ends.reserve(element.count) : column.values.reserve(element.count));
  for (std::size_t i = 0; i < element.count; ++i)
    for (std::size_t k = 0; k < properties.size(); ++k) {
      if (element.columns[k].list)
        take_list(body, properties[k], element.columns[k], name);
      else
        element.columns[k].values.push_back(body.take(properties[k].type));
    }
}

}  // namespace

const PlyColumn* PlyElement::find(std::string_view column) const {
  const auto found = std::find_if(columns.begin(), columns.end(), [&](const PlyColumn& c) { return c.name == column; });
  return found == columns.end() ? nullptr : &*found;
}

std::vector<PlyElement> parse_ply_elements(std::string_view bytes, const std::string& name) {
  Header header = parse_header(bytes, name);
  Body body(bytes, header.format, name);
  for (std::size_t i = 0; i < header.elements.size(); ++i) take_element(body, header.properties[i], header.elements[i], name);
  return std::move(header.elements);
}

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/ply_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "vantage/base/error.h"
#include "vantage/io/bytes.h"
#include "vantage/io/text_scanner.h"

namespace vantage {
namespace {

using Type = Ply::Type;

constexpr std::size_t kMaxHeaderBytes = 1 << 20;

std::optional<Type> type_of(std::string_view name) {
  constexpr std::pair<std::string_view, Type> kNames[] = {
      {"char", Type::int8},     {"int8", Type::int8},       {"uchar", Type::uint8},    {"uint8", Type::uint8},
      {"short", Type::int16},   {"int16", Type::int16},     {"ushort", Type::uint16},  {"uint16", Type::uint16},
      {"int", Type::int32},     {"int32", Type::int32},     {"uint", Type::uint32},    {"uint32", Type::uint32},
      {"float", Type::float32}, {"float32", Type::float32}, {"double", Type::float64}, {"float64", Type::float64}};
  for (const auto& [text, type] : kNames)
    if (text == name) return type;
  return std::nullopt;
}

std::size_t size_of(Type type) {
  constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<int>(type)];
}

double number_at(std::string_view bytes, std::size_t offset, Type type, std::endian order) {
  switch (type) {
    case Type::int8: return get<std::int8_t>(bytes, offset, order);
    case Type::uint8: return get<std::uint8_t>(bytes, offset, order);
    case Type::int16: return get<std::int16_t>(bytes, offset, order);
    case Type::uint16: return get<std::uint16_t>(bytes, offset, order);
    case Type::int32: return get<std::int32_t>(bytes, offset, order);
    case Type::uint32: return get<std::uint32_t>(bytes, offset, order);
    case Type::float32: return static_cast<double>(get<float>(bytes, offset, order));
    default: return get<double>(bytes, offset, order);
  }
}

/// Reads numbers one after the other, from text or bytes; throws with the place where they end too soon.
class Source {
 public:
  virtual ~Source() = default;
  virtual double number(Type type) = 0;
  /// Fewest bytes that a number of this type takes.
  [[nodiscard]] virtual std::size_t least(Type type) const = 0;
  [[nodiscard]] virtual std::size_t remaining() const = 0;
  [[nodiscard]] virtual std::string place() const = 0;
  [[noreturn]] void fail(const std::string& message) const { throw Error(ErrorCode::bad_input, message, place()); }
};

class BinarySource final : public Source {
 public:
  BinarySource(std::string_view bytes, std::size_t offset, std::endian order, std::string_view where)
      : bytes_(bytes), offset_(offset), order_(order), where_(where) {}
  double number(Type type) override {
    if (size_of(type) > remaining()) fail("the file ends within the data");
    const double value = number_at(bytes_, offset_, type, order_);
    offset_ += size_of(type);
    return value;
  }
  std::size_t least(Type type) const override { return size_of(type); }
  std::size_t remaining() const override { return bytes_.size() - offset_; }
  std::string place() const override { return fmt::format("{}:{}", where_, offset_); }

 private:
  std::string_view bytes_;
  std::size_t offset_;
  std::endian order_;
  std::string_view where_;
};

class TextSource final : public Source {
 public:
  TextSource(std::string_view text, std::size_t line, std::string_view where) : scanner_(text, line), where_(where) {}
  double number(Type) override {
    std::string_view word = take_word(line_);
    while (word.empty()) {
      const std::optional<std::string_view> next = scanner_.next_line();
      if (!next) fail("the file ends within the data");
      line_ = *next;
      word = take_word(line_);
    }
    const std::optional<double> value = to_number<double>(word);
    if (!value) fail(fmt::format("{:.40}: not a number", word));
    return *value;
  }
  std::size_t least(Type) const override { return 1; }
  std::size_t remaining() const override { return scanner_.remaining() + line_.size(); }
  std::string place() const override { return fmt::format("{}:{}", where_, scanner_.line()); }

 private:
  TextScanner scanner_;
  std::string_view line_;
  std::string_view where_;
};

void parse_property(std::string_view line, Ply& ply, const std::string& place) {
  require(!ply.elements.empty(), "property before the first element", place);
  Ply::Property property;
  std::string_view type_name = take_word(line);
  if (type_name == "list") {
    property.count_type = type_of(take_word(line));
    require(property.count_type.has_value() && *property.count_type < Type::float32, "list length: must be a whole-number type", place);
    type_name = take_word(line);
  }
  const std::optional<Type> type = type_of(type_name);
  require(type.has_value(), fmt::format("property type {:.40}: not known", type_name), place);
  property.type = *type;
  property.name = take_word(line);
  require(!property.name.empty(), "property without a name", place);
  ply.elements.back().properties.push_back(std::move(property));
}

void parse_element(std::string_view line, Ply& ply, const std::string& place) {
  Ply::Element element;
  element.name = take_word(line);
  const std::string_view count_text = take_word(line);
  const std::optional<std::uint64_t> count = to_number<std::uint64_t>(count_text);
  require(!element.name.empty() && count.has_value(), fmt::format("element {}: count {:.40}: must be a whole number", element.name, count_text),
          place);
  element.count = *count;
  ply.elements.push_back(std::move(element));
}

/// One header line; false at end_header.
bool parse_header_line(std::string_view line, Ply& ply, const std::string& place) {
  std::string_view rest = line;
  const std::string_view key = take_word(rest);
  if (key == "end_header") return false;
  if (key == "format") {
    ply.format = take_word(rest);
    require(ply.format == "ascii" || ply.format == "binary_little_endian" || ply.format == "binary_big_endian",
            fmt::format("format {:.40}: must be ascii, binary_little_endian or binary_big_endian", ply.format), place);
  } else if (key == "comment" || key == "obj_info") {
    ply.comments.emplace_back(rest.substr(std::min<std::size_t>(rest.size(), 1)));
  } else if (key == "element") {
    parse_element(rest, ply, place);
  } else if (key == "property") {
    parse_property(rest, ply, place);
  } else {
    require(key.empty(), fmt::format("{:.40}: not a header line of PLY", key), place);
  }
  return true;
}

void check_room(const Ply::Element& element, const Source& source) {
  std::size_t least = 0;
  for (const Ply::Property& p : element.properties) least += source.least(p.count_type.value_or(p.type));
  if (least > 0 && element.count > source.remaining() / least)
    source.fail(fmt::format("{} {} elements exceed the file ({} bytes left)", element.count, element.name, source.remaining()));
}

void read_list(Ply::Property& property, Source& source, bool keep) {
  const double length = source.number(*property.count_type);
  if (!(length >= 0.0) || length * static_cast<double>(source.least(property.type)) > static_cast<double>(source.remaining()))
    source.fail(fmt::format("list length {} exceeds the file", length));
  if (length != std::floor(length)) source.fail(fmt::format("list length {}: must be a whole number", length));
  for (std::size_t k = 0; k < static_cast<std::size_t>(length); ++k) {
    const double value = source.number(property.type);
    if (keep) property.values.push_back(value);
  }
  if (keep) property.row_start.push_back(property.values.size());
}

void read_element(Ply::Element& element, Source& source, const std::function<bool(std::string_view, std::string_view)>& wanted) {
  if (element.properties.empty()) return;
  check_room(element, source);
  std::vector<bool> keep;
  for (Ply::Property& property : element.properties) {
    keep.push_back(wanted(element.name, property.name));
    if (!keep.back()) continue;
    property.values.reserve(element.count);
    if (property.count_type) property.row_start.push_back(0);
  }
  for (std::size_t row = 0; row < element.count; ++row)
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      Ply::Property& property = element.properties[p];
      if (property.count_type) {
        read_list(property, source, keep[p]);
      } else {
        const double value = source.number(property.type);
        if (keep[p]) property.values.push_back(value);
      }
    }
}

}  // namespace

const Ply::Property* Ply::Element::find(std::string_view property) const {
  const auto it = std::find_if(properties.begin(), properties.end(), [&](const Property& p) { return p.name == property; });
  return it == properties.end() ? nullptr : &*it;
}

const Ply::Element* Ply::find(std::string_view element) const {
  const auto it = std::find_if(elements.begin(), elements.end(), [&](const Element& e) { return e.name == element; });
  return it == elements.end() ? nullptr : &*it;
}

Ply parse_ply_header(std::string_view bytes, std::string_view where, std::size_t& data_offset) {
  require(!bytes.empty(), "the file is empty", where);
  TextScanner scanner(bytes.substr(0, kMaxHeaderBytes));
  const std::size_t length = scanner.remaining();
  const std::optional<std::string_view> first = scanner.next_line();
  require(first == "ply", "not a PLY file: the first line must be `ply`", where);
  Ply ply;
  while (const std::optional<std::string_view> line = scanner.next_line()) {
    if (parse_header_line(*line, ply, fmt::format("{}:{}", where, scanner.line()))) continue;
    require(!ply.format.empty(), "header without a format line", where);
    data_offset = length - scanner.remaining();
    return ply;
  }
  throw Error(ErrorCode::bad_input, "the file ends within the header", fmt::format("{}:{}", where, scanner.line()));
}

Ply parse_ply(std::string_view bytes, std::string_view where, const std::function<bool(std::string_view, std::string_view)>& wanted) {
  std::size_t offset = 0;
  Ply ply = parse_ply_header(bytes, where, offset);
  const std::size_t header_lines = static_cast<std::size_t>(std::count(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(offset), '\n'));
  const std::endian order = ply.format == "binary_big_endian" ? std::endian::big : std::endian::little;
  std::unique_ptr<Source> source;
  if (ply.format == "ascii")
    source = std::make_unique<TextSource>(bytes.substr(offset), header_lines, where);
  else
    source = std::make_unique<BinarySource>(bytes, offset, order, where);
  for (Ply::Element& element : ply.elements) read_element(element, *source, wanted);
  return ply;
}

}  // namespace vantage

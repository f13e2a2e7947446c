// SPDX-License-Identifier: Apache-2.0
// OBJ, OFF, PLY, STL. Read here rather than by assimp to keep doubles double and to believe no count before its bytes.
#include <fmt/format.h>

#include <array>
#include <cstring>
#include <utility>

#include "vantage/base/error.h"
#include "vantage/io/ply.h"
#include "vantage/io/polygons.h"
#include "vantage/io/text.h"

namespace vantage {
namespace {

/// Three numbers off the front of `text`; throws bad_input "WHAT: not a number".
template <class What>
Vec<3> next_position(std::string_view& text, const std::string& name, const What& what) {
  Vec<3> v;
  for (int a = 0; a < 3; ++a) {
    const auto value = leading_number(next_word(text));
    if (!value) throw Error(ErrorCode::bad_input, fmt::format("{}: needs three numbers", what()), name);
    v[a] = *value;
  }
  return v;
}

std::size_t next_count(std::string_view& text, const std::string& name) {
  const auto count = leading_integer(next_word(text));
  require(count && *count >= 0, "OFF header: needs three counts", name);
  return static_cast<std::size_t>(*count);
}

/// OFF without its comments.
std::string without_comments(std::string_view bytes) {
  std::string clean;
  clean.reserve(bytes.size());
  while (!bytes.empty()) {
    const std::string_view line = next_line(bytes);
    clean += line.substr(0, line.find('#'));
    clean += '\n';
  }
  return clean;
}

std::uint32_t little_u32(const char* bytes) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

float little_f32(const char* bytes) {
  const std::uint32_t bits = little_u32(bytes);
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

constexpr std::size_t kStlHeader = 84, kStlFacet = 50;

Polygons parse_binary_stl(std::string_view bytes, std::size_t count) {
  Polygons polygons;
  polygons.vertices.reserve(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const char* facet = bytes.data() + kStlHeader + i * kStlFacet + 12;  // Behind the normal.
    for (int k = 0; k < 9; k += 3) {
      polygons.corners.push_back(static_cast<std::int64_t>(polygons.vertices.size()));
      polygons.vertices.push_back({little_f32(facet + 4 * k), little_f32(facet + 4 * k + 4), little_f32(facet + 4 * k + 8)});
    }
    polygons.close_polygon();
  }
  return polygons;
}

Polygons parse_ascii_stl(std::string_view bytes, const std::string& name) {
  Polygons polygons;
  const auto where = [&] { return fmt::format("vertex {}", polygons.vertices.size()); };
  bool open = false;
  while (!bytes.empty()) {
    std::string_view line = next_line(bytes);
    const std::string_view key = next_word(line);
    if (key == "vertex") {
      polygons.corners.push_back(static_cast<std::int64_t>(polygons.vertices.size()));
      polygons.vertices.push_back(next_position(line, name, where));
    } else if (key == "outer" || key == "endloop") {
      require(open == (key == "endloop"), fmt::format("facet {}: 'outer loop' and 'endloop' do not alternate", polygons.ends.size()), name);
      open = !open;
      if (!open) polygons.close_polygon();
    }
  }
  require(!open && (polygons.ends.empty() ? polygons.corners.empty() : polygons.ends.back() == polygons.corners.size()), "cut short within a facet",
          name);
  return polygons;
}

}  // namespace

Polygons parse_obj(std::string_view bytes, const std::string& name) {
  Polygons polygons;
  std::int64_t line_number = 0;
  std::string joined;  // Of lines that end in a backslash.
  const auto where = [&] { return fmt::format("line {}", line_number); };
  while (!bytes.empty()) {
    std::string_view line = next_line(bytes);
    ++line_number;
    if (line.ends_with('\\')) {
      joined.append(line.substr(0, line.size() - 1)).push_back(' ');
      if (!bytes.empty()) continue;
      line = {};
    }
    const std::string whole = joined.empty() ? std::string() : std::exchange(joined, {}).append(line);
    if (!whole.empty()) line = whole;
    const std::string_view key = next_word(line);
    if (key == "v") polygons.vertices.push_back(next_position(line, name, where));
    if (key != "f") continue;
    for (std::string_view word = next_word(line); !word.empty() && word[0] != '#'; word = next_word(line)) {
      const auto index = leading_integer(word);
      const auto count = static_cast<std::int64_t>(polygons.vertices.size());
      require(index && *index != 0, fmt::format("line {}: face corner '{}': must be a vertex, 1 .. {}", line_number, printable(word), count), name);
      polygons.corners.push_back(*index > 0 ? *index - 1 : *index + count);  // Negative ones count back from here.
    }
    polygons.close_polygon();
  }
  return polygons;
}

Polygons parse_off(std::string_view bytes, const std::string& name) {
  const std::string clean = without_comments(bytes);
  std::string_view text = clean;
  std::string_view first = next_word(text);
  const bool extras = first.ends_with("COFF") || first.ends_with("NOFF");
  require(first == "OFF" || extras, "not an OFF file: it does not begin with 'OFF'", name);
  const std::size_t vertices = next_count(text, name), faces = next_count(text, name);
  (void)next_line(text);  // The count of edges, of no use.
  require(vertices <= text.size() / 6 && faces <= text.size() / 2,
          fmt::format("OFF header: {} vertices and {} faces are more than the file's {} bytes can hold", vertices, faces, bytes.size()), name);
  Polygons polygons;
  const auto where = [&] { return fmt::format("vertex {}", polygons.vertices.size()); };
  const auto next_item = [&] {  // A line that is not blank.
    std::string_view line;
    while (!text.empty() && line.find_first_not_of(" \t") == std::string_view::npos) line = next_line(text);
    return line;
  };
  while (polygons.vertices.size() < vertices) {
    std::string_view line = next_item();
    polygons.vertices.push_back(next_position(line, name, where));
  }
  while (polygons.ends.size() < faces) {
    std::string_view line = next_item();
    const auto count = leading_integer(next_word(line));
    require(count && *count >= 0 && *count <= static_cast<std::int64_t>(line.size()), fmt::format("face {}: cut short", polygons.ends.size()), name);
    for (std::int64_t i = 0; i < *count; ++i) {
      const auto index = leading_integer(next_word(line));
      require(index.has_value(), fmt::format("face {}: needs {} corners", polygons.ends.size(), *count), name);
      polygons.corners.push_back(*index);
    }
    polygons.close_polygon();
  }
  return polygons;
}

Polygons parse_ply(std::string_view bytes, const std::string& name) {
  Polygons polygons;
  for (const PlyElement& element : parse_ply_elements(bytes, name)) {
    if (element.name == "vertex" && element.count > 0) {
      const std::array<const PlyColumn*, 3> xyz{element.find("x"), element.find("y"), element.find("z")};
      for (const PlyColumn* column : xyz) require(column && !column->list, "PLY header: the vertices lack x, y or z", name);
      for (std::size_t i = 0; i < element.count; ++i) polygons.vertices.push_back({xyz[0]->values[i], xyz[1]->values[i], xyz[2]->values[i]});
    }
    if (element.name == "face" && element.count > 0) {
      const PlyColumn* column = element.find("vertex_indices");
      if (!column) column = element.find("vertex_index");
      require(column && column->list, "PLY header: the faces lack a list 'vertex_indices'", name);
      for (const double index : column->values) polygons.corners.push_back(index >= -1.0 && index < 1e18 ? static_cast<std::int64_t>(index) : -1);
      polygons.ends = column->ends;
    }
  }
  return polygons;
}

Polygons parse_stl(std::string_view bytes, const std::string& name) {
  // Some binary files begin with "solid", too: their size tells.
  const std::size_t count = bytes.size() >= kStlHeader ? little_u32(bytes.data() + 80) : 0;
  if (bytes.size() >= kStlHeader && bytes.size() == kStlHeader + count * kStlFacet) return parse_binary_stl(bytes, count);
  std::string_view rest = bytes;
  if (next_word(rest) == "solid") return parse_ascii_stl(bytes, name);
  require(bytes.size() >= kStlHeader, "not an STL file: neither 'solid' nor a binary header", name);
  require(bytes.size() >= kStlHeader + count * kStlFacet,
          fmt::format("STL header: {} triangles need {} bytes, the file has {}", count, kStlHeader + count * kStlFacet, bytes.size()), name);
  return parse_binary_stl(bytes, count);
}

}  // namespace vantage

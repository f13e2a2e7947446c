// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/gltf_file.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>

#include "vantage/base/error.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/bytes.h"
#include "vantage/io/json_text.h"
#include "vantage/io/polygons.h"
#include "vantage/io/text.h"

namespace vantage {
namespace {

struct Container {
  std::string_view json, binary;
};

/// The chunks of a GLB, or the whole file.
Container open_container(std::string_view bytes, const std::string& name) {
  if (!bytes.starts_with("glTF")) return {bytes, {}};
  const FileBytes file(bytes, name);
  const auto version = file.number<std::uint32_t>(4, "GLB header"), length = file.number<std::uint32_t>(8, "GLB header");
  if (version != 2) file.fail(4, fmt::format("GLB header: version {}: only 2 is read", version));
  if (length > bytes.size()) file.fail(8, fmt::format("GLB header: {} bytes exceed the file", length));
  Container parts;
  parts.json = file.part(20, file.number<std::uint32_t>(12, "GLB header"), "GLB header: its JSON");
  const std::size_t next = 20 + parts.json.size();
  if (bytes.size() >= next + 8 && bytes.substr(next + 4, 4) == std::string_view("BIN\0", 4))
    parts.binary = file.part(next + 8, file.number<std::uint32_t>(next, "GLB chunk"), "GLB chunk BIN");
  return parts;
}

std::optional<std::string> from_base64(std::string_view text) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve(text.size() / 4 * 3);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text.substr(0, text.find_last_not_of('=') + 1)) {
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string_view::npos) return std::nullopt;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    if (++count == 5) count = 1;
    if (count > 1) out += static_cast<char>(bits >> (8 - 2 * count) & 0xff);
  }
  return out;
}

/// A path as a URI has it, `%20` for a blank.
std::string from_percent(std::string_view uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned value = 0;
    const bool coded =
        uri[i] == '%' && i + 2 < uri.size() && std::from_chars(uri.data() + i + 1, uri.data() + i + 3, value, 16).ptr == uri.data() + i + 3;
    out += coded ? static_cast<char>(value) : uri[i];
    if (coded) i += 2;
  }
  return out;
}

}  // namespace

/// How an accessor's numbers lie.
struct GltfFile::Layout {
  std::uint64_t component = 0;  ///< OpenGL's name of the type.
  std::size_t bytes = 0;        ///< Of a number.
  std::size_t numbers = 0;      ///< Of an element.
  bool normalized = false;

  [[nodiscard]] double read(std::string_view data, std::size_t at) const {
    switch (component) {
      case 5120: return normalized ? std::max(get<std::int8_t>(data, at) / 127.0, -1.0) : get<std::int8_t>(data, at);
      case 5121: return get<std::uint8_t>(data, at) / (normalized ? 255.0 : 1.0);
      case 5122: return normalized ? std::max(get<std::int16_t>(data, at) / 32767.0, -1.0) : get<std::int16_t>(data, at);
      case 5123: return get<std::uint16_t>(data, at) / (normalized ? 65535.0 : 1.0);
      case 5125: return get<std::uint32_t>(data, at);
      default: return static_cast<double>(get<float>(data, at));
    }
  }
};

GltfFile::GltfFile(std::string_view bytes, const std::string& name) : name_(name), file_size_(bytes.size()) {
  const Container parts = open_container(bytes, name);
  binary_ = parts.binary;
  json_ = std::make_unique<nlohmann::json>(parse_json(parts.json, name, static_cast<std::size_t>(parts.json.data() - bytes.data())));
  if (!has(root(), "asset")) fail("not a glTF file: lacks 'asset'");
  const std::string version = text(element(root(), "asset"), "version");
  if (!version.starts_with("2.")) fail(fmt::format("glTF {}: only 2.0 is read", printable(version)));
}

GltfFile::~GltfFile() = default;

void GltfFile::fail(const std::string& message) const { throw Error(ErrorCode::bad_input, message, name_); }

bool GltfFile::has(const Part& part, const char* key) { return part.json->is_object() && part.json->contains(key); }

GltfFile::Part GltfFile::element(const Part& part, const char* key) const {
  if (!has(part, key)) fail(fmt::format("{}lacks '{}'", part.place.empty() ? "" : part.place + ": ", key));
  return {&(*part.json)[key], part.place.empty() ? std::string(key) : part.place + "." + key};
}

std::size_t GltfFile::size(const Part& part, const char* key) const {
  if (!has(part, key)) return 0;
  const nlohmann::json& list = (*part.json)[key];
  if (!list.is_array()) fail(fmt::format("{}: must be an array", element(part, key).place));
  return list.size();
}

GltfFile::Part GltfFile::at(const Part& part, const char* key, std::uint64_t index) const {
  const std::string place = fmt::format("{}{}{}[{}]", part.place, part.place.empty() ? "" : ".", key, index);
  const std::size_t count = size(part, key);
  if (index >= count) fail(fmt::format("{} is not there: {} are", place, count));
  return {&(*part.json)[key][index], place};
}

std::string GltfFile::text(const Part& part, const char* key) const {
  const Part found = element(part, key);
  if (!found.json->is_string()) fail(fmt::format("{}: must be a text", found.place));
  return found.json->get<std::string>();
}

double GltfFile::number(const Part& part) const {
  if (!part.json->is_number()) fail(fmt::format("{}: must be a number", part.place));
  return part.json->get<double>();
}

std::uint64_t GltfFile::whole(const Part& part) const {
  const double value = number(part);
  if (!(value >= 0.0 && value < 1e15 && value == std::floor(value))) fail(fmt::format("{} = {}: must be a whole number", part.place, value));
  return static_cast<std::uint64_t>(value);
}

std::uint64_t GltfFile::whole(const Part& part, const char* key, std::uint64_t otherwise) const {
  return has(part, key) ? whole(element(part, key)) : otherwise;
}

std::vector<std::uint64_t> GltfFile::indices(const Part& part, const char* key) const {
  std::vector<std::uint64_t> out;
  for (std::size_t i = 0; i < size(part, key); ++i) out.push_back(whole(at(part, key, i)));
  return out;
}

bool GltfFile::fetch(const Part& part, const char* key, std::size_t count, double* out) const {
  if (!has(part, key)) return false;
  if (size(part, key) != count) fail(fmt::format("{}.{}: must be {} numbers", part.place, key, count));
  for (std::size_t i = 0; i < count; ++i) out[i] = number(at(part, key, i));
  return true;
}

std::vector<double> GltfFile::values(std::uint64_t index, std::string_view type) {
  const Part accessor = at(root(), "accessors", index);
  if (text(accessor, "type") != type) fail(fmt::format("{}.type: must be {}", accessor.place, type));
  const Layout layout = layout_of(accessor, type == "VEC3" ? 3 : 1);
  const std::uint64_t count = whole(element(accessor, "count"));
  std::vector<double> out;
  if (has(accessor, "bufferView")) {
    read_view(accessor, count, layout, out);
  } else {
    if (count > file_size_) fail(fmt::format("{}: {} zeros exceed the file", accessor.place, count));
    out.resize(count * layout.numbers);
  }
  if (has(accessor, "sparse")) replace_some(element(accessor, "sparse"), layout, out);
  return out;
}

GltfFile::Layout GltfFile::layout_of(const Part& part, std::size_t numbers) const {
  const std::uint64_t c = whole(element(part, "componentType"));
  if (!(c >= 5120 && c <= 5126 && c != 5124)) fail(fmt::format("{}.componentType = {}: must be 5120 .. 5123, 5125 or 5126", part.place, c));
  return {c, c <= 5121 ? 1U : c <= 5123 ? 2U : 4U, numbers, has(part, "normalized") && (*part.json)["normalized"] == nlohmann::json(true)};
}

/// `count` elements from the byteOffset and in the bufferView that `part` names.
void GltfFile::read_view(const Part& part, std::uint64_t count, const Layout& layout, std::vector<double>& out) {
  const Part view = at(root(), "bufferViews", whole(element(part, "bufferView")));
  const std::string_view buffer = buffer_bytes(whole(element(view, "buffer")));
  const std::uint64_t begin = whole(view, "byteOffset", 0), length = whole(element(view, "byteLength"));
  if (begin > buffer.size() || length > buffer.size() - begin) fail(fmt::format("{}: {} bytes from {} exceed its buffer", view.place, length, begin));
  const std::size_t each = layout.bytes * layout.numbers;
  const std::uint64_t offset = whole(part, "byteOffset", 0), stride = whole(view, "byteStride", each);
  if (stride < each) fail(fmt::format("{}.byteStride = {}: must be at least {}", view.place, stride, each));
  if (count > 0 && (offset > length || length - offset < each || count - 1 > (length - offset - each) / stride))
    fail(fmt::format("{}: {} elements exceed {}", part.place, count, view.place));
  out.reserve(count * layout.numbers);
  for (std::uint64_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < layout.numbers; ++k) out.push_back(layout.read(buffer, begin + offset + i * stride + k * layout.bytes));
}

/// What a sparse accessor says otherwise.
void GltfFile::replace_some(const Part& sparse, const Layout& layout, std::vector<double>& out) {
  const std::uint64_t count = whole(element(sparse, "count"));
  const Part which = element(sparse, "indices");
  std::vector<double> places, by;
  read_view(which, count, layout_of(which, 1), places);
  read_view(element(sparse, "values"), count, layout, by);
  const std::size_t elements = out.size() / layout.numbers;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!(places[i] >= 0.0 && places[i] < static_cast<double>(elements)))
      fail(fmt::format("{}: {}: must be less than {}", which.place, places[i], elements));
    std::copy_n(by.begin() + static_cast<std::ptrdiff_t>(i * layout.numbers), layout.numbers,
                out.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(places[i]) * layout.numbers));
  }
}

std::string_view GltfFile::buffer_bytes(std::uint64_t index) {
  const Part buffer = at(root(), "buffers", index);
  std::string_view bytes = binary_;
  if (has(buffer, "uri")) {
    const Part uri = element(buffer, "uri");
    if (!uri.json->is_string()) fail(fmt::format("{}: must be a text", uri.place));
    bytes = load(uri.json->get_ref<const std::string&>(), uri.place);
  } else if (index > 0 || binary_.data() == nullptr) {
    fail(fmt::format("{}: lacks 'uri'", buffer.place));
  }
  const std::uint64_t length = whole(element(buffer, "byteLength"));
  if (length > bytes.size()) fail(fmt::format("{}: {} bytes exceed the {} that are there", buffer.place, length, bytes.size()));
  return bytes.substr(0, length);
}

const std::string& GltfFile::load(const std::string& uri, const std::string& place) {
  const auto [entry, fresh] = loaded_.try_emplace(uri);
  if (!fresh) return entry->second;
  if (uri.starts_with("data:")) {
    const std::size_t comma = uri.find(";base64,");
    auto bytes = comma == std::string::npos ? std::nullopt : from_base64(std::string_view(uri).substr(comma + 8));
    if (!bytes) fail(fmt::format("{}: must be base64", place));
    return entry->second = *std::move(bytes);
  }
  const std::filesystem::path file = from_percent(uri), path = std::filesystem::path(name_).parent_path() / file;
  std::error_code error;
  if (file.empty() || file.is_absolute() || file.native().find('\0') != std::string::npos || !std::filesystem::is_regular_file(path, error))
    fail(fmt::format("{}: {}: no such file beside it", place, printable(uri)));
  return entry->second = read_file(path);
}

}  // namespace vantage

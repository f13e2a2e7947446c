// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/zone_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "vantage/base/error.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/geojson.h"
#include "vantage/io/json_text.h"
#include "vantage/io/text.h"

namespace vantage {
namespace {

using Json = nlohmann::json;
using Ring = std::vector<Vec<2>>;

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

/// Gathers the polygons of a GeoJSON text.
class GeoJson {
 public:
  GeoJson(const Json& root, const std::string& file) : root_(root), file_(file) {}

  std::vector<Zone> read() {
    geometry(root_, "");
    require(!zones_.empty(), "no Polygon or MultiPolygon in it", file_);
    check_system();
    return std::move(zones_);
  }

 private:
  [[noreturn]] void fail(const std::string& pointer, const std::string& message) const {
    throw Error(ErrorCode::bad_input, message, file_ + ":" + (pointer.empty() ? "/" : pointer));
  }
  const Json& member(const Json& object, const char* name, const std::string& pointer) const {
    if (!object.is_object()) fail(pointer, "must be an object");
    const auto found = object.find(name);
    if (found == object.end()) fail(pointer, fmt::format("has no \"{}\"", name));
    return *found;
  }
  const Json& list(const Json& value, const std::string& pointer) const {
    if (!value.is_array()) fail(pointer, "must be a list");
    return value;
  }
  void geometry(const Json& object, const std::string& pointer) {
    const Json& kind = member(object, "type", pointer);
    if (kind == "FeatureCollection") return every(object, "features", pointer);
    if (kind == "GeometryCollection") return every(object, "geometries", pointer);
    if (kind == "Feature") {
      const Json& inner = member(object, "geometry", pointer);
      if (!inner.is_null()) geometry(inner, pointer + "/geometry");
      return;
    }
    const std::string place = pointer + "/coordinates";
    if (kind == "Polygon") return polygon(member(object, "coordinates", pointer), place);
    if (kind != "MultiPolygon") return;  // Points and lines bound no area.
    const Json& parts = list(member(object, "coordinates", pointer), place);
    for (std::size_t k = 0; k < parts.size(); ++k) polygon(parts[k], fmt::format("{}/{}", place, k));
  }
  void every(const Json& object, const char* name, const std::string& pointer) {
    const std::string place = pointer + "/" + name;
    const Json& all = list(member(object, name, pointer), place);
    for (std::size_t k = 0; k < all.size(); ++k) geometry(all[k], fmt::format("{}/{}", place, k));
  }
  void polygon(const Json& rings, const std::string& pointer) {
    Zone zone;
    for (std::size_t r = 0; r < list(rings, pointer).size(); ++r) {
      const std::string place = fmt::format("{}/{}", pointer, r);
      Ring& ring = zone.rings.emplace_back();
      for (std::size_t k = 0; k < list(rings[r], place).size(); ++k) ring.push_back(corner(rings[r][k], fmt::format("{}/{}", place, k)));
    }
    try {
      tidy_zone(zone, {});
    } catch (const Error& error) {
      fail(pointer, error.what());
    }
    zones_.push_back(std::move(zone));
  }
  Vec<2> corner(const Json& position, const std::string& pointer) const {
    if (!position.is_array() || position.size() < 2 || !position[0].is_number() || !position[1].is_number()) fail(pointer, "must be [x, y]");
    return {position[0].get<double>(), position[1].get<double>()};
  }
  /// Lengths are wanted; degrees are none.
  void check_system() const {
    const auto crs = root_.find("crs");
    if (crs != root_.end() && crs->is_null()) return;
    if (crs != root_.end()) {
      const Json& name = member(member(*crs, "properties", "/crs"), "name", "/crs/properties");
      if (!name.is_string()) fail("/crs/properties/name", "must be text");
      const std::string text = name.get<std::string>();
      if (lower(text).find("crs84") != std::string::npos)
        fail("/crs/properties/name", "CRS84: longitudes and latitudes; the coordinates of the scans are wanted, in a projected system");
      const std::size_t code = lower(text).rfind("epsg:");
      if (code == std::string::npos) fail("/crs/properties/name", fmt::format("{}: must name EPSG:CODE", printable(text)));
      static_cast<void>(parse_epsg(text.substr(text.rfind(':') + 1), file_ + ":/crs/properties/name"));
      return;
    }
    for (const Zone& zone : zones_)
      for (const Ring& ring : zone.rings)
        for (const Vec<2>& p : ring)
          if (std::abs(p.x()) > 180.0 || std::abs(p.y()) > 90.0) return;
    fail("",
         "has no \"crs\", so its numbers are degrees (RFC 7946): the coordinates of the scans are wanted, with \"crs\" naming a projected EPSG:CODE, "
         "or null, or as .csv");
  }

  const Json& root_;
  const std::string& file_;
  std::vector<Zone> zones_;
};

std::vector<std::string> words_of(std::string_view line) {
  std::vector<std::string> words;
  std::string word;
  for (const char c : std::string(line) + ' ') {
    const bool apart = c == ' ' || c == '\t' || c == ',' || c == ';' || c == '\r';
    if (!apart) word += c;
    if (apart && !word.empty()) words.push_back(std::exchange(word, {}));
  }
  return words;
}

std::optional<double> number_of(const std::string& word) {
  return word.find_first_not_of("0123456789+-.eE") == std::string::npos ? leading_number(word) : std::nullopt;
}

/// Which columns hold x and y.
struct Columns {
  std::size_t x = 0, y = 1, count = 2;
};

Columns columns_of(const std::vector<std::string>& names, const std::string& where) {
  const auto find = [&](std::initializer_list<const char*> wanted) {
    const auto at = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
      return std::any_of(wanted.begin(), wanted.end(), [&](const char* w) { return lower(name) == w; });
    });
    return static_cast<std::size_t>(at - names.begin());
  };
  const Columns columns{find({"x", "east", "easting", "x_m"}), find({"y", "north", "northing", "y_m"}), names.size()};
  require(columns.x < names.size() && columns.y < names.size(), "a corner x,y a line, or a first line that names the columns x and y", where);
  return columns;
}

}  // namespace

std::vector<Zone> parse_geojson_zones(std::string_view text, const std::string& where) {
  const Json root = parse_json(text, where);
  return GeoJson(root, where).read();
}

std::vector<Zone> parse_csv_zones(std::string_view text, const std::string& where) {
  std::vector<Zone> zones;
  std::optional<Columns> columns;
  Ring ring;
  int number = 1, begin = 1;
  const auto close = [&] {
    if (ring.empty()) return;
    zones.push_back({{std::exchange(ring, {})}});
    tidy_zone(zones.back(), fmt::format("{}:{}", where, begin));
  };
  for (; !text.empty(); ++number) {
    const std::vector<std::string> words = words_of(next_line(text));
    const std::string place = fmt::format("{}:{}", where, number);
    if (words.empty()) close();
    if (words.empty() || words.front().front() == '#') continue;
    const bool first = !columns;
    if (first) columns = number_of(words.front()) ? Columns{} : columns_of(words, place);
    if (first && !number_of(words.front())) continue;
    require(words.size() == columns->count, fmt::format("{} columns: must be {}", words.size(), columns->count == 2 ? "x,y" : "as many as named"),
            place);
    Vec<2> corner;
    for (int a = 0; a < 2; ++a) {
      const std::string& word = words[a == 0 ? columns->x : columns->y];
      const std::optional<double> value = number_of(word);
      require(value && std::isfinite(*value), fmt::format("{}: must be a finite number", printable(word)), place);
      corner[a] = *value;
    }
    if (ring.empty()) begin = number;
    ring.push_back(corner);
  }
  close();
  require(!zones.empty(), "no corners in it", where);
  return zones;
}

bool names_zone_file(std::string_view name) {
  const std::string ending = lower(std::filesystem::path(name).extension().string());
  return ending == ".geojson" || ending == ".json" || ending == ".csv" || ending == ".txt";
}

std::vector<Zone> read_zones(const std::filesystem::path& path) {
  const std::string ending = lower(path.extension().string()), text = read_file(path);
  return ending == ".geojson" || ending == ".json" ? parse_geojson_zones(text, path.string()) : parse_csv_zones(text, path.string());
}

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/next_zones.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "vantage/base/error.h"
#include "vantage/io/text.h"
#include "vantage/session/zone_file.h"

namespace vantage {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kForms =
    "must be a box x0,y0,z0,x1,y1,z1, a polygon \"x,y x,y x,y\", or a file .geojson, .json, .csv, .txt; behind a polygon or a file z=LOW..HIGH";

std::string trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\n"), end = text.find_last_not_of(" \t\n");
  return begin == std::string_view::npos ? std::string() : std::string(text.substr(begin, end - begin + 1));
}

std::vector<std::string> parts_of(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    if (const std::string part = trimmed(text.substr(begin, end - begin)); !part.empty()) parts.push_back(part);
    begin = end + 1;
  }
  return parts;
}

double number_of(const std::string& word, const std::string& where) {
  const bool clean = !word.empty() && word.find_first_not_of("0123456789+-.eE") == std::string::npos;
  const double value = clean ? leading_number(word).value_or(kNoNumber) : kNoNumber;
  require(!std::isnan(value), fmt::format("{}: {}", printable(word), kForms), where);
  require(std::isfinite(value), fmt::format("{}: must be finite", printable(word)), where);
  return value;
}

std::vector<double> numbers_of(const std::string& text, const std::string& where) {
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    numbers.push_back(number_of(text.substr(begin, end - begin), where));
    begin = end + 1;
  }
  return numbers;
}

/// What stands before `z=LOW..HIGH`, and the heights.
struct Item {
  std::string body;
  double low = -kInfinity, high = kInfinity;
};

Item item_of(const std::string& text, const std::string& where) {
  const std::size_t at = text.rfind(" z=");
  if (at == std::string::npos) return {text};
  const std::string heights = text.substr(at + 3);
  const std::size_t dots = heights.find("..");
  require(dots != std::string::npos, fmt::format("z={}: must be z=LOW..HIGH", printable(heights)), where);
  Item item{trimmed(text.substr(0, at)), number_of(heights.substr(0, dots), where), number_of(heights.substr(dots + 2), where)};
  require(item.low <= item.high, fmt::format("z={}: the lower height comes first", printable(heights)), where);
  return item;
}

bool is_box(const std::string& text) { return text.find(' ') == std::string::npos; }

Zone polygon_of(const Item& item, const std::string& where) {
  Zone zone{{}, item.low, item.high};
  for (const std::string& ring : parts_of(item.body, '/')) {
    zone.rings.emplace_back();
    for (const std::string& word : parts_of(ring, ' ')) {
      const std::vector<double> p = numbers_of(word, where);
      require(p.size() == 2, fmt::format("{}: must be x,y", printable(word)), where);
      zone.rings.back().emplace_back(p[0], p[1]);
    }
  }
  tidy_zone(zone, where);
  return zone;
}

std::string text_of(const Zone& zone) {
  std::string text;
  for (const auto& ring : zone.rings) {
    if (!text.empty()) text += " /";
    for (const Vec<2>& p : ring) text += fmt::format("{}{},{}", text.empty() ? "" : " ", p.x(), p.y());
  }
  return zone.low > -kInfinity ? fmt::format("{} z={}..{}", text, zone.low, zone.high) : text;
}

/// From the coordinates of scan files.
class ToMetres {
 public:
  explicit ToMetres(const MeasuredOptions& options) : turn_(upright(options.up)), unit_(options.unit) {
    while (turn_(2, up_) == 0.0) ++up_;
  }
  [[nodiscard]] Zone operator()(Zone zone) const {
    for (auto& ring : zone.rings)
      for (Vec<2>& p : ring) {
        Vec<3> q;
        q[up_] = 0.0;
        q[up_ == 0 ? 1 : 0] = p[0];
        q[up_ == 2 ? 1 : 2] = p[1];
        p = (turn_ * q * unit_).head<2>();
      }
    const double up = turn_(2, up_) * unit_, a = up * zone.low, b = up * zone.high;
    zone.low = std::min(a, b);
    zone.high = std::max(a, b);
    return zone;
  }

 private:
  Eigen::Matrix3d turn_;
  double unit_;
  int up_ = 0;
};

}  // namespace

std::string settled_zones(const std::string& text, const MeasuredOptions& options, const std::string& where) {
  const ToMetres to_metres(options);
  std::string settled;
  const auto add = [&](const std::string& zone) { settled += (settled.empty() ? "" : "; ") + zone; };
  for (const std::string& part : parts_of(text, ';')) {
    const Item item = item_of(part, where);
    if (names_zone_file(item.body)) {
      for (Zone& zone : read_zones(item.body)) {
        zone.low = item.low;
        zone.high = item.high;
        add(text_of(to_metres(zone)));
      }
    } else {
      add(is_box(part) ? part : text_of(to_metres(polygon_of(item, where))));
    }
  }
  return settled;
}

template <int Dim>
std::vector<Zone> zones_of(const std::string& text, const std::string& where) {
  std::vector<Zone> zones;
  for (const std::string& part : parts_of(text, ';')) {
    if (!is_box(part)) {
      zones.push_back(polygon_of(item_of(part, where), where));
      continue;
    }
    const std::vector<double> numbers = numbers_of(part, where);
    require(numbers.size() % (2 * Dim) == 0, fmt::format("{} numbers: {} each are wanted", numbers.size(), 2 * Dim), where);
    for (std::size_t k = 0; k < numbers.size(); k += 2 * Dim) {
      const Box<Dim> box{Eigen::Map<const Vec<Dim>>(&numbers[k]), Eigen::Map<const Vec<Dim>>(&numbers[k + Dim])};
      require(!box.empty(), "the low corner must come first, then the high one", where);
      zones.push_back(box_zone<Dim>(box));
    }
  }
  return zones;
}

template std::vector<Zone> zones_of<2>(const std::string&, const std::string&);
template std::vector<Zone> zones_of<3>(const std::string&, const std::string&);

}  // namespace vantage

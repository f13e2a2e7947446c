// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/e57.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <pugixml.hpp>

#include "vantage/base/error.h"
#include "vantage/geometry/angle.h"
#include "vantage/geometry/box.h"
#include "vantage/io/scan_formats.h"
#include "vantage/io/text.h"
#include "vantage/io/text_scanner.h"
#include "vantage/io/wkt.h"

namespace vantage {
namespace {

constexpr std::uint64_t kRaysPerRecord = 64;  // A table of rays with more cells than this a record is not kept.
constexpr double kUnit = 0.01;                // A pose's quaternion may differ from length 1 by so much.

/// Reads XML elements with messages that name them.
class Element {
 public:
  Element(pugi::xml_node node, std::string_view where) : node_(node), where_(where) {}
  [[nodiscard]] bool exists() const { return static_cast<bool>(node_); }
  [[nodiscard]] pugi::xml_node node() const { return node_; }
  [[nodiscard]] Element child(const char* name) const { return {node_.child(name), where_}; }
  [[noreturn]] void fail(const std::string& message) const {
    throw Error(ErrorCode::bad_input, fmt::format("XML element {}: {}", printable(node_.name()), message), std::string(where_));
  }
  /// The text or an attribute as a number; `otherwise` if there is none.
  template <class Number>
  [[nodiscard]] Number number(Number otherwise, const char* attribute = nullptr) const {
    std::string_view text = attribute == nullptr ? node_.text().get() : node_.attribute(attribute).value();
    const std::string_view word = next_word(text);
    if (word.empty()) return otherwise;
    const std::optional<Number> value = to_number<Number>(word);
    if (!value) fail(fmt::format("{}: not a number of this kind", printable(word)));
    return *value;
  }

 private:
  pugi::xml_node node_;
  std::string_view where_;
};

E57Field parse_field(const Element& element) {
  using Type = E57Field::Type;
  E57Field field;
  field.name = element.node().name();
  const std::string_view type = element.node().attribute("type").value();
  if (type == "Integer" || type == "ScaledInteger") {
    field.type = Type::integer;
    field.low = element.number(std::numeric_limits<std::int64_t>::min(), "minimum");
    field.high = element.number(std::numeric_limits<std::int64_t>::max(), "maximum");
    if (field.low > field.high) element.fail(fmt::format("minimum {} above maximum {}", field.low, field.high));
    if (type == "Integer") return field;
    field.scale = element.number(1.0, "scale");
    field.offset = element.number(0.0, "offset");
    if (!std::isfinite(field.scale) || !std::isfinite(field.offset)) element.fail("scale and offset must be finite");
  } else if (type == "Float") {
    const std::string_view precision = element.node().attribute("precision").value();
    if (precision != "" && precision != "double" && precision != "single") element.fail(fmt::format("precision {}: not known", printable(precision)));
    field.type = precision == "single" ? Type::float32 : Type::float64;
  } else if (type == "String") {
    field.type = Type::text;
  } else {
    element.fail(fmt::format("type {}: not known in a record", printable(type)));
  }
  return field;
}

/// The records of a scan that a name asks for; decoded one by one.
class Records {
 public:
  /// `room`: bytes that no scan has used yet.
  Records(const Element& points, const E57Pages& pages, std::uint64_t& room)
      : element_(points), count_(points.number<std::uint64_t>(0, "recordCount")) {
    for (const pugi::xml_node node : points.child("prototype").node().children())
      if (node.type() == pugi::node_element) fields_.push_back(parse_field({node, pages.contents().where()}));
    for (const pugi::xml_node codec : points.child("codecs").node().children())
      if (codec.type() == pugi::node_element && !codec.child("bitPackCodec")) points.fail("a codec other than bitPackCodec");
    streams_.resize(fields_.size());
    if (count_ == 0) return;  // Then the section need not be there.
    const std::uint64_t begin = pages.logical(points.number<std::uint64_t>(0, "fileOffset"), "a compressed vector");
    std::vector<bool> wanted;
    for (const E57Field& field : fields_) wanted.push_back(is_wanted(field.name));
    streams_ = e57_streams(pages, begin, wanted, room);
    check_streams(wanted);
  }
  [[nodiscard]] std::uint64_t count() const { return count_; }
  /// Index of a field, -1: none.
  [[nodiscard]] int find(std::string_view name) const {
    const auto it = std::find_if(fields_.begin(), fields_.end(), [&](const E57Field& f) { return f.name == name; });
    return it == fields_.end() ? -1 : static_cast<int>(it - fields_.begin());
  }
  /// The same, of whole numbers only.
  [[nodiscard]] int find_integer(std::string_view name) const {
    const int field = find(name);
    return field >= 0 && fields_[static_cast<std::size_t>(field)].type == E57Field::Type::integer ? field : -1;
  }
  [[nodiscard]] double value(int field, std::uint64_t record) const {
    const auto k = static_cast<std::size_t>(field);
    return e57_value(fields_[k], streams_[k], record);
  }

 private:
  static bool is_wanted(std::string_view name) {
    return name.starts_with("cartesian") || name.starts_with("spherical") || name == "rowIndex" || name == "columnIndex" || name == "returnIndex";
  }
  void check_streams(const std::vector<bool>& wanted) const {
    bool backed = false;  // By bytes: fields of one value only take none, however many records are announced.
    for (std::size_t k = 0; k < fields_.size(); ++k) {
      if (!wanted[k]) continue;
      if (fields_[k].type == E57Field::Type::text) element_.fail(fmt::format("{} is text", printable(fields_[k].name)));
      const unsigned bits = fields_[k].bits();
      backed = backed || bits > 0;
      if (bits > 0 && count_ > 8 * streams_[k].size() / bits)
        element_.fail(fmt::format("{} records announced, {} has {} bytes", count_, printable(fields_[k].name), streams_[k].size()));
    }
    if (!backed && count_ > 1) element_.fail(fmt::format("{} records announced without any data", count_));
  }

  Element element_;
  std::uint64_t count_ = 0;
  std::vector<E57Field> fields_;
  std::vector<std::string> streams_;
};

Vec<3> from_spherical(double range, double azimuth, double elevation) {
  const auto [sin_a, cos_a] = sin_cos(azimuth);
  const auto [sin_e, cos_e] = sin_cos(elevation);
  return {range * cos_e * cos_a, range * cos_e * sin_a, range * sin_e};
}

/// The three coordinates and the state of every record.
struct Coordinates {
  bool spherical = false;
  int field[3] = {-1, -1, -1};
  int invalid = -1;

  explicit Coordinates(const Records& records, const Element& points) {
    constexpr const char* kNames[2][4] = {{"cartesianX", "cartesianY", "cartesianZ", "cartesianInvalidState"},
                                          {"sphericalAzimuth", "sphericalElevation", "sphericalRange", "sphericalInvalidState"}};
    spherical = records.find(kNames[0][0]) < 0;
    for (int a = 0; a < 3; ++a) {
      field[a] = records.find(kNames[spherical][a]);
      if (field[a] < 0) points.fail("neither cartesianX, Y, Z nor sphericalRange, Azimuth, Elevation");
    }
    invalid = records.find(kNames[spherical][3]);
  }
  [[nodiscard]] Vec<3> point(const Records& records, std::uint64_t i) const {
    const double a = records.value(field[0], i), b = records.value(field[1], i), c = records.value(field[2], i);
    if (!spherical) return {a, b, c};
    return std::abs(a) < kLargestAngle && std::abs(b) < kLargestAngle ? from_spherical(c, a, b) : Vec<3>::Constant(kNaN);
  }
  /// 0: valid, 1: the direction alone, 2: nothing.
  [[nodiscard]] int state(const Records& records, std::uint64_t i) const {
    const double value = invalid < 0 ? 0.0 : records.value(invalid, i);
    return value == 0.0 ? 0 : value == 1.0 ? 1 : 2;
  }

 private:
  static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  static constexpr double kLargestAngle = 1e6;  // [rad]
};

/// Cells of the table of rays, from the row and column of each record.
class RayCells {
 public:
  explicit RayCells(const Records& records)
      : records_(records), row_(records.find_integer("rowIndex")), column_(records.find_integer("columnIndex")) {
    if (row_ < 0 || column_ < 0 || records.count() == 0) return;
    for (std::uint64_t i = 0; i < records.count(); ++i) cells_.extend(cell(i));
    const Vec<2> size = cells_.size() + Vec<2>::Ones();
    const double most = std::min(static_cast<double>(kRaysPerRecord) * static_cast<double>(records.count()),
                                 static_cast<double>(std::numeric_limits<std::int32_t>::max()));
    // The table's indices have 31 bits.
    if (!(size.prod() <= most) || records.count() > static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max())) return;
    table_ = RayTable{static_cast<std::int32_t>(size[1]), static_cast<std::int32_t>(size[0]), {}};
    table_->point.assign(static_cast<std::size_t>(size.prod()), RayTable::kNoData);
  }
  /// Of several returns of a ray the first counts.
  void set(std::uint64_t record, std::int32_t value) {
    if (!table_) return;
    const Vec<2> at = cell(record) - cells_.low;
    std::int32_t& entry = table_->point[static_cast<std::size_t>(at[1]) * static_cast<std::size_t>(table_->rows) + static_cast<std::size_t>(at[0])];
    if (entry < 0) entry = std::max(entry, value);
  }
  [[nodiscard]] std::optional<RayTable> take() { return std::move(table_); }

 private:
  [[nodiscard]] Vec<2> cell(std::uint64_t record) const { return {records_.value(row_, record), records_.value(column_, record)}; }

  const Records& records_;
  int row_, column_;
  Box<2> cells_;
  std::optional<RayTable> table_;
};

/// The standard: an absent pose, or part of one, is the identity.
void read_pose(const Element& pose, MeasuredScan& scan) {
  const Element turn = pose.child("rotation"), shift = pose.child("translation");
  scan.position = Vec<3>(shift.child("x").number(0.0), shift.child("y").number(0.0), shift.child("z").number(0.0));
  if (!scan.position->allFinite()) pose.fail("the translation must be finite");
  if (!turn.exists()) return;
  const Eigen::Quaterniond q(turn.child("w").number(0.0), turn.child("x").number(0.0), turn.child("y").number(0.0), turn.child("z").number(0.0));
  if (!(std::abs(q.norm() - 1.0) < kUnit)) pose.fail(fmt::format("the rotation's quaternion has length {}: must be 1", q.norm()));
  scan.orientation = q.normalized();
}

MeasuredScan parse_scan(const Element& element, const E57Pages& pages, std::uint64_t& room) {
  MeasuredScan scan;
  scan.format = "E57";
  read_pose(element.child("pose"), scan);
  const Element points = element.child("points");
  if (!points.exists()) return scan;
  const Records records(points, pages, room);
  const Coordinates coordinates(records, points);
  RayCells rays(records);
  const Eigen::Matrix3d turn = scan.orientation.toRotationMatrix();
  for (std::uint64_t i = 0; i < records.count(); ++i) {
    const int state = coordinates.state(records, i);
    const Vec<3> p = state == 0 ? Vec<3>(turn * coordinates.point(records, i) + *scan.position) : Vec<3>::Zero();
    const bool finite = p.allFinite();
    scan.not_finite += !finite;
    const bool kept = state == 0 && finite;
    rays.set(i, kept ? static_cast<std::int32_t>(scan.points.size()) : state == 1 ? RayTable::kNoReturn : RayTable::kNoData);
    if (kept) scan.points.push_back(p);
  }
  scan.rays = rays.take();
  return scan;
}

}  // namespace

std::vector<MeasuredScan> parse_e57(FileBytes file) {
  const E57Pages pages(file);
  const std::string_view xml = pages.xml();
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(xml.data(), xml.size());
  if (!parsed)
    throw Error(ErrorCode::bad_input, fmt::format("its XML part, byte {}: {}", parsed.offset, parsed.description()), std::string(file.where()));
  const pugi::xml_node root = document.child("e57Root");
  require(static_cast<bool>(root), "its XML part has no element e57Root", file.where());
  std::vector<MeasuredScan> scans;
  std::uint64_t room = pages.contents().size();
  for (const pugi::xml_node node : root.child("data3D").children())
    if (node.type() == pugi::node_element) scans.push_back(parse_scan(Element(node, file.where()), pages, room));
  // Of the whole file. Damage here costs the system, not the points.
  const std::optional<int> epsg = crs_epsg(root.child("coordinateMetadata").text().get());
  for (MeasuredScan& scan : scans) scan.epsg = epsg;
  return scans;
}

}  // namespace vantage

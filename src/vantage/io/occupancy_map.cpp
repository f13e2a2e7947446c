// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/occupancy_map.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <unordered_map>

#include "vantage/base/error.h"
#include "vantage/geometry/angle.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/image.h"
#include "vantage/io/text.h"

namespace vantage {
namespace {

constexpr std::uint8_t kUnknownShade = 205;  ///< Between ROS's thresholds.

std::string extension_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

/// A YAML file whose values are asked for one by one.
class Keys {
 public:
  Keys(const std::string& text, const std::string& name) : name_(name) {
    require(text.size() <= 1 << 20, "larger than 1 MiB: not a map's description", name_);
    try {
      root_ = YAML::Load(text);
    } catch (const YAML::Exception& e) {
      throw Error(ErrorCode::bad_input, printable(e.msg, 200), fmt::format("{}:{}", name_, e.mark.line + 1));
    }
    require(root_.IsMap(), "not a map's description: must hold 'image: FILE'", name_);
  }
  /// Throws bad_input unless low <= value <= high.
  [[nodiscard]] double number(const YAML::Node& node, const std::string& key, double low, double high) const {
    try {
      const double value = node.as<double>();
      if (value >= low && value <= high) return value;
      require(false, fmt::format("{} = {}: must be {} .. {}", key, value, low, high), name_);
    } catch (const YAML::Exception&) {
      require(false, fmt::format("{}: must be a number", key), name_);
    }
    return 0.0;
  }
  [[nodiscard]] double number(const std::string& key, double fallback, double low, double high) const {
    return root_[key] ? number(root_[key], key, low, high) : fallback;
  }
  [[nodiscard]] std::string image() const {
    const std::string file = root_["image"] && root_["image"].IsScalar() ? root_["image"].Scalar() : "";
    const bool plain = std::none_of(file.begin(), file.end(), [](unsigned char c) { return c < 0x20; });
    require(!file.empty() && plain, "lacks 'image: FILE'", name_);
    return file;
  }
  [[nodiscard]] std::array<double, 3> origin() const {
    const YAML::Node node = root_["origin"];
    if (!node) return {};
    require(node.IsSequence() && (node.size() == 2 || node.size() == 3), "origin: must be [x, y, yaw]", name_);
    std::array<double, 3> values{};
    for (std::size_t i = 0; i < node.size(); ++i) values[i] = number(node[i], "origin", -1e9, 1e9);
    return values;
  }
  [[nodiscard]] bool flag(const std::string& key) const {
    if (!root_[key]) return false;
    const std::string text = root_[key].IsScalar() ? root_[key].Scalar() : "";
    require(text == "0" || text == "1" || text == "true" || text == "false", fmt::format("{}: must be 0 | 1", key), name_);
    return text == "1" || text == "true";
  }
  /// Only the way that maps are saved by default.
  void check_mode() const {
    if (!root_["mode"]) return;
    const std::string mode = root_["mode"].IsScalar() ? root_["mode"].Scalar() : "";
    require(mode == "trinary" || mode == "scale", fmt::format("mode = {}: must be trinary | scale", printable(mode)), name_);
  }

 private:
  const std::string& name_;
  YAML::Node root_;
};

CellState state_of(std::uint8_t shade, const MapDescription& description) {
  const double p = (description.negate ? shade : 255 - shade) / 255.0;
  return p > description.occupied_threshold ? CellState::occupied : p < description.free_threshold ? CellState::free : CellState::unknown;
}

void fill_cells(const std::filesystem::path& image, const MapDescription& description, OccupancyMap& map) {
  const GrayImage gray = read_gray_image(image, description.negate ? 255 - kUnknownShade : kUnknownShade);
  map.width = gray.width;
  map.height = gray.height;
  map.cells.resize(gray.pixels.size());
  const auto width = static_cast<std::size_t>(gray.width), height = static_cast<std::size_t>(gray.height);
  for (std::size_t row = 0; row < height; ++row)
    for (std::size_t x = 0; x < width; ++x) map.cells[(height - 1 - row) * width + x] = state_of(gray.pixels[row * width + x], description);
}

/// Collects segments between lattice corners.
class Walls {
 public:
  explicit Walls(const OccupancyMap& map) : map_(map) {}

  void add(int x0, int y0, int x1, int y1) {
    const std::uint32_t first = corner(x0, y0);
    mesh_.facets.push_back({first, corner(x1, y1)});
  }
  /// Runs where `is_wall(i)` holds, i in [0, count), handed to `close(first, last)`.
  template <class IsWall, class Close>
  static void runs(int count, IsWall&& is_wall, Close&& close) {
    int start = -1;
    for (int i = 0; i <= count; ++i) {
      const bool wall = i < count && is_wall(i);
      if (wall && start < 0) start = i;
      if (!wall && start >= 0) close(std::exchange(start, -1), i);
    }
  }
  [[nodiscard]] Mesh<2> take() { return std::move(mesh_); }

 private:
  std::uint32_t corner(int x, int y) {
    const std::int64_t key = (static_cast<std::int64_t>(y) << 32) + x;
    const auto [found, fresh] = corners_.try_emplace(key, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (fresh) mesh_.vertices.push_back(map_.position(x, y));
    return found->second;
  }

  const OccupancyMap& map_;
  Mesh<2> mesh_;
  std::unordered_map<std::int64_t, std::uint32_t> corners_;
};

}  // namespace

Vec<2> OccupancyMap::position(double x, double y) const {
  const auto [s, c] = sin_cos(yaw);
  return origin + resolution * Vec<2>(c * x - s * y, s * x + c * y);
}

bool is_map_file(const std::filesystem::path& path) {
  const std::string extension = extension_of(path);
  return extension == ".yaml" || extension == ".yml" || extension == ".png" || extension == ".pgm";
}

MapDescription parse_map_description(const std::string& text, const std::string& name) {
  const Keys keys(text, name);
  MapDescription map;
  map.image = keys.image();
  map.resolution = keys.number("resolution", map.resolution, 1e-4, 1e4);
  const auto [x, y, yaw] = keys.origin();
  map.origin = {x, y};
  map.yaw = yaw;
  keys.check_mode();
  map.occupied_threshold = keys.number("occupied_thresh", map.occupied_threshold, 0.0, 1.0);
  map.free_threshold = keys.number("free_thresh", map.free_threshold, 0.0, 1.0);
  map.negate = keys.flag("negate");
  require(map.free_threshold <= map.occupied_threshold,
          fmt::format("free_thresh = {}: must be <= occupied_thresh = {}", map.free_threshold, map.occupied_threshold), name);
  return map;
}

OccupancyMap read_occupancy_map(const std::filesystem::path& path, double resolution) {
  MapDescription description;
  std::filesystem::path image = path;
  if (const std::string extension = extension_of(path); extension == ".yaml" || extension == ".yml") {
    description = parse_map_description(read_file(path), path.string());
    image = path.parent_path() / description.image;
  }
  require(resolution == 0.0 || (resolution >= 1e-4 && resolution <= 1e4), fmt::format("unit = {}: must be 0.0001 .. 10000 [m] a pixel", resolution));
  OccupancyMap map;
  map.resolution = resolution > 0.0 ? resolution : description.resolution;
  map.origin = description.origin;
  map.yaw = description.yaw;
  fill_cells(image, description, map);
  return map;
}

Mesh<2> walls(const OccupancyMap& map) {
  Walls walls(map);
  const auto solid = [&](int x, int y) { return map.at(x, y) != CellState::free; };
  for (int x = 0; x <= map.width; ++x)
    Walls::runs(map.height, [&](int y) { return solid(x - 1, y) != solid(x, y); }, [&](int first, int last) { walls.add(x, first, x, last); });
  for (int y = 0; y <= map.height; ++y)
    Walls::runs(map.width, [&](int x) { return solid(x, y - 1) != solid(x, y); }, [&](int first, int last) { walls.add(first, y, last, y); });
  const int right = map.width + 1, top = map.height + 1;
  walls.add(-1, -1, right, -1);
  walls.add(right, -1, right, top);
  walls.add(right, top, -1, top);
  walls.add(-1, top, -1, -1);
  return walls.take();
}

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/octomap.h"

#include <fmt/format.h>

#include <cmath>

#include "vantage/base/error.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/scan_formats.h"
#include "vantage/io/text.h"
#include "vantage/io/text_scanner.h"

namespace vantage {
namespace {

constexpr int kDepth = 16;
constexpr std::string_view kFirstLine = "# Octomap OcTree binary file";

struct Header {
  std::uint64_t nodes = 0;
  double resolution = 0.0;
  std::size_t data = 0;
};

void parse_line(std::string_view line, Header& header, const std::string& place) {
  const std::string_view key = take_word(line), word = take_word(line);
  if (key.empty() || key.front() == '#') return;
  if (key == "id") {
    require(word == "OcTree", fmt::format("id {}: must be OcTree", printable(word)), place);
  } else if (key == "size") {
    const std::optional<std::uint64_t> nodes = to_number<std::uint64_t>(word);
    require(nodes.has_value(), fmt::format("size {}: must be a whole number", printable(word)), place);
    header.nodes = *nodes;
  } else if (key == "res") {
    const std::optional<double> resolution = to_number<double>(word);
    require(resolution && std::isfinite(*resolution) && *resolution > 0.0, fmt::format("res {}: must be a number > 0", printable(word)), place);
    header.resolution = *resolution;
  } else {
    require(key == "data", fmt::format("{}: not a header line of OctoMap", printable(key)), place);
  }
}

Header parse_header(const FileBytes& file) {
  require(file.all().starts_with(kFirstLine), "not an OctoMap binary file (.bt)", file.where());
  TextScanner scanner(file.all().substr(0, 65536));
  const std::size_t length = scanner.remaining();
  Header header;
  while (const std::optional<std::string_view> line = scanner.next_line()) {
    parse_line(*line, header, fmt::format("{}:{}", file.where(), scanner.line()));
    if (!line->starts_with("data")) continue;
    require(header.resolution > 0.0, "header without res", file.where());
    header.data = length - scanner.remaining();
    return header;
  }
  throw Error(ErrorCode::bad_input, "the file ends within the header", std::string(file.where()));
}

/// Two bytes a node, two bits a child: 0 unknown, 1 free, 2 occupied, 3 a node of its own, which follows later, depth first.
class TreeReader {
 public:
  TreeReader(const FileBytes& file, const Header& header, OccupancyTree& tree) : file_(file), offset_(header.data), tree_(tree) {}

  void read(const Vec<3>& centre, int depth) {
    const auto children = file_.number<std::uint16_t>(offset_, "the tree's nodes");
    offset_ += 2;
    const double side = tree_.resolution * static_cast<double>(1 << (kDepth - depth - 1));
    const auto child = [&](int i) -> Vec<3> { return centre + 0.5 * side * Vec<3>(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1); };
    for (int i = 0; i < 8; ++i) {
      const int state = (children >> (2 * i)) & 3;
      nodes_ += state != 0;
      if (state == 1 || state == 2) tree_.leaves.push_back({child(i), side, state == 2});
    }
    for (int i = 0; i < 8; ++i) {
      if (((children >> (2 * i)) & 3) != 3) continue;
      if (depth + 1 >= kDepth) file_.fail(offset_ - 2, fmt::format("a tree deeper than {} levels", kDepth));
      read(child(i), depth + 1);
    }
  }
  [[nodiscard]] std::uint64_t nodes() const { return nodes_; }

 private:
  const FileBytes& file_;
  std::uint64_t offset_, nodes_ = 1;
  OccupancyTree& tree_;
};

}  // namespace

OccupancyTree parse_occupancy_tree(FileBytes file) {
  const Header header = parse_header(file);
  OccupancyTree tree;
  tree.resolution = header.resolution;
  if (header.nodes == 0) return tree;
  TreeReader reader(file, header, tree);
  reader.read(Vec<3>::Zero(), 0);
  if (reader.nodes() != header.nodes) file.fail(header.data, fmt::format("{} nodes, the header announces {}", reader.nodes(), header.nodes));
  return tree;
}

OccupancyTree read_occupancy_tree(const std::filesystem::path& path) {
  const FileBuffer buffer = read_buffer(path);
  return parse_occupancy_tree(FileBytes(buffer.view(), path.string()));
}

std::vector<MeasuredScan> parse_octomap(FileBytes file) {
  const OccupancyTree tree = parse_occupancy_tree(file);
  MeasuredScan scan;
  scan.name = file.where();
  scan.format = fmt::format("OctoMap, {} m", tree.resolution);
  for (const OccupancyTree::Leaf& leaf : tree.leaves)
    if (leaf.occupied) scan.points.push_back(leaf.centre);
  return {std::move(scan)};
}

}  // namespace vantage

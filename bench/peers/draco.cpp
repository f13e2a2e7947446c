// SPDX-License-Identifier: Apache-2.0
// Draco 1.5: the points themselves, quantised and coded as a k-d tree.
#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/point_cloud/point_cloud_builder.h>

#include <algorithm>

#include "../contender.h"
#include "vantage/base/error.h"

namespace vantage::bench {
namespace {

using Point = std::array<float, 3>;

void check(const draco::Status& status) { require(status.ok(), "Draco: " + status.error_msg_string()); }

/// `once`: points that fall together are stored once.
class Draco final : public Contender {
 public:
  Draco(double bits, bool once) : bits_(static_cast<int>(bits)), once_(once) {}

  void build(const Cloud& cloud, std::size_t scans) override {
    std::vector<Point> points;
    for (const Vec<3>& p : cloud.scans_before(scans))
      points.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
    Point low = points.front(), high = low;
    for (const Point& p : points)
      for (std::size_t a = 0; a < 3; ++a) low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
    const float range = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
    if (once_) merge(points, low, range);
    encode(points, low, range);
  }
  Output output() override {
    draco::DecoderBuffer buffer;
    buffer.Init(buffer_.data(), buffer_.size());
    auto cloud = draco::Decoder().DecodePointCloudFromBuffer(&buffer);
    check(cloud.status());
    const draco::PointAttribute& at = *cloud.value()->GetNamedAttribute(draco::GeometryAttribute::POSITION);
    Output out;
    for (std::uint32_t i = 0; i < cloud.value()->num_points(); ++i) {
      Point p;
      at.GetMappedValue(draco::PointIndex(i), p.data());
      out.soup.push_back(point(Vec<3>(p[0], p[1], p[2])));
    }
    out.primitives = static_cast<std::int64_t>(out.soup.size());
    out.kind = "points";
    out.bytes = static_cast<double>(buffer_.size());
    return out;
  }

 private:
  /// Points of Draco's lattice (2^bits - 1 steps over the range), each once.
  void merge(std::vector<Point>& points, const Point& low, float range) const {
    const float steps = static_cast<float>((1 << bits_) - 1) / range;
    std::vector<std::array<std::int32_t, 3>> nodes;
    for (const Point& p : points) {
      const auto node = [&](std::size_t a) { return static_cast<std::int32_t>(std::floor((p[a] - low[a]) * steps + 0.5F)); };
      nodes.push_back({node(0), node(1), node(2)});
    }
    std::ranges::sort(nodes);
    const auto rest = std::ranges::unique(nodes);
    nodes.erase(rest.begin(), rest.end());
    points.clear();
    for (const auto& n : nodes) {
      const auto place = [&](std::size_t a) { return low[a] + static_cast<float>(n[a]) / steps; };
      points.push_back({place(0), place(1), place(2)});
    }
  }
  void encode(const std::vector<Point>& points, const Point& low, float range) {
    draco::PointCloudBuilder builder;
    builder.Start(static_cast<std::uint32_t>(points.size()));
    const int id = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    builder.SetAttributeValuesForAllPoints(id, points.data(), 0);
    const auto cloud = builder.Finalize(false);
    draco::Encoder encoder;
    encoder.SetSpeedOptions(0, 0);
    encoder.SetEncodingMethod(draco::POINT_CLOUD_KD_TREE_ENCODING);
    encoder.SetAttributeExplicitQuantization(draco::GeometryAttribute::POSITION, bits_, 3, low.data(), range);
    check(encoder.EncodePointCloudToBuffer(*cloud, &buffer_));
  }

  int bits_;
  bool once_;
  draco::EncoderBuffer buffer_;
};

}  // namespace

std::vector<ContenderKind> draco_contenders() {
  return {{"draco",
           "Draco, {} bits",
           "k-d tree coding of all points, best compression",
           {10, 11, 12, 13, 14},
           [](double bits) { return std::make_unique<Draco>(bits, false); },
           true},
          {"draco-once",
           "Draco, equal points once, {} bits",
           "the same of the points left when those that fall together are merged",
           {10, 11, 12, 13, 14},
           [](double bits) { return std::make_unique<Draco>(bits, true); }}};
}

}  // namespace vantage::bench

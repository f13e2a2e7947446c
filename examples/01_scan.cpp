// SPDX-License-Identifier: Apache-2.0
// 1 Scan. A sensor is one function: from a place to one range per ray. Here: flat ground, known by a formula.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "vantage/scan/scan.h"

using namespace vantage;

namespace {

/// Stands over the plane z = 0.
class OverFlatGround final : public Sensor<3> {
 public:
  Scan<3> scan(const Vec<3>& vantage_point, int /*index*/) override {
    Scan<3> scan;  // The default pattern is the paper's: 0.5 degree steps all around, 80 m.
    scan.origin = vantage_point;
    for (const Vec<3>& direction : directions<3>(scan.pattern)) {
      const double range = direction.z() < 0.0 ? vantage_point.z() / -direction.z() : kInfinity;
      scan.ranges.push_back(range <= scan.pattern.max_range ? static_cast<float>(range) : kNoReturn);
    }
    return scan;
  }
};

}  // namespace

int main() {
  const double height = 2.0;
  OverFlatGround sensor;
  const Scan<3> scan = sensor.scan(Vec<3>(10.0, 20.0, height), 0);
  const auto free = std::count(scan.ranges.begin(), scan.ranges.end(), kNoReturn);
  fmt::print("{} columns x {} rays: {} meet the ground, {} are free up to {} m\n", scan.pattern.columns(), scan.pattern.rows<3>(),
             scan.ranges.size() - static_cast<std::size_t>(free), free, scan.pattern.max_range);

  double farthest = 0.0, deviation = 0.0;
  for (const Vec<3>& point : hit_points(scan)) {
    farthest = std::max(farthest, (point - scan.origin).norm());
    deviation = std::max(deviation, std::abs(point.z()));
  }
  fmt::print("farthest hit at {:.1f} m; every hit lies within {:.1e} m of the ground\n", farthest, deviation);
  return farthest > 60.0 && deviation < 1e-5 ? 0 : 1;
}

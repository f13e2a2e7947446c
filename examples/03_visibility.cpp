// SPDX-License-Identifier: Apache-2.0
// 3 Visibility. From surfaces and one scan to a level set: positive where seen, negative in the shadow. In the plane, one wall.
#include <fmt/core.h>

#include <array>

#include "vantage/visibility/visibility.h"

using namespace vantage;

namespace {

/// What a scanner at `origin` measures of one wall.
Scan<2> scan_of(const Patch<2>& wall, const Vec<2>& origin) {
  Scan<2> scan;
  scan.origin = origin;
  for (const Vec<2>& direction : directions<2>(scan.pattern))
    scan.ranges.push_back(static_cast<float>(ray_range(wall, origin, direction, 0.0).value_or(kNoReturn)));
  return scan;
}

/// One letter a node, the highest row first.
void draw(const Field<2>& phi, const Scan<2>& scan) {
  const Index<2> here = phi.window.nearest(scan.origin);
  for (int y = phi.window.extent[1] - 1; y >= 0; --y) {
    std::string row;
    for (int x = 0; x < phi.window.extent[0]; ++x) {
      const float value = phi.at({x, y});
      row += here == Index<2>(x, y) ? 'x' : value > 0.0F ? '.' : value == 0.0F ? '#' : ' ';
    }
    fmt::print("{}\n", row);
  }
}

}  // namespace

int main() {
  const double eta = 0.15;  // The surface is only known to within eta [m].
  const std::array wall = {segment_patch<2>({4.0, 1.0}, {4.0, 5.0})};
  const Scan<2> scan = scan_of(wall[0], {1.0, 3.0});
  const Grid<2> window = window_over<2>({{0.0, 0.0}, {12.0, 6.0}}, 0.25);
  const Field<2> phi = visibility<2>(wall, scan, window, eta);

  fmt::print("x the scanner, # the wall, . seen, blank the shadow\n");
  draw(phi, scan);
  const float front = phi.at(window.nearest({2.0, 3.0})), behind = phi.at(window.nearest({6.0, 3.0}));
  fmt::print("2 m before the wall phi = {:.2f} m, 2 m behind it {:.2f} m\n", front, behind);
  return front > 1.8F && behind < -1.8F ? 0 : 1;
}

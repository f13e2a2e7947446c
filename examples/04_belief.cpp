// SPDX-License-Identifier: Apache-2.0
// 4 Belief. What has been seen is united, scan by scan, and never forgotten; psi is the signed distance to the border of the unseen.
#include <fmt/core.h>

#include "vantage/belief/belief.h"

using namespace vantage;

namespace {

/// What a scan saw: a ball of `radius` around `center`.
SeenSet<3> seen_ball(const Grid<3>& window, const Vec<3>& center, double radius) {
  Field<3, std::uint8_t> seen(window);
  for (std::size_t i = 0; i < window.size(); ++i) seen[i] = (window.position(i) - center).norm() < radius;
  return SeenSet<3>(seen);
}

}  // namespace

int main() {
  const Box<3> domain = {Vec<3>(0, 0, 0), Vec<3>(20, 10, 10)};
  Belief<3> belief(window_over(domain, 0.25), 0.05);

  // Each scan touches only the window it reaches: another part of the same lattice.
  double before = 0.0;
  for (const double x : {5.0, 9.0, 15.0}) {
    const Vec<3> center(x, 5.0, 5.0);
    const Grid<3> window = window_over(domain.intersection({center.array() - 4.5, center.array() + 4.5}), 0.25);
    const Field<3> known_distance(window, 5.0F);  // The nearest known surface is 5 m away.
    belief.unite(seen_ball(window, center, 3.0), known_distance);
    fmt::print("a ball seen at x = {:4.1f}: {:6.1f} m3 seen in all, {:5.1f} of them new\n", x, belief.seen_volume(), belief.seen_volume() - before);
    before = belief.seen_volume();
  }

  const BeliefView<3> view = belief.view();
  const auto psi = [&](double x) { return view.psi.at(view.window().nearest(Vec<3>(x, 5.0, 5.0))); };
  fmt::print("psi along the axis: {:.2f} at x = 5, {:.2f} at 12 (the border), {:.2f} at 19\n", psi(5.0), psi(12.0), psi(19.0));
  const double ball = 4.0 / 3.0 * kPi * 27.0;
  return before > 2.5 * ball && before < 3.0 * ball && psi(5.0) > 2.5F && psi(19.0) < -0.7F ? 0 : 1;
}

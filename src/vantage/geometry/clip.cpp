// SPDX-License-Identifier: Apache-2.0
#include "vantage/geometry/clip.h"

namespace vantage {

template <int Dim>
ConvexRegion<Dim - 1> clip_to_box(const Frame<Dim>& frame, const Box<Dim>& box) {
  using Region = ConvexRegion<Dim - 1>;
  using Place = typename Region::Place;
  const double size = box.size().norm();
  const double tolerance = 1e-9 * size;  // A plane may lie in a face of the box.
  const Place reach = Place::Constant(2.0 * size);
  Region region = Region::box(-reach, reach);
  for (int axis = 0; axis < Dim && region.count > 0; ++axis) {
    const Place normal = frame.axes.row(axis).template head<Dim - 1>().transpose();
    region = region.clipped(normal, box.high[axis] - frame.origin[axis] + tolerance);
    region = region.clipped(-normal, frame.origin[axis] - box.low[axis] + tolerance);
  }
  return region.simplified(4.0 * tolerance);
}

template ConvexRegion<1> clip_to_box<2>(const Frame<2>&, const Box<2>&);
template ConvexRegion<2> clip_to_box<3>(const Frame<3>&, const Box<3>&);

}  // namespace vantage

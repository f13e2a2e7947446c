// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/planner_options.h"

namespace vantage {

void describe(PlannerOptions& o, const OptionVisitor& visit) {
  using namespace std::string_literals;
  visit(
      "metric", o.metric, Choices{"ray", "boundary", "nearest", "count", "random", "optimistic"},
      "form of E: rays to the shadow boundary, or the paper's sum over its elements; or instead of E: nearest frontier, number of frontier faces in "
      "view, any medial place, unseen volume up to the known surface");
  visit("volume_weight", o.volume_weight, "", Range{0, 1e6}, "ray form: weight of the expected new volume");
  visit("solid_angle_weight", o.solid_angle_weight, "", Range{0, 1e6}, "ray form: weight of the shadow boundary's solid angle");
  visit("area_weight", o.area_weight, "", Range{0, 1e6}, "ray form: weight of Eq. (1) with line of sight");
  visit("lambda_factor", o.lambda_factor, "", Range{0, 1e3}, "opacity of the unseen over the measured one; 0 is optimistic");
  visit("learned", o.learned, "weigh faces by the learned probability to open; false: the two hard masks");
  visit("rays", o.rays, "rays", Range{16, 1e6}, "for the first look at a candidate in 3D; 2D: a quarter");
  visit("refine_rays", o.refine_rays, "rays", Range{16, 1e7}, "for the second look at the best in 3D; 2D: a quarter");
  visit("refine", o.refine, "candidates", Range{1, 1e6}, "looked at twice");
  visit("elements", o.elements, Choices{"faces", "smeared", "printed"}, "boundary sum: one element a face, smeared delta, or the delta as printed");
  visit("facing", o.facing, Choices{"seen", "behind", "absolute"}, "boundary sum: which side counts; behind is as printed");
  visit("mask", o.mask, Choices{"both", "known", "none"},
        "boundary sum: without known surface and what was looked at frontally, without known surface, all as printed");
  visit("normalise", o.normalise, "boundary sum: divide by the distance; false as printed");
  visit("line_of_sight", o.line_of_sight, "boundary sum: only elements in view; false as printed");
  visit("tree_angle", o.tree_angle, "rad", Range{0, 1},
        "boundary sum without line of sight: groups of elements that look smaller are summed at once; 0: one by one");
  visit("tau_power", o.tau_power, "", Range{0, 4}, "depth factor tau = r^-p, in quarters; 0 is the paper's");
  visit("candidates", o.candidates, "places", Range{1, 1e6}, "evaluated at a step in 3D; 2D: twice as many");
  visit("curvature", o.curvature, "", Range{0, 100}, "M h: candidates have -lap(psi) > M");
  visit("printed_curvature", o.printed_curvature, "candidates by lap(psi) > M, as printed");
  visit("clearance", o.clearance, "m", Range{0, 1e3}, "of a vantage point and of the path to known obstacles");
  visit("travel_weight", o.travel_weight, "", Range{0, 4},
        "p in E / (1 + walk / (speed x scan_time))^p, in quarters: 0 for few scans, 1 for little time, between for both");
  visit("speed", o.speed, "m/s", Range{1e-3, 1e3}, "of travel, for travel_weight");
  visit("scan_time", o.scan_time, "s", Range{1e-3, 1e6}, "of a scan with its set-up, for travel_weight");
  visit("look_ahead", o.look_ahead, "candidates", Range{0, 1000}, "ray form: so many of the best are tried in pairs; 0: none, the best place itself");
  visit("stop_volume", o.stop_volume, "", Range{0, 1}, "stop when the expected new volume is below this share of the seen, twice in a row");
  visit("idle_limit", o.idle_limit, "scans", Range{1, 1e6}, "stop after so many in a row that gained nothing");
  visit("last_looks", o.last_looks, "scans", Range{0, 1e6},
        "before the end, look so often in a row at what nobody has looked at frontally, although little is expected of it");
  visit("report_volume", o.report_volume, "m^d", Range{0, 1e9}, "smaller unseen regions are not listed; 0: 27 cells (2D: 9)");
}

}  // namespace vantage

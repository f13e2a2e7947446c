// SPDX-License-Identifier: Apache-2.0
#include "vantage/survey/survey_options.h"

namespace vantage {

void describe(SurveyOptions& o, const OptionVisitor& visit) {
  visit("range", o.range, "m", Range{1e-3, 1e5}, "farthest measurement that counts");
  visit("min_range", o.min_range, "m", Range{0.0, 1e4}, "nearest one");
  visit.angle("incidence_deg", o.incidence, Range{1.0, 90.0}, "largest angle between the ray and the wall's normal");
  visit("density", o.density, "1/m2", Range{0.0, 1e9}, "least points on a square metre of wall (2D: on a metre) by one scan");
  visit.angle("step_deg", o.step, Range{1e-3, 30.0}, "between the sensor's rays, both ways");
  visit("cover", o.cover, "", Range{1, 64}, "so many stations see each place");
  visit("overlap", o.overlap, "", Range{0.0, 0.95},
        "share of the wall a station sees that one earlier station sees as well, for registration; 0: not asked for");
  visit("height", o.height, "m", Range{0.0, 1e3}, "of the scanner above what is below it, up to half a voxel; 0: any");
  visit("share", o.share, "", Range{0.01, 1.0}, "of all that can be seen within the limits, to be seen");
  visit("clearance", o.clearance, "m", Range{0.0, 1e3}, "of stations and paths to obstacles");
  visit("voxel", o.voxel, "m", Range{1e-4, 1e4}, "spacing of the lattice of places");
  visit("volume", o.volume, "the free space is to be seen too");
  visit("come_back", o.come_back, "the tour ends where it begins");
  visit("samples", o.samples, "", Range{1, 1e7}, "places drawn on the surface");
  visit("candidates", o.candidates, "", Range{1, 1e6}, "reachable places drawn to choose stations from; some are added");
  visit("effort", o.effort, "", Range{0, 1e6}, "of the search for fewer stations, in millions of elementary steps: 300 take about a second");
  visit("seed", o.seed, "", Range{0, 9e15}, "of the draws and the search");
}

}  // namespace vantage

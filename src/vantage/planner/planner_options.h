// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "vantage/base/options.h"

namespace vantage {

/// The visibility metric E and how its maximum is searched (paper Eq. 1, Sec. III-A). The defaults are the best variant measured; the paper's
/// own formulas, as repaired or as printed, are options, so that the differences can be measured.
struct PlannerOptions {
  /// March rays to the shadow boundary, or sum over its elements; or what others do (baselines.h): walk to the nearest frontier, to where most faces
  /// of it are in view, or to any medial node; or the most unseen volume along rays up to the known surface, over a medial node of every block.
  enum class Metric { ray, boundary, nearest, count, random, optimistic } metric = Metric::ray;

  // Ray form: a sum of terms, each divided by its maximum over the candidates.
  double volume_weight = 1.0;       ///< Expected new volume.
  double solid_angle_weight = 0.1;  ///< Solid angle of the shadow boundary in view.
  double area_weight = 0.0;         ///< Eq. (1) with line of sight and tau = 1.
  double lambda_factor = 0.5;       ///< Opacity of the unseen, in units of the measured A/(4V) (2D: A/(pi V)); 0: optimistic.
  bool learned = true;              ///< Weigh faces by the learned probability to open; false: hard masks.
  std::int64_t rays = 400;          ///< First look at every candidate.
  std::int64_t refine_rays = 4000;  ///< Second look at the best (2D: a quarter of it).
  std::int64_t refine = 16;         ///< How many are looked at twice.

  /// The paper's weighting w: boxes, each as its low corner, its high corner [m] and its weight [1], one after the other, 2 Dim + 1 numbers each.
  /// Inside a box its weight counts (the last one that holds the place), elsewhere 1. Not described to visitors: it is a list.
  std::vector<double> weights;

  // Boundary sum.
  enum class Elements { faces, smeared, printed } elements = Elements::faces;  ///< printed: delta without pi.
  enum class Facing { seen, behind, absolute } facing = Facing::seen;          ///< behind: as printed.
  enum class Mask { both, known, none } mask = Mask::both;  ///< Which elements are shadow boundary; none: omega_O as printed, identically 1.
  bool normalise = true;                                    ///< Divide by |z - y|; false: as printed.
  bool line_of_sight = true;                                ///< Eq. (1) has none.
  double tree_angle = 0.2;                                  ///< Without line of sight: what looks smaller is summed at once; 0: nothing [rad].
  double tau_power = 0.0;                                   ///< tau = r^-p; 0 is the paper's.

  // Candidates.
  std::int64_t candidates = 500;   ///< At most (2D: twice as many; boundary metric without line of sight: all medial nodes up to 20 times).
  double curvature = 0.5;          ///< M in -lap(psi) > M/h.
  bool printed_curvature = false;  ///< lap(psi) > M/h, as printed.
  double clearance = 0.5;          ///< Of a vantage point and of the path to known obstacles [m].

  // What a place costs, and what comes after it.
  double travel_weight = 0.0;   ///< E / (1 + walk / (speed scan_time))^p: 0 for few scans, 1 for little time, between for both.
  double speed = 1.0;           ///< Of travel [m/s].
  double scan_time = 120.0;     ///< Of one scan with its set-up [s].
  std::int64_t look_ahead = 0;  ///< Ray form: so many of the best are tried in pairs; the better half of the best pair comes first. 0: none.

  // Stop.
  double stop_volume = 2e-4;     ///< Expected new volume as a share of the seen volume, twice in a row.
  std::int64_t idle_limit = 30;  ///< Picks in a row that gained nothing.
  std::int64_t last_looks = 6;   ///< Picks in a row at what nobody has looked at frontally, although little is expected of it, before the end; twice
                                 ///< as many where much may show.
  double report_volume = 0.0;    ///< Unseen regions below this are not listed [m^Dim]; 0: a cube of three cells.
};

void describe(PlannerOptions& options, const OptionVisitor& visit);

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "vantage/field/field.h"
#include "vantage/geometry/box.h"
#include "vantage/planner/verdict.h"

namespace vantage {

/// What one step of the loop did. Volumes are areas in 2D.
template <int Dim>
struct StepRecord {
  int scan = 0;
  Vec<Dim> vantage = Vec<Dim>::Zero();    ///< Where this scan was taken [m].
  double score = 0.0;                     ///< max E that led here; 0 for the first [1 for the ray form, m^(Dim-1) for the boundary sum].
  double next_score = 0.0;                ///< max E over the candidates after this scan.
  double expected_volume = 0.0;           ///< Expected new volume of the next place [m^Dim].
  std::int64_t candidates = 0;            ///< Evaluated for the next place.
  std::int64_t points = 0;                ///< Hits of this scan.
  double new_volume = 0.0;                ///< Seen for the first time by this scan [m^Dim].
  double seen_volume = 0.0;               ///< [m^Dim]
  double seen_fraction = 0.0;             ///< seen / (seen + what may still open) [1]
  double path_length = 0.0;               ///< From the previous vantage point to this one [m].
  std::map<std::string, double> seconds;  ///< Wall time per stage; for timing.json only.
};

/// A horizontal cut (2D: the plane itself) kept for the pictures: Fig. 2 of the paper for any scene.
template <int Dim>
struct Snapshot {
  int step = 0;         ///< After this scan.
  double height = 0.0;  ///< Of the cut, third axis [m]; 0 in 2D.
  Field<2, NodeState> state;
  Field<2, float> metric;            ///< E where evaluated (on a coarser window), NaN elsewhere.
  std::vector<Vec<Dim>> vantage;     ///< So far.
  Vec<Dim> next = Vec<Dim>::Zero();  ///< arg max E.
  bool has_next = false;
};

}  // namespace vantage

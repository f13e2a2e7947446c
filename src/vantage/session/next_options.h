// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "vantage/session/measured.h"
#include "vantage/session/scenario.h"

namespace vantage {

/// What a person wants of the next station.
struct NextOptions {
  std::int64_t count = 5;  ///< Places in the list.
  /// Where the scanner stands: on walkable ground, anywhere in the seen space, or as the scans were taken: of a person's scans on the ground, if
  /// ground is found below them, of simulated ones anywhere.
  enum class Stand { scans, ground, air } stand = Stand::scans;
  double height = 0.0;      ///< Above the ground [m]; 0: as the scans were taken.
  double slope = 30.0;      ///< Steepest ground [deg].
  double step = 0.2;        ///< Highest step [m].
  double apart = 0.0;       ///< Between places of the list [m]; 0: four cells, but 1 m at least.
  double overlap = 0.0;     ///< Least share of known surface in view [1].
  double incidence = 90.0;  ///< Between ray and normal: what is met flatter does not count as seen well [deg].
  double margin = 0.0;      ///< Of the domain around the points [m]; 0: two cells.
  /// A person's points that another scan looks through (moved.h).
  enum class Moved { keep, drop } moved = Moved::keep;
  double moved_gap = 0.2;       ///< So far from them is what other scans met, at least [m].
  std::vector<double> domain;   ///< Low corner, high corner [m]; empty: around the points.
  std::vector<double> among;    ///< Only these places come into question, one after the other [m]; empty: all that can be reached.
  std::vector<double> planned;  ///< Stations already planned, one after the other [m].
  std::string keep_out;         ///< Zones where no scanner may stand or pass (next_zones.h).
  std::string must_see;         ///< Zones where what is hidden counts ten times.
};

void describe(NextOptions& options, const OptionVisitor& visit);

/// All that a decision depends on beside the scans.
struct NextSetup {
  NextOptions next;
  MeasuredOptions measured;  ///< Of the scans that are added now.
  Scenario scenario;         ///< Its explore, surface, visibility and planner stages; what was not set is filled in by the points.
  bool voxel_set = false, eta_set = false;
};

/// The setup with the settings applied in order; names are `next.*`, `measured.*` and those of a scenario. Throws bad_input.
[[nodiscard]] NextSetup next_setup(std::span<const Setting> settings);

/// `next.toml`: the settings that a folder keeps, all but those of `measured`, the last of each name.
[[nodiscard]] std::string settings_as_toml(std::span<const Setting> settings);

/// Places out of a list of numbers.
template <int Dim>
[[nodiscard]] std::vector<Vec<Dim>> places_of(std::span<const double> numbers);

/// Throws bad_input unless the lists of the options hold whole places, boxes and zones of that dimension.
template <int Dim>
void check_lists(const NextOptions& options);

/// Throws bad_input for a zone that `settings` name and that has no place in common with the domain.
template <int Dim>
void require_met(const NextOptions& options, const Box<Dim>& domain, std::span<const Setting> settings);

}  // namespace vantage

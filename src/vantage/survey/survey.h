// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/base/progress.h"
#include "vantage/field/field.h"
#include "vantage/survey/sight.h"

namespace vantage {

/// One place of the tour.
template <int Dim>
  requires SpatialDim<Dim>
struct Station {
  Vec<Dim> place;         ///< [m]
  double sees = 0.0;      ///< Wall measured from here within the limits [m^(Dim-1)].
  double adds = 0.0;      ///< Of it what no earlier station measures.
  double overlap = 0.0;   ///< Largest share of `sees` that one earlier station measures too [1].
  int partner = -1;       ///< That station, -1 for the first.
};

/// A plan to measure a place whose map is known.
template <int Dim>
  requires SpatialDim<Dim>
struct Survey {
  SurveyOptions options;
  std::vector<Station<Dim>> stations;      ///< In the order of the tour.
  std::vector<std::vector<Vec<Dim>>> legs; ///< Way to each station, the first from the start; with come_back one more. Empty where there is none [m].
  double bound = 0.0;                      ///< Lower bound on the number of stations among the candidates, without the overlap.
  std::int64_t at_least = 0;               ///< The same as a whole number.
  bool linked = true;                      ///< Every station but the first overlaps an earlier one as asked for.
  std::int64_t candidates = 0, demands = 0;
  double wall = 0.0;                       ///< Wall that some candidate measures within the limits [m^(Dim-1)].
  double share = 0.0;                      ///< Of the demands, met as often as asked for [1].
  double thin = 0.0;                       ///< Of the demands, those that fewer places see than asked for: met as often as can be [1].
  std::vector<double> greedy;              ///< Share seen once after each station, in the order of a greedy choice [1].
  std::vector<Demand<Dim>> seen;           ///< The demands on walls,
  std::vector<std::uint8_t> times;         ///< and by how many stations each is seen.
  Field<Dim, std::uint8_t> reachable;      ///< Where the scanner can be, on the lattice.

  [[nodiscard]] double length() const;     ///< Of all legs [m].
};

/// The fewest stations that we find, and how few they could be at best. Samples of the walls, and with `volume` of the free space, that some
/// reachable place measures within the limits are to be measured from as many stations as asked for. Greedy set cover, also with the prices of the
/// lower bound, the best made smaller (`improved`), joined by overlap where it is asked for, ordered into a tour. `scene.start` is where the tour
/// begins. Throws bad_input for options out of range or without any reachable place, memory. Same bits for any number of threads.
template <int Dim>
[[nodiscard]] Survey<Dim> make_survey(const Scene<Dim>& scene, const SurveyOptions& options, Observer* observer = nullptr);

/// `id,x,y,z,sees,adds,overlap,partner`: one row a station.
template <int Dim>
[[nodiscard]] std::string stations_as_csv(const Survey<Dim>& survey);
/// `leg,x,y,z`: the corners of the way to station `leg`.
template <int Dim>
[[nodiscard]] std::string path_as_csv(const Survey<Dim>& survey);

/// One self-contained HTML page: figures, a map with the tour, the stations.
template <int Dim>
[[nodiscard]] std::string survey_page(const Survey<Dim>& survey, const std::string& scene);

}  // namespace vantage

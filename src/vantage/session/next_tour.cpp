// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/next_tour.h"

#include "vantage/survey/tour.h"

namespace vantage {

template <int Dim>
NextTour<Dim> tour_past(const Field<Dim, std::uint8_t>& passable, const Vec<Dim>& here, std::span<const Vec<Dim>> stations) {
  std::vector<Vec<Dim>> places{here};
  places.insert(places.end(), stations.begin(), stations.end());
  const std::vector<std::size_t> order = tour(travel_table<Dim>(passable, places), false);
  NextTour<Dim> result;
  result.path.push_back(here);
  for (std::size_t k = 1; k < order.size(); ++k) {
    const Vec<Dim>& to = places[order[k]];
    const std::vector<Vec<Dim>> way = way_between<Dim>(passable, places[order[k - 1]], to);
    if (way.empty())
      result.path.push_back(to);
    else
      result.path.insert(result.path.end(), way.begin() + 1, way.end());
    result.order.push_back(order[k] - 1);
  }
  result.length = length_of<Dim>(result.path);
  return result;
}

template NextTour<2> tour_past<2>(const Field<2, std::uint8_t>&, const Vec<2>&, std::span<const Vec<2>>);
template NextTour<3> tour_past<3>(const Field<3, std::uint8_t>&, const Vec<3>&, std::span<const Vec<3>>);

}  // namespace vantage

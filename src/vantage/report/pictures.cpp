// SPDX-License-Identifier: Apache-2.0
#include "vantage/report/pictures.h"

#include <fmt/format.h>

#include "vantage/report/overlay.h"

namespace vantage {

namespace {

constexpr std::size_t kMostPoints = 2'000'000;

}  // namespace

template <int Dim>
Vec<3> in_space(const Vec<Dim>& p) {
  Vec<3> q = Vec<3>::Zero();
  q.head(Dim) = p;
  return q;
}

template <int Dim>
std::vector<Vec<2>> on_picture(std::span<const Vec<Dim>> places, const Camera& camera) {
  std::vector<Vec<2>> pixels;
  for (const Vec<Dim>& place : places) {
    if (!place.allFinite() || !camera.in_front(in_space<Dim>(place))) continue;
    const Projected q = camera.project(in_space<Dim>(place));
    pixels.emplace_back(q.x, q.y);
  }
  return pixels;
}

template <int Dim>
std::string journey_overlay(const ReportInput<Dim>& input, const Camera& camera) {
  std::vector<Vec<Dim>> places;
  std::vector<int> numbers;
  for (const StepRecord<Dim>& step : input.steps) {
    if (!step.vantage.allFinite() || !camera.in_front(in_space<Dim>(step.vantage))) continue;
    places.push_back(step.vantage);
    numbers.push_back(step.scan);
  }
  return path_overlay(on_picture<Dim>(input.path, camera)) + station_overlay(on_picture<Dim>(places, camera), numbers);
}

template <int Dim>
std::string unseen_overlay(const ReportInput<Dim>& input, const Camera& camera) {
  std::string tags;
  for (std::size_t i = std::min(kTaggedRegions, input.verdict.unseen.size()); i-- > 0;) {
    const Box<Dim> box = input.verdict.unseen[i].box.intersection(input.domain);
    if (box.empty()) continue;
    const std::vector<Vec<Dim>> centre{box.center()};
    for (const Vec<2>& pixel : on_picture<Dim>(centre, camera)) tags += tag_overlay(pixel, fmt::format("{}", i + 1));
  }
  return tags;
}

template <int Dim>
std::size_t point_count(const ReportInput<Dim>& input) {
  std::size_t count = 0;
  for (const auto& points : input.scan_points) count += points.size();
  return count;
}

template <int Dim>
std::size_t point_stride(const ReportInput<Dim>& input) {
  return std::max<std::size_t>(1, (point_count(input) + kMostPoints - 1) / kMostPoints);
}

std::string legend_entry(const std::string& kind, const std::string& colour, const std::string& text) {
  const std::string style = colour.empty() ? std::string() : fmt::format(" style=\"--c:{}\"", colour);
  return fmt::format("<span class=\"key\"><i class=\"{}\"{}></i>{}</span>", kind, style, text);
}

std::string legend_bar(const std::string& gradient, const std::string& low, const std::string& high) {
  return fmt::format("<span class=\"key\">{}<i class=\"bar\" style=\"background:{}\"></i>{}</span>", low, gradient, high);
}

std::string journey_legend() { return legend_entry("dot", "", "vantage point with the number of its scan") + legend_entry("line", "", "path"); }

#define VANTAGE_INSTANTIATE(Dim)                                                                    \
  template Vec<3> in_space<Dim>(const Vec<Dim>&);                                                   \
  template std::vector<Vec<2>> on_picture<Dim>(std::span<const Vec<Dim>>, const Camera&);           \
  template std::string journey_overlay(const ReportInput<Dim>&, const Camera&);                     \
  template std::string unseen_overlay(const ReportInput<Dim>&, const Camera&);                      \
  template std::size_t point_count(const ReportInput<Dim>&);                                        \
  template std::size_t point_stride(const ReportInput<Dim>&);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)
#undef VANTAGE_INSTANTIATE

}  // namespace vantage

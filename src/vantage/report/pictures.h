// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/base/parallel.h"
#include "vantage/report/camera.h"
#include "vantage/report/figure.h"
#include "vantage/report/raster.h"
#include "vantage/report/report.h"

namespace vantage {

/// All pictures of a run in the order of the page; those with nothing to show are left out.
template <int Dim>
[[nodiscard]] std::vector<Figure> pictures(const ReportInput<Dim>& input);

// Pieces that both dimensions share.

/// Position in space; the plane lies at z = 0.
template <int Dim>
[[nodiscard]] Vec<3> in_space(const Vec<Dim>& p);
template <int Dim>
[[nodiscard]] std::vector<Vec<2>> on_picture(std::span<const Vec<Dim>> places, const Camera& camera);
/// The way and the numbered vantage points.
template <int Dim>
[[nodiscard]] std::string journey_overlay(const ReportInput<Dim>& input, const Camera& camera);
/// Numbers at the largest unseen regions, as in the table of them.
template <int Dim>
[[nodiscard]] std::string unseen_overlay(const ReportInput<Dim>& input, const Camera& camera);
template <int Dim>
[[nodiscard]] std::size_t point_count(const ReportInput<Dim>& input);
/// Of the points of all scans, every so many-th is drawn: two million at most.
template <int Dim>
[[nodiscard]] std::size_t point_stride(const ReportInput<Dim>& input);
[[nodiscard]] std::string journey_legend();

/// Calls `body(scan, p)` for every drawn point of the domain, on any thread.
template <int Dim, class Body>
void for_drawn_points(const ReportInput<Dim>& input, const Body& body) {
  const std::size_t stride = point_stride(input);
  std::size_t before = 0;
  for (std::size_t scan = 0; scan < input.scan_points.size(); ++scan) {
    const std::vector<Vec<Dim>>& points = input.scan_points[scan];
    const std::size_t first = (stride - before % stride) % stride;
    const std::size_t count = points.size() > first ? (points.size() - first + stride - 1) / stride : 0;
    parallel_for(count, 4096, [&](std::size_t k) {
      const Vec<Dim>& p = points[first + k * stride];
      if (input.domain.contains(p)) body(scan, p);
    });
    before += points.size();
  }
}

/// Unseen regions that get a number in the pictures.
inline constexpr std::size_t kTaggedRegions = 9;

}  // namespace vantage

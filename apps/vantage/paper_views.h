// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "paper_run.h"
#include "vantage/report/board.h"
#include "vantage/report/facets.h"

/// Where a picture in space is taken from.
struct PaperView {
  double azimuth_deg = 66.0, elevation_deg = 38.0;
  int width = 620, height = 440;
};

/// A camera that holds all of the scene within `frame`.
[[nodiscard]] vantage::Camera view_camera(const vantage::Scene<3>& scene, const vantage::Box<3>& frame, const PaperView& view);

/// The true scene, each kind of thing in its colour, cut at `frame`.
[[nodiscard]] vantage::Image scene_picture(const vantage::Scene<3>& scene, const vantage::Box<3>& frame, const vantage::Camera& camera);
/// What was taken for an obstacle in clay, and the shadow boundary that was left.
[[nodiscard]] vantage::Image visibility_picture(const vantage::Field<3>& psi, const vantage::Field<3, vantage::NodeState>& state,
                                                const vantage::Camera& camera);
/// The points within `frame`, coloured by height.
[[nodiscard]] vantage::Image points_picture(const std::vector<std::vector<vantage::Vec<3>>>& hits, const vantage::Box<3>& frame,
                                            const vantage::Camera& camera);
[[nodiscard]] vantage::Image patches_picture(std::span<const vantage::Patch<3>> patches, const vantage::Box<3>& frame, const vantage::Camera& camera);

/// The picture on a plate, with numbered vantage points on it.
[[nodiscard]] vantage::Image with_stations(const vantage::Image& picture, std::span<const vantage::Vec<3>> stations, const vantage::Camera& camera);
[[nodiscard]] vantage::Image on_plate(const vantage::Image& picture);

[[nodiscard]] std::vector<vantage::Vec<3>> stations_of(const PaperRun<3>& run);

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "paper_run.h"

/// A part of the paper's virtual site (Sec. VI), explored under its settings: a 60^3 grid, its eta, half-degree scans.
struct PaperSite {
  std::string figure, scene;
  std::vector<vantage::Setting> settings;
  std::int64_t scans = 0;   ///< That the paper took.
  std::int64_t points = 0;  ///< That the paper had from them.
  bool everything = false;  ///< It counts what was scanned outside the domain too.
};
[[nodiscard]] PaperSite patio_site(const std::string& figure, bool quick);
[[nodiscard]] PaperSite church_site(const std::string& figure, bool quick);

/// What the pictures need of a run after `PaperSite::scans` scans, or at its end if that came first.
struct SiteMap {
  vantage::Field<3> psi;
  vantage::Field<3, vantage::NodeState> state;
  std::vector<vantage::Patch<3>> patches;
  vantage::SurfaceStatistics surface;
  std::vector<std::vector<vantage::Vec<3>>> hits;
  std::vector<vantage::Vec<3>> stations;
};

struct SiteRun {
  std::string name, label;
  PaperRun<3> run;
  double falsely_free = 0.0;  ///< Called seen though nothing reachable sees it, after the paper's number of scans [m^3].
  SiteMap map;

  /// Share seen after so many scans, or at the end.
  [[nodiscard]] double seen_after(std::int64_t scans) const;
  /// Hits of the first so many scans within a box.
  [[nodiscard]] std::int64_t points(std::int64_t scans, const vantage::Box<3>& box) const;
};

/// Ours, alone.
[[nodiscard]] SiteRun explore_site(const PaperSite& site, const PaperPlace<3>& place, vantage::Observer& observer);
/// By every formula, and ours with the paper's cones in place of range images.
[[nodiscard]] std::vector<SiteRun> explore_site_by_all(const PaperSite& site, const PaperPlace<3>& place, vantage::Observer& observer);

[[nodiscard]] std::string site_table(const PaperSite& site, const PaperPlace<3>& place, const std::vector<SiteRun>& runs);
[[nodiscard]] vantage::Json site_json(const PaperSite& site, const PaperPlace<3>& place, const std::vector<SiteRun>& runs);

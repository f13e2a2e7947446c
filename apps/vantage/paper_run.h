// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>

#include "audit_variants.h"
#include "numbers.h"
#include "paper.h"
#include "vantage/audit/trial.h"
#include "vantage/report/image.h"

/// One way to choose, as the figures name and colour it.
struct PaperFormula {
  Variant variant;
  std::string label;
  vantage::Rgb colour;
};

/// Eq. (1) as printed, repaired without and with line of sight, and the default. The names are those of `vantage audit`.
[[nodiscard]] const std::vector<PaperFormula>& paper_formulas();

/// A place to explore under the paper's settings, with its truth.
template <int Dim>
  requires vantage::SpatialDim<Dim>
class PaperPlace {
 public:
  /// `settings` stand over the scene's own; of the sensor, the step of `setup`. Finding what can be seen takes a second or so.
  PaperPlace(const std::string& scene, std::vector<vantage::Setting> settings, const PaperSetup& setup);

  [[nodiscard]] const vantage::Trial<Dim>& trial() const { return *trial_; }
  [[nodiscard]] const vantage::Scene<Dim>& scene() const { return trial_->scene(); }
  /// The options of a run by `variant`.
  [[nodiscard]] vantage::TrialOptions options(const Variant& variant) const;

 private:
  vantage::World world_;
  std::optional<vantage::Trial<Dim>> trial_;
};

/// What is kept of a run.
template <int Dim>
struct PaperRun {
  std::vector<vantage::StepRecord<Dim>> steps;
  std::vector<double> coverage;                      ///< True share of what can be seen, after each scan [1].
  std::vector<std::vector<vantage::Vec<Dim>>> hits;  ///< Per scan [m].
  vantage::Verdict<Dim> verdict;
  bool finished = false;

  [[nodiscard]] std::optional<std::int64_t> scans_to(double share) const { return vantage::scans_to(coverage, share); }
};

struct PaperLimits {
  std::int64_t scans = 100;  ///< At most.
  double coverage = 2.0;     ///< Enough is seen [1]; above 1: never.
  std::string title;         ///< For the progress: what this run is.
};

/// Explores `place`, judged by the truth after every scan; `after_step`, if given, may look at the explorer. Throws interrupted when `observer` asks
/// to stop.
template <int Dim>
[[nodiscard]] PaperRun<Dim> explore_place(const PaperPlace<Dim>& place, const Variant& variant, const PaperLimits& limits,
                                          vantage::Observer& observer, const std::function<void(const vantage::Explorer<Dim>&)>& after_step = {});

/// `12` or, for never, a dash.
[[nodiscard]] std::string count_text(const std::optional<std::int64_t>& count);
[[nodiscard]] vantage::Json count_json(const std::optional<std::int64_t>& count);
/// A Markdown table; the first column is set left, the others right.
[[nodiscard]] std::string markdown(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows);

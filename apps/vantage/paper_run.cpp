// SPDX-License-Identifier: Apache-2.0
#include "paper_run.h"

#include <fmt/format.h>

#include <algorithm>

#include "vantage/audit/coverage.h"
#include "vantage/base/error.h"
#include "vantage/geometry/angle.h"
#include "vantage/report/png.h"

using namespace vantage;

namespace {

/// Tells where in a long figure the work is.
class Titled final : public Observer {
 public:
  Titled(Observer& inner, std::string title) : inner_(inner), title_(std::move(title)) {}
  void scan(std::size_t number) { number_ = number; }
  void stage(std::string_view name) override { inner_.stage(fmt::format("{}: scan {}, {}", title_, number_, name)); }
  void warn(std::string_view message) override { inner_.warn(message); }
  [[nodiscard]] bool stop_requested() override { return inner_.stop_requested(); }
  void stop_if_asked() {
    if (stop_requested()) throw Error(ErrorCode::interrupted, "stopped at " + title_);
  }

 private:
  Observer& inner_;
  std::string title_;
  std::size_t number_ = 1;
};

/// Keeps the hits of the scans that pass through it.
template <int Dim>
class Recorded final : public Sensor<Dim> {
 public:
  Recorded(const Mesh<Dim>& mesh, const LidarOptions& options, std::vector<std::vector<Vec<Dim>>>& hits) : lidar_(mesh, options), hits_(hits) {}
  [[nodiscard]] Scan<Dim> scan(const Vec<Dim>& vantage_point, int index) override {
    Scan<Dim> scan = lidar_.scan(vantage_point, index);
    hits_.push_back(hit_points(scan));
    return scan;
  }

 private:
  SimulatedLidar<Dim> lidar_;
  std::vector<std::vector<Vec<Dim>>>& hits_;
};

World world_of(const std::string& scene, std::vector<Setting> settings, const PaperSetup& setup) {
  settings.push_back({"sensor.step_deg", fmt::format("{}", degrees(setup.sensor.pattern.step)), "--step-deg"});
  return make_world(scene, settings);
}

}  // namespace

void PaperItem::add_texts(const std::string& name) {
  files.emplace_back(name + ".md", text);
  files.emplace_back(name + ".json", as_text(json));
}

void PaperItem::add_picture(const std::string& name, Image image) {
  for (std::uint8_t& channel : image.rgba) channel = static_cast<std::uint8_t>(std::min(255, (channel + 4) / 8 * 8));
  files.emplace_back(name, png(image));
}

const std::vector<PaperFormula>& paper_formulas() {
  static const std::vector<PaperFormula> all = [] {
    const std::vector<Variant> variants = chosen_variants("printed,repaired,sight,default", {});
    return std::vector<PaperFormula>{{variants[0], "Eq. (1) as printed", {176, 58, 46}},
                                     {variants[1], "Eq. (1), signs repaired", {214, 137, 16}},
                                     {variants[2], "Eq. (1) with line of sight", {36, 113, 163}},
                                     {variants[3], "expected volume (default)", {30, 132, 73}}};
  }();
  return all;
}

template <int Dim>
  requires SpatialDim<Dim>
PaperPlace<Dim>::PaperPlace(const std::string& scene, std::vector<Setting> settings, const PaperSetup& setup)
    : world_(world_of(scene, std::move(settings), setup)) {
  Scene<Dim> place = std::get<Scene<Dim>>(world_.scene);
  place.start = Eigen::Map<const Vec<Dim>>(world_.scenario.start.data());
  trial_.emplace(place, TrialOptions{world_.scenario.explore, world_.scenario.sensor});
}

template <int Dim>
  requires SpatialDim<Dim>
TrialOptions PaperPlace<Dim>::options(const Variant& variant) const {
  const Scenario scenario = with_settings(world_.scenario, variant.settings, world_.scene);
  return {scenario.explore, scenario.sensor};
}

template <int Dim>
PaperRun<Dim> explore_place(const PaperPlace<Dim>& place, const Variant& variant, const PaperLimits& limits, Observer& observer,
                            const std::function<void(const Explorer<Dim>&)>& after_step) {
  TrialOptions options = place.options(variant);
  options.explore.max_scans = limits.scans;
  options.explore.snapshots = static_cast<bool>(after_step);
  PaperRun<Dim> run;
  Titled progress(observer, limits.title);
  Recorded<Dim> sensor(place.scene().mesh, options.lidar, run.hits);
  Explorer<Dim> explorer(sensor, place.scene().domain, place.scene().start, options.explore, &progress);
  while (!explorer.finished() && (run.coverage.empty() || run.coverage.back() < limits.coverage)) {
    progress.scan(run.steps.size() + 1);
    run.steps.push_back(explorer.step());
    run.coverage.push_back(coverage(place.trial().reference(), explorer.states()).fraction);
    if (after_step) after_step(explorer);
    progress.stop_if_asked();
  }
  run.verdict = explorer.verdict();
  run.finished = explorer.finished() && static_cast<std::int64_t>(run.steps.size()) < limits.scans;
  return run;
}

std::string count_text(const std::optional<std::int64_t>& count) { return count ? std::to_string(*count) : "–"; }

Json count_json(const std::optional<std::int64_t>& count) { return count ? Json(*count) : Json(); }

std::string markdown(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows) {
  std::string out = fmt::format("| {} |\n|", fmt::join(header, " | "));
  for (std::size_t i = 0; i < header.size(); ++i) out += i == 0 ? " --- |" : " ---: |";
  out += "\n";
  for (const auto& row : rows) out += fmt::format("| {} |\n", fmt::join(row, " | "));
  return out;
}

template class PaperPlace<2>;
template class PaperPlace<3>;
template PaperRun<2> explore_place<2>(const PaperPlace<2>&, const Variant&, const PaperLimits&, Observer&,
                                      const std::function<void(const Explorer<2>&)>&);
template PaperRun<3> explore_place<3>(const PaperPlace<3>&, const Variant&, const PaperLimits&, Observer&,
                                      const std::function<void(const Explorer<3>&)>&);

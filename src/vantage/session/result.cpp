// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/result.h"

#include <fmt/format.h>

namespace vantage {
namespace {

constexpr const char* kAxes[] = {"x", "y", "z"};

template <int Dim>
Json to_json(const Box<Dim>& box) {
  return Json::array({vantage::to_json<Dim>(box.low), vantage::to_json<Dim>(box.high)});
}

}  // namespace

template <int Dim>
Json to_json(const Verdict<Dim>& verdict) {
  Json unseen = Json::array();
  for (const UnseenRegion<Dim>& region : verdict.unseen)
    unseen.push_back({{"volume_m3", region.volume},
                      {"box", to_json(region.box)},
                      {"reason", region.reason},
                      {"open_from", region.open_from ? vantage::to_json<Dim>(*region.open_from) : Json(nullptr)}});
  return {{"complete", verdict.complete},
          {"reason", verdict.reason},
          {"seen_fraction", verdict.seen_fraction},
          {"seen_fraction_bounds", {verdict.seen_low, verdict.seen_high}},
          {"unseen", unseen}};
}

template <int Dim>
Json to_json(const StepRecord<Dim>& step) {
  return {{"scan", step.scan},
          {"vantage", to_json<Dim>(step.vantage)},
          {"score", step.score},
          {"next_score", step.next_score},
          {"expected_volume_m3", step.expected_volume},
          {"candidates", step.candidates},
          {"points", step.points},
          {"new_volume_m3", step.new_volume},
          {"seen_volume_m3", step.seen_volume},
          {"seen_fraction", step.seen_fraction},
          {"path_m", step.path_length}};
}

Json to_json(const SurfaceStatistics& surface) {
  return {{"points", surface.points},
          {"outside", surface.outside},
          {"not_finite", surface.not_finite},
          {"depth", surface.depth},
          {"nodes", surface.nodes},
          {"leaves", surface.leaves},
          {"fits", surface.fits},
          {"segments", surface.segments},
          {"loose_points", surface.loose_points},
          {"eta_m", surface.eta},
          {"quantise_m", surface.quantise},
          {"beyond_eta", surface.beyond_eta},
          {"hausdorff",
           {{"data_to_surface_m", surface.data_to_surface}, {"surface_to_data_m", surface.surface_to_data}, {"certified_m", surface.certified()}}}};
}

template <int Dim>
std::string steps_as_csv(const std::vector<StepRecord<Dim>>& steps) {
  std::string out = "scan,";
  for (int a = 0; a < Dim; ++a) out += fmt::format("{},", kAxes[a]);
  out += "score,next_score,expected_volume_m3,candidates,points,new_volume_m3,seen_volume_m3,seen_fraction,path_m\n";
  for (const StepRecord<Dim>& s : steps)
    out += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", s.scan, fmt::join(s.vantage.data(), s.vantage.data() + Dim, ","), s.score, s.next_score,
                       s.expected_volume, s.candidates, s.points, s.new_volume, s.seen_volume, s.seen_fraction, s.path_length);
  return out;
}

std::string as_text(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

template Json to_json<2>(const Verdict<2>&);
template Json to_json<3>(const Verdict<3>&);
template Json to_json<2>(const StepRecord<2>&);
template Json to_json<3>(const StepRecord<3>&);
template std::string steps_as_csv<2>(const std::vector<StepRecord<2>>&);
template std::string steps_as_csv<3>(const std::vector<StepRecord<3>>&);

}  // namespace vantage

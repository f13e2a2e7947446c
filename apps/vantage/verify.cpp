// SPDX-License-Identifier: Apache-2.0
#include "verify.h"

#include <fmt/format.h>

#include "numbers.h"

using vantage::CertificateReport;
using vantage::Json;
using vantage::OneSided;

namespace {

Json one_sided(const OneSided& truth, double low, double claimed) {
  return {{"max_m", truth.max}, {"max_at_least_m", low}, {"p99_m", truth.p99}, {"mean_m", truth.mean}, {"certified_m", claimed}};
}

std::string line(const char* name, const OneSided& truth, double low, double claimed) {
  const std::string largest = low < truth.max ? fmt::format("{:.6g} .. {:.6g}", low, truth.max) : fmt::format("{:.6g}", truth.max);
  return fmt::format("  {} {} m, certified {:.6g} m; p99 {:.3g} m, mean {:.3g} m\n", name, largest, claimed, truth.p99, truth.mean);
}

}  // namespace

Json to_json(const CertificateReport& report) {
  return {{"holds", report.holds()},
          {"points", report.points},
          {"not_finite", report.not_finite},
          {"patches", report.patches},
          {"data_to_surface", one_sided(report.data_to_surface, report.data_to_surface.max, report.claimed.data_to_surface)},
          {"surface_to_data", one_sided(report.surface_to_data, report.surface_to_data_low, report.claimed.surface_to_data)},
          {"wrong_patches", report.wrong_patches},
          {"unclaimed_points", report.unclaimed_points},
          {"faults", report.faults},
          {"loose", report.loose}};
}

std::string verify_text(const CertificateReport& report) {
  std::string out = fmt::format("{}: {} points against {} patches\n", report.holds() ? "verified" : "NOT verified", grouped(report.points),
                                grouped(report.patches));
  out += line("point to surface, largest:", report.data_to_surface, report.data_to_surface.max, report.claimed.data_to_surface);
  out += line("patch to points, largest:", report.surface_to_data, report.surface_to_data_low, report.claimed.surface_to_data);
  for (const std::string& loose : report.loose) out += fmt::format("  loose: {}\n", loose);
  for (const std::string& fault : report.faults) out += fmt::format("  wrong: {}\n", fault);
  return out;
}

// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/certificate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "vantage/audit/covering.h"
#include "vantage/base/error.h"
#include "vantage/base/parallel.h"

namespace vantage {
namespace {

constexpr double kTenth = 1.1;        ///< What a bound of the whole may be above the truth,
constexpr double kThousandth = 1e-3;  ///< and so much of eta, since flat walls have a truth of nothing.

/// A copy of the finite points, and how far rounding may take a distance between places this far out.
template <int Dim>
struct Cloud {
  std::vector<Vec<Dim>> points;
  double rounding = 0.0;  ///< [m]
};

template <int Dim>
Cloud<Dim> finite_points(std::span<const Vec<Dim>> points) {
  Cloud<Dim> cloud;
  cloud.points.reserve(points.size());
  double largest = 0.0;
  for (const Vec<Dim>& p : points) {
    if (!p.allFinite()) continue;
    cloud.points.push_back(p);
    largest = std::max(largest, p.template lpNorm<Eigen::Infinity>());
  }
  cloud.rounding = 16.0 * std::numeric_limits<double>::epsilon() * largest;
  return cloud;
}

/// `body(i)` for all i, block by block, so that the observer hears of it.
template <class Body>
void in_blocks(std::size_t count, std::size_t block, std::string_view what, Observer* observer, Body&& body) {
  for (std::size_t begin = 0; begin < count; begin += block) {
    if (observer != nullptr) {
      observer->stage(fmt::format("verify {} {} %", what, 100 * begin / count));
      if (observer->stop_requested()) throw Error(ErrorCode::interrupted, "stopped while verifying");
    }
    parallel_for(std::min(block, count - begin), 64, [&](std::size_t i) { body(begin + i); });
  }
}

OneSided summed_up(std::vector<double> values) {
  if (values.empty()) return {};
  OneSided out;
  for (const double v : values) {
    out.max = std::max(out.max, v);
    out.mean += v / static_cast<double>(values.size());
  }
  const auto rank = values.begin() + static_cast<std::ptrdiff_t>(std::ceil(0.99 * static_cast<double>(values.size()))) - 1;
  std::nth_element(values.begin(), rank, values.end());
  out.p99 = *rank;
  return out;
}

template <int Dim>
std::string text(const Vec<Dim>& p) {
  return fmt::format("({:.9g})", fmt::join(p.data(), p.data() + Dim, ", "));
}

/// Patches with their own tree of boxes.
template <int Dim>
class Surface {
 public:
  explicit Surface(std::span<const Patch<Dim>> patches) : patches_(patches), tree_(tree_of(patches)) {
    for (const Patch<Dim>& patch : patches) {
      pieces_.emplace_back(patch);
      reach_ = std::max(reach_, static_cast<double>(patch.data_to_surface));
    }
  }
  [[nodiscard]] typename BoxTree<Dim>::Hit nearest(const Vec<Dim>& p, std::uint32_t guess) const {
    return tree_.nearest(p, {distance2(guess, p), guess}, [&](std::uint32_t i) { return distance2(i, p); });
  }
  /// Does some patch say that it carries p, that is, is p within that patch's own bound?
  [[nodiscard]] bool claims(const Vec<Dim>& p, double rounding) const {
    return tree_.any_within(p, reach_ + rounding, [&](std::uint32_t i) { return within(i, distance2(i, p), rounding); });
  }
  [[nodiscard]] bool within(std::uint32_t patch, double distance2, double rounding) const {
    return std::sqrt(distance2) <= static_cast<double>(patches_[patch].data_to_surface) + rounding;
  }

 private:
  static BoxTree<Dim> tree_of(std::span<const Patch<Dim>> patches) {
    std::vector<Box<Dim>> boxes;
    for (const Patch<Dim>& patch : patches) boxes.push_back(patch.bounds());
    return BoxTree<Dim>(boxes.size(), [&boxes](std::uint32_t i) { return boxes[i]; });
  }
  [[nodiscard]] double distance2(std::uint32_t i, const Vec<Dim>& p) const { return pieces_[i].distance2(patches_[i], p); }

  std::span<const Patch<Dim>> patches_;
  std::vector<FlatPiece<Dim>> pieces_;
  BoxTree<Dim> tree_;
  double reach_ = 0.0;
};

/// Every point against all patches.
template <int Dim>
void check_points(const Cloud<Dim>& cloud, std::span<const Patch<Dim>> patches, Observer* observer, CertificateReport& report) {
  std::vector<double> distances(cloud.points.size(), kInfinity);
  std::vector<char> claimed(cloud.points.size(), 0);
  if (!patches.empty()) {
    const Surface<Dim> surface(patches);
    in_blocks(cloud.points.size(), 1u << 18, "points", observer, [&](std::size_t i) {
      const Vec<Dim>& p = cloud.points[i];
      const auto hit = surface.nearest(p, 0);
      distances[i] = std::sqrt(hit.distance2);
      claimed[i] = surface.within(hit.item, hit.distance2, cloud.rounding) || surface.claims(p, cloud.rounding) ? 1 : 0;
    });
  }
  report.data_to_surface = summed_up(distances);
  if (!report.claimed.keeps_all) return;
  report.unclaimed_points = std::count(claimed.begin(), claimed.end(), 0);
  const auto first = static_cast<std::size_t>(std::find(claimed.begin(), claimed.end(), 0) - claimed.begin());
  if (report.unclaimed_points > 0)
    report.faults.push_back(fmt::format("{} points are farther from every patch than that patch says; the first at {}, {:.9g} m from the nearest",
                                        report.unclaimed_points, text<Dim>(cloud.points[first]), distances[first]));
}

/// Every patch against all points.
template <int Dim>
void check_patches(const Cloud<Dim>& cloud, std::span<const Patch<Dim>> patches, Observer* observer, CertificateReport& report) {
  const std::span<const Vec<Dim>> points(cloud.points);
  const BoxTree<Dim> tree(points.size(), [points](std::uint32_t i) { return Box<Dim>{points[i], points[i]}; });
  std::vector<Covering> truths(patches.size());
  in_blocks(patches.size(), 1u << 13, "patches", observer, [&](std::size_t i) { truths[i] = covering_of<Dim>(patches[i], points, tree); });
  std::vector<double> highs;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const auto says = static_cast<double>(patches[i].surface_to_data);
    highs.push_back(truths[i].high);
    report.surface_to_data_low = std::max(report.surface_to_data_low, truths[i].low);
    if (truths[i].low <= says + cloud.rounding) continue;
    if (report.wrong_patches++ == 0)
      report.faults.push_back(fmt::format("patch {}, at {}: says {:.9g} m to the data, the truth is at least {:.9g} m", i,
                                          text<Dim>(patches[i].vertices[0]), says, truths[i].low));
  }
  if (report.wrong_patches > 1) report.faults.back() += fmt::format("; so do {} more", report.wrong_patches - 1);
  report.surface_to_data = summed_up(std::move(highs));
}

/// The bounds of the whole: `low` .. `high` hold the truth.
void check_whole(const char* name, double claimed, double low, double high, double rounding, CertificateReport& report) {
  if (!(low <= claimed + rounding)) report.faults.push_back(fmt::format("{} = {:.9g} m: the truth is at least {:.9g} m", name, claimed, low));
  if (claimed > kTenth * high + kThousandth * report.claimed.eta)
    report.loose.push_back(fmt::format("{} = {:.9g} m: more than a tenth above the truth, {:.9g} m", name, claimed, high));
}

}  // namespace

template <int Dim>
CertificateReport check_certificate(std::span<const Vec<Dim>> points, std::span<const Patch<Dim>> patches, const Certificate& claimed,
                                    Observer* observer) {
  for (const Patch<Dim>& patch : patches)
    require(patch.count >= 1 && patch.count <= Patch<Dim>::kMaxVertices &&
                std::all_of(patch.corners().begin(), patch.corners().end(), [](const Vec<Dim>& v) { return v.allFinite(); }),
            fmt::format("patch {}: must have 1 .. {} finite corners", &patch - patches.data(), Patch<Dim>::kMaxVertices));
  const Cloud<Dim> cloud = finite_points(points);
  CertificateReport report;
  report.claimed = claimed;
  report.points = static_cast<std::int64_t>(cloud.points.size());
  report.not_finite = static_cast<std::int64_t>(points.size()) - report.points;
  report.patches = static_cast<std::int64_t>(patches.size());
  check_points(cloud, patches, observer, report);
  check_patches(cloud, patches, observer, report);
  const double to_surface = report.data_to_surface.max;
  check_whole("data_to_surface", claimed.data_to_surface, to_surface, to_surface, cloud.rounding, report);
  check_whole("surface_to_data", claimed.surface_to_data, report.surface_to_data_low, report.surface_to_data.max, cloud.rounding, report);
  if (observer != nullptr) observer->stage("verify done");
  return report;
}

template CertificateReport check_certificate<2>(std::span<const Vec<2>>, std::span<const Patch<2>>, const Certificate&, Observer*);
template CertificateReport check_certificate<3>(std::span<const Vec<3>>, std::span<const Patch<3>>, const Certificate&, Observer*);

}  // namespace vantage

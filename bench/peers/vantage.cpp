// SPDX-License-Identifier: Apache-2.0
// Ours: the Hausdorff tree.
#include <fmt/format.h>

#include "../contender.h"
#include "vantage/base/error.h"
#include "vantage/io/patch_file.h"
#include "vantage/surface/surface.h"

namespace vantage::bench {
namespace {

SurfaceOptions& surface_options() {
  static SurfaceOptions options;
  return options;
}

/// Size of the map as a file [bytes].
double file_bytes(std::span<const Patch<3>> patches) { return static_cast<double>(patches_as_ply<3>(patches).size()); }

class Tree final : public Contender {
 public:
  Tree(double eta, bool at_once) : options_(surface_options()), at_once_(at_once) { options_.eta = eta; }

  void build(const Cloud& cloud, std::size_t scans) override {
    tree_ = std::make_unique<HausdorffTree<3>>(cloud.domain, options_);
    if (at_once_) {
      tree_->insert(cloud.scans_before(scans));
    } else {
      for (std::size_t i = 0; i < scans; ++i) tree_->insert(cloud.scan(i));
    }
    (void)tree_->statistics();  // The certificate belongs to the work.
  }
  bool add(const Cloud& cloud, std::size_t scan) override {
    tree_->insert(cloud.scan(scan));
    (void)tree_->statistics();
    return true;
  }
  Output output() override {
    const std::vector<Patch<3>> patches = tree_->patches();
    const SurfaceStatistics s = tree_->statistics();
    Output out{.soup = {},
               .primitives = static_cast<std::int64_t>(patches.size()),
               .kind = fmt::format("{} fits, {} segments, {} points", s.fits, s.segments, s.loose_points),
               .bytes = file_bytes(patches),
               .data_to_surface = s.data_to_surface,
               .surface_to_data = s.surface_to_data};
    for (const Patch<3>& patch : patches) add_polygon(out.soup, patch.corners());
    return out;
  }

 private:
  SurfaceOptions options_;
  bool at_once_;
  std::unique_ptr<HausdorffTree<3>> tree_;
};

}  // namespace

void set_surface_option(const std::string& text) {
  const std::size_t equals = text.find('=');
  for (Option& option : list_options(surface_options())) {
    if (equals == std::string::npos || option.name != text.substr(0, equals)) continue;
    option.parse(text.substr(equals + 1), "surface." + option.name);
    return;
  }
  require(false, fmt::format("--set {}: must be option=value with an option of the surface stage", text));
}

std::vector<ContenderKind> vantage_contenders() {
  return {
      {"vantage", "vantage, η {} m", "all points at once, with the certificate", {0.1}, [](double eta) { return std::make_unique<Tree>(eta, true); }},
      {"vantage-scans", "vantage scan by scan, η {} m", "the same map, grown scan by scan", {0.1}, [](double eta) {
         return std::make_unique<Tree>(eta, false);
       }}};
}

}  // namespace vantage::bench

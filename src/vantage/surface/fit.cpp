// SPDX-License-Identifier: Apache-2.0
#include "vantage/surface/fit.h"

#include <algorithm>
#include <numeric>

#include "vantage/surface/cluster.h"

namespace vantage {
namespace {

template <int Dim>
Frame<Dim> frame_of(std::span<const Site<Dim>> sites, const Cell<Dim>& cell, const FitRules<Dim>& rules) {
  return principal_frame<Dim>(moments<Dim>(sites, cell.low, cell.bits), rules.snap.step());
}

/// Represents few sites by as few patches as come easily: each part that hangs together by a flat of its own, in halves if it is bent.
template <int Dim>
class FewSites {
 public:
  FewSites(std::span<const Site<Dim>> sites, const Cell<Dim>& cell, const FitRules<Dim>& rules) : sites_(sites), cell_(cell), rules_(rules) {}

  CellFit<Dim> fit() {
    Parts parts;
    find_parts<Dim>(sites_, rules_.snap, reach(sites_), parts);
    for (std::size_t p = 0; p < parts.size(); ++p) carry_whole(parts[p], parts.size() == 1);
    std::sort(fit_.loose.begin(), fit_.loose.end());
    return std::move(fit_);
  }

  CellFit<Dim> refit(std::span<const std::uint32_t> numbers, const CellFit<Dim>& before) {
    Parts parts;
    find_parts<Dim>(sites_, rules_.snap, reach(sites_), parts);
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const auto part = parts[p];
      // With spacing the reach is another one for other sites, and so may the parts be.
      const bool known = rules_.spacing == nullptr && parts.size() > 1 && part.size() > 2 &&
                         std::none_of(part.begin(), part.end(), [&](auto i) { return numbers[i] == kNewSite; });
      if (!known || !take_over(part, numbers, before)) carry_whole(part, parts.size() == 1);
    }
    std::sort(fit_.loose.begin(), fit_.loose.end());
    return std::move(fit_);
  }

 private:
  std::span<const Site<Dim>> sites_;
  const Cell<Dim>& cell_;
  const FitRules<Dim>& rules_;
  CellFit<Dim> fit_;
  std::vector<Site<Dim>> gathered_;

  /// Sites farther apart have no patch together.
  [[nodiscard]] double reach(std::span<const Site<Dim>> sites) const {
    if (rules_.spacing == nullptr || sites.empty()) return 2.0 * rules_.limit;
    return 2.0 * std::max(rules_.limit, rules_.spacing->at_most(sites, rules_.snap.local(sites[sites.size() / 2])));
  }
  /// Good until it is asked again.
  [[nodiscard]] std::span<const Site<Dim>> gather(std::span<const std::uint32_t> numbers) {
    gathered_.clear();
    for (const std::uint32_t i : numbers) gathered_.push_back(sites_[i]);
    return gathered_;
  }

  /// The patches and loose sites that a part had before. False if it was the whole cell then, whose patch may be the cell's.
  bool take_over(std::span<const std::uint32_t> part, std::span<const std::uint32_t> numbers, const CellFit<Dim>& before) {
    const std::uint32_t owner = numbers[part[0]];
    if (owner == 0 && std::count(before.owners.begin(), before.owners.end(), 0U) == static_cast<std::ptrdiff_t>(before.owners.size())) return false;
    for (std::size_t i = 0; i < before.patches.size(); ++i)
      if (before.owners[i] == owner) {
        fit_.patches.push_back(before.patches[i]);
        fit_.owners.push_back(part[0]);
      }
    for (const std::uint32_t i : part)
      if (std::binary_search(before.loose.begin(), before.loose.end(), numbers[i])) fit_.loose.push_back(i);
    return true;
  }

  void carry_whole(std::span<const std::uint32_t> part, bool whole) {
    carry(part, whole);
    fit_.owners.resize(fit_.patches.size(), part[0]);
  }

  void split(std::span<const std::uint32_t> numbers) {
    Parts parts;
    const std::span<const Site<Dim>> sites = gather(numbers);
    find_parts<Dim>(sites, rules_.snap, reach(sites), parts);
    for (std::uint32_t& i : parts.order) i = numbers[i];
    for (std::size_t p = 0; p < parts.size(); ++p) carry(parts[p], false);
  }

  void carry(std::span<const std::uint32_t> part, bool whole) {
    if (part.size() == 1) return fit_.loose.push_back(part[0]);
    if (part.size() == 2 && same_place<Dim>(sites_[part[0]], sites_[part[1]])) return fit_.loose.push_back(part[0]);
    if (part.size() == 2) return fit_.patches.push_back(pair_patch<Dim>(sites_[part[0]], sites_[part[1]], rules_.snap));
    const std::span<const Site<Dim>> sites = gather(part);
    if (const auto chord = fit_chord<Dim>(sites, rules_, kThin * rules_.limit)) return fit_.patches.push_back(*chord);
    const Frame<Dim> frame = frame_of<Dim>(sites, cell_, rules_);
    const bool small = static_cast<std::int64_t>(part.size()) < rules_.min_points;
    if (const auto patch = fit_flat<Dim>(sites, frame, rules_, whole ? &cell_ : nullptr, small ? Dim - 2 : Dim - 1))
      return fit_.patches.push_back(*patch);
    if (small) {
      fit_.loose.insert(fit_.loose.end(), part.begin(), part.end());
      return;
    }
    std::array<std::vector<std::uint32_t>, 2> halves;
    for (const std::uint32_t i : part) halves[frame.local(rules_.snap.local(sites_[i]))[0] > 0.0 ? 1 : 0].push_back(i);
    if (halves[0].empty() || halves[1].empty()) {  // All but equal: rounding alone keeps them from a fit.
      fit_.loose.insert(fit_.loose.end(), part.begin(), part.end());
      return;
    }
    for (const auto& half : halves) split(half);
  }
};

/// Each cluster its own patch.
template <int Dim>
std::optional<CellFit<Dim>> fit_clusters(const Clusters<Dim>& clusters, const Cell<Dim>& cell, const FitRules<Dim>& rules) {
  CellFit<Dim> fit;
  for (const std::vector<Site<Dim>>& cluster : clusters) {
    if (rules.paper && static_cast<std::int64_t>(cluster.size()) < rules.min_points) return std::nullopt;
    const auto patch = fit_flat<Dim>(cluster, frame_of<Dim>(cluster, cell, rules), rules, nullptr, Dim - 1);
    if (!patch) return std::nullopt;
    fit.patches.push_back(*patch);
  }
  return fit;
}

/// Two patches for two clusters (paper Sec. IV).
template <int Dim>
std::optional<CellFit<Dim>> fit_two(GatheredSites<Dim>& sites, const Frame<Dim>& frame, const Cell<Dim>& cell, const FitRules<Dim>& rules) {
  Clusters<Dim> failed;
  for (int axis = 0; axis < Dim && frame.variance[axis] > kThin * kThin * rules.limit * rules.limit; ++axis) {
    auto clusters = two_clusters<Dim>(sites, cell, rules, frame, axis);
    if (!clusters || *clusters == failed) continue;
    if (auto fit = fit_clusters<Dim>(*clusters, cell, rules)) return fit;
    failed = std::move(*clusters);
  }
  return std::nullopt;
}

/// Is a patch on the frame's plane out of the question, by the mean square or a sample of the sites?
template <int Dim>
bool sample_rejects(const SiteView<Dim>& sites, const Cell<Dim>& cell, const Frame<Dim>& frame, const FitRules<Dim>& rules) {
  if (frame.variance[Dim - 1] > rules.limit * rules.limit) return true;
  const std::vector<Site<Dim>> sample = spread_sample<Dim>(sites, cell);
  const auto off_plane = [&](const Site<Dim>& site) { return std::abs(frame.local(rules.snap.local(site))[Dim - 1]) > rules.limit; };
  return std::any_of(sample.begin(), sample.end(), off_plane) ||
         shows_hole<Dim>(probe_pairs<Dim>(sites, cell), sites, cell, frame, rules.snap,
                         rules.spacing != nullptr ? std::max(rules.limit, rules.spacing->most()) : rules.limit);
}

}  // namespace

template <int Dim>
std::optional<CellFit<Dim>> fit_cell(GatheredSites<Dim>& sites, const Moments<Dim>* known, const Cell<Dim>& cell, const FitRules<Dim>& rules,
                                     Refusal<Dim>* refusal) {
  const bool few = sites.size() <= kFewSites;
  if (few && !rules.paper) return FewSites<Dim>(sites.all(), cell, rules).fit();
  const Moments<Dim> sums = known != nullptr ? *known : moments<Dim>(sites.all(), cell.low, cell.bits);
  const Frame<Dim> frame = principal_frame(sums, rules.snap.step());
  if (few || !sample_rejects<Dim>(sites.view(), cell, frame, rules)) {
    const bool plain = !rules.paper && rules.spacing == nullptr && !rules.sharp;
    FlatReport<Dim> report;
    const bool large = plain && sites.size() >= kManySites;
    if (auto one = fit_flat<Dim>(sites.all(), frame, rules, &cell, Dim - 1, large ? &report : nullptr)) {
      if (plain) set_limit_bounds(*one, rules);
      CellFit<Dim> fit{{*one}, {}, {}, nullptr};
      if (report.surface > 0.0) fit.standing = std::make_unique<Standing<Dim>>(Standing<Dim>{sums, report.data, report.surface});
      return fit;
    }
    if (refusal != nullptr) *refusal = report.refusal;
  }
  if (!rules.paper) return std::nullopt;
  return fit_two<Dim>(sites, frame, cell, rules);
}

template <int Dim>
CellFit<Dim> refit_few(std::span<const Site<Dim>> sites, std::span<const std::uint32_t> numbers, const CellFit<Dim>& before, const Cell<Dim>& cell,
                       const FitRules<Dim>& rules) {
  return FewSites<Dim>(sites, cell, rules).refit(numbers, before);
}

template <int Dim>
CellFit<Dim> fit_at_limit(std::span<const Site<Dim>> sites, const Cell<Dim>& cell, const FitRules<Dim>& rules) {
  const Frame<Dim> frame = frame_of<Dim>(sites, cell, rules);
  if (rules.paper) return {{force_plane<Dim>(sites, frame, rules)}, {}, {}, nullptr};
  CellFit<Dim> fit;
  std::vector<Site<Dim>> carried;
  for (std::uint32_t i = 0; i < sites.size(); ++i) {
    const bool on_plane = std::abs(frame.local(rules.snap.local(sites[i]))[Dim - 1]) <= rules.limit;
    if (on_plane) carried.push_back(sites[i]);
    if (!on_plane) fit.loose.push_back(i);
  }
  if (static_cast<std::int64_t>(carried.size()) >= rules.min_points)
    if (const auto patch = fit_flat<Dim>(carried, frame, rules, nullptr, Dim - 1)) {
      fit.patches.push_back(*patch);
      return fit;
    }
  fit.loose.resize(sites.size());
  std::iota(fit.loose.begin(), fit.loose.end(), 0U);
  return fit;
}

#define VANTAGE_INSTANTIATE(D)                                                                                                                       \
  template std::optional<CellFit<D>> fit_cell<D>(GatheredSites<D>&, const Moments<D>*, const Cell<D>&, const FitRules<D>&, Refusal<D>*);             \
  template CellFit<D> refit_few<D>(std::span<const Site<D>>, std::span<const std::uint32_t>, const CellFit<D>&, const Cell<D>&, const FitRules<D>&); \
  template CellFit<D> fit_at_limit<D>(std::span<const Site<D>>, const Cell<D>&, const FitRules<D>&);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage

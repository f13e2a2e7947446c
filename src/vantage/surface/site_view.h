// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>
#include <vector>

#include "vantage/surface/node.h"

namespace vantage {

/// The sites of a cell in Morton order, wherever they are: in one span, or in the leaves below a node. What is asked of them is the same either way.
template <int Dim>
class SiteView {
 public:
  SiteView() = default;
  SiteView(std::span<const Site<Dim>> sites) : sites_(sites) {}     // NOLINT(google-explicit-constructor)
  SiteView(const std::vector<Site<Dim>>& sites) : sites_(sites) {}  // NOLINT(google-explicit-constructor)
  explicit SiteView(const Node<Dim>& node);

  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] bool empty() const { return size() == 0; }
  /// The site of that rank.
  [[nodiscard]] const Site<Dim>& operator[](std::size_t rank) const;
  /// Those of the children of `cell`, which is the view's own.
  [[nodiscard]] std::array<SiteView, Cell<Dim>::kChildren> split(const Cell<Dim>& cell) const;
  /// All in one array.
  [[nodiscard]] std::vector<Site<Dim>> collect() const;
  /// Not spread over leaves: `span` holds them.
  [[nodiscard]] bool in_one_span() const { return inner_ == nullptr; }
  [[nodiscard]] std::span<const Site<Dim>> span() const { return sites_; }

 private:
  std::span<const Site<Dim>> sites_;
  const InnerNode<Dim>* inner_ = nullptr;
};

/// A view whose sites are brought together when someone asks for all of them, once.
template <int Dim>
class GatheredSites {
 public:
  explicit GatheredSites(const SiteView<Dim>& view) : view_(view) {}
  [[nodiscard]] const SiteView<Dim>& view() const { return view_; }
  [[nodiscard]] std::size_t size() const { return view_.size(); }
  [[nodiscard]] std::span<const Site<Dim>> all() {
    if (view_.in_one_span()) return view_.span();
    if (sites_.empty()) sites_ = view_.collect();
    return sites_;
  }
  /// Sites read so far.
  [[nodiscard]] std::size_t read() const { return sites_.size(); }

 private:
  SiteView<Dim> view_;
  std::vector<Site<Dim>> sites_;
};

/// Is there no site within `radius` of `center`? Lengths are in steps. Cost follows the ball, not the cell.
template <int Dim>
[[nodiscard]] bool is_empty_ball(const SiteView<Dim>& sites, const Cell<Dim>& cell, const Vec<Dim>& center, double radius);

/// First and middle sites of the cell's grandchildren (spread over the cell, however dense the sites), those of neighbours far apart in the order.
template <int Dim>
[[nodiscard]] std::vector<Site<Dim>> spread_sample(const SiteView<Dim>& sites, const Cell<Dim>& cell);

}  // namespace vantage

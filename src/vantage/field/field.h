// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "vantage/field/grid.h"
#include "vantage/field/pages.h"

namespace vantage {

/// One value per node of a window, axis 0 fastest.
template <int Dim, class Value = float>
  requires SpatialDim<Dim>
struct Field {
  Grid<Dim> window;
  std::vector<Value> values;

  Field() = default;
  explicit Field(const Grid<Dim>& w, Value value = Value()) : window(w) {
    values.reserve(w.size());
    prefer_large_pages(values.data(), w.size() * sizeof(Value));
    values.resize(w.size(), value);
  }
  [[nodiscard]] Value& operator[](std::size_t i) { return values[i]; }
  [[nodiscard]] const Value& operator[](std::size_t i) const { return values[i]; }
  [[nodiscard]] Value& at(const Index<Dim>& local) { return values[window.linear(local)]; }
  [[nodiscard]] const Value& at(const Index<Dim>& local) const { return values[window.linear(local)]; }
};

/// What is known of a node. `obstacle` belongs to the occlusion set but is known; outside the domain there is nothing.
enum class NodeState : std::uint8_t { unseen = 0, seen = 1, obstacle = 2 };

}  // namespace vantage

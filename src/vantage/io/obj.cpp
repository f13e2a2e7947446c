// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/obj.h"

#include <fmt/format.h>

#include <iterator>

namespace vantage {

template <int Dim>
std::string patches_as_obj(std::span<const Patch<Dim>> patches) {
  constexpr char kElements[] = {'p', 'l', 'f'};  // By rank.
  std::string vertices, elements;
  std::int64_t next = 1;
  for (const Patch<Dim>& patch : patches) {
    elements += kElements[patch.rank()];
    for (const Vec<Dim>& corner : patch.corners()) {
      Vec<3> p = Vec<3>::Zero();
      p.head<Dim>() = corner;
      fmt::format_to(std::back_inserter(vertices), "v {} {} {}\n", p[0], p[1], p[2]);
      fmt::format_to(std::back_inserter(elements), " {}", next++);
    }
    elements += '\n';
  }
  return "# vantage: metres, z up\n" + vertices + elements;
}

template std::string patches_as_obj<2>(std::span<const Patch<2>>);
template std::string patches_as_obj<3>(std::span<const Patch<3>>);

}  // namespace vantage

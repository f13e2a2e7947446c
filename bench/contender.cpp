// SPDX-License-Identifier: Apache-2.0
#include "contender.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "vantage/base/error.h"

namespace vantage::bench {
namespace {

using Kinds = std::vector<ContenderKind> (*)();

std::vector<ContenderKind> all() {
  const std::vector<Kinds> files{
      vantage_contenders,
#ifdef VANTAGE_OCTOMAP
      octomap_contenders,
#endif
#ifdef VANTAGE_CGAL
      cgal_contenders,
#endif
#ifdef VANTAGE_OPENVDB
      openvdb_contenders,
#endif
#ifdef VANTAGE_DRACO
      draco_contenders,
#endif
  };
  std::vector<ContenderKind> kinds;
  for (const Kinds file : files) std::ranges::move(file(), std::back_inserter(kinds));
  return kinds;
}

}  // namespace

const std::vector<ContenderKind>& contenders() {
  static const std::vector<ContenderKind> kinds = all();
  return kinds;
}

const ContenderKind& find_contender(const std::string& name) {
  std::string names;
  for (const ContenderKind& kind : contenders()) {
    if (kind.name == name) return kind;
    names += (names.empty() ? "" : ", ") + kind.name;
  }
  throw Error(ErrorCode::bad_input, fmt::format("{}: no such contender in this build; there are {}", name, names));
}

}  // namespace vantage::bench

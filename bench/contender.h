// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cloud.h"
#include "distance.h"

namespace vantage::bench {

/// What a contender's map amounts to.
struct Output {
  Soup soup;                                               ///< The reconstruction, to be judged.
  std::int64_t primitives = 0;                             ///< Of the contender's own kind.
  std::string kind;                                        ///< "voxels", "planes", ...; more about them, for the table.
  double bytes = 0.0;                                      ///< In the contender's own file format.
  std::optional<double> data_to_surface, surface_to_data;  ///< Bounds of its own, if it has any [m].
};

/// A mapper under test. Its own structures only: whoever measures it knows `Soup` alone.
class Contender {
 public:
  virtual ~Contender() = default;
  /// Maps the first `scans` scans.
  virtual void build(const Cloud& cloud, std::size_t scans) = 0;
  /// Adds one more scan; false if it cannot.
  virtual bool add(const Cloud& /*cloud*/, std::size_t /*scan*/) { return false; }
  /// The reconstruction so far, the primitives already in memory.
  [[nodiscard]] virtual Output output() = 0;
};

/// A kind of mapper with one number to choose.
struct ContenderKind {
  std::string name;                ///< As on the command line: NAME:PARAMETER.
  std::string title;               ///< In the table; {} is the parameter.
  std::string doc;                 ///< What was measured, one sentence.
  std::vector<double> parameters;  ///< In the paper's table.
  std::function<std::unique_ptr<Contender>(double parameter)> make;
  bool match = false;  ///< In the paper's table, ours at its largest error stands beside it.
};

/// Ours and the peers that were built in.
[[nodiscard]] const std::vector<ContenderKind>& contenders();
/// Throws bad_input for an unknown name.
[[nodiscard]] const ContenderKind& find_contender(const std::string& name);

// One a file under peers/.
[[nodiscard]] std::vector<ContenderKind> vantage_contenders();
[[nodiscard]] std::vector<ContenderKind> octomap_contenders();
[[nodiscard]] std::vector<ContenderKind> cgal_contenders();
[[nodiscard]] std::vector<ContenderKind> openvdb_contenders();
[[nodiscard]] std::vector<ContenderKind> draco_contenders();

/// `name=value` of the surface options, for all of ours. Throws bad_input.
void set_surface_option(const std::string& text);

}  // namespace vantage::bench

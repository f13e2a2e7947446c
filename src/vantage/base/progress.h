// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

namespace vantage {

/// What a long computation tells its caller, who may ask it to stop. The library itself prints nothing.
class Observer {
 public:
  virtual ~Observer() = default;
  /// `stage` begins ("scan", "surface", "visibility", "belief", "planner").
  virtual void stage(std::string_view /*name*/) {}
  /// Something the user should know, e.g. that eta is below four sigma of the noise.
  virtual void warn(std::string_view /*message*/) {}
  /// Asked between steps; true stops cleanly.
  [[nodiscard]] virtual bool stop_requested() { return false; }
};

}  // namespace vantage

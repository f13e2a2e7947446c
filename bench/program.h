// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include "vantage/base/error.h"

namespace vantage::bench {

/// What main() of a bench returns: that of `run`; an error is one line, and 2.
template <class Run>
int guarded(const char* name, Run&& run) {
  try {
    return run();
  } catch (const Error& error) {
    fmt::print(stderr, "{}: {}\n", name, error.what());
    return 2;
  }
}

}  // namespace vantage::bench

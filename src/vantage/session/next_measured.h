// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "vantage/session/next.h"

namespace vantage {

/// Where to scan next, of a person's scans: those of the folder that `request` names, if it `exists`, and those of the files. See find_next().
[[nodiscard]] NextOutcome next_of_measured(const NextRequest& request, std::span<const std::filesystem::path> files, bool exists, Observer* observer);

}  // namespace vantage

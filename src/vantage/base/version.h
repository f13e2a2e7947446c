// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace vantage {

/// Version of the build, from CMakeLists.txt.
inline constexpr const char* kVersion = VANTAGE_VERSION;

}  // namespace vantage

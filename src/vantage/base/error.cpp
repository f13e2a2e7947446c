// SPDX-License-Identifier: Apache-2.0
#include "vantage/base/error.h"

#include <fmt/format.h>

#include <fstream>

namespace vantage {
namespace {

double available_bytes() {
  std::ifstream meminfo("/proc/meminfo");
  std::string key, unit;
  double kibibytes = 0.0;
  while (meminfo >> key >> kibibytes) {
    if (key == "MemAvailable:") return kibibytes * 1024.0;
    std::getline(meminfo, unit);
  }
  return 1e18;  // Unknown: let the allocation itself decide.
}

}  // namespace

Error::Error(ErrorCode code, const std::string& message, std::string where)
    : std::runtime_error(where.empty() ? message : where + ": " + message), code_(code), where_(std::move(where)) {}

void require(bool condition, std::string_view message, std::string_view where) {
  if (!condition) throw Error(ErrorCode::bad_input, std::string(message), std::string(where));
}

void require_memory(double count, double bytes_each, std::string_view what) {
  constexpr double kGiB = 1024.0 * 1024.0 * 1024.0;
  const double need = count * bytes_each;
  const double have = available_bytes();
  if (need > have) throw Error(ErrorCode::memory, fmt::format("{}: needs {:.1f} GiB, {:.1f} GiB are free", what, need / kGiB, have / kGiB));
}

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <string>
#include <string_view>

#include "vantage/geometry/angle.h"
#include "vantage/io/bytes.h"
#include "vantage/session/scan_log.h"

namespace vantage::samples {

/// Two scans of four rays and fewer, the second with measured points.
template <int Dim>
std::string scan_log() {
  Scan<Dim> scan;
  scan.pattern.step = radians(20);
  scan.pattern.horizontal_fov = 4 * scan.pattern.step;
  scan.pattern.vertical_fov = scan.pattern.step;
  scan.ranges.assign(static_cast<std::size_t>(scan.pattern.columns()) * static_cast<std::size_t>(scan.pattern.template rows<Dim>()), 2.5F);
  scan.ranges.front() = kNoReturn;
  Scan<Dim> measured = scan;
  measured.origin[0] = 1.0;
  measured.points = {Vec<Dim>::Constant(0.5), Vec<Dim>::Constant(-3.25)};
  const Scan<Dim> scans[] = {scan, measured};
  return scans_as_log<Dim>(scans);
}

/// A changed log of the same size with the checksums of its records made right again, for tests of what lies behind them.
inline std::string resealed_log(std::string_view changed) {
  constexpr std::size_t kHeader = 16, kNumber = 4;
  std::string file(changed);
  const auto set = [&](std::size_t at, std::uint32_t value) { overwrite(file, at, value); };
  for (std::size_t at = kHeader; at + kHeader <= file.size();) {
    const std::size_t size = std::min<std::size_t>(get<std::uint32_t>(file, at + kNumber), file.size() - at - kHeader);
    set(at + kNumber, static_cast<std::uint32_t>(size));
    set(at + 2 * kNumber, checksum(std::string_view(file).substr(at + kHeader, size)));
    set(at + 3 * kNumber, checksum(std::string_view(file).substr(at, 3 * kNumber)));
    at += kHeader + size;
  }
  return file;
}

}  // namespace vantage::samples

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/io/scan_writer.h"

namespace vantage {

/// The formats behind `scans_as`. Of what is left out they tell only what they alone know.
[[nodiscard]] WrittenScans scans_as_ply(std::span<const MeasuredScan> scans, const ScanWriteOptions& options);
/// With VIEWPOINT, if there is one scan and it has a pose.
[[nodiscard]] WrittenScans scans_as_pcd(std::span<const MeasuredScan> scans, const ScanWriteOptions& options);
/// Point format 0, or 6 of LAS 1.4 without a coordinate system; the number of the scan, from 1, is the point source ID.
[[nodiscard]] WrittenScans scans_as_las(std::span<const MeasuredScan> scans, const ScanWriteOptions& options);

/// 2 if all scans are planes, else 3.
[[nodiscard]] int common_dim(std::span<const MeasuredScan> scans);
[[nodiscard]] std::size_t point_count(std::span<const MeasuredScan> scans);

}  // namespace vantage

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <vector>

#include "vantage/io/geojson.h"
#include "vantage/io/scan_file.h"
#include "vantage/scan/scan.h"

/// What `vantage convert` tells apart.
enum class ConvertKind { scans, surface, field };

/// By content, then by name; a run folder counts as scans. Throws bad_input for files of no kind, naming the command for them where there is one; io.
[[nodiscard]] ConvertKind convert_kind(const std::filesystem::path& in);

/// A scan as the writers of files take it.
template <int Dim>
[[nodiscard]] vantage::MeasuredScan as_measured(const vantage::Scan<Dim>& scan);

struct LoadedScans {
  std::vector<vantage::MeasuredScan> scans;
  std::vector<std::string> left_out;  ///< What the scans cannot hold any more.
};

/// The scans of a file, a log or a run folder. Throws io, bad_input.
[[nodiscard]] LoadedScans load_scans(const std::filesystem::path& in);

/// Stations of the scans that know theirs; of a run folder also its path and the places that `vantage next` ranked.
[[nodiscard]] std::vector<vantage::MapFeature> map_features(const std::filesystem::path& in, const std::vector<vantage::MeasuredScan>& scans);

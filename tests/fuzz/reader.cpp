// SPDX-License-Identifier: Apache-2.0
// libFuzzer on the reader of one format of scans.
#include "contract.h"
#include "vantage/io/sample_scans.h"
#include "vantage/io/scan_file.h"

namespace {

constexpr std::string_view kName = "fuzz." VANTAGE_FUZZ_ENDING;
constexpr bool kPages = std::string_view(VANTAGE_FUZZ_ENDING) == "e57";
constexpr std::size_t kPage = 1024;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return keeps_contract(data, size, [](std::string_view bytes) {
    for (const vantage::MeasuredScan& scan : vantage::parse_scan_file(bytes, kName)) {
      for (const vantage::Vec<3>& p : scan.points) demand(p.allFinite());
      if (!scan.rays) continue;
      demand(scan.rays->point.size() == static_cast<std::size_t>(scan.rays->columns) * static_cast<std::size_t>(scan.rays->rows));
      for (const std::int32_t ray : scan.rays->point)
        demand(ray >= vantage::RayTable::kNoData && ray < static_cast<std::int64_t>(scan.points.size()));
    }
  });
}

/// E57: three in four changes get checksums and a length that hide them, or none would reach what lies behind.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  size = LLVMFuzzerMutate(data, size, most);
  if (!kPages || size < kPage || seed % 4 == 0) return size;
  std::string file(reinterpret_cast<const char*>(data), size / kPage * kPage);
  if (seed % 4 == 1) {
    std::string length;
    vantage::put<std::uint64_t>(length, file.size());
    file.replace(16, length.size(), length);
  }
  file = vantage::samples::e57_resealed(file);
  std::copy(file.begin(), file.end(), data);
  return file.size();
}

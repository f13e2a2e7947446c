// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "vantage/base/progress.h"
#include "vantage/scan/scan.h"

namespace vantage {

/// The durable list of a run's scans (`scans.log`), from which all else is made. A file of
///
///     header   "VANTSCAN", u32 version, u32 dimension
///     record   "SCAN", u32 bytes of the payload, u32 CRC-32 of the payload, u32 CRC-32 of these first 12 bytes, payload
///     payload  u32 index, Dim x f64 origin, Dim x Dim x f64 rotation (row by row), 5 x f64 pattern (step, horizontal and vertical field of
///              view [rad], min and max range [m]), u64 rays, rays x f32 range [m] (infinity: no return, NaN: no data);
///              of a scan that keeps its measured points also u64 points, points x Dim x f64 [m]
///
/// all little-endian, records back to back. A scan is acknowledged only once it is on the disk. One process at a time may hold it open.
template <int Dim>
  requires SpatialDim<Dim>
class ScanLog {
 public:
  /// A new log; throws io if the file exists or cannot be made.
  [[nodiscard]] static ScanLog create(const std::filesystem::path& path);
  /// Opens and verifies a log to go on with it. A torn last record (the machine stopped while it was written) is cut off, with a warning; damage
  /// anywhere else throws bad_input naming `FILE:OFFSET`; io when another process writes it.
  [[nodiscard]] static ScanLog open(const std::filesystem::path& path, Observer* observer = nullptr);
  /// The same without touching the file; `append` is not allowed.
  [[nodiscard]] static ScanLog open_to_read(const std::filesystem::path& path);
  ~ScanLog();
  ScanLog(ScanLog&& other) noexcept;
  ScanLog& operator=(ScanLog&&) = delete;

  [[nodiscard]] int size() const { return static_cast<int>(records_.size()); }
  [[nodiscard]] Scan<Dim> read(int index) const;
  /// Returns once the scan is on the disk; throws io, and the log is as before.
  void append(const Scan<Dim>& scan);

 private:
  struct Record {
    std::uint64_t offset = 0;  ///< Of the payload.
    std::uint32_t length = 0;
  };
  ScanLog(std::filesystem::path path, int file) : path_(std::move(path)), file_(file) {}
  /// Lists the records; returns the offset of a torn one at the end, or the file's size.
  std::uint64_t list_records(std::uint64_t bytes);
  /// Adds the record at the end of those listed; false if it is torn.
  bool list_record(std::uint64_t bytes);

  std::filesystem::path path_;
  int file_ = -1;
  std::uint64_t end_ = 0;
  std::vector<Record> records_;
};

/// Dimension of the log at `path`, from its header. Throws io, or bad_input if it is none.
[[nodiscard]] int scan_log_dim(const std::filesystem::path& path);

/// A whole log of the given scans, numbered from 0.
template <int Dim>
[[nodiscard]] std::string scans_as_log(std::span<const Scan<Dim>> scans);

/// Takes scans out of the log at `path` (the others move up) and keeps the log as it was beside it as `scans.log.bak`. Throws bad_input for an
/// index that is not there, io.
template <int Dim>
void remove_scans(const std::filesystem::path& path, std::span<const int> indices);

}  // namespace vantage
